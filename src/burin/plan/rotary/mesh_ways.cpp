// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/mesh_ways.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/base/text.h"
#include "burin/plan/rotary/cusp.h"
#include "burin/plan/rotary/slicer.h"
#include "burin/plan/rotary/sweep.h"

namespace burin::rotary::detail {
namespace {

/// Sections a turn of the spiral: between two of them it climbs by a small part of the side step, and goes
/// straight from one to the other.
constexpr std::size_t kSectors = 48;

Error many_pieces(double x, std::size_t loops) {
  return {ErrorCode::unsupported,
          "the section at x " + format_fixed(x, 3) + " has " + std::to_string(loops) +
              " loops (spiral and lines need one around the axis; rings take any)",
          {}};
}

Result<MeshRing> only_ring(Slicer& slicer, double x) {
  std::vector<MeshRing> rings = slicer.rings(x);
  if (rings.size() != 1 || !rings[0].closed) return many_pieces(x, rings.size());
  return std::move(rings[0]);
}

void append(std::vector<Contact>& points, const Contact& c) {
  if (!points.empty() && points.back().p == c.p && points.back().n == c.n) return;
  points.push_back(c);
}

/// The sector from u0 to u1 of the ring `a`, moved towards `b` by the part of the turn that has gone by.
void append_sector(std::vector<Contact>& points, const MeshRing& a, const MeshRing& b, double u0, double u1) {
  const auto moved = [&](const Contact& c) {
    Contact m = c;
    const double f = (c.u - u0) / (u1 - u0);
    m.p = lerp(c.p, at_u(b, c.u).p, f);
    m.w = c.w + f * (b.points.front().w - c.w);
    append(points, m);
  };
  moved(at_u(a, u0));
  for (const Contact& c : a.points) {
    if (c.u > u0 && c.u < u1) moved(c);
  }
}

}  // namespace

Result<PatternResult> mesh_spiral(const Part& part, const PatternOptions& options,
                                  const std::vector<double>& xs, PatternResult result) {
  // One step for all turns: the least one between rings (the last is what remains).
  double least = part.x_max - part.x_min;
  for (std::size_t i = 1; i + 1 < xs.size(); ++i) least = std::min(least, xs[i] - xs[i - 1]);
  const double length = part.x_max - part.x_min;
  const double turns = std::max(1.0, std::ceil(length / least * (1 - 1e-12)));
  if (turns + 2 > double(options.max_paths)) return too_many(options, turns, 1000);
  Slicer slicer(part, options.ball_radius, options.density_mm);
  ContactPath path;
  auto ring = only_ring(slicer, part.x_min);
  if (!ring) return ring.error();
  for (const Contact& c : ring->points) append(path.points, c);
  const std::size_t sectors = std::size_t(turns) * kSectors;
  for (std::size_t k = 0; k < sectors; ++k) {
    auto next = only_ring(slicer, part.x_min + length * (double(k + 1) / double(sectors)));
    if (!next) return next.error();
    const double u = double(k % kSectors) / double(kSectors);
    append_sector(path.points, *ring, *next, u, u + 1.0 / double(kSectors));
    if (path.points.size() > options.max_points) {
      return too_many(options, turns, double(path.points.size()) / double(k + 1) * double(kSectors));
    }
    ring = std::move(next);
  }
  for (const Contact& c : ring->points) append(path.points, c);
  append(path.points, ring->points.front());
  result.side_step_min = result.side_step_max = length / turns;
  result.paths.push_back(std::move(path));
  return result;
}

namespace {

class MeshLines {
 public:
  MeshLines(const Part& part, const PatternOptions& options) : part_(part), options_(options) {}

  Result<PatternResult> run();

