// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/toolpath.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "burin/base/text.h"
#include "burin/plan/laser/contour_moves.h"
#include "burin/plan/laser/nesting.h"
#include "burin/plan/laser/order.h"

namespace burin::laser {

using detail::Job;
using detail::Stroke;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

namespace {

/// Beyond this the program is a typing error in `copies`, and memory is at stake.
constexpr double kMostRecords = 2e7;
/// Coordinates beyond this (10 km) are damage, not a drawing.
constexpr double kLargestCoordinate = 1e7;

// --- checks
// ---------------------------------------------------------------------------------------------------

Error usage(std::string message) {
  return {ErrorCode::usage, std::move(message), {}};
}

Result<void> check_number(double value, const char* name, double low, bool open) {
  if (std::isfinite(value) && (open ? value > low : value >= low)) return {};
  return usage(std::string(name) + " is " + format_shortest(value) + " (" +
               (open ? "more than " : "at least ") + format_shortest(low) + ")");
}

Result<void> check_options(const LaserOptions& o) {
  if (!std::isfinite(o.offset_mm)) return usage("the offset is not a number (a finite number of mm)");
  struct Rule {
    double value;
    const char* name;
    double low;
    bool open;
  };
  const Rule rules[] = {
      {o.feed_mm_min, "the feed in mm/min", 0, true},
      {o.power_w, "the power in W", 0, false},
      {o.engrave_power_factor, "the power factor of engraving", 0, false},
      {o.tolerance.path_mm, "the tolerance in mm", 0, true},
      {o.tolerance.point_mm, "the point tolerance in mm", 0, true},
      {o.lead.length_mm, "the lead length in mm", 0, false},
      {o.lead.out_mm, "the lead-out length in mm", 0, false},
      {o.corners.angle_deg, "the corner angle in degrees", 0, false},
      {o.corners.loop_mm, "the loop size in mm", 0, o.corners.kind == Corners::loop},
      {o.corners.slow_mm, "the length of slow corners in mm", 0, false},
      {o.corners.slow_factor, "the factor of slow corners", 0, true},
      {o.micro_joints.width_mm, "the width of micro-joints in mm", 0, o.micro_joints.per_contour > 0},
      {static_cast<double>(o.micro_joints.per_contour), "the number of micro-joints", 0, false},
      {o.overcut_mm, "the overcut in mm", 0, false},
      {o.copies.gap_mm, "the gap between copies in mm", 0, false},
      {static_cast<double>(o.copies.columns), "the number of columns of copies", 1, false},
      {static_cast<double>(o.copies.rows), "the number of rows of copies", 1, false},
      {o.motion.rapid_mm_min, "the rapid speed in mm/min", 0, true},
      {o.motion.acceleration_mm_s2, "the acceleration in mm/s2", 0, true},
      {o.motion.pierce_s, "the pierce time in s", 0, false},
  };
  for (const Rule& r : rules) {
    if (auto ok = check_number(r.value, r.name, r.low, r.open); !ok) return ok.error();
  }
  if (o.micro_joints.per_contour > 1000) return usage("more than 1000 micro-joints in a contour (0 to 1000)");
  return {};
}

bool is_sound(const geom::ArcSpline& spline) {
  const auto good = [](double v) { return std::abs(v) <= kLargestCoordinate; };
  return std::all_of(spline.segments.begin(), spline.segments.end(), [&](const Segment& s) {
    return good(s.a.x) && good(s.a.y) && good(s.b.x) && good(s.b.y) && std::isfinite(s.radius) &&
           (s.is_line() || (std::isfinite(s.center.x) && std::isfinite(s.center.y)));
  });
}

Result<void> check_profile(const Profile& profile, const LaserOptions& options) {
  std::size_t segments = 0;
  for (const CutPath& p : profile.paths) {
    if (!is_sound(p.spline)) {
      return Error{
          ErrorCode::geometry, "a beam path has coordinates that are not numbers or beyond 1e7 mm", {}};
    }
    segments += p.spline.segments.size();
  }
  for (const Outline& o : profile.outlines) {
    if (!is_sound(o.spline)) {
      return Error{
          ErrorCode::geometry, "an outline has coordinates that are not numbers or beyond 1e7 mm", {}};
    }
  }
  if (segments == 0) return Error{ErrorCode::geometry, "nothing to cut (at least one contour)", {}};
  const double copies = static_cast<double>(options.copies.columns) * options.copies.rows;
  if (copies * static_cast<double>(segments) > kMostRecords) {
    return Error{ErrorCode::range,
                 format_shortest(copies) + " copies of " + std::to_string(segments) +
                     " segments are too many for one program (20 million segments at most)",
                 {}};
  }
  return {};
}

// --- planning
// -------------------------------------------------------------------------------------------------

detail::Tiling tiling_of(const Profile& profile, const CopyOptions& copies) {
  geom::Box2 box;
  for (const CutPath& p : profile.paths) {
    if (!p.spline.empty()) box.add(geom::bounds_of(p.spline));
  }
  return {copies.columns, copies.rows, {box.width() + copies.gap_mm, box.height() + copies.gap_mm}};
}

std::string role_name(Role role) {
  switch (role) {
    case Role::outer:
      return "outer";
    case Role::hole:
      return "hole";
    case Role::open:
      return "open";
    case Role::engrave:
      return "engrave";
  }
  return "";
}

std::string contour_name(const Profile& profile, std::uint32_t path) {
  const CutPath& p = profile.paths[path];
  return "contour " + std::to_string(p.contour + 1) + " " + role_name(p.role);
}

detail::OrderItem order_item(const Job& job, bool fixed) {
  detail::OrderItem item;
  const auto& segments = job.spline.segments;
  if (!job.spline.closed) {
    const Point2 a = segments.front().a, b = segments.back().b;
    if (fixed) {
      item.ways = {{a, b, 0}};
    } else {
      item.ways = {{a, b, 1}, {b, a, 0}};
    }
    return item;
  }
  for (std::uint32_t i = 0; i < job.sites.sites.size(); ++i) {
    const detail::Site& s = job.sites.sites[i];
    item.ways.push_back({s.lead_in ? s.lead_in->a : s.point, s.point, i});
  }
  return item;
}

/// Engraving first, then cuts, each group in a good order; or all as given.
std::vector<detail::Visit> plan_order(const Profile& profile, const std::vector<Job>& jobs,
                                      const LaserOptions& options) {
  std::vector<detail::Visit> tour;
  if (options.order == Order::file) {
    for (std::uint32_t i = 0; i < jobs.size(); ++i) tour.push_back({i, 0});
    return tour;
  }
  const auto parents = detail::path_parents(profile.paths, options.tolerance.point_mm);
  Point2 from{};
  for (const bool engraving : {true, false}) {
    std::vector<detail::OrderItem> items;
    std::vector<std::uint32_t> job_of;
    std::vector<std::uint32_t> item_of(profile.paths.size(), detail::kNoParent);
    for (std::uint32_t i = 0; i < jobs.size(); ++i) {
      if ((jobs[i].role == Role::engrave) != engraving) continue;
      item_of[jobs[i].path] = static_cast<std::uint32_t>(items.size());
      items.push_back(order_item(jobs[i], false));
      job_of.push_back(i);
    }
    for (std::size_t k = 0; k < items.size(); ++k) {
      const std::uint32_t parent = parents[jobs[job_of[k]].path];
      if (parent != detail::kNoParent) items[k].parent = item_of[parent];
    }
    for (const detail::Visit v : detail::order_items(items, from)) {
      tour.push_back({job_of[v.item], v.way});
      from = items[v.item].ways[v.way].out;
    }
  }
  return tour;
}

void report_lead(const Profile& profile, const Job& job, const detail::Site& site,
                 const LaserOptions& options, Diagnostics& diagnostics) {
  const std::string name = contour_name(profile, job.path);
  if (job.sites.fit == detail::Fit::shortened) {
    diagnostics.info_at("lead_shortened",
                        name + ": lead of " + format_fixed(job.sites.length_mm, 3) + " mm instead of " +
                            format_fixed(options.lead.length_mm, 3) + " mm, there is no room for more",
                        site.point.x, site.point.y);
  } else if (job.sites.fit == detail::Fit::none) {
    diagnostics.info_at("no_lead", name + ": no room for a lead, the beam pierces on the path", site.point.x,
                        site.point.y);
  }
}

void report_moves(const Profile& profile, const Job& job, const detail::ContourMoves& moves,
                  Diagnostics& diagnostics) {
  const std::string name = contour_name(profile, job.path);
  const Point2 start = moves.strokes.front().segment.a;
  if (!moves.loops_without_room.empty()) {
    const Point2 p = moves.loops_without_room.front();
    diagnostics.info_at("corner_slowed",
                        name + ": " + std::to_string(moves.loops_without_room.size()) +
                            " corners without room for a loop on the waste side are cut slowly",
                        p.x, p.y);
  }
  if (moves.joints_missing > 0) {
    diagnostics.info_at("no_micro_joint",
                        name + ": " + std::to_string(moves.joints_missing) + " micro-joints have no place",
                        start.x, start.y);
  }
  if (moves.lead_out_missing) {
    diagnostics.info_at("no_lead_out", name + ": no room for a lead-out", start.x, start.y);
  }
}

// --- program
// --------------------------------------------------------------------------------------------------

/// Writes the records and keeps the state of feed and beam.
class Writer {
 public:
  Writer(const Profile& profile, const LaserOptions& options, Toolpath& out)
      : profile_(profile), options_(options), out_(out) {
    set_feed(options.feed_mm_min, cl::Program::kNoSource);
  }

