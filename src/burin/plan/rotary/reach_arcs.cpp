// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/reach_arcs.h"

#include <algorithm>

#include "burin/geom/vec.h"

namespace burin::rotary::detail {

double angle_of_turn(double turn) {
  if (turn <= -2) return -geom::kPi;
  if (turn >= 2) return geom::kPi;
  const double c = 1 - std::abs(turn);
  return std::copysign(std::atan2(1 - std::abs(c), c), turn);
}

void Arcs::add(double lo, double hi) {
  if (lo <= hi) {
    add_straight(lo, hi);
  } else {
    add_straight(lo, 2);
    add_straight(-2, hi);
  }
}

void Arcs::add_straight(double lo, double hi) {
  if (lo <= -2 + kSlack) lo = -2;
  if (hi >= 2 - kSlack) hi = 2;
  const auto first = std::lower_bound(arcs_.begin(), arcs_.end(), lo,
                                      [](const Arc& a, double at) { return a.hi + kSlack < at; });
  auto end = first;
  while (end != arcs_.end() && end->lo <= hi + kSlack) {
    lo = std::min(lo, end->lo);
    hi = std::max(hi, end->hi);
    ++end;
  }
  if (first == end) {
    arcs_.insert(first, {lo, hi});
  } else {
    *first = {lo, hi};
    arcs_.erase(first + 1, end);
  }
}

AngleSet Arcs::gaps() const {
  if (arcs_.empty()) return {{-geom::kPi, geom::kPi}};
  AngleSet out;
  const auto gap = [&out](double lo, double hi) {
    if (hi - lo > kSlack) out.push_back({lo, hi});
  };
  const bool seam = arcs_.front().lo > -2 && arcs_.back().hi < 2;  // free on both sides of it
  if (!seam) gap(-geom::kPi, angle_of_turn(arcs_.front().lo));
  for (std::size_t i = 1; i < arcs_.size(); ++i)
    gap(angle_of_turn(arcs_[i - 1].hi), angle_of_turn(arcs_[i].lo));
  if (seam) {
    gap(angle_of_turn(arcs_.back().hi), angle_of_turn(arcs_.front().lo) + 2 * geom::kPi);
  } else {
    gap(angle_of_turn(arcs_.back().hi), geom::kPi);
  }
  return out;
}

}  // namespace burin::rotary::detail