 private:
  std::optional<Error> slice();
  SegmentRuns line(double u) const {
    SegmentRuns way;
    for (std::size_t i = 0; i + 1 < rings_.size(); ++i) {
      way.add(center_of(at_u(rings_[i], u), options_.ball_radius),
              center_of(at_u(rings_[i + 1], u), options_.ball_radius));
    }
    return way;
  }
  double cusp(double a, double b) const;
  double gap(double a, double b) const {
    double most = 0;
    for (const MeshRing& r : rings_) most = std::max(most, r.length * (b - a));
    return most;
  }

  const Part& part_;
  const PatternOptions& options_;
  std::vector<MeshRing> rings_;
};

std::optional<Error> MeshLines::slice() {
  constexpr double kMost = 1000;
  const double length = part_.x_max - part_.x_min;
  const std::size_t n = std::size_t(std::clamp(std::ceil(4 * length / options_.ball_radius), 16.0, kMost));
  Slicer slicer(part_, options_.ball_radius, options_.density_mm);
  for (std::size_t i = 0; i <= n; ++i) {
    auto ring = only_ring(slicer, i == n ? part_.x_max : part_.x_min + length * (double(i) / double(n)));
    if (!ring) return ring.error();
    rings_.push_back(std::move(*ring));
  }
  return std::nullopt;
}

double MeshLines::cusp(double a, double b) const {
  const SegmentRuns line_a = line(a), line_b = line(b);
  double worst = 0;
  std::size_t hint_a = 0, hint_b = 0;
  for (const double f : {0.5, 0.25, 0.75}) {
    for (const MeshRing& ring : rings_) {
      const Contact q = at_u(ring, a + f * (b - a));
      const double height = entry(line_a, q.p, q.n, options_.ball_radius, hint_a);
      if (height <= worst) continue;
      worst = std::max(worst, std::min(height, entry(line_b, q.p, q.n, options_.ball_radius, hint_b)));
    }
  }
  return worst;
}

Result<PatternResult> MeshLines::run() {
  if (auto error = slice()) return *error;
  double longest = 0;
  for (const MeshRing& r : rings_) longest = std::max(longest, r.length);
  const double flat = flat_or_side_step(options_);
  // 2 million cusps are a minute's work.
  const double limit = std::min(double(options_.max_paths), 2e6 / double(rings_.size()));
  if (longest / (8 * flat) > limit) return too_many(options_, longest / flat, double(rings_.size()));
  PatternResult result;
  result.side_step_min = std::numeric_limits<double>::infinity();
  double guess = flat / longest;
  std::vector<double> us{0};
  while (us.back() < 1) {
    const double u = us.back(), rest = 1 - u;
    double step = options_.side_step ? std::min(flat / longest, rest)
                                     : step_for([&](double d) { return cusp(u, u + d); }, options_.scallop,
                                                std::min(guess, rest), rest);
    // An edge along X: lines cannot lie on both of its sides exactly.
    if (!(step > 0)) step = std::min(rest, guess / 16);
    guess = step;
    const double to = step >= rest * (1 - 1e-9) ? 1 : u + step;
    result.side_step_min = std::min(result.side_step_min, gap(u, to));
    result.side_step_max = std::max(result.side_step_max, gap(u, to));
    if (!options_.side_step) result.scallop_max = std::max(result.scallop_max, cusp(u, to));
    us.push_back(to);
    if (double(us.size()) * double(rings_.size()) > double(options_.max_points) ||
        double(us.size()) > limit + 1) {
      return too_many(options_, double(us.size()) / to, double(rings_.size()));
    }
  }
  us.pop_back();  // the first one again
  for (std::size_t k = 0; k < us.size(); ++k) {
    ContactPath path;
    for (const MeshRing& ring : rings_) path.points.push_back(at_u(ring, us[k]));
    if (k % 2 == 1) std::reverse(path.points.begin(), path.points.end());
    result.paths.push_back(std::move(path));
  }
  return result;
}

}  // namespace

Result<PatternResult> mesh_lines(const Part& part, const PatternOptions& options) {
  return MeshLines(part, options).run();
}

}  // namespace burin::rotary::detail
