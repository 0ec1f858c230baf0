// SPDX-License-Identifier: Apache-2.0
// What random_curves.h and wild_curves.h share: the generator, and the place and heading a motion goes on
// from.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "burin/servo/plan.h"

namespace burin::servo::test {

class RandomMotion {
 protected:
  explicit RandomMotion(std::uint64_t seed) : random_(seed) {}

  double real(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }
  int integer(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(random_); }
  double log_uniform(double lo, double hi) { return std::exp(real(std::log(lo), std::log(hi))); }
  /// Every other one in the plane.
  geom::Vec3 any_direction() {
    geom::Vec3 v;
    do v = {real(-1, 1), real(-1, 1), integer(0, 1) ? real(-1, 1) : 0.0};
    while (geom::norm(v) < 0.1);
    return geom::unit(v);
  }
  /// The path is moved to where the motion is.
  void place(geom::QuinticPath& path) const {
    const geom::Vec3 shift = at_ - path.start();
    for (auto& node : path.nodes) node.p = node.p + shift;
    path.nodes.front().p = at_;
  }
  /// The motion goes on from the path's end; the heading is zero where that has none.
  void go_on_from(const geom::QuinticPath& path) {
    at_ = path.end();
    heading_ = geom::unit(path.nodes.back().d1);
  }

  geom::Point3 at_;
  geom::Vec3 heading_;
  double scale_ = 1;

 private:
  std::mt19937_64 random_;
};

}  // namespace burin::servo::test
