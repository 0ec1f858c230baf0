// SPDX-License-Identifier: Apache-2.0
// Suh & Lee, procedure 3: T1 and T2 along the part's section, offset by the ball's radius. The plane is (y,
// z).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "burin/geom/box_tree.h"
#include "burin/geom/mesh/slice.h"
#include "burin/geom/point_tools.h"
#include "burin/plan/rotary/reach.h"

namespace burin::rotary {

namespace {

using geom::Box2;
using geom::Point2;
using geom::Vec2;

constexpr double kRoundStep = geom::kPi / 180;  // of the arcs about corners
/// Of the radius: an offset point this much nearer to the section than R is one of a loop. Above the sagitta
/// of a mesh section under normals that turn evenly, and of the arcs about corners.
constexpr double kLoop = 1e-3;

Point2 in_plane(geom::Point3 p) {
  return {p.y, p.z};
}
Vec2 in_plane(geom::Vec3 v) {
  return {v.y, v.z};
}
/// The tool axis angle of a direction: 0 along Z, growing towards Y.
double theta_of(Vec2 d) {
  return std::atan2(d.x, d.y);
}

/// A section with the question whether a place is nearer to it than some distance.
class Section {
 public:
  explicit Section(std::vector<Point2> points) : points_(std::move(points)), tree_(boxes(points_)) {}

  bool nearer(Point2 p, double than) const {
    Box2 area;
    area.add(p);
    return !tree_.query(area.grown(than), [&](std::uint32_t i) {
      return distance_to_segment(p, points_[i], points_[(i + 1) % points_.size()]) >= than;
    });
  }

 private:
  static std::vector<Box2> boxes(const std::vector<Point2>& points) {
    std::vector<Box2> out(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      out[i].add(points[i]);
      out[i].add(points[(i + 1) % points.size()]);
    }
    return out;
  }
  std::vector<Point2> points_;
  geom::BoxTree2 tree_;
};

/// Q' = Q + R N', about corners in steps, with loops removed: what is nearer to the section than R is in one.
/// Where a loop has been, the last place before it and the first after it are found by halving.
std::vector<Point2> offset(const geom::SliceLoop& loop, const Section& section, double radius) {
  std::vector<Point2> raw;
  for (const geom::SlicePoint& q : loop.points) {
    const Vec2 from = unit(in_plane(q.normal_before)), to = unit(in_plane(q.normal));
    if (norm2(to) == 0 && norm2(from) == 0) continue;  // a wall across X
    const Vec2 first = norm2(from) > 0 ? from : to, last = norm2(to) > 0 ? to : from;
    const double turn = std::atan2(cross(first, last), dot(first, last));
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(turn) / kRoundStep)));
    for (int k = std::abs(turn) > 1e-9 ? 0 : steps; k <= steps; ++k) {
      const double a = turn * k / steps, c = std::cos(a), s = std::sin(a);
      raw.push_back(in_plane(q.p) + radius * Vec2{c * first.x - s * first.y, s * first.x + c * first.y});
    }
  }
  const double least = radius * (1 - kLoop);
  const auto inside = [&](Point2 p) { return section.nearer(p, least); };
  const auto border = [&](Point2 out, Point2 in) {
    for (int k = 0; k < 40; ++k) {
      const Point2 mid = lerp(out, in, 0.5);
      (inside(mid) ? in : out) = mid;
    }
    return out;
  };
  std::vector<Point2> kept;
  if (raw.empty()) return kept;
  bool before_in = inside(raw.back());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const Point2 before = raw[i == 0 ? raw.size() - 1 : i - 1];
    const bool in = inside(raw[i]);
    if (in != before_in) kept.push_back(in ? border(before, raw[i]) : border(raw[i], before));
    if (!in) kept.push_back(raw[i]);
    before_in = in;
  }
  return kept;
}

/// Directions with V as the third axis: a along the walk where it begins (T_L), b along the normal.
struct Seen {
  double a, b;
};
double cross(Seen u, Seen v) {
  return u.a * v.b - u.b * v.a;
}
double dot(Seen u, Seen v) {
  return u.a * v.a + u.b * v.b;
}
/// Between `before` and `now` the walk crossed the direction against t (eq. 9, 10).
bool crossed_behind(Seen t, Seen before, Seen now) {
  return dot(t, now) < 0 && dot(t, before) < 0 && (cross(t, before) > 0) != (cross(t, now) > 0);
}

}  // namespace

