// SPDX-License-Identifier: Apache-2.0
// burin orient: a design surface and a face mill -> tilt and yaw of every contact point -> CL, NC.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "burin/base/parallel.h"
#include "burin/base/text.h"
#include "burin/cl/apt.h"
#include "burin/job/orient_check.h"
#include "burin/plan/orient/to_cl.h"
#include "burin/post/emit_tcp.h"
#include "burin/view/orient_html.h"
#include "burin/view/orient_scene.h"
#include "cli.h"
#include "commands.h"
#include "joint_options.h"
#include "orient_setup.h"

namespace burin::cli {
namespace {

namespace fs = std::filesystem;
using geom::degrees;

struct OrientArgs {
  std::string job, points, view;
  std::optional<double> tolerance;
  bool tcp = false, joints = false;
};

/// All that came of a job.
struct OrientRun {
  orient::OrientPlan plan;
  orient::ToolPath path;
  std::optional<kinematics::JointPath> joints;  ///< of a job with a machine
  std::optional<post::NcText> nc;
};

/// Share of the tolerance by which the tip may leave the tool path between two blocks: what the poses may
/// gouge is the whole tolerance already.
constexpr double kJointShare = 0.1;

/// Share of the tolerance that the motion between two poses may gouge more than they do
/// (plan/orient/motion_check: 0.3, and kJointShare); beyond it is worth a warning.
constexpr double kMotionShare = 0.4;

// --- points.csv

std::string number(double value) {
  return std::isfinite(value) ? format_shortest(value) : value > 0 ? "inf" : "0";
}

void add_point(const orient::OrientedPath& path, std::size_t index, std::string& text) {
  const orient::OrientedPoint& point = path.points[index];
  const auto add = [&text](double value) { text += number(value) + ","; };
  const auto add3 = [&add](const auto& v) { add(v.x), add(v.y), add(v.z); };
  const auto add_angles = [&add](bool found, const orient::Angles& a, double rho) {
    add(found ? degrees(a.alpha) : 0), add(found ? degrees(a.beta) : 0), add(found ? rho : 0);
  };
  const orient::CcPoint& cc = point.cc;
  text += std::to_string(path.number) + "," + std::to_string(index) + ",";
  add3(cc.c), add3(cc.n), add3(cc.f);
  add_angles(point.reachable, point.angles, point.rho);
  add_angles(point.initial_found, point.initial, point.rho_initial);
  // Where no angles are allowed the columns hold the contact point and its normal: numbers, but no pose.
  add3(point.reachable ? point.pose.tip : cc.c), add3(point.reachable ? point.pose.axis : cc.n);
  text += std::to_string(point.tests) + "," + orient::word(point.cause) + "," +
          (point.reachable ? "ok" : "unreachable") + "\n";
}

std::string points_csv(const orient::OrientPlan& plan) {
  std::string text =
      "path,index,x,y,z,nx,ny,nz,fx,fy,fz,alpha_deg,beta_deg,rho_mm,alpha_initial_deg,beta_initial_deg,"
      "rho_initial_mm,px,py,pz,ux,uy,uz,tests,cause,state\n";
  for (const orient::OrientedPath& path : plan.paths)
    for (std::size_t i = 0; i < path.points.size(); ++i) add_point(path, i, text);
  return text;
}

// --- messages

const char* in_words(orient::Cause cause) {
  switch (cause) {
    case orient::Cause::gouge:
      return "the cutting body would gouge";
    case orient::Cause::collision:
      return "shank, holder or head would collide";
    case orient::Cause::limit:
      return "the machine does not get there";
    default:
      return "no tilt and yaw of the range is free";
  }
}

/// Runs of unreachable points of one cause, path by path.
void list_unreachable(const orient::OrientPlan& plan, Session& session) {
  for (const orient::OrientedPath& path : plan.paths) {
    const std::vector<orient::OrientedPoint>& points = path.points;
    for (std::size_t i = 0; i < points.size();) {
      std::size_t end = i + 1;
      if (points[i].reachable) {
        i = end;
        continue;
      }
      while (end < points.size() && !points[end].reachable && points[end].cause == points[i].cause) ++end;
      const geom::Point3 at = points[i].cc.c;
      const bool one = end == i + 1;
      session.diagnostics.add(
          {Severity::left_out,
           "unreachable",
           "path " + std::to_string(path.number) + ", " +
               (one ? "point " + std::to_string(i) + " is"
                    : "points " + std::to_string(i) + " to " + std::to_string(end - 1) + " are") +
               " unreachable: " + in_words(points[i].cause),
           {},
           std::array{at.x, at.y, at.z}});
      i = end;
    }
  }
}

/// Runs of reachable points that no clear way leads to: nothing is left out silently.
void list_not_milled(const orient::OrientPlan& plan, const orient::ToolPath& tool_path, Session& session) {
  std::vector<bool> stranded(plan.contact_points, false);
  for (const std::size_t point : tool_path.stranded)
    if (point < stranded.size()) stranded[point] = true;
  std::size_t first = 0;  // of the path, over all paths
  for (const orient::OrientedPath& path : plan.paths) {
    const std::size_t count = path.points.size();
    const auto lost = [&](std::size_t i) { return i < count && stranded[first + i]; };
    for (std::size_t i = 0; i < count; ++i) {
      if (!lost(i)) continue;
      const std::size_t begin = i;
      while (lost(i + 1)) ++i;
      const geom::Point3 at = path.points[begin].cc.c;
      session.diagnostics.add({Severity::left_out,
                               "not_milled",
                               "path " + std::to_string(path.number) + ", points " + std::to_string(begin) +
                                   " to " + std::to_string(i) +
                                   " are not milled: no free way to them and back was found",
                               {},
                               std::array{at.x, at.y, at.z}});
    }
    first += count;
  }
}

std::size_t unreachable_by(const orient::OrientPlan& plan, orient::Cause cause) {
  std::size_t count = 0;
  for (const orient::OrientedPath& path : plan.paths)
    for (const orient::OrientedPoint& point : path.points)
      if (!point.reachable && point.cause == cause) ++count;
  return count;
}

/// What to change when nothing at all can be milled.
std::string advice(const OrientSetup& setup, const orient::OrientPlan& plan) {
  const std::size_t gouge = unreachable_by(plan, orient::Cause::gouge);
  const std::size_t collision = unreachable_by(plan, orient::Cause::collision);
  const std::size_t limit = unreachable_by(plan, orient::Cause::limit);
  const std::size_t most = std::max({gouge, collision, limit});
  if (most == gouge && !setup.contacts.empty())
    return "the cutting body gouges everywhere: do the normals of the contacts point away from the part?";
  const auto* surface = std::get_if<job::OrientSurface>(&setup.file.part);
  if (most == gouge && surface != nullptr)
    return std::string(
               "the cutting body gouges everywhere: the tool probably stands on the wrong side "
               "(flip = ") +
           (surface->flip ? "false" : "true") + " in [part])";
  if (most == gouge) return "the cutting body gouges everywhere (a smaller radius or a larger tilt)";
  if (most == collision)
    return "shank, holder or head collide everywhere (a longer cutting body, a slimmer holder, a larger "
           "tilt)";
  return "machine " + setup.file.machine +
         " does not get to any of them (a machine that tilts as far as the job's tilts, or the part turned)";
}

/// Error when there is nothing to write; otherwise the messages.
Result<void> judge(const OrientArgs& args, const OrientSetup& setup, const orient::OrientPlan& plan,
                   Session& session) {
  if (plan.contact_points == 0)
    return Error{ErrorCode::geometry, "the job has no contact points (faces that its paths cross)", {}};
  const Common& c = session.common;
  const bool none = plan.unreachable == plan.contact_points;
  const bool reported =
      !args.points.empty() || !c.json.empty() || !c.html.empty() || !c.svg.empty() || !args.view.empty();
  if (none && !reported)
    return Error{ErrorCode::geometry,
                 "none of the " + std::to_string(plan.contact_points) +
                     " contact points is reachable: " + advice(setup, plan),
                 {}};
  if (none)
    session.diagnostics.left_out("nothing_reachable",
                                 "no contact point is reachable: " + advice(setup, plan));
  list_unreachable(plan, session);
  return {};
}

// --- report

const char* word(orient::Pattern pattern) {
  return pattern == orient::Pattern::iso_u ? "iso-u" : pattern == orient::Pattern::iso_v ? "iso-v" : "plane";
}
const char* word(orient::Search search) {
  return search == orient::Search::optimal   ? "optimal"
         : search == orient::Search::contour ? "contour"
                                             : "sturz";
}

Json parameters(const OrientSetup& setup, const std::string& dialect) {
  const orient::OrientOptions& o = setup.file.options;
  const model::Mill& mill = setup.file.mill;
  const bool generated = setup.contacts.empty();
  return {{"paths", generated ? Json(word(o.paths.pattern)) : Json("contacts")},
          {"tilt_deg", {degrees(o.range.alpha_lo), degrees(o.range.alpha_hi)}},
          {"yaw_deg", {degrees(o.range.beta_lo), degrees(o.range.beta_hi)}},
          {"tolerance_mm", o.tolerance_mm},
          {"clearance_mm", o.clearance_mm},
          {"objective", o.objective == orient::Objective::radius ? "radius" : "strip"},
          {"search", word(o.search)},
          {"smooth", o.smooth},
          {"scallop_mm", o.scallop_mm},
          {"side_step_mm", o.side_step_mm ? Json(*o.side_step_mm) : Json(nullptr)},
          {"path_count", o.path_count ? Json(*o.path_count) : Json(nullptr)},
          {"feed_mm_min", o.feed_mm_min},
          {"tool", mill.kind == model::MillKind::flat ? "flat" : "bull"},
          {"radius_mm", mill.radius},
          {"corner_radius_mm", mill.corner_radius},
          {"length_mm", mill.length},
          {"holder", pieces_json(mill.holder)},
          {"machine", setup.file.machine},
          {"dialect", dialect}};
}

/// Feed moves as the joints make them, rapids at the axes' speeds; at the feed alone without a machine.
double machining_s(const OrientSetup& setup, const OrientRun& run) {
  if (!run.joints) return 60 * cl::totals(run.path.program).feed_mm / setup.file.options.feed_mm_min;
  return 60 * kinematics::total_minutes(*setup.machine, run.joints->moves);
}

Json comparison_json(const orient::Comparison& c) {
  return {{"name", c.name},           {"possible", c.possible},       {"tilt_deg", degrees(c.tilt)},
          {"radius_mm", c.radius_mm}, {"unreachable", c.unreachable}, {"paths", c.paths},
          {"cut_mm", c.cut_mm},       {"cut_min", c.minutes}};
}

void fill_report(const OrientSetup& setup, const OrientRun& run, const std::optional<job::OrientCheck>& check,
                 Session& session) {
  const orient::OrientPlan& plan = run.plan;
  Report& r = session.report;
  r.parameters = parameters(setup, session.common.dialect);
  std::size_t initial = 0;
  double speed = 0, acceleration = 0, loss = 0;
  for (const orient::OrientedPath& path : plan.paths) {
    speed = std::max(speed, path.speed_share);
    acceleration = std::max(acceleration, path.acceleration_share);
    loss += path.smooth_loss / static_cast<double>(plan.paths.size());
    for (const orient::OrientedPoint& point : path.points) initial += point.initial_found ? 1 : 0;
  }
  r.counts = {{"contact_points", plan.contact_points},
              {"unreachable", plan.unreachable},
              {"unreachable_gouge", unreachable_by(plan, orient::Cause::gouge)},
              {"unreachable_collision", unreachable_by(plan, orient::Cause::collision)},
              {"unreachable_limit", unreachable_by(plan, orient::Cause::limit)},
              {"initial_found", initial},
              {"feasibility_tests", plan.tests},
              {"paths", plan.paths.size()},
              {"triangles", setup.part.mesh.triangles.size()},
              {"cl_points", run.path.program.move_count()},
              {"links", run.path.links},
              {"broken", run.path.broken.size()},
              {"stranded", run.path.stranded.size()}};
  if (run.joints) {
    r.counts["inserted"] = run.joints->inserted;
    r.counts["feed_limited"] = run.joints->feed_limited;
    r.counts["acceleration_limited"] = run.joints->acceleration_limited;
  }
  if (run.nc) r.counts["nc_blocks"] = run.nc->moves;
  r.quality = {{"rho_gain_mean", plan.gain_mean},
               {"rho_gain_per_path", plan.gain_per_path},
               {"axis_step_max_deg", degrees(plan.axis_step_max)},
               {"gouge_max_mm", check ? Json(check->gouge_max_mm()) : Json(nullptr)}};
  if (check) {
    r.quality["gouge_cutter_mm"] = check->cutter.mm;
    r.quality["gouge_holder_mm"] = check->holder.mm;
    r.quality["bound_mm"] = check->bound_mm;
  }
  if (setup.file.options.smooth) {
    r.quality["smooth_loss_mean"] = loss;
    r.quality["rotary_speed_share_max"] = speed;
    r.quality["rotary_acceleration_share_max"] = acceleration;
  }
  r.lengths_mm = {{"cut", run.path.cut_mm}, {"link", run.path.link_mm}, {"rapid", run.path.rapid_mm}};
  r.time_s["machining"] = machining_s(setup, run);
  r.time_s["cutting"] = 60 * plan.cut_mm / setup.file.options.feed_mm_min;
  Json comparisons = Json::array();
  for (const orient::Comparison& c : plan.comparisons) {
    comparisons.push_back(comparison_json(c));
    r.lengths_mm[c.name + "_cut"] = c.possible ? Json(c.cut_mm) : Json(nullptr);
    r.time_s[c.name + "_machining"] = c.possible ? Json(60 * c.minutes) : Json(nullptr);
  }
  r.extra["comparisons"] = std::move(comparisons);
}

/// What the independent check found beyond the tolerance.
void warn_of_gouge(const OrientSetup& setup, const job::OrientCheck& check, Session& session) {
  const auto say = [&](const verify::MillFinding& found, const char* what, double allowed) {
    if (found.mm <= allowed + check.bound_mm) return;
    session.diagnostics.add({Severity::left_out,
                             "gouge",
                             std::string("the ") + what + " gets " + format_fixed(found.mm, 4) +
                                 " mm into the part at record " + std::to_string(found.move) +
                                 " of the CL data",
                             {},
                             std::array{found.at.x, found.at.y, found.at.z}});
  };
  say(check.cutter, "cutting body", (1 + kMotionShare) * setup.file.options.tolerance_mm);
  say(check.holder, "shank, holder or head", 0);
}

/// The motion as it will run, by code that shares nothing with the planner.
Result<job::OrientCheck> check_motion(const OrientArgs& args, const OrientSetup& setup, const OrientRun& run,
                                      const Session& session) {
  // A hundredth of the tolerance each: what is found is then right to a percent or so.
  const double share = 0.01 * setup.file.options.tolerance_mm;
  const job::OrientCheckOptions options{share, share, static_cast<unsigned>(session.common.threads)};
  if (run.path.program.move_count() == 0) return job::OrientCheck{};
  if (run.joints && !args.tcp)
    return job::check_orient_job(setup.part, setup.file.mill, *setup.machine, *run.joints, options);
  return job::check_orient_job(setup.part, setup.file.mill, run.path.program, options);
}

// --- pictures

/// Maps on the page: as fine as their number allows, so that the page stays a few megabytes.
constexpr std::size_t kMapNodes = 3'000'000, kMostMaps = 4000;
constexpr int kFinestTilts = 60, kFinestYaws = 61, kCoarsestTilts = 24, kCoarsestYaws = 25;

std::vector<view::OrientPicture::PointMap> point_maps(const OrientSetup& setup, const OrientRun& run,
                                                      const orient::Scene& scene,
                                                      const orient::MachineLimits& limits, unsigned threads) {
  std::vector<std::pair<std::size_t, std::size_t>> all;
  for (std::size_t p = 0; p < run.plan.paths.size(); ++p)
    for (std::size_t i = 0; i < run.plan.paths[p].points.size(); ++i) all.emplace_back(p, i);
  const std::size_t every = std::max<std::size_t>(1, (all.size() + kMostMaps - 1) / kMostMaps);
  std::vector<view::OrientPicture::PointMap> maps((all.size() + every - 1) / every);
  const double share =
      std::sqrt(static_cast<double>(kMapNodes) /
                (static_cast<double>(std::max<std::size_t>(maps.size(), 1)) * kFinestTilts * kFinestYaws));
  const auto fine = [share](int least, int most) {
    return std::clamp(static_cast<int>(share * most), least, most);
  };
  const orient::Setting setting = orient::setting_of(scene, limits, setup.file.options);
  parallel_for(maps.size(), thread_count(threads), [&](std::size_t task, std::size_t) {
    const auto [path, point] = all[task * every];
    orient::Scene::Memory memory;
    maps[task] = {
        path, point,
        orient::make_map(setting, run.plan.paths[path].points[point].cc, fine(kCoarsestTilts, kFinestTilts),
                         fine(kCoarsestYaws, kFinestYaws), memory)};
  });
  return maps;
}

view::OrientPicture picture_of(const OrientArgs& args, const OrientSetup& setup, const OrientRun& run,
                               const orient::Scene& scene, const orient::MachineLimits& limits,
                               const Session& session) {
  view::OrientPicture picture;
  picture.title = fs::path(args.job).stem().string();
  picture.command_line = session.command_line;
  picture.part = &setup.part;
  picture.plan = &run.plan;
  picture.mill = &setup.file.mill;
  picture.options = &setup.file.options;
  picture.diagnostics = &session.diagnostics;
  picture.maps = point_maps(setup, run, scene, limits, static_cast<unsigned>(session.common.threads));
  if (run.nc) picture.nc_text = run.nc->text, picture.nc_line_to_record = run.nc->line_to_record;
  picture.program = &run.path.program;
  picture.machine = setup.machine_or_null();
  const Report& r = session.report;
  const auto add = [&](const char* group, const std::string& name, const Json& value, int decimals,
                       const char* unit) {
    if (value.is_number_float())
      picture.figures.push_back({group, name, format_fixed(value.get<double>(), decimals) + unit});
    else if (value.is_number())
      picture.figures.push_back({group, name, value.dump() + unit});
  };
  for (const auto& [key, value] : r.counts.items()) add("Counts", key, value, 0, "");
  for (const auto& [key, value] : r.quality.items()) add("Quality", key, value, 5, "");
  for (const auto& [key, value] : r.lengths_mm.items()) add("Lengths", key, value, 1, " mm");
  for (const auto& [key, value] : r.time_s.items())
    if (key != "planning") add("Time", key, value, 1, " s");
  return picture;
}

// --- the run

Result<void> put_outputs(const OrientArgs& args, const OrientSetup& setup, const OrientRun& run,
                         const orient::Scene& scene, const orient::MachineLimits& limits,
                         const std::string& nc_path, const std::string& cl_path, Session& session) {
  if (auto ok = session.put_made(nc_path, [&] { return run.nc->text; }); !ok) return ok;
  if (auto ok = session.put_made(args.points, [&] { return points_csv(run.plan); }); !ok) return ok;
  if (auto ok = session.put_made(cl_path, [&] { return cl::write_apt(run.path.program); }); !ok) return ok;
  if (session.common.html.empty() && args.view.empty()) return {};
  const view::OrientPicture picture = picture_of(args, setup, run, scene, limits, session);
  if (auto ok = session.put_made(session.common.html, [&] { return view::orient_html(picture); }); !ok)
    return ok;
  if (args.view.empty()) return {};
  auto shown = view::orient_scene(picture);
  if (!shown) return shown.error();
  auto page = view::viewer_page(*shown);
  if (!page) return page.error();
  return session.put(args.view, *std::move(page));
}

/// Tool path, and what the machine makes of it.
Result<void> make_motion(const OrientArgs& args, const OrientSetup& setup, const orient::Scene& scene,
                         const orient::MachineLimits& limits, const post::Dialect& dialect, bool want_nc,
                         OrientRun& run, Session& session) {
  const orient::OrientOptions& o = setup.file.options;
  auto path = orient::to_cl(
      setup.part, scene, limits, run.plan.paths,
      {o.safety_mm, o.feed_mm_min, o.spindle_rpm, 0, static_cast<unsigned>(session.common.threads)});
  if (!path) return path.error();
  run.path = std::move(*path);
  run.path.program.name = fs::path(args.job).stem().string();
  list_not_milled(run.plan, run.path, session);
  if (!run.path.broken.empty())
    session.diagnostics.info("retracted",
                             std::to_string(run.path.broken.size()) +
                                 " moves between neighbouring points would gouge or collide: the "
                                 "tool retracts there instead");
  if (!setup.machine || run.path.program.move_count() == 0) {
    if (want_nc) run.nc.emplace();
    return {};
  }
  kinematics::JointPathOptions joints;
  joints.tolerance_mm = kJointShare * o.tolerance_mm;
  joints.tool_centre = args.tcp;
  joints.keep_acceleration = o.smooth;
  auto joint_path = kinematics::make_joint_path(*setup.machine, run.path.program, joints);
  if (!joint_path) return joint_path.error();
  run.joints = std::move(*joint_path);
  report_joints(*run.joints, session);
  if (!want_nc) return {};
  post::JointEmitOptions emit;
  emit.write_z = true;
  auto nc = args.tcp ? post::emit_tcp(run.path.program, *setup.machine, *run.joints, dialect, emit,
                                      session.diagnostics)
                     : post::emit_joints(run.path.program, *setup.machine, *run.joints, dialect, emit,
                                         session.diagnostics);
  if (!nc) return nc.error();
  run.nc = std::move(*nc);
  return {};
}

struct OutputNames {
  std::string nc, cl;
};

/// -o and --cl, or when nothing at all is asked for the job's name with .ngc (.cl without a machine).
Result<OutputNames> output_names(const OrientArgs& args, const OrientSetup& setup, Session& session) {
  const Common& c = session.common;
  if (!setup.machine && !c.output.empty())
    return Error{
        ErrorCode::usage,
        "-o: an NC program needs a machine, the job's is \"none\" (name = \"propeller-head-head\" in "
        "[machine], or --cl FILE)",
        {}};
  OutputNames names{c.output, c.cl};
  const bool nothing = args.points.empty() && c.output.empty() && c.cl.empty() && c.json.empty() &&
                       c.html.empty() && c.svg.empty() && args.view.empty();
  if (!nothing) return names;
  std::string& name = setup.machine ? names.nc : names.cl;
  name = fs::path(args.job).replace_extension(setup.machine ? ".ngc" : ".cl").string();
  if (auto ok = session.reserve_output(name); !ok) return ok.error();
  return names;
}

Result<void> run_orient(const OrientArgs& args, Session& session) {
  auto dialect = post::find_dialect(session.common.dialect);
  if (!dialect) return dialect.error();
  for (const std::string& path : {args.points, args.view})
    if (!path.empty())
      if (auto ok = session.reserve_output(path); !ok) return ok;
  auto setup = load_orient(args.job, args.tolerance, session);
  if (!setup) return setup.error();
  auto names = output_names(args, *setup, session);
  if (!names) return names.error();
  const auto workers = session.workers();
  const orient::Scene scene = setup->scene();
  const orient::MachineLimits limits = setup->limits();
  auto plan = orient::plan(setup->part, scene, limits, setup->contacts, setup->machine_or_null(),
                           setup->file.options, *workers, session.diagnostics, session.progress());
  if (!plan) return in_file(plan.error(), args.job);
  if (!session.first()) return {};
  OrientRun run;
  run.plan = std::move(*plan);
  if (auto ok = judge(args, *setup, run.plan, session); !ok) return in_file(ok.error(), args.job);
  if (auto ok = make_motion(args, *setup, scene, limits, *dialect, !names->nc.empty(), run, session); !ok)
    return in_file(ok.error(), args.job);
  std::optional<job::OrientCheck> check;
  if (!session.common.json.empty() || !session.common.html.empty() || !args.view.empty()) {
    auto checked = check_motion(args, *setup, run, session);
    if (!checked) return in_file(checked.error(), args.job);
    check = std::move(*checked);
    warn_of_gouge(*setup, *check, session);
  }
  session.end_progress();
  session.diagnostics.locate(args.job);
  fill_report(*setup, run, check, session);
  return put_outputs(args, *setup, run, scene, limits, names->nc, names->cl, session);
}

}  // namespace

void add_orient(Cli& cli) {
  auto args = std::make_shared<OrientArgs>();
  CLI::App& app = cli.add_command(
      "orient", "tilt and yaw of a face mill for every contact point, free of gouge and collision",
      std::string("  burin orient blade.toml -o blade.ngc --html report.html\n"
                  "  burin orient blade.toml --points points.csv --json figures.json\n"
                  "  burin orient blade.toml --dialect fanuc --tcp -o blade.nc\n"
                  "  mpirun -n 8 burin orient blade.toml --cl blade.cl\n") +
          kOrientJobHelp + "\nExit code 3: done, but contact points are unreachable; each is listed.\n",
      [args](Session& session) { return run_orient(*args, session); });
  add_text(app, "JOB.toml", args->job, "FILE", "part, tool, operation and machine")->required();
  add_text(app, "--points", args->points, "FILE", "contact points, angles, effective radii and poses as CSV");
  add_text(app, "--view", args->view, "FILE",
           "the path in the viewer's page: played, with tilt and yaw of the contact points");
  CLI::Option* tcp =
      app.add_flag("--tcp", args->tcp, "NC for tool-centre-point control (G43.4): tip and rotary angles");
  app.add_flag("--joints", args->joints, "NC in joint coordinates, inverse-time feed G93 (default)")
      ->excludes(tcp);
  add_number(app, "--tolerance", args->tolerance, kPositiveLength, "instead of the job's tolerance");
  cli.add_dialect(app);
  cli.add_threads(app);
  cli.allow_ranks(app);
  cli.add_output(app,
                 "NC program (default, when nothing else is asked for: the job's name with .ngc, or with .cl "
                 "when it has no machine)");
  cli.add_cl(app);
  cli.add_json(app);
  cli.add_html(app);
}

}  // namespace burin::cli
