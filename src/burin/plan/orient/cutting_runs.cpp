// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/cutting_runs.h"

#include <algorithm>
#include <cmath>

#include "burin/base/parallel.h"

namespace burin::orient {
namespace {

using geom::Vec3;

// A move between two contact points is halved this often before it is given up: what a straight way leaves
// the allowed set by goes down with the square, to less than a ten-thousandth.
constexpr int kMaxHalvings = 7;
// Cosine of the angle between feed direction and chord beyond which the points say nothing about a curve.
constexpr double kAlong = 0.5;

struct Station {
  CcPoint cc;
  Angles angles;
  cl::Pose pose;
};

/// The contact half way: on the cubic through both ends with their feed directions as tangents (which have to
/// run along the chord; else on the chord).
CcPoint middle(const CcPoint& a, const CcPoint& b) {
  const Vec3 chord = b.c - a.c;
  const double length = norm(chord);
  CcPoint m = a;
  m.c = lerp(a.c, b.c, 0.5);
  const bool curve = length > 0 && dot(a.f, chord) > kAlong * length && dot(b.f, chord) > kAlong * length;
  if (curve) m.c = m.c + (length / 8) * (a.f - b.f);
  m.n = unit(a.n + b.n);
  // Middle of Hermite's cubic: 1.5 chord - (tangent a + tangent b) / 4.
  Vec3 along = curve ? 1.5 * chord - (length / 4) * (a.f + b.f) : a.f + b.f;
  along = along - dot(along, m.n) * m.n;
  m.f = unit(norm(along) > 1e-9 * (1 + length) ? along : a.f - dot(a.f, m.n) * m.n);
  m.k_ff = 0.5 * (a.k_ff + b.k_ff);
  m.k_ft = 0.5 * (a.k_ft + b.k_ft);
  m.k_tt = 0.5 * (a.k_tt + b.k_tt);
  return m;
}

/// Of one path: its result depends on the path only.
class Maker {
 public:
  Maker(const Scene& scene, const MotionCheck& check, double steepest)
      : scene_(scene), check_(check), steepest_(steepest) {}

  Runs run(const OrientedPath& path, std::size_t first) {
    one(path, first);
    return std::move(out_);
  }

 private:
  void one(const OrientedPath& path, std::size_t first) {
    Run run;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      const OrientedPoint& point = path.points[i];
      if (point.reachable) {
        const Station here{point.cc, point.angles, point.pose};
        source_ = static_cast<std::uint32_t>(first + i);
        if (!run.empty()) {
          const OrientedPoint& before = path.points[i - 1];
          if (!follow({before.cc, before.angles, before.pose}, here, 0, run)) {
            out_.broken.push_back(first + i - 1);
            close(run);
          }
        }
        if (run.empty()) add(here, run);
      } else {
        close(run);
      }
    }
    close(run);
  }

  void add(const Station& station, Run& run) { run.push_back({station.pose, station.cc.n, source_}); }
  void close(Run& run) {
    if (!run.empty()) out_.runs.push_back(std::move(run));
    run.clear();
  }

  /// From a (where the run stands) to b, with points between where the straight way is not free. What was
  /// added stays when the rest fails.
  bool follow(const Station& a, const Station& b, int halvings, Run& run) {
    if (check_.cut(a.pose, b.pose, memory_)) {
      add(b, run);
      return true;
    }
    if (halvings == kMaxHalvings) return false;
    const auto m = between(a, b);
    return m && follow(a, *m, halvings + 1, run) && follow(*m, b, halvings + 1, run);
  }

  /// Angles half way; a higher tilt where those are not free.
  std::optional<Station> between(const Station& a, const Station& b) {
    Station m{middle(a.cc, b.cc), {}, {}};
    m.angles = {0.5 * (a.angles.alpha + b.angles.alpha), 0.5 * (a.angles.beta + b.angles.beta)};
    m.pose = pose(m.cc, m.angles, scene_.mill());
    if (check_.at(m.pose, memory_)) return m;
    const Scene::FirstFree free = scene_.first_free(m.cc, m.angles.beta, m.angles.alpha,
                                                    std::max(steepest_, m.angles.alpha), memory_.exact);
    if (!free.found) return std::nullopt;
    m.angles.alpha = free.alpha;
    m.pose = pose(m.cc, m.angles, scene_.mill());
    if (!check_.at(m.pose, memory_)) return std::nullopt;
    return m;
  }

  const Scene& scene_;
  const MotionCheck& check_;
  double steepest_;  ///< tilt of all points: beyond it nothing is sought
  std::uint32_t source_ = 0;
  MotionCheck::Memory memory_;
  Runs out_;
};

}  // namespace

Runs cutting_runs(const Scene& scene, const MotionCheck& check, const std::vector<OrientedPath>& paths,
                  unsigned threads) {
  double steepest = 0;
  std::vector<std::size_t> first{0};
  for (const OrientedPath& path : paths) {
    first.push_back(first.back() + path.points.size());
    for (const OrientedPoint& point : path.points)
      if (point.reachable) steepest = std::max(steepest, point.angles.alpha);
  }
  std::vector<Runs> parts(paths.size());
  parallel_for(paths.size(), thread_count(threads), [&](std::size_t i, std::size_t) {
    parts[i] = Maker(scene, check, steepest).run(paths[i], first[i]);
  });
  Runs all;
  for (Runs& part : parts) {
    for (Run& run : part.runs) all.runs.push_back(std::move(run));
    all.broken.insert(all.broken.end(), part.broken.begin(), part.broken.end());
  }
  return all;
}

}  // namespace burin::orient
