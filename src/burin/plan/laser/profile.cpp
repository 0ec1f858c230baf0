// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/profile.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "burin/base/text.h"
#include "burin/geom/box_tree.h"
#include "burin/geom/curve/offset.h"
#include "burin/plan/laser/crossings.h"
#include "burin/plan/laser/nesting.h"
#include "burin/plan/laser/outlines.h"

namespace burin::laser {
namespace {

using geom::ArcSpline;
using geom::Point2;
using geom::Segment;

/// What offset_region guarantees; taken off the tolerance of the fit so that the sum stays within it.
constexpr double kOffsetGuarantee = 1e-6;

std::string mm(double v) {
  return format_fixed(v, 4) + " mm";
}

class ProfileMaker {
 public:
  ProfileMaker(const std::vector<Contour>& contours, const io::Drawing& drawing, const LaserOptions& options,
               Diagnostics& diagnostics)
      : contours_(contours), drawing_(drawing), options_(options), diagnostics_(diagnostics) {}

  Result<Profile> run() {
    if (auto ok = make_outlines(); !ok) return ok.error();
    // What is left out below still says what is a hole.
    const std::vector<std::uint32_t> parents = nest();
    leave_out_crossing(parents);
    if (offset_mm() != 0) {
      if (auto ok = refit_for_offset(); !ok) return ok.error();
    }
    orient();
    if (auto ok = make_paths(); !ok) return ok.error();
    if (profile_.paths.empty()) {
      return Error{ErrorCode::geometry, "nothing left to cut (at least one closed or open contour)", {}};
    }
    figures();
    return std::move(profile_);
  }

 private:
  double offset_mm() const { return options_.side == Side::on ? 0.0 : options_.offset_mm; }
  double fit_tolerance() const {
    // Without arcs the chords of the tool path need their half of the tolerance.
    const double share = options_.arcs ? 1.0 : 0.5;
    const double whole = share * options_.tolerance.path_mm;
    return offset_mm() != 0 && whole > 10 * kOffsetGuarantee ? whole - kOffsetGuarantee : whole;
  }

  Where where(const Contour& contour) const {
    Where w;
    const std::uint32_t e = contour.entity.empty() ? 0 : contour.entity.front();
    if (e < drawing_.entities.size())
      w.entity = drawing_.entities[e].name(), w.line = drawing_.entities[e].line;
    return w;
  }
  Where where(std::uint32_t contour) const { return where(contours_[contour]); }

  Result<void> make_outlines() {
    for (std::uint32_t i = 0; i < contours_.size(); ++i) {
      const Contour& c = contours_[i];
      if (c.treatment == Treatment::ignore || c.curves.empty()) continue;
      auto spline = detail::outline_of(c, drawing_, 0.0, fit_tolerance(), options_, profile_.pieces);
      if (!spline) return spline.error();
      if (spline->segments.empty()) continue;
      if (spline->closed && spline->segments.size() < 2) {
        diagnostics_.left_out_at("degenerate_contour", "a closed contour of a single line",
                                 spline->segments[0].a.x, spline->segments[0].a.y, where(i));
        continue;
      }
      const Role role = c.treatment == Treatment::engrave ? Role::engrave
                        : c.closed                        ? Role::outer
                                                          : Role::open;
      profile_.outlines.push_back({std::move(*spline), role, 0, i});
    }
    return {};
  }

