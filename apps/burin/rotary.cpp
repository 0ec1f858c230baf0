// SPDX-License-Identifier: Apache-2.0
// burin rotary: a rotational part and a ball-end mill -> 4-axis paths free of SSI, TSI and TAI -> CL, NC.
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "burin/base/text.h"
#include "burin/cl/apt.h"
#include "burin/job/rotary_job.h"
#include "burin/post/emit.h"
#include "burin/view/rotary_html.h"
#include "burin/view/rotary_scene.h"
#include "cli.h"
#include "commands.h"
#include "joint_options.h"

namespace burin::cli {
namespace {

namespace fs = std::filesystem;

struct RotaryArgs {
  std::string job, points, view;
  std::optional<double> tolerance;
  std::optional<rotary::Tsi> tsi;
  std::optional<rotary::Tai> tai;
  JointOptions joints;
};

const char* word(rotary::State state) {
  return state == rotary::State::ok ? "ok" : state == rotary::State::moved ? "moved" : "unreachable";
}
const char* word(rotary::Pattern pattern) {
  return pattern == rotary::Pattern::rings    ? "rings"
         : pattern == rotary::Pattern::spiral ? "spiral"
                                              : "lines";
}

// --- points.csv

/// lo:hi;lo:hi in degrees, lo in [-180, 180).
std::string reachable_text(const rotary::AngleSet& set) {
  std::string text;
  for (const rotary::AngleInterval& interval : set)
    text += (text.empty() ? "" : ";") + format_fixed(geom::degrees(interval.lo), 4) + ":" +
            format_fixed(geom::degrees(interval.hi), 4);
  return text;
}

std::string points_csv(const rotary::RotaryPlan& plan) {
  constexpr int kLength = 6, kUnit = 8, kAngle = 4;
  std::string text =
      "path,index,u,w,contact_x,contact_y,contact_z,normal_x,normal_y,normal_z,center_x,center_y,center_z,"
      "theta_deg,state,reachable\n";
  for (const rotary::RotaryPoint& point : plan.points) {
    const auto add = [&text](double value, int decimals) { text += format_fixed(value, decimals) + ","; };
    const rotary::Contact& c = point.place.contact;
    text += std::to_string(point.path) + "," + std::to_string(point.index) + ",";
    add(c.u, kUnit), add(c.w, kUnit);
    add(c.p.x, kLength), add(c.p.y, kLength), add(c.p.z, kLength);
    add(c.n.x, kUnit), add(c.n.y, kUnit), add(c.n.z, kUnit);
    add(point.place.center.x, kLength), add(point.place.center.y, kLength),
        add(point.place.center.z, kLength);
    add(geom::degrees(point.theta), kAngle);
    text += std::string(word(point.place.state)) + "," + reachable_text(point.reachable) + "\n";
  }
  return text;
}

// --- report

void fill_report(const job::RotaryJobFile& file, const job::RotaryJob& job, const post::NcText& nc,
                 const kinematics::Kinematics& machine, const std::optional<job::RotaryCheck>& check,
                 Session& session) {
  const rotary::RotaryOptions& o = file.options;
  const rotary::RotaryCounts& c = job.plan.counts;
  const rotary::RotaryQuality& q = job.plan.quality;
  Report& r = session.report;
  r.parameters = {{"pattern", word(o.pattern)},
                  {"tolerance_mm", o.tolerance_mm},
                  {"scallop_mm", o.side_step ? Json(nullptr) : Json(o.scallop)},
                  {"side_step_mm", o.side_step ? Json(*o.side_step) : Json(nullptr)},
                  {"tsi", o.tsi == rotary::Tsi::surface ? "surface" : "path"},
                  {"tai", o.tai == rotary::Tai::exact ? "exact" : "section"},
                  {"clearance_angle_deg", geom::degrees(o.clearance)},
                  {"lean_angle_deg", geom::degrees(o.lean)},
                  {"smooth", o.smooth},
                  {"feed_mm_min", o.feed_mm_min},
                  {"ball_radius_mm", file.tool.radius},
                  {"shank_radius_mm", file.tool.shank_radius},
                  {"shank_length_mm", file.tool.shank_length},
                  {"holder", pieces_json(file.tool.holder)},
                  {"machine", machine.machine().name},
                  {"dialect", session.common.dialect}};
  r.counts = {{"contact_points", c.contact_points},
              {"planned_contacts", c.planned_contacts},
              {"ssi_split", c.ssi_split},
              {"tsi", c.tsi},
              {"tai", c.tai},
              {"moved", c.moved},
              {"unreachable", c.unreachable},
              {"cl_points", c.cl_points},
              {"axis_reversals", c.axis_reversals},
              {"halving_points", c.halving_points},
              {"broken", c.broken},
              {"paths", job.plan.points.empty() ? 0 : job.plan.points.back().path + 1},
              {"triangles", job.part.mesh.triangles.size()},
              {"nc_blocks", nc.moves},
              {"feed_limited", job.joints.feed_limited}};
  r.quality = {{"ssi_max_mm", q.ssi_max_mm},
               {"gouge_max_mm", check ? check->report.gouge_max_mm() : q.gouge_max_mm},
               {"excess_max_mm", check ? check->report.excess_max_mm : q.excess_max_mm},
               {"axis_step_max_deg", geom::degrees(q.axis_step_max)},
               {"axis_turn_total_deg", geom::degrees(q.axis_turn_total)},
               {"scallop_mm", q.scallop_mm},
               {"side_step_min_mm", q.side_step_min_mm},
               {"side_step_max_mm", q.side_step_max_mm},
               {"gouge_planned_mm", q.gouge_max_mm},
               {"uncut_planned_mm", q.excess_max_mm}};
  if (check) {
    r.quality["gouge_ball_mm"] = check->report.ball.mm;
    r.quality["gouge_shank_mm"] = check->report.shank.mm;
    r.quality["gouge_holder_mm"] = check->report.holder.mm;
    r.quality["bound_mm"] = check->bound_mm;
  }
  r.lengths_mm = {{"cut", job.plan.lengths_mm.cut},
                  {"link", job.plan.lengths_mm.link},
                  {"rapid", job.plan.lengths_mm.rapid}};
  r.time_s["machining"] = 60 * kinematics::total_minutes(machine, job.joints.moves);
}

/// What the independent check found beyond the tolerance.
void warn_of_gouge(const job::RotaryJobFile& file, const job::RotaryCheck& check, Session& session) {
  const auto say = [&](const verify::Finding& found, const char* what) {
    if (found.mm <= file.options.tolerance_mm + check.bound_mm) return;
    session.diagnostics.add(
        {Severity::left_out,
         "gouge",
         std::string("the ") + what + " cuts " + format_fixed(found.mm, 4) + " mm into the part",
         {},
         std::array{found.at.x, found.at.y, found.at.z}});
  };
  say(check.report.ball, "ball");
  say(check.report.shank, "shank");
  say(check.report.holder, "holder");
}

view::RotaryPicture picture_of(const RotaryArgs& args, const job::RotaryJobFile& file,
                               const job::RotaryJob& job, const post::NcText& nc,
                               const kinematics::Kinematics& machine, const Session& session) {
  view::RotaryPicture picture;
  picture.title = fs::path(args.job).stem().string();
  picture.command_line = session.command_line;
  picture.part = &job.part;
  picture.plan = &job.plan;
  picture.tool = &file.tool;
  picture.options = &file.options;
  picture.diagnostics = &session.diagnostics;
  picture.nc_text = nc.text;
  picture.nc_line_to_record = nc.line_to_record;
  picture.program = &job.cl;
  picture.machine = &machine;
  const Report& r = session.report;
  const auto add = [&](const char* group, const std::string& name, std::string value) {
    picture.figures.push_back({group, name, std::move(value)});
  };
  for (const auto& [key, value] : r.counts.items()) add("Counts", key, value.dump());
  for (const auto& [key, value] : r.quality.items())
    add("Quality", key, format_fixed(value.get<double>(), 5));
  for (const auto& [key, value] : r.lengths_mm.items())
    add("Lengths", key, format_fixed(value.get<double>(), 1) + " mm");
  add("Time", "machining", format_fixed(r.time_s["machining"].get<double>(), 1) + " s");
  return picture;
}

// --- the run

Result<void> put_outputs(const RotaryArgs& args, const job::RotaryJobFile& file, const job::RotaryJob& job,
                         const post::NcText& nc, const kinematics::Kinematics& machine,
                         const std::string& nc_path, Session& session) {
  if (auto ok = session.put_made(nc_path, [&] { return nc.text; }); !ok) return ok;
  if (auto ok = session.put_made(args.points, [&] { return points_csv(job.plan); }); !ok) return ok;
  if (auto ok = session.put_made(session.common.cl, [&] { return cl::write_apt(job.cl); }); !ok) return ok;
  if (auto ok = session.put_made(session.common.svg,
                                 [&] { return view::rotary_svg(job.part, job.plan, file.tool); });
      !ok)
    return ok;
  if (session.common.html.empty() && args.view.empty()) return {};
  const view::RotaryPicture picture = picture_of(args, file, job, nc, machine, session);
  if (auto ok = session.put_made(session.common.html, [&] { return view::rotary_html(picture); }); !ok)
    return ok;
  if (args.view.empty()) return {};
  auto shown = view::rotary_scene(picture);
  if (!shown) return shown.error();
  auto page = view::viewer_page(*shown);
  if (!page) return page.error();
  return session.put(args.view, *std::move(page));
}

/// -o, or the job's name with .ngc when nothing else is asked for.
std::string nc_name(const RotaryArgs& args, const Common& c) {
  const bool nothing_else = args.points.empty() && c.cl.empty() && c.json.empty() && c.html.empty() &&
                            c.svg.empty() && args.view.empty();
  if (!c.output.empty() || !nothing_else) return c.output;
  return fs::path(args.job).replace_extension(".ngc").string();
}

Result<kinematics::Kinematics> machine_of(const job::RotaryJobFile& file, const fs::path& folder) {
  // A machine file stands beside the job, a preset has no ending.
  const std::string name =
      fs::path(file.machine).extension() == ".toml" ? (folder / file.machine).string() : file.machine;
  auto machine = model::find_machine(name);
  if (!machine) return machine.error();
  return kinematics::Kinematics::make(*machine);
}

Result<void> run_rotary(const RotaryArgs& args, Session& session) {
  auto dialect = post::find_dialect(session.common.dialect);
  if (!dialect) return dialect.error();
  auto text = session.read_input(args.job);
  if (!text) return text.error();
  const std::string nc_path = nc_name(args, session.common);
  for (const std::string& path : {nc_path, args.points, args.view}) {
    if (path.empty() || path == session.common.output) continue;  // -o is reserved already
    if (auto ok = session.reserve_output(path); !ok) return ok;
  }
  auto file = job::read_rotary_job(*text, args.job);
  if (!file) return file.error();
  if (args.tolerance) file->options.tolerance_mm = *args.tolerance;
  if (args.tsi) file->options.tsi = *args.tsi;
  if (args.tai) file->options.tai = *args.tai;
  file->options.threads = static_cast<unsigned>(session.common.threads);
  const fs::path folder = fs::path(args.job).parent_path();
  auto machine = machine_of(*file, folder);
  if (!machine) return machine.error();
  const auto read = [&session](const std::string& path) { return session.read_input(path); };
  auto job = job::make_rotary_job(*file, *machine, fs::path(args.job).stem().string(), folder.string(), read,
                                  session.diagnostics, session.progress());
  session.end_progress();
  session.diagnostics.locate(args.job);
  if (!job) return in_file(job.error(), args.job);
  report_joints(job->joints, session);
  post::JointEmitOptions emit;
  emit.write_z = true;
  emit.feed = args.joints.feed;
  auto nc = post::emit_joints(job->cl, *machine, job->joints, *dialect, emit, session.diagnostics);
  if (!nc) return in_file(nc.error(), args.job);
  std::optional<job::RotaryCheck> check;
  if (!session.common.json.empty() || !session.common.html.empty() || !args.view.empty())
    check = job::check_rotary_job(*file, *job, *machine);
  if (check) warn_of_gouge(*file, *check, session);
  fill_report(*file, *job, *nc, *machine, check, session);
  return put_outputs(args, *file, *job, *nc, *machine, nc_path, session);
}

}  // namespace

void add_rotary(Cli& cli) {
  auto args = std::make_shared<RotaryArgs>();
  CLI::App& app = cli.add_command(
      "rotary", "finish a rotational part on a 4-axis mill, free of interference",
      "  burin rotary cutter.toml -o cutter.ngc --html report.html\n"
      "  burin rotary cutter.toml --points points.csv --json figures.json\n"
      "  burin rotary cam.toml --cl cam.cl --feed-mode per-minute --dialect fanuc -o cam.nc\n"
      "\nA job file (paths are relative to it; mm, degrees):\n"
      "  [part]                        # X is the rotary axis; drawing x, y become y, z\n"
      "  section = \"section.dxf\"       # one closed curve around 0, 0; or sections = [{ file, x }, ...],\n"
      "  length = 50.0                 # surface = \"part.step\", mesh = \"part.stl\" in place of these "
      "three\n"
      "  twist = 180.0                 # or stations = [[x, degrees], ...] in place of length and twist\n"
      "  [tool]\n"
      "  kind = \"ball\"\n"
      "  radius = 2.0                  # also: shank_radius\n"
      "  shank_length = 60.0           # from the ball's centre to the holder\n"
      "  holder = [{ radius = 20.0, height = 50.0 }]\n"
      "  [operation]\n"
      "  pattern = \"rings\"             # rings, spiral, lines\n"
      "  tolerance = 0.01\n"
      "  scallop = 0.05                # or side_step\n"
      "  feed = 600.0                  # mm/min of the tip on the part\n"
      "  # also: tsi, tai, clearance_angle, lean_angle, smooth, safety, spindle; [stock] radius\n"
      "  [machine]\n"
      "  name = \"xyza\"                 # a preset or a file NAME.toml\n"
      "\nExit code 3: done, but places were not reached or are wrong; each is listed.\n",
      [args](Session& session) { return run_rotary(*args, session); });
  add_text(app, "JOB.toml", args->job, "FILE", "part, tool, operation and machine")->required();
  add_text(app, "--points", args->points, "FILE", "contact points, axes and reachable angles as CSV");
  add_text(app, "--view", args->view, "FILE",
           "the path in the viewer's page: played, with the reachable axes");
  add_feed_mode(app, args->joints, "");
  add_choice<std::optional<rotary::Tsi>>(
      app, "--tsi", args->tsi, {{"surface", rotary::Tsi::surface}, {"path", rotary::Tsi::path}},
      "where the ball fits: against the whole part, or along the path as in "
      "the paper; instead of the job's");
  add_choice<std::optional<rotary::Tai>>(
      app, "--tai", args->tai, {{"exact", rotary::Tai::exact}, {"section", rotary::Tai::section}},
      "reachable axes: against the whole part, or in the section as in the "
      "paper; instead of the job's");
  add_number(app, "--tolerance", args->tolerance, kPositiveLength, "instead of the job's tolerance");
  cli.add_dialect(app);
  cli.add_threads(app);
  cli.add_output(app, "NC program (default, when nothing else is asked for: the job's name with .ngc)");
  cli.add_cl(app);
  cli.add_json(app);
  cli.add_html(app);
  cli.add_svg(app);
}

}  // namespace burin::cli
