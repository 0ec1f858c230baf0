// SPDX-License-Identifier: Apache-2.0
// The steps of joining, in order: collect, take out repeats, make runs, join ends, resolve branches, write
// contours.
#include "burin/plan/laser/contours.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "burin/base/text.h"
#include "burin/plan/laser/join_parts.h"

namespace burin::laser {
namespace detail {

// Curves may differ by a tenth of what ends may differ by, but never by more than 1 um: a beam is a hundred
// times wider, and the decimals that CAD systems write stay below it.
constexpr double kSameShare = 0.1;
constexpr double kSameMost = 1e-3;

JoinScale join_scale(const Tolerance& tolerance) {
  JoinScale scale;
  scale.point = tolerance.point_mm;
  scale.join = std::max(tolerance.join_mm, tolerance.point_mm);
  scale.same = std::max(tolerance.point_mm, std::min(kSameShare * tolerance.join_mm, kSameMost));
  return scale;
}

namespace {

using geom::Point2;

std::string place(Point2 p) {
  return "(" + format_fixed(p.x, 4) + ", " + format_fixed(p.y, 4) + ")";
}

Where where(const io::Entity& entity) {
  return {"", entity.line, 0, entity.name()};
}

bool is_point(const geom::Curve2& curve, Point2 a, Point2 b, double tolerance) {
  if (geom::distance(a, b) > tolerance) return false;
  const geom::Box2 box = geom::bounds(curve);
  return std::hypot(box.width(), box.height()) <= tolerance;
}

// A dead end of this many join lengths that is drawn there and back is a slip of the drawing, not a slit to
// be cut.
constexpr double kSpike = 4.0;

/// A part in the direction of the contour.
struct Item {
  std::uint32_t piece = 0;
  double t0 = 0, t1 = 1;
  bool reversed = false;
  Point2 from, to;
};

class Joiner {
 public:
  Joiner(const io::Drawing& drawing, const JoinScale& scale, Diagnostics& diagnostics)
      : drawing_(drawing), scale_(scale), diagnostics_(diagnostics) {}

  /// Contours of all entities with this treatment, with the order of their first curve.
  void join(const std::vector<Treatment>& treatments, Treatment treatment) {
    treatment_ = treatment;
    pieces_ = {};
    collect(treatments);
    Repeats repeats;
    parts_ = split_repeats(pieces_, scale_, repeats);
    make_runs();
    const Nodes nodes = cluster_ends(pieces_, parts_, runs_, scale_);
    const Resolved resolved = resolve(pieces_, parts_, runs_, nodes);
    report_repeats(drawing_, pieces_, parts_, runs_, resolved, repeats, diagnostics_);
    for (const Branch& branch : resolved.branches) report_branch(branch);
    for (const Chain& chain : resolved.chains) {
      if (!is_spike(chain)) write_chain(chain);
    }
  }

  std::vector<Contour> take() {
    std::vector<std::size_t> order(found_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
      const Found &p = found_[i], &q = found_[j];
      if (p.order != q.order) return p.order < q.order;
      return p.t0 != q.t0 ? p.t0 < q.t0 : i < j;
    });
    std::vector<Contour> contours;
    contours.reserve(order.size());
    for (const std::size_t i : order) {
      for (Warning& warning : found_[i].warnings) diagnostics_.add(std::move(warning));
      contours.push_back(std::move(found_[i].contour));
    }
    return contours;
  }

 private:
  struct Found {
    Contour contour;
    std::uint32_t order = 0;  ///< of the first curve in the file
    double t0 = 0;            ///< where on it the contour starts
    std::vector<Warning> warnings;
  };

  void collect(const std::vector<Treatment>& treatments) {
    std::uint32_t order = 0;
    for (std::uint32_t e = 0; e < drawing_.entities.size(); ++e) {
      int points = 0;
      Point2 first_point;
      for (const io::Path& path : drawing_.entities[e].paths) {
        if (treatments[e] != treatment_) {
          order += static_cast<std::uint32_t>(path.curves.size());
          continue;
        }
        PathRange range;
        range.first = static_cast<std::uint32_t>(pieces_.list.size());
        range.closed = path.closed;
        for (const geom::Curve2& curve : path.curves) {
          const Piece piece{&curve, e, order++, geom::start_point(curve), geom::end_point(curve)};
          if (is_point(curve, piece.a, piece.b, scale_.point)) {
            if (points++ == 0) first_point = piece.a;
          } else {
            pieces_.list.push_back(piece);
          }
        }
        range.end = static_cast<std::uint32_t>(pieces_.list.size());
        if (range.end > range.first) pieces_.paths.push_back(range);
      }
      if (points > 0) {
        diagnostics_.info_at("zero_length",
                             points == 1 ? "a curve without length is dropped"
                                         : std::to_string(points) + " curves without length are dropped",
                             first_point.x, first_point.y, where(drawing_.entities[e]));
      }
    }
  }

