// SPDX-License-Identifier: Apache-2.0
// Random motions for the tests: corners, arcs, helices, splines with sharp bends, tiny segments, cusps, mixed
// feeds and rapids.
#pragma once

#include <cmath>
#include <vector>

#include "burin/servo/plan.h"
#include "burin/servo/random_motion.h"

namespace burin::servo::test {

class RandomCurves : RandomMotion {
 public:
  explicit RandomCurves(std::uint64_t seed) : RandomMotion(seed) {}

  std::vector<Stretch> curve() {
    std::vector<Stretch> out;
    at_ = {real(-100, 100), real(-100, 100), real(-10, 10)};
    if (integer(0, 9) == 0) at_ = {real(-2000, 2000), real(-2000, 2000), 0};
    heading_ = direction();
    scale_ = log_uniform(1e-3, 10);
    const int n = integer(1, 5);
    for (int i = 0; i < n; ++i) add(out);
    return out;
  }

  Limits limits() {
    Limits l;
    if (integer(0, 2) > 0) return l;
    l.period_s = log_uniform(2e-4, 5e-3);
    l.accel_mm_s2 = log_uniform(300, 20000);
    l.jerk_mm_s3 = log_uniform(5000, 1e6);
    l.chord_error_mm = log_uniform(1e-4, 1e-2);
    if (integer(0, 3) == 0) l.axis_velocity_mm_s = log_uniform(10, 500);
    return l;
  }

 private:
  geom::Vec3 direction() { return any_direction(); }
  double feed() { return integer(0, 7) == 0 ? 0 : log_uniform(200, 12000); }

  void append(std::vector<Stretch>& out, geom::QuinticPath path, double f) {
    if (path.empty()) return;
    go_on_from(path);
    if (heading_ == geom::Vec3{}) heading_ = direction();
    out.push_back({std::move(path), {}, f, -1, -1});
  }

  void add(std::vector<Stretch>& out) {
    switch (integer(0, 8)) {
      case 0:
        return append(out, geom::straight(at_, at_ + scale_ * real(0.1, 10) * heading_), feed());
      case 1:
        return append(out, geom::straight(at_, at_ + scale_ * real(0.1, 10) * direction()), feed());
      case 2:
        return arc(out, true);
      case 3:
        return arc(out, false);
      case 4:
        return tiny(out);
      case 5:
        return chain(out);
      case 6:
        return cusp(out);
      default:
        return spline(out);
    }
  }

  /// Tangent to the heading or not; sometimes a helix; sometimes very small.
  void arc(std::vector<Stretch>& out, bool tangent) {
    const geom::Vec3 t = tangent ? heading_ : direction();
    geom::Vec3 side = geom::cross(t, direction());
    if (geom::norm(side) < 1e-3) return;
    side = geom::unit(side);
    const double r = scale_ * log_uniform(0.01, 5);
    const geom::Vec3 normal = geom::cross(t, side);  // counter-clockwise: the centre is to the left of t
    append(out, geom::arc(at_, at_ + r * side, normal, real(0.05, 7), integer(0, 2) ? 0 : real(-1, 1) * r),
           feed());
  }

  /// Segments of 1e-4 mm, smooth or with small angles.
  void tiny(std::vector<Stretch>& out) {
    const int n = integer(1, 300);
    const double turn = integer(0, 1) ? log_uniform(1e-6, 0.1) : 0, f = feed();
    const geom::Vec3 side = geom::unit(geom::cross(heading_, direction()));
    for (int i = 0; i < n; ++i) {
      heading_ = geom::unit(heading_ + turn * real(-1, 1) * side);
      const geom::Vec3 h = heading_;
      append(out, geom::straight(at_, at_ + 1e-4 * log_uniform(0.1, 10) * h), f);
    }
  }

  /// Quintic through a few nodes whose derivatives are unrelated to the distances: sharp bends, loops.
  void spline(std::vector<Stretch>& out) {
    geom::QuinticPath path;
    geom::QuinticNode node{0, at_, scale_ * log_uniform(0.1, 3) * heading_, {}};
    path.nodes.push_back(node);
    const int n = integer(1, 8);
    for (int i = 0; i < n; ++i) {
      node.t += log_uniform(0.2, 2);
      node.p = node.p + scale_ * log_uniform(0.1, 2) * direction();
      node.d1 = scale_ * log_uniform(0.05, 3) * direction();
      node.d2 = integer(0, 2) ? scale_ * log_uniform(0.05, 3) * direction() : geom::Vec3{};
      path.nodes.push_back(node);
    }
    append(out, std::move(path), feed());
  }

  /// A smooth wave cut finely: pieces far shorter than a period's way.
  void chain(std::vector<Stretch>& out) {
    geom::QuinticPath path;
    const geom::Vec3 side = geom::unit(geom::cross(heading_, direction()));
    const double length = scale_ * real(1, 5), height = scale_ * log_uniform(0.001, 0.5),
                 k = real(1, 20) / length;
    const int n = integer(20, 1000);
    const geom::Point3 start = at_;
    const geom::Vec3 along = heading_;
    for (int i = 0; i <= n; ++i) {
      const double t = length * i / n, w = height * (1 - std::cos(k * t));
      path.nodes.push_back({t, start + t * along + w * side, along + height * k * std::sin(k * t) * side,
                            height * k * k * std::cos(k * t) * side});
    }
    append(out, std::move(path), feed());
  }

  /// d1 = 0 at a node, where the path turns back, goes on, or bends.
  void cusp(std::vector<Stretch>& out) {
    geom::QuinticPath path;
    const geom::Vec3 a = scale_ * direction(), b = scale_ * direction();
    const int kind = integer(0, 2);
    for (const double t : {-1.0, 0.0, integer(0, 1) ? 1.0 : 0.3}) {
      const double t2 = t * t, t3 = t2 * t;
      if (kind == 0) path.nodes.push_back({t, {}, 2 * t * a + 3 * t2 * b, 2.0 * a + 6 * t * b});
      if (kind == 1) path.nodes.push_back({t, {}, 3 * t2 * a, 6 * t * a});
      if (kind == 2) path.nodes.push_back({t, {}, 3 * t2 * a + 4 * t3 * b, 6 * t * a + 12 * t2 * b});
      const geom::Vec3 p = kind == 0 ? t2 * a + t3 * b : kind == 1 ? t3 * a : t3 * a + t2 * t2 * b;
      path.nodes.back().p = geom::Point3{} + p;
    }
    place(path);
    append(out, std::move(path), feed());
  }
};

}  // namespace burin::servo::test
