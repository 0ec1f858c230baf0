// SPDX-License-Identifier: Apache-2.0
// burin cycle: surface program -> joined surfaces -> paths -> setpoints and NC.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "burin/base/parallel.h"
#include "burin/base/text.h"
#include "burin/cl/apt.h"
#include "burin/job/cycle_job.h"
#include "burin/post/emit.h"
#include "burin/servo/measure.h"
#include "burin/view/cycle_html.h"
#include "cli.h"
#include "commands.h"

namespace burin::cli {
namespace {

namespace fs = std::filesystem;

struct CycleArgs {
  std::string program, surfaces, setpoints;
  job::CycleOptions plan;
  servo::Limits limits;
};

const char* word(cycle::Along along) {
  return along == cycle::Along::u ? "u" : along == cycle::Along::v ? "v" : "auto";
}
const char* word(geom::Continuity continuity) {
  return continuity == geom::Continuity::g0 ? "G0" : continuity == geom::Continuity::g1 ? "G1" : "G2";
}
const char* word(geom::Direction direction) {
  return direction == geom::Direction::u ? "u" : "v";
}

// --- surfaces
// -------------------------------------------------------------------------------------------------

Json blocks_json(const geom::JoinedSurface& surface, const job::CycleSurfaces& group,
                 const nc::SurfaceProgram& program) {
  std::vector<std::size_t> patches;
  for (const geom::Member& member : surface.members) patches.push_back(member.patch);
  std::sort(patches.begin(), patches.end());
  patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
  Json numbers = Json::array();
  for (const std::size_t patch : patches) {
    const std::optional<int> number = program.blocks[group.blocks[patch]].number;
    numbers.push_back(number ? Json(*number) : Json(nullptr));
  }
  return numbers;
}

Json surface_json(const geom::JoinedSurface& joined, const job::CycleSurfaces& group,
                  const nc::SurfaceProgram& program) {
  const geom::NurbsSurface& s = joined.surface;
  Json points = Json::array();
  for (const geom::HPoint& h : s.points) {
    const geom::Point3 p = geom::project(h);
    points.push_back({p.x, p.y, p.z, h.w});
  }
  Json joints = Json::array();
  for (const geom::Joint& joint : joined.joints)
    joints.push_back({{"direction", word(joint.direction)},
                      {"at", joint.at},
                      {"gap_mm", joint.gap_mm},
                      {"continuity", word(joint.continuity)}});
  return {{"degree_u", s.degree_u},      {"degree_v", s.degree_v},
          {"count_u", s.count_u},        {"count_v", s.count_v},
          {"knots_u", s.knots_u},        {"knots_v", s.knots_v},
          {"points", std::move(points)}, {"blocks", blocks_json(joined, group, program)},
          {"joints", std::move(joints)}, {"deviation_mm", joined.deviation_mm}};
}

std::string surfaces_text(const job::CycleJob& job) {
  Json surfaces = Json::array();
  for (const job::CycleSurfaces& group : job.surfaces)
    for (const geom::JoinedSurface& joined : group.composite.surfaces)
      surfaces.push_back(surface_json(joined, group, job.program));
  return surfaces.dump(1) + "\n";
}

// --- the interpolator, measured
// ---------------------------------------------------------------------------------

struct Servo {
  servo::Plan plan;
  std::vector<servo::Setpoint> setpoints;
  servo::Quality quality;
  double planning_s = 0;
  double median_us = 0, p999_us = 0, max_us = 0;  ///< of one tick
};

// More setpoints than this (3 GB) are a mistake in feed or period rather than a part.
constexpr std::size_t kMaxSetpoints = 40'000'000;
// Time of this many periods says what a period takes; more would only take longer.
constexpr std::size_t kTimedTicks = 200'000;

/// The time of single ticks, the clock's own time among them.
void time_ticks(Servo& servo) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> us;
  us.reserve(std::min(servo.plan.setpoints, kTimedTicks));
  servo::Interpolator interpolator(servo.plan);
  servo::Setpoint out;
  for (std::size_t i = 0; i < std::min(servo.plan.setpoints, kTimedTicks); ++i) {
    const Clock::time_point before = Clock::now();
    interpolator.tick(out);
    us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - before).count());
  }
  if (us.empty()) return;
  std::sort(us.begin(), us.end());
  servo.median_us = us[us.size() / 2];
  servo.p999_us = us[std::min(us.size() - 1, us.size() * 999 / 1000)];
  servo.max_us = us.back();
}

