// SPDX-License-Identifier: Apache-2.0
// Profiles made by hand and a walk over programs, for the tests of the tool path.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "burin/plan/laser/toolpath.h"

namespace burin::laser::fixture {

using geom::ArcSpline;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

inline ArcSpline circle(Point2 c, double r, bool ccw) {
  const Point2 e{c.x + r, c.y}, w{c.x - r, c.y};
  ArcSpline s;
  s.closed = true;
  s.segments = {geom::make_arc(e, w, c, ccw), geom::make_arc(w, e, c, ccw)};
  return s;
}

inline ArcSpline polygon(const std::vector<Point2>& p, bool closed = true) {
  ArcSpline s;
  s.closed = closed;
  for (std::size_t i = 0; i + (closed ? 0 : 1) < p.size(); ++i) {
    s.segments.push_back(geom::make_line(p[i], p[(i + 1) % p.size()]));
  }
  return s;
}

inline ArcSpline rectangle(Point2 lo, Point2 hi, bool ccw) {
  if (ccw) return polygon({lo, {hi.x, lo.y}, hi, {lo.x, hi.y}});
  return polygon({lo, {lo.x, hi.y}, hi, {hi.x, lo.y}});
}

/// A counter-clockwise convex polygon grown by d: parallel lines and corner arcs.
inline ArcSpline grown(const std::vector<Point2>& p, double d) {
  ArcSpline s;
  s.closed = true;
  const std::size_t n = p.size();
  const auto normal = [&](std::size_t i) { return d * geom::right(geom::unit(p[(i + 1) % n] - p[i])); };
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 next = p[(i + 1) % n];
    s.segments.push_back(geom::make_line(p[i] + normal(i), next + normal(i)));
    if (d > 0) {
      s.segments.push_back(
          geom::make_arc(next + normal(i), next + normal((i + 1) % n), next, true, geom::kCornerSource));
    }
  }
  return s;
}

struct Builder {
  Profile profile;
  double d = 0.25;

  void add(ArcSpline outline, ArcSpline path, Role role) {
    const auto contour = static_cast<std::uint32_t>(profile.outlines.size());
    profile.outlines.push_back({std::move(outline), role, role == Role::hole ? 1 : 0, contour});
    profile.paths.push_back({std::move(path), role, role == Role::hole ? 1 : 0, contour});
  }
  void plate(Point2 lo, Point2 hi) {
    const std::vector<Point2> p{lo, {hi.x, lo.y}, hi, {lo.x, hi.y}};
    add(polygon(p), grown(p, d), Role::outer);
  }
  void convex(const std::vector<Point2>& p) { add(polygon(p), grown(p, d), Role::outer); }
  void disk(Point2 c, double r) { add(circle(c, r, true), circle(c, r + d, true), Role::outer); }
  void round_hole(Point2 c, double r) { add(circle(c, r, false), circle(c, r - d, false), Role::hole); }
  void rect_hole(Point2 lo, Point2 hi) {
    add(rectangle(lo, hi, false), rectangle({lo.x + d, lo.y + d}, {hi.x - d, hi.y - d}, false), Role::hole);
  }
  void open_cut(const std::vector<Point2>& p) { add(polygon(p, false), polygon(p, false), Role::open); }
  void engrave(const std::vector<Point2>& p) { add(polygon(p, false), polygon(p, false), Role::engrave); }
};

/// Plates in a row, each with cells that hold nothing, a round hole, a square hole, a hole with a disk in it
/// (which may have a hole again), an open cut or an engraved line; shuffled.
inline Profile random_profile(unsigned seed, double d) {
  std::mt19937 random(seed);
  const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
  const auto real = [&](double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(random() % 10007) / 10007);
  };
  Builder b;
  b.d = d;
  const unsigned plates = 1 + below(3);
  for (unsigned k = 0; k < plates; ++k) {
    const double x0 = k * 90.0;
    b.plate({x0, 0}, {x0 + 80, 60});
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 3; ++j) {
        const Point2 c{x0 + 10 + 20 * i + real(-1, 1), 10 + 20 * j + real(-1, 1)};
        switch (below(6)) {
          case 0:
            b.round_hole(c, real(1, 8));
            break;
          case 1:
            b.rect_hole({c.x - real(2, 8), c.y - real(2, 8)}, {c.x + real(2, 8), c.y + real(2, 8)});
            break;
          case 2: {
            const double r = real(6, 8);
            b.round_hole(c, r);
            b.disk(c, r - 3);
            if (below(2)) b.round_hole(c, r - 4.5);
            break;
          }
          case 3:
            b.open_cut({{c.x - 3, c.y - real(0, 3)}, {c.x, c.y}, {c.x + 3, c.y + real(0, 3)}});
            break;
          case 4:
            b.engrave({{c.x - 3, c.y - real(0, 3)}, {c.x + 3, c.y + real(0, 3)}});
            break;
          default:
            break;
        }
      }
    }
  }
  std::vector<std::size_t> order(b.profile.paths.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[below(static_cast<unsigned>(i))]);
  Profile shuffled = b.profile;
  for (std::size_t i = 0; i < order.size(); ++i) shuffled.paths[i] = b.profile.paths[order[i]];
  return shuffled;
}

/// A motion of a program in the plane.
struct Step {
  Segment segment;  ///< radius 0: straight
  MoveKind kind = MoveKind::state;
  bool rapid = false, beam = false;
  double power = 0, feed = 0;
  std::uint32_t source = 0;
  std::size_t record = 0;
  Point2 a() const { return segment.a; }
  Point2 b() const { return segment.b; }
};

inline std::vector<Step> walk(const Toolpath& t) {
  std::vector<Step> steps;
  Point2 at{};
  bool beam = false;
  double power = 0, feed = 0;
  for (std::size_t i = 0; i < t.program.records.size(); ++i) {
    const cl::Record& r = t.program.records[i];
    Step s;
    s.kind = t.kind[i];
    s.source = t.program.source[i];
    s.record = i;
    if (const auto* f = std::get_if<cl::FeedRate>(&r)) feed = f->mm_min;
    if (const auto* b = std::get_if<cl::Beam>(&r)) {
      beam = b->on;
      power = b->power_w;
    }
    s.beam = beam;
    s.power = power;
    s.feed = feed;
    if (const auto* m = std::get_if<cl::Rapid>(&r)) {
      s.rapid = true;
      s.segment = geom::make_line(at, geom::xy(m->to.tip));
    } else if (const auto* l = std::get_if<cl::Feed>(&r)) {
      s.segment = geom::make_line(at, geom::xy(l->to.tip));
    } else if (const auto* c = std::get_if<cl::Arc>(&r)) {
      s.segment.a = at;
      s.segment.b = geom::xy(c->to.tip);
      s.segment.center = geom::xy(c->center);
      s.segment.radius = c->normal.z > 0 ? c->radius : -c->radius;
    } else {
      continue;
    }
    at = s.segment.b;
    steps.push_back(s);
  }
  return steps;
}

inline double distance_to_outlines(const Profile& profile, Point2 p) {
  double best = 1e300;
  for (const Outline& o : profile.outlines) best = std::min(best, geom::distance_to(o.spline, p));
  return best;
}

}  // namespace burin::laser::fixture
