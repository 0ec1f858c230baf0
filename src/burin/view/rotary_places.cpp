// SPDX-License-Identifier: Apache-2.0
#include "burin/view/rotary_places.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace burin::view {
namespace {

/// Middle of a ring's contacts: moved ones stand beside it, so the median.
double middle_x(const rotary::RotaryPlan& plan, std::size_t first, std::size_t end) {
  std::vector<double> xs;
  for (std::size_t i = first; i < end; ++i) xs.push_back(plan.points[i].place.contact.p.x);
  const auto mid = xs.begin() + static_cast<std::ptrdiff_t>(xs.size() / 2);
  std::nth_element(xs.begin(), mid, xs.end());
  return *mid;
}

}  // namespace

std::vector<SectionPlace> section_places(const rotary::Part& part, const rotary::RotaryPlan& plan,
                                         rotary::Pattern pattern, std::size_t most) {
  std::vector<SectionPlace> all;
  if (pattern == rotary::Pattern::rings) {
    for (std::size_t i = 0; i < plan.points.size();) {
      std::size_t end = i;
      while (end < plan.points.size() && plan.points[end].path == plan.points[i].path) ++end;
      all.push_back({middle_x(plan, i, end), static_cast<int>(plan.points[i].path)});
      i = end;
    }
    if (all.size() <= most) return all;
    std::vector<SectionPlace> some;
    for (std::size_t k = 0; k < most; ++k) some.push_back(all[k * (all.size() - 1) / (most - 1)]);
    return some;
  }
  const std::size_t count = std::min<std::size_t>(most, 81);
  for (std::size_t k = 0; k < count; ++k) {
    const double f = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    all.push_back({part.x_min + f * (part.x_max - part.x_min), -1});
  }
  return all;
}

std::vector<std::size_t> section_points(const rotary::RotaryPlan& plan, rotary::Pattern pattern,
                                        const SectionPlace& place, double half_mm) {
  std::vector<std::size_t> list;
  const auto away = [&](std::size_t i) { return std::abs(plan.points[i].place.contact.p.x - place.x); };
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const rotary::RotaryPoint& p = plan.points[i];
    if (place.path >= 0 ? p.path != static_cast<std::size_t>(place.path) : !(away(i) <= half_mm)) continue;
    const bool one_a_path = place.path < 0 && pattern == rotary::Pattern::lines;
    if (one_a_path && !list.empty() && plan.points[list.back()].path == p.path) {
      if (away(i) < away(list.back())) list.back() = i;
    } else {
      list.push_back(i);
    }
  }
  return list;
}

std::vector<LeftPlace> left_places(const rotary::RotaryPlan& plan) {
  std::vector<LeftPlace> list;
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const rotary::RotaryPoint& p = plan.points[i];
    if (p.place.state == rotary::State::ok) continue;
    const bool goes_on = !list.empty() && list.back().last + 1 == i && list.back().path == p.path &&
                         list.back().state == p.place.state;
    if (!goes_on) list.push_back({p.path, i, i, p.place.state, -1, i});
    LeftPlace& place = list.back();
    place.last = i;
    if (p.place.excess_mm > place.excess_mm) place.excess_mm = p.place.excess_mm, place.worst = i;
  }
  std::stable_sort(list.begin(), list.end(), [](const LeftPlace& a, const LeftPlace& b) {
    const auto rank = [](const LeftPlace& p) { return p.state == rotary::State::unreachable ? 0 : 1; };
    return std::make_tuple(rank(a), -a.excess_mm) < std::make_tuple(rank(b), -b.excess_mm);
  });
  return list;
}

double unsmoothed(const rotary::RotaryPoint& point, double clearance) {
  if (point.reachable.empty()) return point.initial;
  const rotary::AngleSet set = rotary::narrowed(point.reachable, clearance);
  return set.empty() ? point.initial : rotary::nearest(set, point.initial);
}

}  // namespace burin::view