  void contour(const Job& job, const std::vector<Stroke>& strokes, Vec2 shift) {
    source_ = job.path;
    const bool engrave = job.role == Role::engrave;
    const double power = options_.power_w * (engrave ? options_.engrave_power_factor : 1.0);
    state(cl::Comment{contour_name(profile_, job.path)});
    rapid(strokes.front().segment.a + shift);
    for (const Stroke& s : strokes) {
      const double factor = s.slow ? options_.corners.slow_factor : 1.0;
      set_feed(options_.feed_mm_min * factor, source_);
      if (s.beam) {
        const bool less = s.slow && options_.corners.kind == Corners::power;
        set_beam(less ? power * factor : power);
      } else {
        beam_off();
      }
      move(detail::moved(s.segment, shift), s);
    }
    beam_off();
  }

 private:
  void add(cl::Record record, MoveKind kind) {
    out_.program.add(std::move(record), source_);
    out_.kind.push_back(kind);
  }
  void state(cl::Record record) { add(std::move(record), MoveKind::state); }

  void set_feed(double feed, std::uint32_t source) {
    if (feed == feed_) return;
    source_ = source;
    feed_ = feed;
    state(cl::FeedRate{feed});
  }
  void set_beam(double power) {
    if (on_ && power == power_) return;
    if (!on_) out_.pierces.push_back(at_);
    on_ = true;
    power_ = power;
    state(cl::Beam{true, power});
  }
  void beam_off() {
    if (on_) state(cl::Beam{});
    on_ = false;
  }
  void rapid(Point2 to) {
    if (moved_) out_.rapid_mm += geom::distance(at_, to);
    moved_ = true;
    add(cl::Rapid{{geom::at_z(to, 0), {0, 0, 1}}}, MoveKind::rapid);
    at_ = to;
  }
  void move(const Segment& s, const Stroke& stroke) {
    const cl::Pose to{geom::at_z(s.b, 0), {0, 0, 1}};
    const MoveKind kind = stroke.beam ? stroke.kind : MoveKind::rapid;
    const double length = geom::length_of(s);
    (kind == MoveKind::rapid ? out_.rapid_mm : kind == MoveKind::lead ? out_.lead_mm : out_.cut_mm) += length;
    if (s.is_line()) {
      add(cl::Feed{to}, kind);
    } else {
      const double up = s.radius > 0 ? 1 : -1;
      add(cl::Arc{geom::at_z(s.center, 0), {0, 0, up}, std::abs(s.radius), to}, kind);
    }
    at_ = s.b;
  }