Error too_many_setpoints(double setpoints, bool at_least, const servo::Limits& limits) {
  // The period that would do for the same feed; a higher feed shortens what is cut by as much.
  const double times = setpoints / static_cast<double>(kMaxSetpoints);
  return {ErrorCode::range,
          (std::string(at_least ? "at least " : "")) + format_fixed(setpoints, 0) + " setpoints (at most " +
              std::to_string(kMaxSetpoints) + ": a --period of " +
              format_fixed(1.01 * times * limits.period_s, 5) + " s or more, or " +
              format_fixed(1.01 * times, 2) + " times the feed or more, or fewer paths)",
          {}};
}

/// Setpoints at the commanded feed without any slowing down.
double fewest_setpoints(const job::CycleJob& job, const servo::Limits& limits) {
  double minutes = 0;
  for (const servo::Stretch& s : job.stretches)
    minutes += geom::length(s.path) / (s.feed_mm_min > 0 ? s.feed_mm_min : limits.rapid_mm_min);
  return 60 * minutes / limits.period_s;
}

/// `timed`: also how long single periods take.
Result<Servo> interpolate(const job::CycleJob& job, const servo::Limits& limits, bool timed,
                          Session& session) {
  Servo servo;
  if (const double least = fewest_setpoints(job, limits); least > static_cast<double>(kMaxSetpoints))
    return too_many_setpoints(least, true, limits);
  const auto start = std::chrono::steady_clock::now();
  auto plan = servo::plan(job.stretches, limits, session.diagnostics);
  if (!plan) return plan.error();
  servo.planning_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  servo.plan = std::move(*plan);
  if (servo.plan.setpoints > kMaxSetpoints)
    return too_many_setpoints(static_cast<double>(servo.plan.setpoints), false, limits);
  servo.setpoints = servo::run(servo.plan);
  servo.quality = servo::measure(servo.plan, servo.setpoints);
  if (timed) time_ticks(servo);
  return servo;
}

// --- report
// ---------------------------------------------------------------------------------------------------

struct Worst {
  double scallop_min = 0, scallop_max = 0, side_step = 0, gouge = 0, gap = 0, deviation = 0;
};

Worst worst_of(const job::CycleJob& job) {
  Worst w;
  bool any = false;
  for (const job::CycleRun& run : job.runs) {
    w.gouge = std::max(w.gouge, run.plan.gouge_max_mm);
    for (const cycle::PassFigures& f : run.plan.figures) {
      w.scallop_max = std::max(w.scallop_max, f.scallop_max);
      w.side_step = std::max(w.side_step, f.side_step_max);
      // The last path of a surface ends where the surface ends: its scallop says nothing of the plan.
      if (f.last) continue;
      w.scallop_min = any ? std::min(w.scallop_min, f.scallop_min) : f.scallop_min;
      any = true;
    }
  }
  for (const job::CycleSurfaces& s : job.surfaces) {
    w.gap = std::max(w.gap, s.composite.report.gap_max_mm);
    w.deviation = std::max(w.deviation, s.composite.report.deviation_max_mm);
  }
  return w;
}

