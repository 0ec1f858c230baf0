// SPDX-License-Identifier: Apache-2.0
// More random motions for the tests, and harder ones than random_curves.h: rational NURBS with uneven weights
// and repeated knots, hairpins and near-hairpins between nodes, paths that retrace themselves, bursts of tiny
// pieces, coordinates up to a kilometre, feeds over six decades, axes with very unlike limits.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "burin/geom/surface/evaluate.h"
#include "burin/servo/plan.h"
#include "burin/servo/random_motion.h"

namespace burin::servo::test {

class WildCurves : RandomMotion {
 public:
  explicit WildCurves(std::uint64_t seed) : RandomMotion(seed) {}

  std::vector<Stretch> curve() {
    std::vector<Stretch> out;
    const double reach = integer(0, 3) ? 100 : log_uniform(100, 1e6);
    at_ = {real(-reach, reach), real(-reach, reach), real(-reach, reach)};
    heading_ = direction();
    // Nothing is finer than the coordinates can say.
    scale_ = log_uniform(std::max(1e-4, 1e-9 * reach), 10);
    const int n = integer(1, 4);
    for (int i = 0; i < n; ++i) add(out);
    return out;
  }

  Limits limits() {
    Limits l;
    if (integer(0, 3) == 0) return l;
    l.period_s = integer(0, 4) ? log_uniform(2.5e-4, 4e-3) : log_uniform(5e-5, 2e-2);
    l.accel_mm_s2 = log_uniform(50, 1e5);
    // What an axis may do is reached in a fiftieth of a second to a second.
    l.jerk_mm_s3 = std::clamp(l.accel_mm_s2 * log_uniform(1, 50), 500.0, 2e6);
    l.chord_error_mm = log_uniform(3e-5, 3e-2);
    if (integer(0, 2) == 0) l.axis_velocity_mm_s = log_uniform(1, 1000);
    l.rapid_mm_min = log_uniform(1000, 60000);
    return l;
  }

 private:
  geom::Vec3 direction() {
    const int kind = integer(0, 9);
    if (kind < 3) return {kind == 0 ? 1.0 : 0.0, kind == 1 ? 1.0 : 0.0, kind == 2 ? 1.0 : 0.0};
    return any_direction();
  }

  /// Slow ones only on short paths: a part is run through in half a second at most.
  double feed(double length) {
    if (integer(0, 9) == 0) return 0;
    return std::max(log_uniform(0.05, 60000), 60 * length / 0.5);
  }

  void append(std::vector<Stretch>& out, geom::QuinticPath path) {
    if (path.empty()) return;
    // Where rounding hides a difference of parameters the path has no shape.
    for (std::size_t i = 1; i < path.nodes.size(); ++i)
      if (!(path.nodes[i].t > path.nodes[i - 1].t)) return;
    go_on_from(path);
    if (heading_ == geom::Vec3{}) heading_ = direction();
    const double f = feed(geom::length(path));
    out.push_back({std::move(path), {}, f, -1, -1});
  }

  void add(std::vector<Stretch>& out) {
    switch (integer(0, 8)) {
      case 0:
      case 1:
      case 2:
        return nurbs(out);
      case 3:
        return hairpin(out);
      case 4:
        return retrace(out);
      case 5:
        return burst(out);
      case 6:
        return spike(out);
      case 7:
        return append(out, geom::straight(at_, at_ + scale_ * log_uniform(0.01, 10) * direction()));
      default:
        return append(out, geom::straight(at_, at_ + scale_ * log_uniform(0.01, 10) * heading_));
    }
  }

  /// Rational, degree 2 to 5, inner knots up to full multiplicity (creases), points that coincide (no speed),
  /// as a planner would hand it on: nodes at equal steps of every span, derivatives exact.
  void nurbs(std::vector<Stretch>& out) {
    geom::NurbsCurve c;
    c.degree = integer(2, 5);
    const int count = c.degree + 1 + integer(0, 6);
    c.knots.assign(static_cast<std::size_t>(c.degree) + 1, 0.0);
    double t = 0;
    for (int i = c.degree + 1, times = 0; i < count; ++i) {
      if (times == 0 || times >= c.degree || integer(0, 3)) t += log_uniform(1e-2, 1), times = 0;
      c.knots.push_back(t);
      ++times;
    }
    t += log_uniform(1e-2, 1);
    c.knots.insert(c.knots.end(), static_cast<std::size_t>(c.degree) + 1, t);
    const double uneven = log_uniform(1, 30);
    geom::Point3 p = at_;
    for (int i = 0; i < count; ++i) {
      const double w = log_uniform(1 / uneven, uneven);
      c.points.push_back({w * p.x, w * p.y, w * p.z, w});
      if (i == 0)
        p = p + scale_ * log_uniform(0.05, 2) * (integer(0, 1) ? heading_ : direction());
      else if (integer(0, 9))
        p = p + scale_ * log_uniform(0.02, 2) * direction();
    }
    if (!geom::validate(c).ok()) return;
    std::vector<double> spans;
    for (const double k : c.knots)
      if (spans.empty() || k > spans.back()) spans.push_back(k);
    const int steps = 1 << integer(0, 6);
    for (std::size_t s = 0; s + 1 < spans.size(); ++s) {
      // Each span is a path of its own where its derivatives do not meet those of the next.
      geom::QuinticPath path;
      for (int i = 0; i <= steps; ++i) {
        const double u = i == steps ? spans[s + 1] : spans[s] + (spans[s + 1] - spans[s]) * i / steps;
        const geom::CurveDerivatives d =
            geom::derivatives(c, u, i == steps ? geom::Side::left : geom::Side::right);
        path.nodes.push_back({u, d.p, d.d1, d.d2});
      }
      path.nodes.front().p = at_;
      append(out, std::move(path));
    }
  }

