// SPDX-License-Identifier: Apache-2.0
// Method: where two outlines meet cuts each into stretches that lie wholly on one side of the other. They
// cross deeply when one stretch reaches further than the tolerance inside and another further than the
// tolerance outside (asked of both, since a needle thinner than the tolerance is seen from its own side
// only). A single outline is cut where it meets itself; it is simple (or only touches itself) when the
// winding number on the left is the same along all stretches that come away from the rest by more than the
// tolerance.
#include "burin/plan/laser/crossings.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "burin/geom/box_tree.h"
#include "burin/geom/curve/intersect.h"

namespace burin::laser::detail {
namespace {

using geom::ArcSpline;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

/// A place along an outline: segment and fraction of its length.
struct Place {
  std::uint32_t segment = 0;
  double fraction = 0;
  bool operator==(const Place&) const = default;
  bool operator<(const Place& o) const {
    return segment != o.segment ? segment < o.segment : fraction < o.fraction;
  }
};

struct Meeting {
  Place on_first, on_second;
  Point2 point;
};

double fraction_of(const Segment& s, Point2 p) {
  if (s.is_line()) {
    const Vec2 v = s.b - s.a;
    return std::clamp(dot(p - s.a, v) / norm2(v), 0.0, 1.0);
  }
  const Segment part{s.a, p, s.center, s.radius, 0};
  if (distance(p, s.a) <= geom::kArcConsistency * (std::abs(s.radius) + 1)) return 0;
  return std::clamp(sweep_of(part) / sweep_of(s), 0.0, 1.0);
}

class Finder {
 public:
  Finder(const std::vector<ArcSpline>& outlines, double tolerance, double point)
      : outlines_(outlines), tolerance_(tolerance), point_(point) {
    std::vector<geom::Box2> boxes;
    for (std::uint32_t o = 0; o < outlines.size(); ++o) {
      first_.push_back(static_cast<std::uint32_t>(owner_.size()));
      if (!outlines[o].closed) continue;
      for (const Segment& s : outlines[o].segments) {
        owner_.push_back(o);
        boxes.push_back(bounds_of(s).grown(point));
      }
    }
    first_.push_back(static_cast<std::uint32_t>(owner_.size()));
    tree_ = geom::BoxTree2(std::move(boxes));
  }

  std::vector<CrossingReport> run() {
    collect();
    std::vector<CrossingReport> reports;
    for (auto& [pair, meetings] : meetings_) {
      for (const bool deep : {true, false}) {
        // The shallow test looks for anything beyond the size of rounding and of the points' own tolerance.
        const double reach = deep ? tolerance_ : std::min(tolerance_, 10 * point_);
        const auto where = pair.first == pair.second
                               ? self_crossing(pair.first, meetings, reach)
                               : pair_crossing(pair.first, pair.second, meetings, reach);
        if (!where) continue;
        reports.push_back({pair.first, pair.second, deep, *where});
        break;
      }
    }
    return reports;
  }

 private:
  const Segment& segment(std::uint32_t global) const {
    return outlines_[owner_[global]].segments[global - first_[owner_[global]]];
  }

  bool neighbours(std::uint32_t i, std::uint32_t j) const {
    if (owner_[i] != owner_[j]) return false;
    const std::uint32_t o = owner_[i], n = first_[o + 1] - first_[o];
    const std::uint32_t a = i - first_[o], b = j - first_[o];
    return (a + 1) % n == b || (b + 1) % n == a;
  }

  void collect() {
    for (std::uint32_t i = 0; i < owner_.size(); ++i) {
      tree_.query(bounds_of(segment(i)).grown(point_), [&](std::uint32_t j) {
        if (j > i) meet(i, j);
        return true;
      });
    }
  }

  void meet(std::uint32_t i, std::uint32_t j) {
    const Segment &s = segment(i), &t = segment(j);
    const auto add = [&](Point2 p) {
      // Neighbours share an end; that is no meeting.
      if (neighbours(i, j)) {
        for (const Point2 shared : {s.a, s.b}) {
          if ((shared == t.a || shared == t.b) && distance(p, shared) <= 10 * point_) return;
        }
      }
      meetings_[{owner_[i], owner_[j]}].push_back(
          {{i - first_[owner_[i]], fraction_of(s, p)}, {j - first_[owner_[j]], fraction_of(t, p)}, p});
    };
    const geom::Intersection found = intersect(s, t, point_);
    if (const auto* points = std::get_if<geom::PointIntersections>(&found)) {
      for (int k = 0; k < points->count; ++k) add(points->point[static_cast<std::size_t>(k)]);
    } else if (const auto* overlap = std::get_if<geom::Overlap>(&found)) {
      add(overlap->a);
      add(overlap->b);
      if (overlap->twice) add(overlap->c), add(overlap->d);
    }
  }

