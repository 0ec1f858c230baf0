// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/nesting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "burin/plan/laser/clearance.h"

namespace burin::laser::detail {

using geom::Box2;
using geom::Point2;
using geom::Segment;

namespace {

/// Part of a segment that only rises or only falls: a horizontal ray meets it at most once, and with
/// half-open ranges of y a chain of such parts is met consistently.
struct Rise {
  Point2 a, b;
  Point2 center{};
  double radius = 0;   ///< 0: a line
  bool right = false;  ///< which half of the circle
};

double x_at(const Rise& r, double y) {
  if (r.radius == 0) return r.a.x + (y - r.a.y) * ((r.b.x - r.a.x) / (r.b.y - r.a.y));
  const double h = y - r.center.y;
  const double w = std::sqrt(std::max(0.0, r.radius * r.radius - h * h));
  return r.right ? r.center.x + w : r.center.x - w;
}

void add_arc(const Segment& s, std::vector<Rise>& out) {
  const double r = std::abs(s.radius), sweep = geom::sweep_of(s);
  const double start = std::atan2(s.a.y - s.center.y, s.a.x - s.center.x);
  // The tangent is horizontal at +-90 degrees: cut there.
  std::vector<double> cuts{0};
  for (int k = -6; k <= 6; ++k) {
    const double f = (geom::kPi / 2 + k * geom::kPi - start) / sweep;
    if (f > 0 && f < 1) cuts.push_back(f);
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.push_back(1);
  Point2 from = s.a;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const double middle = start + sweep * (cuts[i - 1] + cuts[i]) / 2;
    const double end = start + sweep * cuts[i];
    const Point2 to =
        i + 1 == cuts.size() ? s.b : Point2{s.center.x + r * std::cos(end), s.center.y + r * std::sin(end)};
    out.push_back({from, to, s.center, r, std::cos(middle) > 0});
    from = to;
  }
}

std::vector<Rise> rises_of(const geom::ArcSpline& spline) {
  std::vector<Rise> out;
  for (const Segment& s : spline.segments) {
    if (s.is_line()) {
      out.push_back({s.a, s.b, {}, 0, false});
    } else {
      add_arc(s, out);
    }
  }
  return out;
}

std::vector<Box2> boxes_of(const std::vector<Rise>& rises) {
  std::vector<Box2> all;
  all.reserve(rises.size());
  for (const Rise& r : rises) {
    Box2 b;
    b.add(r.a);
    b.add(r.b);
    if (r.radius != 0) {
      // A half of a circle bulges beyond its ends to the side at most to the radius.
      b.lo.x = std::min(b.lo.x, r.center.x - r.radius);
      b.hi.x = std::max(b.hi.x, r.center.x + r.radius);
    }
    all.push_back(b);
  }
  return all;
}

/// A closed path that answers which points it contains in about the logarithm of its segments.
class Container {
 public:
  explicit Container(const geom::ArcSpline& spline) : rises_(rises_of(spline)), tree_(boxes_of(rises_)) {}

  bool contains(Point2 p) const {
    const Box2 ray{p, {tree_.bounds().hi.x, p.y}};
    if (ray.empty()) return false;
    int winding = 0;
    tree_.query(ray, [&](std::uint32_t i) {
      const Rise& r = rises_[i];
      const bool up = r.a.y <= p.y && p.y < r.b.y, down = r.b.y <= p.y && p.y < r.a.y;
      if ((up || down) && x_at(r, p.y) > p.x) winding += up ? 1 : -1;
      return true;
    });
    return winding != 0;
  }

  /// Whether p lies on the path, within `reach`.
  bool touches(Point2 p, double reach) const {
    return !tree_.query(Box2{p, p}.grown(reach), [&](std::uint32_t i) {
      const Rise& r = rises_[i];
      if (r.radius == 0) return geom::nearest_on(geom::make_line(r.a, r.b), p).distance > reach;
      return std::abs(geom::distance(p, r.center) - r.radius) > reach;
    });
  }

 private:
  std::vector<Rise> rises_;
  geom::BoxTree2 tree_;
};

/// Three points of a path, so that one that touches another path does not decide alone.
std::array<Point2, 3> witnesses(const geom::ArcSpline& spline) {
  const auto& s = spline.segments;
  const std::size_t n = s.size();
  return {geom::point_on(s[0], 0.5), geom::point_on(s[n / 3], n == 1 ? 0.25 : 0.41),
          geom::point_on(s[2 * n / 3], n <= 2 ? 0.77 : 0.59)};
}

/// Whether the path lies in the container: by points of it that do not lie on the container's own line, where
/// rounding would decide. Paths that coincide contain each other as their witnesses say.
bool is_inside(const geom::ArcSpline& path, const Container& container, double point_mm) {
  const auto first = witnesses(path);
  int inside = 0, seen = 0;
  const auto ask = [&](Point2 p) {
    if (container.touches(p, 10 * point_mm)) return;
    ++seen;
    inside += container.contains(p);
  };
  for (const Point2 p : first) ask(p);
  for (std::size_t i = 0; i < path.segments.size() && seen == 0; ++i)
    ask(geom::point_on(path.segments[i], 0.5));
  if (seen > 0) return 2 * inside > seen;
  for (const Point2 p : first) inside += container.contains(p);
  return 2 * inside > static_cast<int>(first.size());
}

}  // namespace

std::vector<std::uint32_t> path_parents(const std::vector<CutPath>& paths, double point_mm) {
  const std::size_t n = paths.size();
  std::vector<double> area(n, 0);
  std::vector<Box2> box(n), closed_box;
  std::vector<std::uint32_t> closed;
  for (std::size_t i = 0; i < n; ++i) {
    box[i] = geom::bounds_of(paths[i].spline);
    if (!paths[i].spline.closed || paths[i].role == Role::engrave || paths[i].spline.empty()) continue;
    area[i] = std::abs(geom::signed_area(paths[i].spline));
    closed.push_back(static_cast<std::uint32_t>(i));
    closed_box.push_back(box[i].grown(point_mm));
  }
  const auto smaller = [&](std::uint32_t a, std::uint32_t b) {
    return area[a] != area[b] ? area[a] < area[b] : a < b;
  };
  const geom::BoxTree2 tree(closed_box);
  std::vector<std::optional<Container>> containers(n);
  std::vector<std::uint32_t> parents(n, kNoParent);
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (paths[i].role == Role::engrave || paths[i].spline.empty()) continue;
    candidates.clear();
    tree.query({box[i].lo, box[i].lo}, [&](std::uint32_t k) {
      const std::uint32_t c = closed[k];
      if (c != i && smaller(i, c) && closed_box[k].contains(box[i].hi)) candidates.push_back(c);
      return true;
    });
    std::sort(candidates.begin(), candidates.end(), smaller);
    for (const std::uint32_t c : candidates) {
      if (!containers[c]) containers[c].emplace(paths[c].spline);
      if (!is_inside(paths[i].spline, *containers[c], point_mm)) continue;
      parents[i] = c;
      break;
    }
  }
  return parents;
}

}  // namespace burin::laser::detail
