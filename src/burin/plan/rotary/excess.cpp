// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/excess.h"

#include <algorithm>
#include <cmath>

#include "burin/plan/rotary/segment_runs.h"

namespace burin::rotary::detail {
double spread_excess(std::vector<Place>& places, const std::vector<Contact>& left, const Place* before,
                     const Place* after, double radius) {
  std::vector<geom::Point3> way;
  if (before) way.push_back(before->center);
  for (const Place& p : places) way.push_back(p.center);
  if (after) way.push_back(after->center);
  if (way.empty()) return 0;
  SegmentRuns runs;
  for (std::size_t i = 0; i == 0 || i + 1 < way.size(); ++i)
    runs.add(way[i], way[std::min(i + 1, way.size() - 1)]);
  double worst = 0;
  std::size_t hint = 0;
  for (const Contact& c : left) {
    double d2 = 0;
    hint = runs.nearest(c.p, hint, d2);
    const double excess = std::max(0.0, std::sqrt(d2) - radius);
    worst = std::max(worst, excess);
    if (places.empty()) continue;
    const std::size_t at = before && hint > 0 ? hint - 1 : hint;
    Place& place = places[std::min(at, places.size() - 1)];
    place.excess_mm = std::max(place.excess_mm, excess);
  }
  return worst;
}

}  // namespace burin::rotary::detail