  /// Whether part q follows part p in the drawn path.
  bool follows(const Part& p, const Part& q) const {
    if (p.piece == q.piece) return p.t1 == q.t0;
    return p.piece + 1 == q.piece && meet(p, q);
  }
  bool meet(const Part& p, const Part& q) const {
    return p.t1 == 1 && q.t0 == 0 && geom::distance(p.b, q.a) <= scale_.join;
  }

  void make_runs() {
    runs_ = {};
    std::vector<std::uint32_t> order(parts_.list.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      const Part &p = parts_.list[i], &q = parts_.list[j];
      return p.piece != q.piece ? p.piece < q.piece : p.t0 < q.t0;
    });
    run_of_.assign(parts_.list.size(), kNone);
    std::size_t k = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> follow;
    for (const PathRange& path : pieces_.paths) {
      const std::size_t begin = k;
      while (k < order.size() && parts_.list[order[k]].piece < path.end) ++k;
      path_runs(path,
                {order.begin() + static_cast<std::ptrdiff_t>(begin),
                 order.begin() + static_cast<std::ptrdiff_t>(k)},
                follow);
    }
    runs_.base_count = runs_.list.size();
    for (auto i = static_cast<std::uint32_t>(parts_.base_count); i < parts_.list.size(); ++i)
      add_spare_run(i);
    runs_.neighbour.assign(2 * runs_.list.size(), kNone);
    for (const auto& [p, q] : follow) {
      if (run_of_[p] == kNone || run_of_[q] == kNone) continue;
      runs_.neighbour[2 * run_of_[p] + 1] = 2 * run_of_[q];
      runs_.neighbour[2 * run_of_[q]] = 2 * run_of_[p] + 1;
    }
  }

