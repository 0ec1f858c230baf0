// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "burin/plan/rotary/path_plan.h"

namespace burin::rotary {

CenterLine::CenterLine(const CenterPath& path, double radius) : path_(path), radius_(radius) {
  double s = 0;
  for (std::size_t i = 0; i < path.places.size(); ++i) {
    if (i > 0) s += geom::distance(path.places[i - 1].center, path.places[i].center);
    at_.push_back(s);
  }
  if (path.closed && !path.places.empty())
    at_.push_back(s + geom::distance(path.places.back().center, path.places.front().center));
}

double CenterLine::length_at(std::size_t i) const {
  const std::size_t n = path_.places.size();
  if (i < n) return at_[i];
  if (!path_.closed) return 1e300;
  return at_[i % n] + static_cast<double>(i / n) * length();
}

std::size_t CenterLine::first_after(double s) const {
  const std::size_t n = path_.places.size();
  std::size_t turns = 0;
  if (path_.closed && length() > 0 && s >= length()) {
    turns = static_cast<std::size_t>(s / length());
    s -= static_cast<double>(turns) * length();
  }
  const auto it = std::upper_bound(at_.begin(), at_.begin() + static_cast<std::ptrdiff_t>(n), s);
  return turns * n + static_cast<std::size_t>(it - at_.begin());
}

Place CenterLine::at(double s) const {
  const std::size_t next = first_after(s);
  if (next == 0) return place(0);
  const double lo = length_at(next - 1), hi = length_at(next);
  const Place& a = place(next - 1);
  if (s == lo || !(hi < 1e300) || !(hi > lo)) return a;
  const Place& b = place(next);
  const double t = (s - lo) / (hi - lo);
  Place out = t < 0.5 ? a : b;
  out.contact.p = lerp(a.contact.p, b.contact.p, t);
  const geom::Vec3 n = unit((1 - t) * a.contact.n + t * b.contact.n);
  out.contact.n = norm(n) > 0 ? n : a.contact.n;
  // The parameter along a closed section starts again at the seam.
  if (std::abs(b.contact.u - a.contact.u) < 0.5)
    out.contact.u = a.contact.u + t * (b.contact.u - a.contact.u);
  out.contact.w = a.contact.w + t * (b.contact.w - a.contact.w);
  out.center = lerp(a.center, b.center, t);
  out.excess_mm = std::max(a.excess_mm, b.excess_mm);
  return out;
}

std::vector<double> CenterLine::locate(const std::vector<Place>& points) const {
  std::vector<double> out;
  const std::size_t n = path_.places.size(), end = path_.closed ? 2 * n + 1 : n;
  std::size_t i = 0;
  for (const Place& p : points) {
    std::size_t j = i;
    while (j < end && !(place(j).center == p.center && place(j).contact.n == p.contact.n &&
                        place(j).contact.p == p.contact.p))
      ++j;
    if (j >= end) continue;  // not of this path: it is left to the motion check
    out.push_back(length_at(j));
    i = j + 1;
  }
  return out;
}

}  // namespace burin::rotary