/// Bytes of the program as it came, and of the G01 program of the same motion within the same tolerance.
Result<Json> program_size(const job::CycleJob& job, std::size_t bytes, const post::Dialect& dialect,
                          double tolerance_mm) {
  Diagnostics ignored;
  auto lines = post::emit(job::as_lines(job, tolerance_mm), dialect, {.write_z = true}, ignored);
  if (!lines) return lines.error();
  return Json{{"surface_blocks", job.program.blocks.size()},
              {"surface_program_bytes", bytes},
              {"g01_blocks", lines->moves},
              {"g01_program_bytes", lines->text.size()}};
}

/// `options`: those in force, with the tolerance of the command line.
void fill_report(const job::CycleOptions& options, const servo::Limits& limits, const job::CycleJob& job,
                 const Servo& servo, const post::NcText& nc, Session& session) {
  const Worst w = worst_of(job);
  session.report.parameters = {
      {"period_s", limits.period_s},
      {"chord_error_mm", limits.chord_error_mm},
      {"accel_mm_s2", limits.accel_mm_s2},
      {"jerk_mm_s3", limits.jerk_mm_s3},
      {"rapid_mm_min", limits.rapid_mm_min},
      {"tolerance_mm", options.tolerance_mm},
      {"join_mm", options.join_mm},
      {"join_deviation_mm", options.join_deviation_mm.value_or(options.tolerance_mm)},
      {"along", job.runs.empty() ? word(options.along) : word(job.runs.front().plan.along)},
      {"dialect", session.common.dialect},
      {"strict", options.strict}};
  session.report.counts = {{"blocks", job.program.nc_blocks},
                           {"surfaces_in", job.program.blocks.size()},
                           {"surfaces_out", job.surfaces_out},
                           {"paths", job.paths},
                           {"setpoints", servo.setpoints.size()},
                           {"nc_blocks", nc.line_to_record.size()},
                           {"lifted", job.lifted},
                           {"repeats", job.repeats}};
  session.report.lengths_mm = {{"cut", job.cut_mm}, {"link", job.link_mm}, {"rapid", job.rapid_mm}};
  session.report.time_s = {{"machining", servo.plan.duration_s}, {"servo_planning", servo.planning_s}};
  const servo::Quality& q = servo.quality;
  session.report.quality = {
      {"join_gap_max_mm", w.gap},
      {"join_deviation_max_mm", w.deviation},
      {"feed_fluctuation_max", q.feed_fluctuation_max},
      {"feed_fluctuation_rms", q.feed_fluctuation_rms},
      {"chord_error_max_mm", q.chord_error_max_mm},
      {"accel_max_mm_s2", q.accel_max_mm_s2},
      {"jerk_max_mm_s3", q.jerk_max_mm_s3},
      {"scallop_min_mm", w.scallop_min},
      {"scallop_max_mm", w.scallop_max},
      {"side_step_max_mm", w.side_step},
      {"gouge_max_mm", w.gouge},
      {"max_deviation_mm", job.fit_deviation_mm},
      {"period_us", {{"median", servo.median_us}, {"p999", servo.p999_us}, {"max", servo.max_us}}}};
}