  void leave_out_crossing(const std::vector<std::uint32_t>& parents) {
    std::vector<ArcSpline> closed(profile_.outlines.size());
    for (std::size_t i = 0; i < closed.size(); ++i) {
      if (is_closed_cut(profile_.outlines[i])) closed[i] = profile_.outlines[i].spline;
    }
    const double tolerance = options_.tolerance.path_mm, point = options_.tolerance.point_mm;
    const auto found = detail::find_crossings(closed, tolerance, point);
    // Whether a wider tolerance would do is what the user of a drawing with overshooting corners wants to
    // know.
    std::set<std::pair<std::uint32_t, std::uint32_t>> deep_at_ten;
    if (std::any_of(found.begin(), found.end(), [](const auto& c) { return c.deep; })) {
      for (const detail::CrossingReport& c : detail::find_crossings(closed, 10 * tolerance, point)) {
        if (c.deep) deep_at_ten.insert({c.first, c.second});
      }
    }
    std::set<std::uint32_t> out;
    for (const detail::CrossingReport& c : found) {
      report_crossing(c, deep_at_ten.count({c.first, c.second}) == 0);
      if (!c.deep) {
        repaired_.insert(profile_.outlines[c.first].contour);
        repaired_.insert(profile_.outlines[c.second].contour);
      } else if (options_.side != Side::on) {
        out.insert(c.first);
        out.insert(c.second);
      }
    }
    std::vector<Outline> kept;
    for (std::uint32_t i = 0; i < profile_.outlines.size(); ++i) {
      if (out.count(i) != 0) continue;
      if (profile_.outlines[i].role == Role::hole && out.count(parents[i]) != 0)
        orphans_.insert(profile_.outlines[i].contour);
      kept.push_back(std::move(profile_.outlines[i]));
    }
    profile_.outlines = std::move(kept);
  }

  void report_crossing(const detail::CrossingReport& c, bool repairable) {
    const double tolerance = options_.tolerance.path_mm;
    const Where w = where(profile_.outlines[c.first].contour);
    const bool self = c.first == c.second;
    const char* code = self ? "self_crossing" : "contours_cross";
    const std::string what =
        self ? "the contour crosses itself"
             : "the contour crosses " + where(profile_.outlines[c.second].contour).to_string();
    if (!c.deep) {
      diagnostics_.info_at("crossing_repaired",
                           what + ", less deep than the tolerance of " + mm(tolerance) + "; repaired",
                           c.position.x, c.position.y, w);
    } else if (options_.side == Side::on) {
      diagnostics_.info_at(code, what + "; cut on the line as drawn", c.position.x, c.position.y, w);
    } else {
      diagnostics_.left_out_at(
          code,
          what + ", deeper than the tolerance of " + mm(tolerance) + "; " +
              (self ? "it is left out" : "both are left out") +
              (repairable ? " (a tolerance of " + mm(10 * tolerance) + " would repair it)" : ""),
          c.position.x, c.position.y, w);
    }
  }

  /// The parent of each outline.
  std::vector<std::uint32_t> nest() {
    std::vector<CutPath> as_paths;
    as_paths.reserve(profile_.outlines.size());
    for (const Outline& o : profile_.outlines) as_paths.push_back({o.spline, o.role, 0, o.contour});
    const std::vector<std::uint32_t> parents = detail::path_parents(as_paths, options_.tolerance.point_mm);
    for (std::size_t i = 0; i < parents.size(); ++i) {
      Outline& o = profile_.outlines[i];
      for (std::uint32_t p = parents[i]; p != detail::kNoParent; p = parents[p]) ++o.depth;
      if (o.role == Role::outer && o.depth % 2 == 1) o.role = Role::hole;
    }
    return parents;
  }

  bool is_closed_cut(const Outline& o) const { return o.role == Role::outer || o.role == Role::hole; }

  /// Whether the path runs outside the closed contour, by role or by the user's word.
  bool runs_outside(const Outline& o) const {
    if (options_.side == Side::outside) return true;
    if (options_.side == Side::inside) return false;
    return o.role == Role::outer;
  }

  /// Free curves are fitted again, now that the side is known on which the offset must be within the
  /// tolerance.
  Result<void> refit_for_offset() {
    std::vector<Piece> pieces;
    for (Outline& o : profile_.outlines) {
      const Contour& c = contours_[o.contour];
      if (is_closed_cut(o) && detail::has_free_curves(c)) {
        const bool drawn_ccw = signed_area(o.spline) > 0;
        // To the right of the drawn direction lies the outside of a counter-clockwise contour.
        const double right = drawn_ccw == runs_outside(o) ? offset_mm() : -offset_mm();
        auto spline = detail::outline_of(c, drawing_, right, fit_tolerance(), options_, pieces);
        if (!spline) return spline.error();
        o.spline = std::move(*spline);
        continue;
      }
      const auto shift = static_cast<std::uint32_t>(pieces.size());
      std::map<std::uint32_t, std::uint32_t> renumbered;
      for (Segment& s : o.spline.segments) {
        const auto [it, fresh] =
            renumbered.try_emplace(s.source, shift + static_cast<std::uint32_t>(renumbered.size()));
        if (fresh) pieces.push_back(profile_.pieces[s.source]);
        s.source = it->second;
      }
    }
    profile_.pieces = std::move(pieces);
    return {};
  }

