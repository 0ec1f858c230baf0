// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "burin/plan/rotary/path_plan.h"

namespace burin::rotary {

CenterLine::CenterLine(const CenterPath& path, double radius, double accuracy_mm)
    : path_(path), radius_(radius), accuracy_(accuracy_mm) {
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
  // Where the ball rolls it stands on its contact. Else the two places are of different contacts, and what
  // lies between may be inside of the part: the nearer one stands for it.
  const geom::Point3 rolling = out.contact.p + radius_ * out.contact.n;
  if (geom::distance(rolling, lerp(a.center, b.center, t)) > accuracy_) return t < 0.5 ? a : b;
  out.center = rolling;
  out.excess_mm = std::max(a.excess_mm, b.excess_mm);
  return out;
}

double CenterLine::length_of(double number) const {
  const auto i = static_cast<std::size_t>(std::max(0.0, number));
  const double f = number - static_cast<double>(i), a = length_at(i);
  return f > 0 ? a + f * (length_at(i + 1) - a) : a;
}

}  // namespace burin::rotary