  void path_runs(const PathRange& path, const std::vector<std::uint32_t>& order,
                 std::vector<std::pair<std::uint32_t, std::uint32_t>>& follow) {
    const std::size_t n = order.size();
    if (n == 0) return;
    const auto glued = [&](std::size_t i, std::size_t j) {
      return !parts_.list[order[i]].cut && !parts_.list[order[j]].cut;
    };
    std::vector<bool> breaks(n, false);  // before part i
    bool any = false;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t before = i == 0 ? n - 1 : i - 1;
      const Part &p = parts_.list[order[before]], &q = parts_.list[order[i]];
      bool connected = false;
      if (i > 0) {
        connected = follows(p, q);
      } else if (path.closed) {
        connected = p.piece == path.end - 1 && q.piece == path.first && meet(p, q);
      }
      breaks[i] = !connected || !glued(before, i);
      any = any || breaks[i];
      if (connected && breaks[i]) follow.emplace_back(order[before], order[i]);
    }
    if (!any) {
      write_path(order);
      return;
    }
    const auto first =
        static_cast<std::size_t>(std::find(breaks.begin(), breaks.end(), true) - breaks.begin());
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t at = (first + i) % n;
      const std::uint32_t part = order[at];
      if (parts_.list[part].spare) continue;
      if (breaks[at] || runs_.list.empty()) {
        runs_.list.push_back({static_cast<std::uint32_t>(runs_.parts.size()), 0, kNone, false, false});
      }
      ++runs_.list.back().count;
      runs_.parts.push_back(part);
      run_of_[part] = static_cast<std::uint32_t>(runs_.list.size() - 1);
    }
  }

  void add_spare_run(std::uint32_t i) {
    const Part& part = parts_.list[i];
    const std::uint32_t base = run_of_[part.twin];
    Run run{static_cast<std::uint32_t>(runs_.parts.size()), 1, base, false, true};
    const Part& twin = parts_.list[part.twin];
    // Closed twins have their ends at one place: there the direction does not matter.
    run.twin_reversed = geom::distance(part.a, twin.a) > geom::distance(part.a, twin.b);
    run_of_[i] = static_cast<std::uint32_t>(runs_.list.size());
    runs_.list[base].twin = run_of_[i];
    runs_.parts.push_back(i);
    runs_.list.push_back(run);
  }

  Item item(std::uint32_t index, bool reversed) const {
    const Part& part = parts_.list[index];
    return {part.piece, part.t0, part.t1, reversed, reversed ? part.b : part.a, reversed ? part.a : part.b};
  }

  void write_path(const std::vector<std::uint32_t>& parts) {
    std::vector<Item> items;
    for (const std::uint32_t part : parts) items.push_back(item(part, false));
    write(std::move(items), true);
  }

  bool is_spike(const Chain& chain) {
    if (chain.closed) return false;
    double length = 0;
    for (const Step& step : chain.steps) {
      if (runs_.list[step.run].twin == kNone) return false;
      const Part& part = parts_.list[runs_.parts[runs_.list[step.run].first]];
      length += geom::distance(part.a, part.b);
    }
    if (length > kSpike * scale_.join) return false;
    const Part& part = parts_.list[runs_.parts[runs_.list[chain.steps[0].run].first]];
    diagnostics_.info_at("zero_length",
                         "a spike of " + format_fixed(length, 4) + " mm, drawn there and back, is dropped",
                         part.a.x, part.a.y, where(drawing_.entities[pieces_.list[part.piece].entity]));
    return true;
  }

  void write_chain(const Chain& chain) {
    std::vector<Item> items;
    for (const Step& step : chain.steps) {
      const Run& run = runs_.list[step.run];
      for (std::uint32_t k = 0; k < run.count; ++k) {
        const std::uint32_t at = step.reversed ? run.count - 1 - k : k;
        items.push_back(item(runs_.parts[run.first + at], step.reversed));
      }
    }
    write(std::move(items), chain.closed);
  }

  /// In the direction of the first drawn curve; a closed contour starts with it.
  static void orient(std::vector<Item>& items, bool closed) {
    const auto earlier = [](const Item& p, const Item& q) {
      return p.piece != q.piece ? p.piece < q.piece : p.t0 < q.t0;
    };
    if (std::min_element(items.begin(), items.end(), earlier)->reversed) {
      std::reverse(items.begin(), items.end());
      for (Item& i : items) {
        i.reversed = !i.reversed;
        std::swap(i.from, i.to);
      }
    }
    if (closed)
      std::rotate(items.begin(), std::min_element(items.begin(), items.end(), earlier), items.end());
  }

  /// Parts of one curve that follow each other are one again.
  static void merge_parts(std::vector<Item>& items) {
    std::vector<Item> merged;
    for (const Item& next : items) {
      if (!merged.empty() && merged.back().piece == next.piece && merged.back().reversed == next.reversed &&
          (next.reversed ? merged.back().t0 == next.t1 : merged.back().t1 == next.t0)) {
        (next.reversed ? merged.back().t0 : merged.back().t1) = next.reversed ? next.t0 : next.t1;
        merged.back().to = next.to;
      } else {
        merged.push_back(next);
      }
    }
    items = std::move(merged);
  }

  geom::Curve2 curve_of(const Item& i) const {
    const geom::Curve2& drawn = *pieces_.list[i.piece].curve;
    const geom::Curve2 used = i.t0 == 0 && i.t1 == 1 ? drawn : geom::part(drawn, i.t0, i.t1);
    return i.reversed ? geom::reversed(used) : used;
  }
  const io::Entity& entity_of(const Item& i) const { return drawing_.entities[pieces_.list[i.piece].entity]; }

  void write(std::vector<Item> items, bool closed) {
    orient(items, closed);
    merge_parts(items);
    Found found;
    found.order = pieces_.list[items.front().piece].order;
    found.t0 = items.front().t0;
    Contour& contour = found.contour;
    geom::Box2 box;
    for (const Item& i : items) {
      contour.curves.push_back(curve_of(i));
      contour.entity.push_back(pieces_.list[i.piece].entity);
      box.add(geom::bounds(contour.curves.back()));
    }
    if (std::hypot(box.width(), box.height()) <= scale_.join) {
      diagnostics_.info_at("zero_length", "an outline no larger than the join tolerance is dropped",
                           items.front().from.x, items.front().from.y, where(entity_of(items.front())));
      return;
    }
    const double gap = geom::distance(items.front().from, items.back().to);
    contour.closed = closed || gap <= scale_.join;
    contour.treatment = treatment_;
    write_joints(items, found);
    if (!contour.closed && treatment_ == Treatment::cut) report_open(items, gap, found);
    found_.push_back(std::move(found));
  }

  void write_joints(const std::vector<Item>& items, Found& found) {
    Contour& contour = found.contour;
    double widest = 0;
    std::size_t widest_at = 0;
    int gaps = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (i == 0 && !contour.closed) {
        contour.joints.push_back(items[0].from);
        continue;
      }
      const Point2 before = items[i == 0 ? items.size() - 1 : i - 1].to, after = items[i].from;
      const double gap = geom::distance(before, after);
      const bool agree = gap <= scale_.point;
      contour.joints.push_back(agree ? (i == 0 ? after : before) : geom::lerp(before, after, 0.5));
      if (agree) continue;
      ++gaps;
      if (gap > widest) {
        widest = gap;
        widest_at = i;
      }
    }
    if (!contour.closed) contour.joints.push_back(items.back().to);
    if (gaps == 0) return;
    const Item &next = items[widest_at], &last = items[widest_at == 0 ? items.size() - 1 : widest_at - 1];
    const Point2 at = contour.joints[widest_at];
    found.warnings.push_back({Severity::info, "ends_joined",
                              std::to_string(gaps) + (gaps == 1 ? " gap" : " gaps") +
                                  " of this outline closed, the widest " +
                                  format_shortest(std::round(widest * 1e9) / 1e9) + " mm from " +
                                  entity_of(last).name() + " to " + entity_of(next).name(),
                              where(entity_of(next)), std::array{at.x, at.y, 0.0}});
  }

  void report_open(const std::vector<Item>& items, double gap, Found& found) const {
    const Point2 a = items.front().from, b = items.back().to;
    const io::Entity &first = entity_of(items.front()), &last = entity_of(items.back());
    const std::string end = &first == &last ? "" : " (" + last.name() + " is the last)";
    found.warnings.push_back({Severity::left_out, "open_chain",
                              "open outline of " + std::to_string(items.size()) +
                                  (items.size() == 1 ? " curve" : " curves") + " from " + place(a) + " to " +
                                  place(b) + ", ends " + format_fixed(gap, 4) + " mm apart" + end +
                                  ": cut on the line, no offset",
                              where(first), std::array{a.x, a.y, 0.0}});
  }

  void report_branch(const Branch& branch) {
    const Run& run = runs_.list[branch.end / 2];
    const Part& part = parts_.list[runs_.parts[branch.end % 2 == 0 ? run.first : run.first + run.count - 1]];
    const Point2 at = end_point(parts_, runs_, branch.end);
    diagnostics_.info_at(
        "branch_point",
        std::to_string(branch.degree) + " ends meet here: joined along the smoothest way that closes", at.x,
        at.y, where(drawing_.entities[pieces_.list[part.piece].entity]));
  }

  const io::Drawing& drawing_;
  JoinScale scale_;
  Diagnostics& diagnostics_;
  Treatment treatment_ = Treatment::cut;
  Pieces pieces_;
  Parts parts_;
  Runs runs_;
  std::vector<std::uint32_t> run_of_;  ///< by part
  std::vector<Found> found_;
};

}  // namespace
}  // namespace detail

Result<std::vector<Contour>> join_contours(const io::Drawing& drawing, const LaserOptions& options,
                                           Diagnostics& diagnostics) {
  const Tolerance& tolerance = options.tolerance;
  if (!(tolerance.join_mm >= 0) || !std::isfinite(tolerance.join_mm) || !(tolerance.point_mm > 0)) {
    return Error{ErrorCode::usage, "the join tolerance is no length (a number of mm >= 0 is)", {}};
  }
  auto treatments = detail::treatments(drawing, options.layers);
  if (!treatments) return treatments.error();
  detail::Joiner joiner(drawing, detail::join_scale(tolerance), diagnostics);
  joiner.join(*treatments, Treatment::cut);
  joiner.join(*treatments, Treatment::engrave);
  return joiner.take();
}

}  // namespace burin::laser
