// SPDX-License-Identifier: Apache-2.0
// Rings on a general part: sections of its mesh. The step to the next ring is found from the balls of the two
// rings and contacts of sections between them, beginning with the step before.
#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/base/text.h"
#include "burin/plan/rotary/cusp.h"
#include "burin/plan/rotary/mesh_ways.h"
#include "burin/plan/rotary/patterns.h"
#include "burin/plan/rotary/slicer.h"
#include "burin/plan/rotary/sweep.h"

namespace burin::rotary::detail {

double flat_or_side_step(const PatternOptions& o) {
  return o.side_step ? *o.side_step : flat_step(o.ball_radius, o.scallop);
}

void report_steep(const Part& part, const PatternOptions& options, Diagnostics& diagnostics) {
  // Faces that stand across X: rings run past them, their cusps are not bounded.
  constexpr double kSteep = 0.985;  // of the normal along X: 10 degrees
  double area = 0, x = 0, largest = 0;
  for (const auto& t : part.mesh.triangles) {
    const geom::Point3 a = part.mesh.vertices[t[0]], b = part.mesh.vertices[t[1]],
                       c = part.mesh.vertices[t[2]];
    const geom::Vec3 n = 0.5 * cross(b - a, c - a);
    const double size = norm(n), middle = (a.x + b.x + c.x) / 3;
    const bool end = middle - part.x_min < options.scallop || part.x_max - middle < options.scallop;
    if (end || std::abs(n.x) < kSteep * size) continue;
    area += size;
    if (size > largest) {
      largest = size;
      x = middle;
    }
  }
  const double step = flat_or_side_step(options);
  if (area <= step * step) return;
  diagnostics.left_out("steep_faces", format_fixed(area, 2) +
                                          " mm2 of the part stand across the X axis (the largest face at x " +
                                          format_fixed(x, 3) +
                                          "): rings and lines do not bound the cusps there");
}

namespace {

/// Steps are looked for between these parts of the flat step.
constexpr double kLeastStep = 1.0 / 64;
constexpr int kTries = 10;
constexpr std::size_t kProbes = 500;  ///< contacts looked at in a section

class MeshRings {
 public:
  MeshRings(const Part& part, const PatternOptions& options)
      : part_(part), options_(options), slicer_(part, options.ball_radius, 2e-3 * options.ball_radius) {}

  Result<std::vector<double>> places(PatternResult& result, Diagnostics& diagnostics);

 private:
  struct Ways {
    double x = 0;
    SegmentRuns centers;
    double widest = 1;  ///< mm across the ring on the surface for a mm of X
  };
  Ways ways_at(double x);
  double cusp(const Ways& a, const Ways& b);
  double step_from(const Ways& a, double guess, Ways& next, double& height);