  const Profile& profile_;
  const LaserOptions& options_;
  Toolpath& out_;
  std::uint32_t source_ = cl::Program::kNoSource;
  double feed_ = 0, power_ = 0;
  bool on_ = false, moved_ = false;
  Point2 at_{};
};

detail::LeadRoom room_of(const LaserOptions& options, const detail::Clearance& outlines,
                         const detail::Clearance& paths) {
  detail::LeadRoom room;
  room.outlines = &outlines;
  room.paths = &paths;
  room.distance_mm = std::abs(options.offset_mm) - options.tolerance.path_mm;
  room.kerf_mm = 2 * std::abs(options.offset_mm);
  room.path_mm = options.tolerance.path_mm;
  room.point_mm = options.tolerance.point_mm;
  if (!options.arcs) {
    // The other half belongs to the fit of free curves (profile.cpp).
    constexpr double kShare = 0.5;
    room.sagitta_mm = kShare * options.tolerance.path_mm;
  }
  return room;
}

std::vector<Job> make_jobs(const Profile& profile, const LaserOptions& options,
                           const detail::LeadRoom& room) {
  std::vector<Job> jobs;
  const bool fixed = options.order == Order::file;
  for (std::uint32_t i = 0; i < profile.paths.size(); ++i) {
    if (profile.paths[i].spline.empty()) continue;
    Job job = detail::make_job(profile, i, options);
    if (job.spline.closed)
      job.sites = detail::plan_sites(job.spline, i, job.waste, options.lead, fixed, room);
    jobs.push_back(std::move(job));
  }
  return jobs;
}

}  // namespace

Result<Toolpath> make_toolpath(const Profile& profile, const LaserOptions& options,
                               Diagnostics& diagnostics) {
  if (auto ok = check_options(options); !ok) return ok.error();
  if (auto ok = check_profile(profile, options); !ok) return ok.error();

  const detail::Tiling tiling = tiling_of(profile, options.copies);
  const detail::Clearance outlines = detail::clearance_of_outlines(profile, tiling);
  const detail::Clearance paths = detail::clearance_of_paths(profile, tiling);
  const detail::LeadRoom room = room_of(options, outlines, paths);
  const std::vector<Job> jobs = make_jobs(profile, options, room);
  const std::vector<detail::Visit> tour = plan_order(profile, jobs, options);

  Toolpath out;
  std::vector<detail::ContourMoves> moves;
  for (const detail::Visit v : tour) {
    const Job& job = jobs[v.item];
    moves.push_back(detail::make_moves(job, v.way, options, room));
    out.order.push_back(job.path);
    if (job.waste != detail::Waste::none) {
      report_lead(profile, job, job.sites.sites[v.way], options, diagnostics);
    }
    report_moves(profile, job, moves.back(), diagnostics);
  }

  Writer writer(profile, options, out);
  for (int row = 0; row < tiling.rows; ++row) {
    for (int k = 0; k < tiling.columns; ++k) {
      const int column = row % 2 == 0 ? k : tiling.columns - 1 - k;  // there and back again
      const Vec2 shift{column * tiling.pitch.x, row * tiling.pitch.y};
      for (std::size_t i = 0; i < tour.size(); ++i)
        writer.contour(jobs[tour[i].item], moves[i].strokes, shift);
    }
  }
  out.machining_s = estimate_time(out.program, options.motion, options.feed_mm_min);
  return out;
}

}  // namespace burin::laser
