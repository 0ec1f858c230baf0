// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/uncut.h"
#include "burin/geom/point_tools.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace burin::rotary {
namespace {

struct Chord {
  geom::Point3 a, b;
  double x_min = 0, x_max = 0;
};

/// The cuts, by x.
class Cuts {
 public:
  explicit Cuts(const RotaryPlan& plan) {
    for (const Leg& leg : plan.legs) {
      if (leg.kind != LegKind::cut) continue;
      for (std::size_t i = 0; i < leg.poses.size(); ++i) {
        const geom::Point3 a = leg.poses[i > 0 ? i - 1 : 0].center, b = leg.poses[i].center;
        chords_.push_back({a, b, std::min(a.x, b.x), std::max(a.x, b.x)});
        longest_ = std::max(longest_, chords_.back().x_max - chords_.back().x_min);
      }
    }
    std::sort(chords_.begin(), chords_.end(),
              [](const Chord& a, const Chord& b) { return a.x_min < b.x_min; });
  }

  /// Distance of the nearest cut; infinite when there is none.
  double distance(geom::Point3 p) const {
    const auto middle = std::lower_bound(chords_.begin(), chords_.end(), p.x,
                                         [](const Chord& c, double x) { return c.x_min < x; });
    double best = std::numeric_limits<double>::infinity();
    for (auto it = middle; it != chords_.end() && it->x_min - p.x < best; ++it)
      best = std::min(best, distance_to_segment(p, it->a, it->b));
    for (auto it = middle; it != chords_.begin();) {
      --it;
      if (p.x - it->x_min - longest_ > best) break;
      best = std::min(best, distance_to_segment(p, it->a, it->b));
    }
    return best;
  }
  bool empty() const { return chords_.empty(); }

 private:
  std::vector<Chord> chords_;
  double longest_ = 0;
};

}  // namespace

double uncut_excess(RotaryPlan& plan, const std::vector<geom::Point3>& more, double radius) {
  const Cuts cuts(plan);
  double worst = 0;
  if (cuts.empty()) return worst;
  for (RotaryPoint& point : plan.points) {
    if (point.place.state != State::unreachable) continue;
    point.place.excess_mm = std::max(0.0, cuts.distance(point.place.contact.p) - radius);
    worst = std::max(worst, point.place.excess_mm);
  }
  for (const geom::Point3& p : more) worst = std::max(worst, cuts.distance(p) - radius);
  return worst;
}

}  // namespace burin::rotary