  /// Whether any segment of `outline` but those in `skip` comes within `reach` of p.
  template <class Skip>
  bool near(std::uint32_t outline, Point2 p, double reach, const Skip& skip) const {
    const geom::Box2 area = geom::Box2{p, p}.grown(reach);
    return !tree_.query(area, [&](std::uint32_t k) {
      return owner_[k] != outline || skip(k - first_[outline]) || nearest_on(segment(k), p).distance > reach;
    });
  }

  /// Calls visit(point, tangent) at places spread over the stretch from `a` to `b` until it returns true.
  template <class Visit>
  bool walk(const ArcSpline& spline, Place a, Place b, const Visit& visit) const {
    const auto n = static_cast<std::uint32_t>(spline.segments.size());
    // A stretch may run over the seam of the outline.
    const std::uint32_t last = b < a || b == a ? b.segment + n : b.segment;
    for (std::uint32_t k = a.segment; k <= last; ++k) {
      const Segment& s = spline.segments[k % n];
      const double from = k == a.segment ? a.fraction : 0, to = k == last ? b.fraction : 1;
      if (to <= from) continue;
      for (const double f : {0.5, 0.2, 0.8, 0.05, 0.95, 0.999}) {
        const double at = from + f * (to - from);
        const Point2 p = point_on(s, at);
        const Vec2 tangent = s.is_line()
                                 ? start_tangent(s)
                                 : (s.radius > 0 ? left(unit(p - s.center)) : right(unit(p - s.center)));
        if (visit(p, tangent)) return true;
      }
    }
    return false;
  }

  std::optional<Point2> pair_crossing(std::uint32_t a, std::uint32_t b, std::vector<Meeting>& meetings,
                                      double reach) {
    for (const bool swapped : {false, true}) {
      const ArcSpline& mine = outlines_[swapped ? b : a];
      const std::uint32_t other = swapped ? a : b;
      std::vector<std::pair<Place, Point2>> cuts;
      for (const Meeting& m : meetings) cuts.emplace_back(swapped ? m.on_second : m.on_first, m.point);
      std::sort(cuts.begin(), cuts.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
      bool inside = false, outside = false;
      for (std::size_t i = 0; i < cuts.size(); ++i) {
        walk(mine, cuts[i].first, cuts[(i + 1) % cuts.size()].first, [&](Point2 p, Vec2) {
          if (near(other, p, reach, [](std::uint32_t) { return false; })) return false;
          (winding_number(outlines_[other], p) != 0 ? inside : outside) = true;
          return true;
        });
        if (inside && outside) return cuts[i].second;
      }
    }
    return std::nullopt;
  }

  std::optional<Point2> self_crossing(std::uint32_t o, std::vector<Meeting>& meetings, double reach) {
    const ArcSpline& spline = outlines_[o];
    std::vector<std::pair<Place, Point2>> cuts;
    for (const Meeting& m : meetings) {
      cuts.emplace_back(m.on_first, m.point);
      cuts.emplace_back(m.on_second, m.point);
    }
    std::sort(cuts.begin(), cuts.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    const auto n = static_cast<std::uint32_t>(spline.segments.size());
    std::optional<int> side;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      const Place a = cuts[i].first, b = cuts[(i + 1) % cuts.size()].first;
      const std::uint32_t last = b < a || b == a ? b.segment + n : b.segment;
      const auto own = [&](std::uint32_t k) {
        const std::uint32_t wrapped = k < a.segment ? k + n : k;
        return wrapped <= last;
      };
      std::optional<int> here;
      walk(spline, a, b, [&](Point2 p, Vec2 tangent) {
        if (near(o, p, reach, own)) return false;
        // A step to the left, well inside the free room and clear of the stretch's own bends.
        here = winding_number(spline, p + (0.25 * reach) * left(tangent));
        return true;
      });
      if (!here) continue;
      if (side && *side != *here) return cuts[i].second;
      side = here;
    }
    return std::nullopt;
  }

  const std::vector<ArcSpline>& outlines_;
  double tolerance_, point_;
  std::vector<std::uint32_t> owner_, first_;
  geom::BoxTree2 tree_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Meeting>> meetings_;
};

}  // namespace

std::vector<CrossingReport> find_crossings(const std::vector<ArcSpline>& outlines, double tolerance_mm,
                                           double point_mm) {
  return Finder(outlines, tolerance_mm, point_mm).run();
}

}  // namespace burin::laser::detail