std::vector<view::CyclePicture::Figure> figures(const Session& session) {
  const Report& r = session.report;
  std::vector<view::CyclePicture::Figure> rows;
  const auto add = [&](const char* group, const std::string& name, std::string value) {
    rows.push_back({group, name, std::move(value)});
  };
  const auto number = [](const Json& v, int decimals) { return format_fixed(v.get<double>(), decimals); };
  for (const auto& [key, value] : r.counts.items()) add("Counts", key, value.dump());
  for (const auto& [key, value] : r.lengths_mm.items()) add("Lengths", key, number(value, 1) + " mm");
  add("Time", "machining", number(r.time_s["machining"], 2) + " s");
  add("Surface", "gap closed, largest", number(r.quality["join_gap_max_mm"], 6) + " mm");
  add("Surface", "deviation by joining", number(r.quality["join_deviation_max_mm"], 6) + " mm");
  add("Surface", "scallop",
      number(r.quality["scallop_min_mm"], 5) + " to " + number(r.quality["scallop_max_mm"], 5) + " mm");
  add("Surface", "side step, largest", number(r.quality["side_step_max_mm"], 4) + " mm");
  add("Surface", "gouge left, largest", number(r.quality["gouge_max_mm"], 6) + " mm");
  add("Motion", "feed fluctuation, steady feed",
      format_fixed(100 * r.quality["feed_fluctuation_max"].get<double>(), 6) + " %");
  add("Motion", "chord error",
      number(r.quality["chord_error_max_mm"], 6) + " mm of " + number(r.parameters["chord_error_mm"], 4));
  add("Motion", "acceleration",
      number(r.quality["accel_max_mm_s2"], 0) + " mm/s\u00b2 of " + number(r.parameters["accel_mm_s2"], 0));
  add("Motion", "jerk",
      number(r.quality["jerk_max_mm_s3"], 0) + " mm/s\u00b3 of " + number(r.parameters["jerk_mm_s3"], 0));
  if (r.extra.contains("program_size")) {
    const Json& size = r.extra["program_size"];
    add("Program", "surface program", size["surface_program_bytes"].dump() + " bytes");
    add("Program", "as G01 within the tolerance", size["g01_program_bytes"].dump() + " bytes");
  }
  if (r.extra.contains("comparison")) {
    const Json& c = r.extra["comparison"];
    add("Paths for this scallop", "iso-parametric (I1)", number(c["iso_parametric_mm"], 0) + " mm");
    add("Paths for this scallop", "iso-scallop (I2)", number(c["iso_scallop_mm"], 0) + " mm");
    add("Paths for this scallop", "parallel passes, at least",
        c["parallel_mm"].is_null() ? "none: a wall stands along them" : number(c["parallel_mm"], 0) + " mm");
  }
  return rows;
}

/// Of all machinings but repeats; only when a report is asked for: it plans everything a second time.
Result<void> compare(const job::CycleJob& job, const job::CycleOptions& options, Session& session) {
  if (session.common.html.empty()) return {};
  job::PathLengths sum;
  sum.parallel_mm = 0;
  for (const job::CycleRun& run : job.runs) {
    if (run.group.repeat) continue;
    auto lengths = job::compare_methods(job, run, options);
    if (!lengths) return lengths.error();
    sum.iso_parametric_mm += lengths->iso_parametric_mm;
    sum.iso_scallop_mm += lengths->iso_scallop_mm;
    if (sum.parallel_mm && lengths->parallel_mm)
      *sum.parallel_mm += *lengths->parallel_mm;
    else
      sum.parallel_mm.reset();
  }
  session.report.extra["comparison"] = {
      {"iso_parametric_mm", sum.iso_parametric_mm},
      {"iso_scallop_mm", sum.iso_scallop_mm},
      {"parallel_mm", sum.parallel_mm ? Json(*sum.parallel_mm) : Json(nullptr)}};
  return {};
}

std::string html(const CycleArgs& args, const job::CycleJob& job, const Servo& servo, const std::string& text,
                 const Session& session) {
  view::CyclePicture picture;
  picture.title = fs::path(args.program).stem().string();
  picture.command_line = session.command_line;
  for (const job::CycleRun& run : job.runs) {
    const job::CycleSurfaces& surfaces = job.surfaces[run.surfaces];
    view::CycleGroup group;
    for (const std::size_t block : surfaces.blocks) {
      const nc::SurfaceBlock& b = job.program.blocks[block];
      group.patches.push_back(b.surface);
      group.patch_names.push_back(b.number ? "N" + std::to_string(*b.number)
                                           : "line " + std::to_string(b.line));
    }
    group.composite = &surfaces.composite;
    group.plan = &run.plan;
    group.displacement = run.group.displacement;
    group.title = run.title;
    group.tool_diameter_mm = run.group.tool_diameter;
    group.stock_mm = run.group.stock;
    group.feed_mm_min = run.group.feed;
    group.scallop_mm = run.group.scallop;
    picture.groups.push_back(std::move(group));
    picture.commanded_feed_mm_min = std::max(picture.commanded_feed_mm_min, run.group.feed);
    picture.scallop_mm = std::max(picture.scallop_mm, run.group.scallop);
  }
  picture.setpoints = &servo.setpoints;
  picture.period_s = args.limits.period_s;
  picture.accel_limit_mm_s2 = args.limits.accel_mm_s2;
  picture.diagnostics = &session.diagnostics;
  picture.figures = figures(session);
  picture.nc_text = text;
  return view::cycle_html(picture);
}

