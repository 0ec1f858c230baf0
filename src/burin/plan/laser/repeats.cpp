// SPDX-License-Identifier: Apache-2.0
// What is drawn more than once: lines on lines, arcs on circles, free curves on each other.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <variant>

#include "burin/geom/box_tree.h"
#include "burin/plan/laser/join_parts.h"
#include "burin/plan/laser/near_grid.h"

namespace burin::laser::detail {
namespace {

using geom::Point2;
using geom::Vec2;

// Of the curves that lie on one, so many are looked at; more on one place is hostile, and is reported.
constexpr int kMostPartners = 64;
// Boxes looked at for one line before the search is given up (and reported).
constexpr int kMostBoxes = 4096;

struct LineView {
  std::uint32_t piece;
  Point2 a, b;
  double length;
};

std::optional<LineView> line_view(const Piece& piece, std::uint32_t index) {
  bool straight = std::holds_alternative<geom::Line2>(*piece.curve);
  if (const auto* spline = std::get_if<geom::Nurbs2>(piece.curve)) {
    straight = spline->degree == 1 && spline->points.size() == 2 &&
               spline->weights[0] == spline->weights[1] && spline->knots[1] < spline->knots[2];
  }
  const double length = geom::distance(piece.a, piece.b);
  if (!straight || length == 0) return std::nullopt;
  return LineView{index, piece.a, piece.b, length};
}

struct ArcView {
  std::uint32_t piece;
  Point2 center;
  double radius, start, sweep;
};

/// Arcs, and elliptic arcs that are round within `same`.
std::optional<ArcView> arc_view(const geom::Curve2& curve, std::uint32_t index, double same) {
  if (const auto* arc = std::get_if<geom::Arc2>(&curve)) {
    return ArcView{index, arc->center, arc->radius, arc->start, arc->sweep};
  }
  if (const auto* e = std::get_if<geom::EllipseArc2>(&curve)) {
    const double r = geom::norm(e->major);
    if (r == 0 || std::abs(r - geom::norm(e->minor)) > same ||
        std::abs(geom::dot(e->major, e->minor)) > same * r) {
      return std::nullopt;
    }
    const double turn = geom::cross(e->major, e->minor) > 0 ? 1.0 : -1.0;
    return ArcView{index, e->center, r, std::atan2(e->major.y, e->major.x) + turn * e->start,
                   turn * e->sweep};
  }
  return std::nullopt;
}

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Lines by direction: in a bucket's own frame its lines are nearly horizontal, so that their boxes are thin.
class LineBuckets {
 public:
  LineBuckets(const std::vector<LineView>& lines, const JoinScale& scale) : lines_(lines), scale_(scale) {
    std::array<std::vector<geom::Box2>, kBuckets> boxes;
    for (std::uint32_t i = 0; i < lines.size(); ++i) {
      const int bucket = bucket_of(lines[i]);
      members_[bucket].push_back(i);
      boxes[bucket].push_back(box_in(bucket, lines[i]));
    }
    trees_.reserve(kBuckets);
    for (auto& list : boxes) trees_.emplace_back(std::move(list));
  }

  /// Calls found(j) for the longer lines (of equal ones, the earlier) that line i lies on partly. False: gave
  /// up.
  template <class Found>
  bool longer_partners(std::uint32_t i, Found found) const {
    const LineView& line = lines_[i];
    // Both ends within `same` of the longer line: the directions differ by at most asin(2 same / length).
    const double spread = 2 * scale_.same / line.length;
    const int reach = spread < 1 ? static_cast<int>(std::ceil(std::asin(spread) / kWidth)) : kBuckets / 2;
    const int own = bucket_of(line);
    int partners = 0, boxes = 0;
    for (int k = -reach; k <= reach; ++k) {
      if (2 * reach >= kBuckets && k == reach) break;  // all the way round: each bucket once
      const int bucket = ((own + k) % kBuckets + kBuckets) % kBuckets;
      if (members_[bucket].empty()) continue;
      trees_[bucket].query(box_in(bucket, line).grown(scale_.same), [&](std::uint32_t member) {
        const std::uint32_t j = members_[bucket][member];
        if (i != j && lies_on(line, lines_[j], i, j)) {
          ++partners;
          found(j);
        }
        return ++boxes < kMostBoxes && partners < kMostPartners;
      });
    }
    return boxes < kMostBoxes && partners < kMostPartners;
  }