  /// (t - c)^2 a + (t - c)^3 b + what keeps both legs apart; the tip anywhere between two nodes.
  void hairpin(std::vector<Stretch>& out) {
    const geom::Vec3 a = scale_ * direction(),
                     b = integer(0, 1) ? scale_ * log_uniform(1e-6, 1) * direction() : geom::Vec3{};
    const geom::Vec3 apart = integer(0, 2) ? scale_ * log_uniform(1e-9, 1e-1) * direction() : geom::Vec3{};
    const double tip = real(0.05, 0.95);
    geom::QuinticPath path;
    const int n = integer(1, 6);
    for (int i = 0; i <= n; ++i) {
      const double t = static_cast<double>(i) / n, d = t - tip;
      path.nodes.push_back({t, geom::Point3{} + (d * d * a + d * d * d * b + d * apart),
                            2 * d * a + 3 * d * d * b + apart, 2.0 * a + 6 * d * b});
    }
    place(path);
    append(out, std::move(path));
  }

  /// There and back on the same way, all but exactly.
  void retrace(std::vector<Stretch>& out) {
    geom::QuinticPath path;
    geom::QuinticNode node{0, at_, scale_ * log_uniform(0.1, 3) * heading_, {}};
    path.nodes.push_back(node);
    for (int i = integer(1, 4); i > 0; --i) {
      node.t += log_uniform(0.2, 2);
      node.p = node.p + scale_ * log_uniform(0.1, 2) * direction();
      node.d1 = scale_ * log_uniform(0.05, 3) * direction();
      node.d2 = scale_ * log_uniform(0.05, 3) * direction();
      path.nodes.push_back(node);
    }
    geom::QuinticPath back = geom::reversed(path);
    const geom::Vec3 off = (integer(0, 1) ? 0 : scale_ * log_uniform(1e-10, 1e-2)) * direction();
    for (std::size_t i = 1; i < back.nodes.size(); ++i) back.nodes[i].p = back.nodes[i].p + off;
    append(out, std::move(path));
    append(out, std::move(back));
  }

  /// Many pieces from 1e-6 mm on, each a little bent, some with a corner between.
  void burst(std::vector<Stretch>& out) {
    const double size = log_uniform(std::max(1e-6, 1e-12 * geom::norm(at_ - geom::Point3{})), 0.1);
    const double bend = log_uniform(1e-3, 1);
    geom::QuinticPath path;
    geom::Vec3 h = heading_;
    geom::Point3 p = at_;
    double t = 0;
    path.nodes.push_back({0, p, h, {}});
    for (int i = integer(2, 200); i > 0; --i) {
      const double l = size * log_uniform(0.1, 3);
      const geom::Vec3 next = geom::unit(h + bend * real(-1, 1) * direction());
      if (!(geom::norm(next) > 0)) break;
      p = p + 0.5 * l * (h + next);
      t += l;
      h = next;
      path.nodes.push_back({t, p, h, {}});
    }
    append(out, std::move(path));
  }

  /// Nodes whose second derivatives are far beyond what the distances ask for.
  void spike(std::vector<Stretch>& out) {
    geom::QuinticPath path;
    geom::QuinticNode node{0, at_, scale_ * heading_, {}};
    path.nodes.push_back(node);
    for (int i = integer(1, 3); i > 0; --i) {
      node.t += log_uniform(0.01, 10);
      node.p = node.p + scale_ * log_uniform(0.01, 2) * direction();
      node.d1 = scale_ * log_uniform(1e-6, 10) * direction();
      node.d2 = scale_ * log_uniform(1e-3, 100) * direction();
      path.nodes.push_back(node);
    }
    append(out, std::move(path));
  }
};

}  // namespace burin::servo::test
