// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/trim.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/geom/point_tools.h"

namespace burin::cycle {
namespace {

using geom::Direction;
using geom::Interval;
using geom::Point2;

std::vector<Point2> mapped(const geom::Member& m, const std::vector<Point2>& points) {
  std::vector<Point2> out;
  out.reserve(points.size());
  for (const Point2 p : points) out.push_back(geom::joined_parameters(m, p));
  return out;
}

bool even_odd(const std::vector<std::vector<Point2>>& loops, Point2 p) {
  bool in = false;
  for (const auto& loop : loops) in ^= geom::inside_polygon(loop, p);
  return in;
}

bool holds(Interval u, Interval v, Point2 p) {
  return p.x >= u.lo && p.x <= u.hi && p.y >= v.lo && p.y <= v.hi;
}

}  // namespace

Region::Region(const geom::JoinedSurface& surface, const std::vector<Trim>& trims)
    : u_(surface.surface.domain(Direction::u)), v_(surface.surface.domain(Direction::v)) {
  for (const geom::Member& m : surface.members) {
    Part part{m.u, m.v, {}};
    for (const Trim& trim : trims)
      if (trim.patch == m.patch && trim.points.size() >= 3) part.loops.push_back(mapped(m, trim.points));
    if (!part.loops.empty()) whole_ = false;
    parts_.push_back(std::move(part));
  }
  if (whole_) return;
  geom::Box2 box;
  for (const Part& part : parts_) {
    geom::Box2 own;
    if (part.loops.empty()) {
      own.add(Point2{part.u.lo, part.v.lo});
      own.add(Point2{part.u.hi, part.v.hi});
    }
    for (const auto& loop : part.loops)
      for (const Point2 p : loop)
        own.add(Point2{std::clamp(p.x, part.u.lo, part.u.hi), std::clamp(p.y, part.v.lo, part.v.hi)});
    box.add(own);
  }
  u_ = {box.lo.x, box.hi.x};
  v_ = {box.lo.y, box.hi.y};
}

bool Region::inside(double u, double v) const {
  if (whole_) return true;
  const Point2 p{u, v};
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    return holds(part.u, part.v, p) && (part.loops.empty() || even_odd(part.loops, p));
  });
}

bool Region::on_edge(Interval u, Interval v) const {
  if (whole_) return false;
  const geom::Box2 box{{u.lo, v.lo}, {u.hi, v.hi}};
  for (const Part& part : parts_)
    for (const auto& loop : part.loops)
      for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
        geom::Box2 edge;
        edge.add(loop[i]);
        edge.add(loop[j]);
        if (edge.overlaps(box)) return true;
      }
  return false;
}

std::vector<Interval> Region::cut(const Graph& graph, Direction along) const {
  if (whole_) return {{graph.lo(), graph.hi()}};
  const auto turned = [along](Point2 p) { return along == Direction::u ? p : Point2{p.y, p.x}; };
  std::vector<double> at{graph.lo(), graph.hi()};
  const auto add = [&](Point2 a, Point2 b) {
    for (const double t : crossings(graph, turned(a), turned(b))) at.push_back(t);
  };
  for (const Part& part : parts_) {
    const Point2 c[4] = {
        {part.u.lo, part.v.lo}, {part.u.hi, part.v.lo}, {part.u.hi, part.v.hi}, {part.u.lo, part.v.hi}};
    for (int i = 0; i < 4; ++i) add(c[i], c[(i + 1) % 4]);
    for (const auto& loop : part.loops)
      for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) add(loop[j], loop[i]);
  }
  std::sort(at.begin(), at.end());
  std::vector<Interval> out;
  const double point = 1e-9 * (graph.hi() - graph.lo());
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    const double a = std::max(at[i], graph.lo()), b = std::min(at[i + 1], graph.hi());
    if (!(b - a > point)) continue;
    const double t = 0.5 * (a + b);
    const Point2 p = turned({t, graph.at(t).w});
    if (!inside(p.x, p.y)) continue;
    if (!out.empty() && a - out.back().hi <= point)
      out.back().hi = b;
    else
      out.push_back({a, b});
  }
  return out;
}

double Region::distance_to_edge(Point2 p) const {
  double best = std::numeric_limits<double>::infinity();
  for (const Part& part : parts_)
    for (const auto& loop : part.loops)
      for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++)
        best = std::min(best, distance_to_segment(p, loop[j], loop[i]));
  return best;
}

bool Region::stays_inside(Point2 a, Point2 b, double slack) const {
  if (whole_) return true;
  constexpr int kSamples = 16;
  const double near = slack * distance(a, b);
  for (int i = 1; i < kSamples; ++i) {
    const Point2 p = lerp(a, b, static_cast<double>(i) / kSamples);
    if (!inside(p.x, p.y) && distance_to_edge(p) > near) return false;
  }
  return true;
}

}  // namespace burin::cycle
