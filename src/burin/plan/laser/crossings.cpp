// SPDX-License-Identifier: Apache-2.0
// Method: where two outlines meet cuts each into stretches that lie wholly on one side of the other. They
// cross deeply when one stretch reaches further than the tolerance inside and another further than the
// tolerance outside (asked of both, since a needle thinner than the tolerance is seen from its own side
// only). A single outline is cut where it meets itself; it is simple (or only touches itself) when the
// winding number on the left is the same along all stretches that come away from the rest by more than the
// tolerance.
#include "burin/plan/laser/crossings.h"

#include <algorithm>
#include <limits>
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
        // The shallow test looks for anything that is more than a touch: the offset would follow a small loop
        // the wrong way round.
        const double reach = deep ? tolerance_ : std::min(tolerance_, point_);
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

  /// Whether any segment of `outline` comes within `reach` of p; away(segment) says how far one is.
  template <class Away>
  bool near(std::uint32_t outline, Point2 p, double reach, const Away& away) const {
    const geom::Box2 area = geom::Box2{p, p}.grown(reach);
    return !tree_.query(
        area, [&](std::uint32_t k) { return owner_[k] != outline || away(k - first_[outline]) > reach; });
  }

  /// Distance from p to what segment k of outline o has outside of the stretch from `a` to `b`.
  double away_outside(std::uint32_t o, std::uint32_t k, Place a, Place b, Point2 p) const {
    const Segment& s = segment(first_[o] + k);
    const auto between = [&](double from, double to) {
      if (to <= from) return std::numeric_limits<double>::infinity();
      const Point2 start = from <= 0 ? s.a : point_on(s, from), end = to >= 1 ? s.b : point_on(s, to);
      // Too short to be told from a full circle.
      if (distance(start, end) <= point_ && to - from < 0.5) return distance(start, p);
      return nearest_on({start, end, s.center, s.radius, 0}, p).distance;
    };
    const bool wraps = b < a || b == a;
    const bool first = k == a.segment, last = k == b.segment;
    if (first && last) {
      return wraps ? between(b.fraction, a.fraction)
                   : std::min(between(0, a.fraction), between(b.fraction, 1));
    }
    if (first) return between(0, a.fraction);
    if (last) return between(b.fraction, 1);
    const bool within = wraps ? k > a.segment || k < b.segment : k > a.segment && k < b.segment;
    return within ? std::numeric_limits<double>::infinity() : nearest_on(s, p).distance;
  }

  /// Whether the straight step from p on segment k of outline o to q meets no other segment of the outline.
  bool free_step(std::uint32_t o, std::uint32_t k, Point2 p, Point2 q) const {
    const Segment step = geom::make_line(p, q);
    return tree_.query(bounds_of(step), [&](std::uint32_t g) {
      return owner_[g] != o || g == first_[o] + k ||
             std::holds_alternative<geom::NoIntersection>(intersect(step, segment(g), 0));
    });
  }

  /// Calls visit(point, tangent, segment) at places spread over the stretch from `a` to `b` until it returns
  /// true.
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
        if (visit(p, tangent, k % n)) return true;
      }
    }
    return false;
  }

  static void same_places_once(std::vector<std::pair<Place, Point2>>& sorted) {
    const auto same = [](const auto& x, const auto& y) { return x.first == y.first; };
    sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  }

  std::optional<Point2> pair_crossing(std::uint32_t a, std::uint32_t b, std::vector<Meeting>& meetings,
                                      double reach) {
    for (const bool swapped : {false, true}) {
      const ArcSpline& mine = outlines_[swapped ? b : a];
      const std::uint32_t other = swapped ? a : b;
      std::vector<std::pair<Place, Point2>> cuts;
      for (const Meeting& m : meetings) cuts.emplace_back(swapped ? m.on_second : m.on_first, m.point);
      std::sort(cuts.begin(), cuts.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
      same_places_once(cuts);
      bool inside = false, outside = false;
      for (std::size_t i = 0; i < cuts.size(); ++i) {
        walk(mine, cuts[i].first, cuts[(i + 1) % cuts.size()].first, [&](Point2 p, Vec2, std::uint32_t) {
          const auto away = [&](std::uint32_t k) {
            return nearest_on(segment(first_[other] + k), p).distance;
          };
          if (near(other, p, reach, away)) return false;
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
    same_places_once(cuts);
    std::optional<int> side;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      const Place a = cuts[i].first, b = cuts[(i + 1) % cuts.size()].first;
      std::optional<int> here;
      walk(spline, a, b, [&](Point2 p, Vec2 tangent, std::uint32_t on) {
        if (near(o, p, reach, [&](std::uint32_t k) { return away_outside(o, k, a, b, p); })) return false;
        // A step to the left, well inside the free room; the stretch's own bends may stand in the way.
        const Point2 q = p + (0.25 * reach) * left(tangent);
        if (!free_step(o, on, p, q)) return false;
        here = winding_number(spline, q);
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