struct SectionAxis::State {
  State(const geom::Mesh& mesh, const std::vector<std::array<geom::Vec3, 3>>& normals, double r)
      : slicer(mesh, normals), radius(r) {}
  geom::Slicer slicer;
  double radius;
};

SectionAxis::SectionAxis(const geom::Mesh& mesh, const std::vector<std::array<geom::Vec3, 3>>& corner_normals,
                         double ball_radius)
    : state_(std::make_unique<State>(mesh, corner_normals, ball_radius)) {}
SectionAxis::~SectionAxis() = default;

namespace {

/// Of several curves in the plane, the one that comes nearest to where the ball touches.
std::optional<std::size_t> nearest_loop(const std::vector<geom::SliceLoop>& loops, Point2 p) {
  std::optional<std::size_t> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto& points = loops[k].points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double d =
          distance_to_segment(p, in_plane(points[i].p), in_plane(points[(i + 1) % points.size()].p));
      if (d < least) {
        least = d;
        best = k;
      }
    }
  }
  return best;
}

struct Cone {
  Seen t1{1, 0}, t2{-1, 0};
};

/// Steps 2 and 3 over the places seen from the centre, in the order of the walk.
Cone walk(const std::vector<Seen>& way) {
  Cone cone;
  std::size_t i = 0;
  const auto longer = [](Seen q) {
    const double n = std::hypot(q.a, q.b);
    return Seen{q.a / n, q.b / n};
  };
  for (; i < way.size(); ++i) {
    if (i > 0 && crossed_behind(cone.t1, way[i - 1], way[i])) break;
    if (cross(cone.t1, way[i]) > 0 && (dot(cone.t1, way[i]) > 0 || i == 0 || cross(cone.t1, way[i - 1]) > 0))
      cone.t1 = longer(way[i]);
  }
  for (std::size_t k = i; k < way.size(); ++k) {
    if (k > i && crossed_behind(cone.t2, way[k - 1], way[k])) break;
    if (cross(cone.t2, way[k]) < 0) cone.t2 = longer(way[k]);
  }
  return cone;
}

}  // namespace

SectionReach SectionAxis::at(geom::Point3 center, geom::Vec3 normal) const {
  const double radius = state_->radius;
  const Point2 c = in_plane(center);
  const Vec2 n = unit(in_plane(normal));
  if (!(norm2(n) > 0) || !std::isfinite(c.x + c.y + center.x)) return {};
  const std::vector<geom::SliceLoop> loops = state_->slicer.at(center.x);
  const auto chosen = nearest_loop(loops, c - radius * n);
  if (!chosen) return {{{theta_of(n) - geom::kPi / 2, theta_of(n) + geom::kPi / 2}}, theta_of(n)};
  const geom::SliceLoop& loop = loops[*chosen];
  std::vector<Point2> points;
  for (const auto& q : loop.points) points.push_back(in_plane(q.p));
  const std::vector<Point2> curve = offset(loop, Section(points), radius);
  // The walk begins at the place of the curve that is nearest to the centre; loops run counter-clockwise
  // about +X with the outside on the right, so V = CQ1' x Nc' is -X.
  std::size_t start = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (distance(curve[i], c) < distance(curve[start], c)) start = i;
  }
  const Vec2 along = left(n);
  std::vector<Seen> way;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Vec2 d = curve[(start + i) % curve.size()] - c;
    // Too near to have a direction: the curve passes through the centre with the tangent that T1 and T2 begin
    // with.
    if (norm(d) > 0.02 * radius) way.push_back({dot(d, along), dot(d, n)});
  }
  const Cone cone = walk(way);
  if (cross(cone.t1, cone.t2) < 0) return {};  // eq. 11
  // From T1 to T2 theta grows: V is -X.
  const double width = std::atan2(cross(cone.t1, cone.t2), dot(cone.t1, cone.t2));
  const Vec2 first = cone.t1.a * along + cone.t1.b * n;
  double lo = theta_of(first);
  if (lo >= geom::kPi) lo = -geom::kPi;
  if (!(width > 0)) return {};
  return {{{lo, lo + width}}, lo + 0.5 * width};
}

}  // namespace burin::rotary