// --- the run
// --------------------------------------------------------------------------------------------------

Result<void> put_outputs(const CycleArgs& args, const job::CycleJob& job, const Servo& servo,
                         const post::NcText& nc, const std::string& nc_path, const std::string& text,
                         Session& session) {
  if (auto ok = session.put_made(nc_path, [&] { return nc.text; }); !ok) return ok;
  if (auto ok = session.put_made(session.common.cl, [&] { return cl::write_apt(job.cl); }); !ok) return ok;
  if (auto ok = session.put_made(args.surfaces, [&] { return surfaces_text(job); }); !ok) return ok;
  const bool npy = to_lower(fs::path(args.setpoints).extension().string()) == ".npy";
  if (auto ok = session.put_made(
          args.setpoints,
          [&] { return npy ? servo::to_npy(servo.setpoints) : servo::to_csv(servo.setpoints); });
      !ok)
    return ok;
  return session.put_made(session.common.html, [&] { return html(args, job, servo, text, session); });
}

/// -o, or the program's name with .ngc when nothing else is asked for.
std::string nc_name(const CycleArgs& args, const Session& session) {
  const Common& c = session.common;
  const bool nothing_else =
      args.surfaces.empty() && args.setpoints.empty() && c.cl.empty() && c.json.empty() && c.html.empty();
  if (!c.output.empty() || !nothing_else) return c.output;
  return fs::path(args.program).replace_extension(".ngc").string();
}

/// .npy or CSV, by the name's ending.
Result<void> check_setpoints_name(const std::string& path) {
  const std::string ending = to_lower(fs::path(path).extension().string());
  if (path.empty() || path == "-" || ending == ".csv" || ending == ".npy") return {};
  return Error{ErrorCode::usage, "--setpoints: " + path + " is of no known kind (FILE.csv or FILE.npy)", {}};
}

Result<void> run_cycle(const CycleArgs& args, Session& session) {
  if (auto ok = check_setpoints_name(args.setpoints); !ok) return ok;
  auto dialect = post::find_dialect(session.common.dialect);
  if (!dialect) return dialect.error();
  auto text = session.read_input(args.program);
  if (!text) return text.error();
  const std::string nc_path = nc_name(args, session);
  for (const std::string& path : {nc_path, args.surfaces, args.setpoints}) {
    if (path.empty() || path == session.common.output) continue;  // -o is reserved already
    if (auto ok = session.reserve_output(path); !ok) return ok;
  }
  job::CycleOptions options = args.plan;
  options.file_name = args.program;
  options.tolerance_mm = session.common.tolerance_mm;
  options.threads = thread_count(static_cast<unsigned>(session.common.threads));
  options.coordinate_limit_mm = dialect->coordinate_limit_mm;
  auto job = job::make_cycle_job(*text, options, session.diagnostics, session.progress());
  session.end_progress();
  session.diagnostics.locate(args.program);
  if (!job) return in_file(job.error(), args.program);
  if (job->stretches.empty())
    session.diagnostics.left_out("no_motion", "the program moves nothing", {.file = args.program});
  if (job->cl.name.empty()) job->cl.name = fs::path(args.program).stem().string();
  // What only the report shows is only found out for it.
  const bool reported = !session.common.json.empty() || !session.common.html.empty();
  auto servo = interpolate(*job, args.limits, reported, session);
  if (!servo) {
    // Without setpoints asked for, NC and surfaces are worth having all the same.
    if (!args.setpoints.empty() || servo.error().code == ErrorCode::usage)
      return in_file(servo.error(), args.program);
    session.diagnostics.left_out("no_setpoints", "no setpoints were made: " + servo.error().message,
                                 {.file = args.program});
    servo = Servo{};
  }
  auto nc = post::emit(job->cl, *dialect, {.write_z = true}, session.diagnostics);
  if (!nc) return in_file(nc.error(), args.program);
  if (reported) {
    auto size = program_size(*job, text->size(), *dialect, options.tolerance_mm);
    if (!size) return in_file(size.error(), args.program);
    session.report.extra["program_size"] = *size;
  }
  if (auto ok = compare(*job, options, session); !ok) return in_file(ok.error(), args.program);
  fill_report(options, args.limits, *job, *servo, *nc, session);
  return put_outputs(args, *job, *servo, *nc, nc_path, *text, session);
}

