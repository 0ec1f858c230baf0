// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/uncut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::rotary {
namespace {

struct Chord {
  geom::Point3 a, b;
  double x_min = 0, x_max = 0;
};

double distance_to(const Chord& c, geom::Point3 p) {
  const geom::Vec3 d = c.b - c.a;
  const double l2 = dot(d, d);
  const double t = l2 > 0 ? std::clamp(dot(p - c.a, d) / l2, 0.0, 1.0) : 0;
  return geom::distance(p, c.a + t * d);
}

}  // namespace

double uncut_excess(RotaryPlan& plan, double radius) {
  std::vector<Chord> chords;
  double longest = 0;
  for (const Leg& leg : plan.legs) {
    if (leg.kind != LegKind::cut) continue;
    for (std::size_t i = 0; i < leg.poses.size(); ++i) {
      const geom::Point3 a = leg.poses[i > 0 ? i - 1 : 0].center, b = leg.poses[i].center;
      chords.push_back({a, b, std::min(a.x, b.x), std::max(a.x, b.x)});
      longest = std::max(longest, chords.back().x_max - chords.back().x_min);
    }
  }
  std::sort(chords.begin(), chords.end(), [](const Chord& a, const Chord& b) { return a.x_min < b.x_min; });
  double worst = 0;
  for (RotaryPoint& point : plan.points) {
    if (point.place.state != State::unreachable || chords.empty()) continue;
    const geom::Point3 p = point.place.contact.p;
    const auto middle = std::lower_bound(chords.begin(), chords.end(), p.x,
                                         [](const Chord& c, double x) { return c.x_min < x; });
    double best = std::numeric_limits<double>::infinity();
    for (auto it = middle; it != chords.end() && it->x_min - p.x < best; ++it)
      best = std::min(best, distance_to(*it, p));
    for (auto it = middle; it != chords.begin();) {
      --it;
      if (p.x - it->x_min - longest > best) break;
      best = std::min(best, distance_to(*it, p));
    }
    point.place.excess_mm = std::max(0.0, best - radius);
    worst = std::max(worst, point.place.excess_mm);
  }
  return worst;
}

}  // namespace burin::rotary