 private:
  static constexpr int kBuckets = 256;
  static constexpr double kWidth = geom::kPi / kBuckets;

  static int bucket_of(const LineView& line) {
    double angle = std::atan2(line.b.y - line.a.y, line.b.x - line.a.x);
    if (angle < 0) angle += geom::kPi;
    return static_cast<int>(std::floor(angle / kWidth + 0.5)) % kBuckets;
  }
  static geom::Box2 box_in(int bucket, const LineView& line) {
    const double c = std::cos(bucket * kWidth), s = std::sin(bucket * kWidth);
    geom::Box2 box;
    for (const Point2 p : {line.a, line.b}) box.add(Point2{c * p.x + s * p.y, c * p.y - s * p.x});
    return box;
  }
  bool lies_on(const LineView& shorter, const LineView& longer, std::uint32_t i, std::uint32_t j) const {
    if (longer.length < shorter.length || (longer.length == shorter.length && j > i)) return false;
    const Vec2 u = (longer.b - longer.a) / longer.length;
    const Vec2 pa = shorter.a - longer.a, pb = shorter.b - longer.a;
    if (std::abs(geom::cross(u, pa)) > scale_.same || std::abs(geom::cross(u, pb)) > scale_.same)
      return false;
    const double sa = geom::dot(u, pa), sb = geom::dot(u, pb);
    const double shared = std::min(longer.length, std::max(sa, sb)) - std::max(0.0, std::min(sa, sb));
    return shared > std::min(scale_.join, 0.5 * shorter.length);
  }

  const std::vector<LineView>& lines_;
  JoinScale scale_;
  std::array<std::vector<std::uint32_t>, kBuckets> members_;
  std::vector<geom::BoxTree2> trees_;
};

class Splitter {
 public:
  Splitter(const Pieces& pieces, const JoinScale& scale, Repeats& repeats)
      : pieces_(pieces), scale_(scale), repeats_(repeats), touched_(pieces.list.size(), false) {}

  Parts run() {
    lines();
    arcs();
    free_curves();
    std::stable_sort(repeats_.list.begin(), repeats_.list.end(),
                     [](const Repeat& p, const Repeat& q) { return p.piece < q.piece; });
    return parts();
  }

 private:
  void take(Cover found) {
    for (const std::uint32_t piece : found.touched) touched_[piece] = true;
    cover_.insert(cover_.end(), found.parts.begin(), found.parts.end());
    repeats_.list.insert(repeats_.list.end(), found.repeats.begin(), found.repeats.end());
  }