  void orient() {
    for (Outline& o : profile_.outlines) {
      if (!is_closed_cut(o)) continue;
      if ((signed_area(o.spline) > 0) != (o.role == Role::outer)) o.spline = reversed(o.spline);
    }
  }

  Result<void> make_paths() {
    if (offset_mm() == 0) {
      for (const Outline& o : profile_.outlines)
        profile_.paths.push_back({o.spline, o.role, o.depth, o.contour});
      return {};
    }
    if (options_.side == Side::automatic) {
      std::vector<std::uint32_t> all;
      for (std::uint32_t i = 0; i < profile_.outlines.size(); ++i) {
        if (!is_closed_cut(profile_.outlines[i])) continue;
        if (orphans_.count(profile_.outlines[i].contour) == 0) {
          all.push_back(i);
        } else if (auto ok = offset_group({i}, false); !ok) {
          return ok.error();
        }
      }
      if (auto ok = offset_group(all, true); !ok) return ok.error();
    } else {
      for (std::uint32_t i = 0; i < profile_.outlines.size(); ++i) {
        if (!is_closed_cut(profile_.outlines[i])) continue;
        if (auto ok = offset_group({i}, false); !ok) return ok.error();
      }
    }
    for (const Outline& o : profile_.outlines) {
      if (!is_closed_cut(o)) profile_.paths.push_back({o.spline, o.role, o.depth, o.contour});
    }
    // In the order of the drawing, which is what `--order file` promises.
    std::stable_sort(profile_.paths.begin(), profile_.paths.end(),
                     [](const CutPath& a, const CutPath& b) { return a.contour < b.contour; });
    return {};
  }

  /// Offsets the outlines `group` together: as one region by nesting, or a single one to the side asked for
  /// (a hole without the contour around it: inside).
  Result<void> offset_group(const std::vector<std::uint32_t>& group, bool by_nesting) {
    if (group.empty()) return {};
    double d = offset_mm();
    std::vector<ArcSpline> region;
    for (const std::uint32_t i : group) {
      const Outline& o = profile_.outlines[i];
      region.push_back(by_nesting || o.role == Role::outer ? o.spline : reversed(o.spline));
      if (!by_nesting && !runs_outside(o)) d = -d;
    }
    const auto in_group = [&](Error error) {
      if (error.where.entity.empty() && group.size() == 1)
        error.where = where(profile_.outlines[group[0]].contour);
      return error;
    };
    std::vector<std::uint32_t> owner(group.size());
    std::iota(owner.begin(), owner.end(), 0u);
    if (std::any_of(group.begin(), group.end(),
                    [&](std::uint32_t i) { return repaired_.count(profile_.outlines[i].contour) != 0; })) {
      // Small loops are taken off first (the region of positive winding): grown with the rest, a loop that
      // turns the other way would open the offset of the corner it sits at.
      auto simple = geom::offset_region(region, 0, {options_.tolerance.point_mm});
      if (!simple) return in_group(simple.error());
      region = std::move(simple->contours);
      owner = std::move(simple->from);
    }
    auto result = geom::offset_region(region, d, {options_.tolerance.point_mm});
    if (!result) return in_group(result.error());
    std::set<std::uint32_t> seen;
    for (std::size_t k = 0; k < result->contours.size(); ++k) {
      const Outline& from = profile_.outlines[group[owner[result->from[k]]]];
      ArcSpline& spline = result->contours[k];
      report_merged(spline, group);
      for (const Segment& s : spline.segments) seen.insert(s.source);
      // The waste side follows from the result itself: a merged path can turn a part's edge into a hole.
      const bool outer = signed_area(spline) > 0;
      const Role role = by_nesting           ? (outer ? Role::outer : Role::hole)
                        : runs_outside(from) ? Role::outer
                                             : Role::hole;
      if (!by_nesting && !runs_outside(from)) spline = reversed(spline);
      profile_.paths.push_back({std::move(spline), role, from.depth, from.contour});
    }
    std::set<std::uint32_t> alive;
    const std::set<std::uint32_t> gone(result->vanished.begin(), result->vanished.end());
    for (std::uint32_t k = 0; k < region.size(); ++k) {
      if (gone.count(k) != 0) continue;
      for (const std::uint32_t g : owners_of(region[k], group, owner[k])) alive.insert(g);
    }
    std::set<std::uint32_t> vanished;
    for (std::uint32_t g = 0; g < group.size(); ++g) {
      if (alive.count(g) == 0) vanished.insert(g);
    }
    for (const std::uint32_t v : vanished) report_vanished(profile_.outlines[group[v]]);
    report_removed_loops(group, vanished, seen);
    return {};
  }

