// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/nesting.h"

#include <algorithm>
#include <array>
#include <cmath>

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
  std::uint32_t path = 0;
};

double x_at(const Rise& r, double y) {
  if (r.radius == 0) return r.a.x + (y - r.a.y) * ((r.b.x - r.a.x) / (r.b.y - r.a.y));
  const double h = y - r.center.y;
  const double w = std::sqrt(std::max(0.0, r.radius * r.radius - h * h));
  return r.right ? r.center.x + w : r.center.x - w;
}

void add_arc(const Segment& s, std::uint32_t path, std::vector<Rise>& out) {
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
    out.push_back({from, to, s.center, r, std::cos(middle) > 0, path});
    from = to;
  }
}

std::vector<Rise> rises_of(const std::vector<CutPath>& paths) {
  std::vector<Rise> out;
  for (std::uint32_t i = 0; i < paths.size(); ++i) {
    if (!paths[i].spline.closed || paths[i].role == Role::engrave) continue;
    for (const Segment& s : paths[i].spline.segments) {
      if (s.is_line()) {
        out.push_back({s.a, s.b, {}, 0, false, i});
      } else {
        add_arc(s, i, out);
      }
    }
  }
  return out;
}

class Containers {
 public:
  explicit Containers(const std::vector<CutPath>& paths) : rises_(rises_of(paths)), tree_(boxes()) {}

  /// Closed paths with a winding number other than 0 about p, in rising order.
  std::vector<std::uint32_t> of(Point2 p) const {
    std::vector<std::pair<std::uint32_t, int>> hits;
    const Box2 ray{p, {tree_.bounds().hi.x, p.y}};
    if (ray.empty()) return {};
    tree_.query(ray, [&](std::uint32_t i) {
      const Rise& r = rises_[i];
      const bool up = r.a.y <= p.y && p.y < r.b.y, down = r.b.y <= p.y && p.y < r.a.y;
      if ((up || down) && x_at(r, p.y) > p.x) hits.emplace_back(r.path, up ? 1 : -1);
      return true;
    });
    std::sort(hits.begin(), hits.end());
    std::vector<std::uint32_t> in;
    for (std::size_t i = 0; i < hits.size();) {
      int winding = 0;
      const std::uint32_t path = hits[i].first;
      for (; i < hits.size() && hits[i].first == path; ++i) winding += hits[i].second;
      if (winding != 0) in.push_back(path);
    }
    return in;
  }

 private:
  std::vector<Box2> boxes() const {
    std::vector<Box2> all;
    all.reserve(rises_.size());
    for (const Rise& r : rises_) {
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

  std::vector<Rise> rises_;
  BoxTree tree_;
};

/// Three points of a path, so that one that touches another path does not decide alone.
std::array<Point2, 3> witnesses(const geom::ArcSpline& spline) {
  const auto& s = spline.segments;
  const std::size_t n = s.size();
  return {geom::point_on(s[0], 0.5), geom::point_on(s[n / 3], n == 1 ? 0.25 : 0.41),
          geom::point_on(s[2 * n / 3], n <= 2 ? 0.77 : 0.59)};
}

}  // namespace

std::vector<std::uint32_t> path_parents(const std::vector<CutPath>& paths, double point_mm) {
  const std::size_t n = paths.size();
  std::vector<double> area(n, 0);
  std::vector<Box2> box(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (paths[i].spline.closed) area[i] = std::abs(geom::signed_area(paths[i].spline));
    box[i] = geom::bounds_of(paths[i].spline);
  }
  const Containers containers(paths);
  std::vector<std::uint32_t> parents(n, kNoParent);
  for (std::uint32_t i = 0; i < n; ++i) {
    if (paths[i].role == Role::engrave || paths[i].spline.empty()) continue;
    std::vector<std::uint32_t> in;
    for (const Point2 p : witnesses(paths[i].spline)) {
      for (const std::uint32_t c : containers.of(p)) in.push_back(c);
    }
    std::sort(in.begin(), in.end());
    for (std::size_t k = 0; k + 1 < in.size(); ++k) {
      const std::uint32_t c = in[k];
      if (c == i || in[k + 1] != c) continue;  // at least two of the three points
      const Box2 room = box[c].grown(point_mm);
      const bool larger = area[c] > area[i] || (area[c] == area[i] && c > i);
      if (!larger || !room.contains(box[i].lo) || !room.contains(box[i].hi)) continue;
      const std::uint32_t best = parents[i];
      if (best == kNoParent || area[c] < area[best] || (area[c] == area[best] && c < best)) parents[i] = c;
    }
  }
  return parents;
}

}  // namespace burin::laser::detail