  void lines() {
    std::vector<LineView> lines;
    for (std::uint32_t i = 0; i < pieces_.list.size(); ++i) {
      if (const auto view = line_view(pieces_.list[i], i)) lines.push_back(*view);
    }
    const LineBuckets buckets(lines, scale_);
    DisjointSets sets(lines.size());
    std::vector<bool> shared(lines.size(), false);
    for (std::uint32_t i = 0; i < lines.size(); ++i) {
      const bool all = buckets.longer_partners(i, [&](std::uint32_t j) {
        sets.join(i, j);
        shared[i] = shared[j] = true;
      });
      if (!all) repeats_.incomplete = true;
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> groups;  // set, line
    for (std::uint32_t i = 0; i < lines.size(); ++i) {
      if (shared[i]) groups.emplace_back(sets.find(i), i);
    }
    std::sort(groups.begin(), groups.end());
    for (std::size_t i = 0; i < groups.size();) {
      std::vector<LineView> group;
      const std::uint32_t set = groups[i].first;
      for (; i < groups.size() && groups[i].first == set; ++i) group.push_back(lines[groups[i].second]);
      line_group(group);
    }
  }

  /// All on the longest of them; a line that strays from it (a chain of overlaps may bend) is left alone.
  void line_group(const std::vector<LineView>& group) {
    const LineView& longest = *std::max_element(
        group.begin(), group.end(), [](const LineView& p, const LineView& q) { return p.length < q.length; });
    const Vec2 u = (longest.b - longest.a) / longest.length;
    std::vector<Interval> intervals;
    for (const LineView& line : group) {
      const Vec2 pa = line.a - longest.a, pb = line.b - longest.a;
      if (std::max(std::abs(geom::cross(u, pa)), std::abs(geom::cross(u, pb))) > 2 * scale_.same) continue;
      const double sa = geom::dot(u, pa), sb = geom::dot(u, pb);
      if (sa <= sb) {
        intervals.push_back({line.piece, sa, sb, 0, 1});
      } else {
        intervals.push_back({line.piece, sb, sa, 1, 0});
      }
    }
    take(cover(intervals, 0, scale_));
  }

  void arcs() {
    std::vector<ArcView> arcs;
    for (std::uint32_t i = 0; i < pieces_.list.size(); ++i) {
      if (const auto view = arc_view(*pieces_.list[i].curve, i, scale_.same)) arcs.push_back(*view);
    }
    // Circles as points: centre and radius in one, so that concentric ones lie apart. Equal ones within
    // `same` lie within 1 + sqrt(2) of that.
    const auto place = [](const ArcView& v) { return Point2{v.center.x + v.radius, v.center.y + v.radius}; };
    const double near = 2.5 * scale_.same;
    NearGrid grid(2 * near, arcs.size());
    std::vector<std::vector<ArcView>> carriers;
    for (const ArcView& arc : arcs) {
      std::uint32_t carrier = kNone;
      grid.near(place(arc), near, [&](std::uint32_t id, double) {
        const ArcView& first = carriers[id].front();
        const bool same = geom::distance(first.center, arc.center) <= scale_.same &&
                          std::abs(first.radius - arc.radius) <= scale_.same;
        if (same) carrier = std::min(carrier, id);
        return true;
      });
      if (carrier == kNone) {
        carrier = static_cast<std::uint32_t>(carriers.size());
        carriers.emplace_back();
        grid.insert(place(arc), carrier);
      }
      carriers[carrier].push_back(arc);
    }
    for (const std::vector<ArcView>& group : carriers) {
      if (group.size() > 1) arc_group(group);
    }
  }

  void arc_group(const std::vector<ArcView>& group) {
    const double radius = group.front().radius;
    const double slack = scale_.same / radius;
    const double full = 2 * geom::kPi;
    const auto low = [](const ArcView& v) { return v.sweep > 0 ? v.start : v.start + v.sweep; };
    // The seam of the circle: where a full circle starts, else the first arc, so that it cuts little.
    const auto circle = std::find_if(group.begin(), group.end(),
                                     [&](const ArcView& v) { return std::abs(v.sweep) >= full - slack; });
    const double seam = low(circle == group.end() ? group.front() : *circle);
    std::vector<Interval> intervals;
    for (const ArcView& arc : group) {
      if (circle != group.end() && &arc != &*circle && std::abs(arc.sweep) >= full - slack) {
        // A second full circle, wherever it starts. The cover would see two halves.
        repeats_.list.push_back({arc.piece, circle->piece, true, 0.5, full * radius});
        touched_[arc.piece] = true;
        continue;
      }
      const double extent = std::min(full, std::abs(arc.sweep));
      double from = std::fmod(low(arc) - seam, full);
      if (from < 0) from += full;
      if (from > full - slack) from = 0;
      const auto add = [&](double x0, double x1) {  // angles from the seam
        const double t0 = (x0 - from) / extent, t1 = (x1 - from) / extent;
        return Interval{arc.piece, x0 * radius, x1 * radius, arc.sweep > 0 ? t0 : 1 - t0,
                        arc.sweep > 0 ? t1 : 1 - t1};
      };
      if (from + extent <= full + slack) {
        intervals.push_back(add(from, from + extent));
      } else {
        intervals.push_back(add(from, full));
        Interval rest = add(full, from + extent);
        rest.lo = 0;
        rest.hi -= full * radius;
        intervals.push_back(rest);
      }
    }
    take(cover(intervals, full * radius, scale_));
  }

  /// A place that equal curves share, drawn from either end: the middle of the ends; of a whole ellipse the
  /// centre.
  Point2 mark(const Piece& piece) const {
    const auto* e = std::get_if<geom::EllipseArc2>(piece.curve);
    if (e && geom::distance(piece.a, piece.b) <= scale_.same) return e->center;
    return geom::lerp(piece.a, piece.b, 0.5);
  }

  bool equal(const Piece& p, const Piece& q) const {
    const auto near = [&](Point2 x, Point2 y) { return geom::distance(x, y) <= scale_.same; };
    const bool ends = (near(p.a, q.a) && near(p.b, q.b)) || (near(p.a, q.b) && near(p.b, q.a));
    const bool ellipses = std::holds_alternative<geom::EllipseArc2>(*p.curve) && near(p.a, p.b) &&
                          std::holds_alternative<geom::EllipseArc2>(*q.curve) && near(q.a, q.b);
    return (ends || ellipses) && same_curve(*p.curve, *q.curve, scale_.same);
  }

  void free_curves() {
    const auto plain = [&](std::uint32_t i) { return pieces_.list[i].curve->index() < 2; };  // line or arc
    bool any = false;
    for (std::uint32_t i = 0; i < pieces_.list.size() && !any; ++i) any = !plain(i);
    if (!any) return;
    NearGrid grid(2 * scale_.same, pieces_.list.size());
    std::vector<std::uint32_t> spare_of(pieces_.list.size(), kNone);
    for (std::uint32_t i = 0; i < pieces_.list.size(); ++i) {
      if (touched_[i]) continue;
      std::uint32_t first = kNone;
      int looked_at = 0;
      grid.near(mark(pieces_.list[i]), scale_.same, [&](std::uint32_t j, double) {
        if (plain(i) && plain(j) && pieces_.list[i].curve->index() == pieces_.list[j].curve->index())
          return true;
        if (equal(pieces_.list[i], pieces_.list[j])) first = std::min(first, j);
        return ++looked_at < kMostPartners;
      });
      if (looked_at >= kMostPartners) repeats_.incomplete = true;
      if (first == kNone) {
        grid.insert(mark(pieces_.list[i]), i);
        continue;
      }
      repeats_.list.push_back({i, first, true, 0.5, 0});
      dropped_.push_back(i);
      if (spare_of[first] == kNone) spare_of[first] = i;
    }
    for (std::uint32_t i = 0; i < pieces_.list.size(); ++i) {
      if (spare_of[i] == kNone) continue;
      touched_[i] = true;
      cover_.push_back({i, 0, 1, spare_of[i], 0, 1});
    }
    for (const std::uint32_t i : dropped_) touched_[i] = true;
  }

  Part part(std::uint32_t piece, double t0, double t1, bool cut) const {
    const Piece& p = pieces_.list[piece];
    return {piece,
            t0,
            t1,
            t0 == 0 ? p.a : geom::point_at(*p.curve, t0),
            t1 == 1 ? p.b : geom::point_at(*p.curve, t1),
            kNone,
            false,
            cut};
  }

  Parts parts() {
    std::stable_sort(cover_.begin(), cover_.end(), [](const CoverPart& p, const CoverPart& q) {
      return p.piece != q.piece ? p.piece < q.piece : p.t0 < q.t0;
    });
    Parts result;
    std::vector<std::uint32_t> part_of(cover_.size());
    std::size_t k = 0;
    for (std::uint32_t i = 0; i < pieces_.list.size(); ++i) {
      if (!touched_[i]) result.list.push_back(part(i, 0, 1, false));
      for (; k < cover_.size() && cover_[k].piece == i; ++k) {
        part_of[k] = static_cast<std::uint32_t>(result.list.size());
        result.list.push_back(part(i, cover_[k].t0, cover_[k].t1, true));
      }
    }
    result.base_count = result.list.size();
    for (k = 0; k < cover_.size(); ++k) {
      if (cover_[k].spare_piece == kNone) continue;
      Part spare = part(cover_[k].spare_piece, cover_[k].spare_t0, cover_[k].spare_t1, true);
      spare.spare = true;
      spare.twin = part_of[k];
      result.list[part_of[k]].twin = static_cast<std::uint32_t>(result.list.size());
      result.list.push_back(spare);
    }
    return result;
  }

  const Pieces& pieces_;
  JoinScale scale_;
  Repeats& repeats_;
  std::vector<bool> touched_;  ///< by piece: `cover_` says what is left of it
  std::vector<CoverPart> cover_;
  std::vector<std::uint32_t> dropped_;
};

}  // namespace

Parts split_repeats(const Pieces& pieces, const JoinScale& scale, Repeats& repeats) {
  return Splitter(pieces, scale, repeats).run();
}

}  // namespace burin::laser::detail