  void number_pieces() {
    if (!piece_contour_.empty()) return;
    piece_contour_.resize(profile_.pieces.size(), 0);
    for (const Outline& o : profile_.outlines) {
      for (const Segment& s : o.spline.segments) piece_contour_[s.source] = o.contour;
    }
  }

  /// Members of the group that the contour of the region was made of: several, when crossing ones were
  /// united.
  std::set<std::uint32_t> owners_of(const ArcSpline& contour, const std::vector<std::uint32_t>& group,
                                    std::uint32_t first) {
    std::set<std::uint32_t> owners{first};
    if (repaired_.empty()) return owners;
    number_pieces();
    std::set<std::uint32_t> drawn;
    for (const Segment& s : contour.segments) {
      if (s.source != geom::kCornerSource) drawn.insert(piece_contour_[s.source]);
    }
    for (std::uint32_t g = 0; g < group.size(); ++g) {
      if (drawn.count(profile_.outlines[group[g]].contour) != 0) owners.insert(g);
    }
    return owners;
  }

  void report_vanished(const Outline& o) {
    const Point2 p = o.spline.segments.front().a;
    diagnostics_.left_out_at(
        "contour_vanished",
        "the contour is too small for an offset of " + mm(offset_mm()) + " and is not cut", p.x, p.y,
        where(o.contour));
  }

  void report_merged(const ArcSpline& path, const std::vector<std::uint32_t>& group) {
    if (group.size() < 2) return;
    number_pieces();
    std::set<std::uint32_t> contours;
    Point2 p;
    for (const Segment& s : path.segments) {
      if (s.source == geom::kCornerSource) continue;
      if (contours.insert(piece_contour_[s.source]).second) p = s.a;
    }
    if (contours.size() < 2) return;
    std::string names;
    for (const std::uint32_t c : contours) {
      if (names.size() > 120) {
        names += ", ...";
        break;
      }
      names += (names.empty() ? "" : ", ") + where(c).entity;
    }
    diagnostics_.left_out_at(
        "contours_merged",
        std::to_string(contours.size()) +
            " contours are closer than twice the offset and are cut as one: what lies between is lost (" +
            names + ")",
        p.x, p.y, where(*contours.begin()));
  }

  /// Segments of the outline that no path runs beside, although one should. Of drawn lines and arcs those
  /// that left nothing in the result; of free curves also a part, unless it ends in a corner of the outline:
  /// what a round beam leaves in inner corners is no news.
  template <class Clearance>
  std::vector<std::uint32_t> lost_segments(const ArcSpline& outline, const std::set<std::uint32_t>& seen,
                                           const Clearance& clearance) const {
    const auto& segments = outline.segments;
    const std::size_t n = segments.size();
    const auto suspect = [&](std::size_t k) {
      if (profile_.pieces[segments[k].source].fitted) return true;
      // Nothing as short as the bridge of a gap is a narrow stretch by itself.
      return seen.count(segments[k].source) == 0 && length_of(segments[k]) > options_.tolerance.join_mm;
    };
    std::vector<bool> lost(n);
    bool any = false;
    for (std::size_t k = 0; k < n; ++k) {
      lost[k] = suspect(k) && clearance(point_on(segments[k], 0.5)) > options_.tolerance.path_mm;
      any = any || lost[k];
    }
    if (!any) return {};
    const auto corner_before = [&](std::size_t k) {
      return geom::count_g1_breaks({{segments[(k + n - 1) % n], segments[k]}, false},
                                   options_.tolerance.tangent_rad) > 0;
    };
    const auto forgive = [&](std::size_t k) {
      const bool forgiven = lost[k] && seen.count(segments[k].source) != 0;
      if (forgiven) lost[k] = false;
      return forgiven;
    };
    for (std::size_t k = 0; k < n; ++k) {
      if (!corner_before(k)) continue;
      for (std::size_t i = 0; i < n && (i == 0 || !corner_before((k + i) % n)) && forgive((k + i) % n);) ++i;
      for (std::size_t i = 1; i <= n && forgive((k + n - i) % n) && !corner_before((k + n - i) % n);) ++i;
    }
    std::vector<std::uint32_t> out;
    for (std::uint32_t k = 0; k < n; ++k) {
      if (lost[k]) out.push_back(k);
    }
    return out;
  }