void add_servo_options(CLI::App& app, servo::Limits& limits) {
  add_number(app, "--period", limits.period_s, {"S", "a servo period in s, 0.00001 to 0.1", 1e-5, 0.1, false},
             "servo period (default 0.001)");
  add_number(app, "--chord-error", limits.chord_error_mm, kPositiveLength,
             "largest distance of the chord of a period from the path (default 0.001)");
  add_number(app, "--accel", limits.accel_mm_s2, {"MM/S2", "an acceleration above 0", 0, 1e9, true},
             "acceleration limit of each axis (default 5000)");
  add_number(app, "--jerk", limits.jerk_mm_s3, {"MM/S3", "a jerk above 0", 0, 1e12, true},
             "jerk limit of each axis (default 50000)");
  add_number(app, "--rapid", limits.rapid_mm_min, kSpeed, "rapid speed (default 10000)");
}

}  // namespace

void add_cycle(Cli& cli) {
  auto args = std::make_shared<CycleArgs>();
  CLI::App& app = cli.add_command(
      "cycle", "machine the NURBS surfaces of a program: join, plan, interpolate, NC",
      "  burin cycle clock.nc -o clock.ngc --html report.html\n"
      "  burin cycle clock.nc --surfaces joined.json --json figures.json\n"
      "  burin cycle clock.nc --setpoints axes.npy --period 0.0005 --accel 3000 --jerk 30000\n"
      "  burin surfaces part.step -o part.nc && burin cycle part.nc --strict -o part.ngc\n",
      [args](Session& session) { return run_cycle(*args, session); });
  app.add_option("program", args->program, "program with G06.23, G106.1 and G106.2 blocks")
      ->required()
      ->type_name("PROGRAM");
  add_servo_options(app, args->limits);
  add_number(app, "--join", args->plan.join_mm, kPositiveLength,
             "edges this close are one edge (default 0.0001)");
  add_number(app, "--join-deviation", args->plan.join_deviation_mm, kLength,
             "largest bend that a forced partial join may bring (default: the tolerance)");
  add_choice<cycle::Along>(
      app, "--along", args->plan.along,
      {{"auto", cycle::Along::automatic}, {"u", cycle::Along::u}, {"v", cycle::Along::v}},
      "parameter that the paths run along");
  app.add_flag("--strict", args->plan.strict, "what is doubtful in the program is an error");
  add_text(app, "--surfaces", args->surfaces, "FILE", "the joined surfaces as JSON");
  add_text(app, "--setpoints", args->setpoints, "FILE", "one row a servo period, .csv or .npy");
  cli.add_tolerance(app);
  cli.add_dialect(app);
  cli.add_threads(app);
  cli.add_output(
      app,
      "NC program of lines and arcs (default, when nothing else is asked for: the program's name with .ngc)");
  cli.add_cl(app);
  cli.add_json(app);
  cli.add_html(app);
}

}  // namespace burin::cli
