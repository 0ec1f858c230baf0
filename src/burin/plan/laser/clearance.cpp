// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/clearance.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace burin::laser::detail {

using geom::Box2;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

// --- tree
// -----------------------------------------------------------------------------------------------------

namespace {

constexpr std::uint32_t kLeafSize = 4;

std::vector<Box2> boxes_of(const std::vector<Segment>& segments) {
  std::vector<Box2> boxes;
  boxes.reserve(segments.size());
  for (const Segment& s : segments) boxes.push_back(geom::bounds_of(s));
  return boxes;
}

}  // namespace

BoxTree::BoxTree(std::vector<Box2> boxes) : boxes_(std::move(boxes)), index_(boxes_.size()) {
  std::iota(index_.begin(), index_.end(), 0u);
  if (boxes_.empty()) return;
  nodes_.reserve(boxes_.size());
  build(0, static_cast<std::uint32_t>(boxes_.size()));
}

std::uint32_t BoxTree::build(std::uint32_t first, std::uint32_t end) {
  const auto self = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({});
  Box2 box, centres;
  for (std::uint32_t i = first; i < end; ++i) {
    const Box2& b = boxes_[index_[i]];
    box.add(b);
    centres.add(geom::lerp(b.lo, b.hi, 0.5));
  }
  nodes_[self].box = box;
  nodes_[self].first = first;
  nodes_[self].end = end;
  if (end - first <= kLeafSize) return self;
  const bool by_x = centres.width() >= centres.height();
  const std::uint32_t middle = first + (end - first) / 2;
  std::nth_element(index_.begin() + first, index_.begin() + middle, index_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const Box2 &p = boxes_[a], &q = boxes_[b];
                     const double u = by_x ? p.lo.x + p.hi.x : p.lo.y + p.hi.y;
                     const double v = by_x ? q.lo.x + q.hi.x : q.lo.y + q.hi.y;
                     return u != v ? u < v : a < b;
                   });
  const std::uint32_t l = build(first, middle);
  const std::uint32_t r = build(middle, end);
  nodes_[self].left = l;
  nodes_[self].right = r;
  return self;
}

// --- distance
// -------------------------------------------------------------------------------------------------

namespace {

bool lines_cross(const Segment& s, const Segment& t) {
  const Vec2 u = s.b - s.a, v = t.b - t.a;
  const double d = geom::cross(u, v);
  if (d == 0) return false;  // parallel: the ends decide
  const double p = geom::cross(t.a - s.a, v) / d;
  const double q = geom::cross(t.a - s.a, u) / d;
  return p >= 0 && p <= 1 && q >= 0 && q <= 1;
}

bool line_crosses_arc(const Segment& line, const Segment& arc) {
  const Vec2 u = geom::unit(line.b - line.a);
  const double length = geom::distance(line.a, line.b);
  const double along = geom::dot(arc.center - line.a, u);
  const double h = geom::cross(u, arc.center - line.a);
  const double c2 = arc.radius * arc.radius - h * h;
  if (c2 < 0) return false;
  const double c = std::sqrt(c2);
  for (const double x : {along - c, along + c}) {
    if (x >= 0 && x <= length && geom::in_sweep(arc, line.a + x * u)) return true;
  }
  return false;
}

bool arcs_cross(const Segment& s, const Segment& t) {
  const Vec2 w = t.center - s.center;
  const double d = geom::norm(w), r = std::abs(s.radius), q = std::abs(t.radius);
  if (d == 0 || d > r + q || d < std::abs(r - q)) return false;
  const double x = (d * d + r * r - q * q) / (2 * d);
  const double y = std::sqrt(std::max(0.0, r * r - x * x));
  const Vec2 u = w / d;
  for (const double side : {y, -y}) {
    const Point2 p = s.center + x * u + side * geom::left(u);
    if (geom::in_sweep(s, p) && geom::in_sweep(t, p)) return true;
  }
  return false;
}

bool cross(const Segment& s, const Segment& t) {
  if (s.is_line() && t.is_line()) return lines_cross(s, t);
  if (s.is_line()) return line_crosses_arc(s, t);
  if (t.is_line()) return line_crosses_arc(t, s);
  return arcs_cross(s, t);
}

/// Distance from the two points of `arc` in direction +-u from its centre, as far as they lie in its sweep.
double distance_along(const Segment& arc, Vec2 u, const Segment& other) {
  double best = std::numeric_limits<double>::infinity();
  for (const double side : {1.0, -1.0}) {
    const Point2 p = arc.center + side * std::abs(arc.radius) * u;
    if (geom::in_sweep(arc, p)) best = std::min(best, geom::nearest_on(other, p).distance);
  }
  return best;
}

}  // namespace