  /// Stretches of an outline that have no path beside them although the contour is cut: notches and fillets
  /// narrower than the beam. How much is left uncut there is what the user wants to know.
  void report_removed_loops(const std::vector<std::uint32_t>& group, const std::set<std::uint32_t>& vanished,
                            const std::set<std::uint32_t>& seen) {
    std::vector<Segment> beam;
    std::vector<geom::Box2> boxes;
    for (const CutPath& path : profile_.paths) {
      for (const Segment& s : path.spline.segments) {
        beam.push_back(s);
        boxes.push_back(bounds_of(s));
      }
    }
    const geom::BoxTree2 tree(std::move(boxes));
    const auto clearance = [&](Point2 p) {
      double best = 1e300;
      for (double reach = 2 * std::abs(offset_mm()); best > reach && reach < 1e7; reach *= 4) {
        tree.query(geom::Box2{p, p}.grown(reach), [&](std::uint32_t k) {
          best = std::min(best, nearest_on(beam[k], p).distance);
          return true;
        });
      }
      return best - std::abs(offset_mm());
    };
    for (std::uint32_t g = 0; g < group.size(); ++g) {
      if (vanished.count(g) != 0) continue;
      const Outline& o = profile_.outlines[group[g]];
      int count = 0;
      double worst = 0;
      Point2 position;
      for (const std::uint32_t k : lost_segments(o.spline, seen, clearance)) {
        const Point2 p = point_on(o.spline.segments[k], 0.5);
        const double excess = clearance(p);
        ++count;
        if (excess > worst) worst = excess, position = p;
      }
      if (count == 0) continue;
      diagnostics_.left_out_at("loop_removed",
                               "the beam does not fit into " + std::to_string(count) +
                                   " narrow stretches of the contour; up to " + mm(worst) +
                                   " of material stays",
                               position.x, position.y, where(o.contour));
    }
  }

  void figures() {
    std::set<std::uint32_t> used;
    for (const CutPath& path : profile_.paths) {
      for (const Segment& s : path.spline.segments) {
        if (s.source == geom::kCornerSource) continue;
        const Piece& piece = profile_.pieces[s.source];
        profile_.max_deviation_mm = std::max(profile_.max_deviation_mm, piece.deviation_mm);
        if (piece.fitted) ++profile_.fitted_segments;
      }
    }
    if (offset_mm() != 0) profile_.max_deviation_mm += kOffsetGuarantee;
    // Arcs keep their centres when offset, so a smooth joint of the outline is a smooth joint of the path.
    for (const Outline& o : profile_.outlines) {
      const auto& segments = o.spline.segments;
      for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
        if (segments[i].source != segments[i + 1].source) continue;
        const ArcSpline pair{{segments[i], segments[i + 1]}, false};
        profile_.g1_breaks += count_g1_breaks(pair, options_.tolerance.tangent_rad);
      }
    }
  }

  const std::vector<Contour>& contours_;
  const io::Drawing& drawing_;
  const LaserOptions& options_;
  Diagnostics& diagnostics_;
  Profile profile_;
  std::vector<std::uint32_t> piece_contour_;
  std::set<std::uint32_t> repaired_;  ///< contours with shallow crossings
  std::set<std::uint32_t> orphans_;   ///< contours: holes in what was left out
};

}  // namespace

Result<Profile> make_profile(const std::vector<Contour>& contours, const io::Drawing& drawing,
                             const LaserOptions& options, Diagnostics& diagnostics) {
  return ProfileMaker(contours, drawing, options, diagnostics).run();
}

}  // namespace burin::laser
