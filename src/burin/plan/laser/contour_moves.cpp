// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/contour_moves.h"

#include <algorithm>
#include <cmath>

#include "burin/plan/laser/micro_joints.h"

namespace burin::laser::detail {

using geom::ArcSpline;
using geom::Segment;

namespace {

bool waste_is_outside(const CutPath& path, const LaserOptions& options) {
  bool outside = path.role == Role::outer;
  if (options.side == Side::outside) outside = true;
  if (options.side == Side::inside) outside = false;
  // A negative offset puts the beam on the other side of the line: what was waste is the part.
  return options.offset_mm < 0 ? !outside : outside;
}

void set_joints(std::vector<Stroke>& strokes, const std::vector<Span>& corner_zones, double lead_mm,
                const LaserOptions& options, ContourMoves& moves) {
  const double length = stations(strokes).back();
  // The beam takes |offset| away at either end of the gap; `width` is what stays.
  const double gap = options.micro_joints.width_mm + 2 * std::abs(options.offset_mm);
  const double margin =
      std::max({options.overcut_mm, 2 * std::abs(options.offset_mm), std::min(lead_mm, length / 16)});
  const auto zones = normalized(corner_zones, length, true);
  JointPlan plan = plan_joints(length, options.micro_joints.per_contour, gap, zones, margin);
  moves.joints_missing = plan.missing;
  if (plan.gaps.empty()) return;
  strokes = marked(strokes, plan.gaps, options.tolerance.point_mm, [](Stroke& s) { s.beam = false; });
}

void add_overcut(std::vector<Stroke>& strokes, const LaserOptions& options) {
  if (options.overcut_mm <= options.tolerance.point_mm) return;
  // Not over the first micro-joint.
  std::size_t until = 0;
  while (until < strokes.size() && strokes[until].beam) ++until;
  const std::vector<Stroke> whole(strokes.begin(), strokes.begin() + static_cast<std::ptrdiff_t>(until));
  for (Stroke s : first_of(whole, options.overcut_mm, options.tolerance.point_mm)) {
    s.kind = MoveKind::overcut;
    strokes.push_back(s);
  }
}

std::vector<Stroke> plain(const ArcSpline& spline, MoveKind kind) {
  std::vector<Stroke> strokes;
  for (const Segment& s : spline.segments) strokes.push_back({s, kind, false, true});
  return strokes;
}

void to_chords(std::vector<Stroke>& strokes, double sagitta) {
  std::vector<Stroke> lines;
  std::vector<Segment> chords;
  for (const Stroke& s : strokes) {
    chords.clear();
    append_chords(s.segment, sagitta, chords);
    for (const Segment& c : chords) lines.push_back({c, s.kind, s.slow, s.beam});
  }
  strokes = std::move(lines);
}

void closed_moves(const Job& job, const Site& site, const LaserOptions& options, const LeadRoom& room,
                  ContourMoves& moves) {
  const ArcSpline spline = started_at(job.spline, site.segment, site.fraction);
  std::vector<Stroke> strokes;
  std::vector<Span> zones;
  if (options.corners.kind == Corners::round && options.micro_joints.per_contour <= 0) {
    strokes = plain(spline, MoveKind::cut);
  } else {
    CornerResult corners = treat_corners(spline, job.waste, options.corners, room);
    strokes = std::move(corners.strokes);
    zones = std::move(corners.zones);
    moves.loops_without_room = std::move(corners.no_room);
  }
  if (options.micro_joints.per_contour > 0) set_joints(strokes, zones, job.sites.length_mm, options, moves);
  add_overcut(strokes, options);
  if (site.lead_in) moves.strokes.push_back({*site.lead_in, MoveKind::lead, false, true});
  moves.strokes.insert(moves.strokes.end(), strokes.begin(), strokes.end());
  if (options.lead.out_mm <= 0) return;
  const Segment& last = strokes.back().segment;
  const auto out = plan_lead_out(last.b, geom::end_tangent(last), job.waste, options.lead, room);
  if (out) moves.strokes.push_back({*out, MoveKind::lead, false, true});
  moves.lead_out_missing = !out && options.lead.kind != LeadKind::none;
}

}  // namespace

Job make_job(const Profile& profile, std::uint32_t path, const LaserOptions& options) {
  const CutPath& from = profile.paths[path];
  Job job;
  job.path = path;
  job.role = from.role;
  job.spline = from.spline;
  if (!from.spline.closed || from.role == Role::engrave || from.role == Role::open) return job;
  const bool outside = waste_is_outside(from, options);
  const bool waste_left = options.direction != Direction::conventional;
  job.waste = waste_left ? Waste::left : Waste::right;
  // The left of a counter-clockwise path is its inside.
  const bool want_ccw = waste_left != outside;
  if ((geom::signed_area(from.spline) > 0) != want_ccw) job.spline = geom::reversed(from.spline);
  return job;
}

ContourMoves make_moves(const Job& job, std::size_t site, const LaserOptions& options, const LeadRoom& room) {
  ContourMoves moves;
  if (job.role == Role::engrave || job.waste == Waste::none) {
    const MoveKind kind = job.role == Role::engrave ? MoveKind::engrave : MoveKind::cut;
    if (job.spline.closed) {
      const Site& s = job.sites.sites[site];
      moves.strokes = plain(started_at(job.spline, s.segment, s.fraction), kind);
    } else {
      const ArcSpline spline = site == 0 ? job.spline : geom::reversed(job.spline);
      if (job.role == Role::engrave || options.corners.kind == Corners::round) {
        moves.strokes = plain(spline, kind);
      } else {
        CornerResult corners = treat_corners(spline, Waste::none, options.corners, room);
        moves.strokes = std::move(corners.strokes);
        moves.loops_without_room = std::move(corners.no_room);
      }
    }
  } else {
    closed_moves(job, job.sites.sites[site], options, room, moves);
  }
  if (!options.arcs) to_chords(moves.strokes, room.sagitta_mm);
  return moves;
}

}  // namespace burin::laser::detail