double segment_distance(const Segment& s, const Segment& t) {
  if (cross(s, t)) return 0;
  double best = std::min({geom::nearest_on(s, t.a).distance, geom::nearest_on(s, t.b).distance,
                          geom::nearest_on(t, s.a).distance, geom::nearest_on(t, s.b).distance});
  if (s.is_line() && t.is_line()) return best;
  if (s.is_line()) return std::min(best, distance_along(t, geom::left(geom::unit(s.b - s.a)), s));
  if (t.is_line()) return std::min(best, distance_along(s, geom::left(geom::unit(t.b - t.a)), t));
  const Vec2 u = geom::unit(t.center - s.center);
  if (u == Vec2{}) return best;  // concentric: the distance is the same wherever they face each other
  return std::min({best, distance_along(s, u, t), distance_along(t, u, s)});
}

Segment moved(const Segment& s, Vec2 by) {
  Segment m = s;
  m.a = s.a + by;
  m.b = s.b + by;
  if (!s.is_line()) m.center = s.center + by;
  return m;
}

// --- clearance
// ------------------------------------------------------------------------------------------------

Clearance::Clearance(std::vector<Segment> segments, std::vector<std::uint32_t> owner, Tiling tiling)
    : segments_(std::move(segments)), owner_(std::move(owner)), tiling_(tiling), tree_(boxes_of(segments_)) {}

bool Clearance::is_free_of_copy(const Segment& move, const Box2& box, double distance, Vec2 shift,
                                std::uint32_t skip) const {
  // Instead of moving the copy to the place, the move is taken back to the first copy.
  const Segment here = shift == Vec2{} ? move : moved(move, -shift);
  const Box2 area{box.lo - shift, box.hi - shift};
  return tree_.query(area, [&](std::uint32_t i) {
    return owner_[i] == skip || segment_distance(here, segments_[i]) >= distance;
  });
}

bool Clearance::is_free(const Segment& move, double distance, std::uint32_t skip) const {
  if (segments_.empty()) return true;
  const Box2 box = geom::bounds_of(move).grown(distance);
  if (!is_free_of_copy(move, box, distance, {}, skip)) return false;
  const Box2 all = tree_.bounds();
  // Copy i overlaps the box in x when box.lo - all.hi <= i pitch <= box.hi - all.lo; seen from any copy, the
  // others lie up to n - 1 steps to either side.
  const auto range = [](double low, double high, double pitch, int n) {
    if (n <= 1 || pitch <= 0) return std::array{0, 0};
    const double most = n - 1;
    return std::array{static_cast<int>(std::clamp(std::ceil(low / pitch), -most, most)),
                      static_cast<int>(std::clamp(std::floor(high / pitch), -most, most))};
  };
  const auto columns = range(box.lo.x - all.hi.x, box.hi.x - all.lo.x, tiling_.pitch.x, tiling_.columns);
  const auto rows = range(box.lo.y - all.hi.y, box.hi.y - all.lo.y, tiling_.pitch.y, tiling_.rows);
  for (int j = rows[0]; j <= rows[1]; ++j) {
    for (int i = columns[0]; i <= columns[1]; ++i) {
      if (i == 0 && j == 0) continue;
      const Vec2 shift{i * tiling_.pitch.x, j * tiling_.pitch.y};
      if (!is_free_of_copy(move, box, distance, shift, kNobody)) return false;
    }
  }
  return true;
}

namespace {

template <class Items>
Clearance clearance_of(const Items& items, const Tiling& tiling) {
  std::vector<Segment> segments;
  std::vector<std::uint32_t> owner;
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    const auto& all = items[i].spline.segments;
    segments.insert(segments.end(), all.begin(), all.end());
    owner.resize(segments.size(), i);
  }
  return {std::move(segments), std::move(owner), tiling};
}

}  // namespace

Clearance clearance_of_outlines(const Profile& profile, const Tiling& tiling) {
  return clearance_of(profile.outlines, tiling);
}
Clearance clearance_of_paths(const Profile& profile, const Tiling& tiling) {
  return clearance_of(profile.paths, tiling);
}

}  // namespace burin::laser::detail