  const Part& part_;
  const PatternOptions& options_;
  Slicer slicer_;
};

MeshRings::Ways MeshRings::ways_at(double x) {
  Ways ways;
  ways.x = x;
  for (const MeshRing& ring : slicer_.rings(x)) {
    const std::size_t n = ring.points.size();
    for (std::size_t i = 0; i + 1 < n + (ring.closed ? 1 : 0); ++i) {
      const Contact &a = ring.points[i], &b = ring.points[(i + 1) % n];
      ways.centers.add(center_of(a, options_.ball_radius), center_of(b, options_.ball_radius));
      const double flat = 1 - std::min(a.n.x * a.n.x, 0.99);
      ways.widest = std::max(ways.widest, 1 / std::sqrt(flat));
    }
  }
  return ways;
}

double MeshRings::cusp(const Ways& a, const Ways& b) {
  double worst = 0;
  for (const double f : {0.5, 0.4, 0.6}) {
    for (const MeshRing& ring : slicer_.rings(a.x + f * (b.x - a.x))) {
      const std::size_t stride = std::max<std::size_t>(1, ring.points.size() / kProbes);
      std::size_t hint_a = 0, hint_b = 0;
      for (std::size_t i = 0; i < ring.points.size(); i += stride) {
        const Contact& q = ring.points[i];
        double height = std::numeric_limits<double>::infinity();
        if (!a.centers.empty()) height = entry(a.centers, q.p, q.n, options_.ball_radius, hint_a);
        if (!b.centers.empty() && height > worst) {
          height = std::min(height, entry(b.centers, q.p, q.n, options_.ball_radius, hint_b));
        }
        worst = std::max(worst, height);
      }
    }
  }
  return worst;
}

/// The place after a; `next` are its ways.
double MeshRings::step_from(const Ways& a, double guess, Ways& next, double& height) {
  const double flat = flat_or_side_step(options_);
  const double least = kLeastStep * flat, longest = part_.x_max - a.x;
  double step = std::clamp(guess, least, std::max(least, longest)), good = 0, bad = longest * 2;
  height = 0;
  for (int k = 0; k < kTries; ++k) {
    step = std::min(step, longest);
    Ways b = ways_at(a.x + step);
    const double h = options_.side_step ? 0 : cusp(a, b);
    if (options_.side_step) {
      // By the steeper of the two.
      const double wanted = *options_.side_step / std::max(a.widest, b.widest);
      if (step <= wanted * 1.0001 || k + 1 == kTries || step <= least) {
        next = std::move(b);
        return step;
      }
      step = std::max(wanted, least);
      continue;
    }
    if (h <= options_.scallop) {
      if (step > good) {
        good = step;
        next = std::move(b);
        height = h;
      }
      if (h >= 0.93 * options_.scallop || step >= longest) break;
    } else {
      bad = std::min(bad, step);
      if (good == 0 && step <= least * 1.0001) break;
    }
    const double factor = h > 0 ? std::clamp(std::sqrt(0.97 * options_.scallop / h), 0.3, 1.6) : 1.6;
    step = std::max(step * factor, least);
    if (good > 0 && bad < 2 * longest && (step <= good || step >= bad)) step = 0.5 * (good + bad);
    if (good > 0 && bad - good < 0.01 * good) break;
  }
  if (good > 0) return good;
  // No step holds: an edge or a step of the part lies across; the least one, and on.
  step = std::min(least, longest);
  next = ways_at(a.x + step);
  height = cusp(a, next);
  return step;
}

Result<std::vector<double>> MeshRings::places(PatternResult& result, Diagnostics& diagnostics) {
  const double length = part_.x_max - part_.x_min, flat = flat_or_side_step(options_);
  const double points = 0.05 * double(part_.mesh.triangles.size());
  if (length / (8 * flat) > double(options_.max_paths)) return too_many(options_, length / flat, points);
  std::vector<double> xs{part_.x_min};
  Ways here = ways_at(part_.x_min);
  double guess = flat, over_at = 0;
  std::size_t over = 0;
  result.side_step_min = std::numeric_limits<double>::infinity();
  while (xs.back() < part_.x_max) {
    Ways next;
    double height = 0;
    const double step = step_from(here, guess, next, height);
    const double x = xs.back() + step >= part_.x_max - 1e-9 * length ? part_.x_max : xs.back() + step;
    if (height > options_.scallop && !options_.side_step) {
      if (over++ == 0) over_at = xs.back();
    } else {
      result.scallop_max = std::max(result.scallop_max, height);
    }
    result.side_step_min = std::min(result.side_step_min, x - xs.back());
    result.side_step_max = std::max(result.side_step_max, x - xs.back());
    xs.push_back(x);
    guess = step;
    here = std::move(next);
    // Long before all of too many are found it is clear that they are.
    const double expected = double(xs.size()) * length / (x - part_.x_min);
    if (xs.size() > options_.max_paths || (xs.size() == 256 && expected > 8 * double(options_.max_paths))) {
      return too_many(options_, expected, points);
    }
  }
  if (over > 0) {
    diagnostics.left_out("cusp_above_scallop",
                         std::to_string(over) +
                             " gaps between rings leave more than the scallop, the first at x " +
                             format_fixed(over_at, 3) + " (edges or faces across the X axis)");
  }
  return xs;
}

}  // namespace

Result<PatternResult> meshed_paths(const Part& part, const PatternOptions& options,
                                   Diagnostics& diagnostics) {
  if (part.mesh.triangles.empty() || part.corner_normals.size() != part.mesh.triangles.size()) {
    return Error{ErrorCode::geometry, "the part has no triangles", {}};
  }
  report_steep(part, options, diagnostics);
  if (options.pattern == Pattern::lines) return mesh_lines(part, options);
  PatternResult result;
  auto xs = MeshRings(part, options).places(result, diagnostics);
  if (!xs) return xs.error();
  if (options.pattern == Pattern::spiral) return mesh_spiral(part, options, *xs, std::move(result));
  Slicer slicer(part, options.ball_radius, options.density_mm);
  std::size_t points = 0;
  for (const double x : *xs) {
    for (MeshRing& ring : slicer.rings(x)) {
      points += ring.points.size();
      if (points > options.max_points)
        return too_many(options, double(xs->size()), double(ring.points.size()));
      result.paths.push_back({std::move(ring.points), ring.closed});
    }
  }
  if (result.paths.empty()) return Error{ErrorCode::geometry, "the part has no section x = const", {}};
  return result;
}

}  // namespace burin::rotary::detail
