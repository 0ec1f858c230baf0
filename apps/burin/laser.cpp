// SPDX-License-Identifier: Apache-2.0
// burin laser: drawing -> kerf -> offset -> NC.
#include "burin/plan/laser/laser.h"

#include <filesystem>
#include <memory>
#include <string>

#include "burin/base/text.h"
#include "burin/cl/apt.h"
#include "burin/job/verify_laser.h"
#include "burin/model/kerf.h"
#include "burin/post/emit.h"
#include "burin/view/picture.h"
#include "cli.h"
#include "commands.h"
#include "kerf_options.h"
#include "layer_options.h"

namespace burin::cli {
namespace {

namespace fs = std::filesystem;

struct LaserArgs {
  std::string drawing;
  // kerf
  KerfOptions model;
  std::optional<double> kerf_mm, offset_mm;
  // drawing
  io::Units units = io::Units::from_file;
  std::vector<std::string> layers;
  // plan
  laser::LaserOptions plan;
  std::string copies;
  bool no_arcs = false;
};

struct Kerf {
  double kerf_mm = 0, offset_mm = 0;
  std::optional<model::KerfPrediction> prediction;
};

Error usage(std::string message) {
  return {ErrorCode::usage, std::move(message), {}};
}

// --- kerf
// -----------------------------------------------------------------------------------------------------

Result<Kerf> predict_kerf(const LaserArgs& args, Session& session) {
  if (!args.model.thickness_mm || !args.model.power_w || !args.model.speed_mm_min) {
    return usage("the kerf is not known (--thickness, --power and --speed together, or --kerf, or --offset)");
  }
  auto database = open_database(args.model, session);
  if (!database) return database.error();
  auto prediction = database->predict(to_query(args.model));
  if (!prediction) return prediction.error();
  warn(*prediction, session.diagnostics);
  return Kerf{prediction->kerf_mm, prediction->offset_mm, *prediction};
}

Result<Kerf> kerf_of(const LaserArgs& args, Session& session) {
  if (args.kerf_mm && args.offset_mm)
    return usage("--kerf and --offset say the same thing twice (one of them)");
  if (args.kerf_mm) return Kerf{*args.kerf_mm, 0.5 * *args.kerf_mm, std::nullopt};
  if (args.offset_mm) return Kerf{2 * std::abs(*args.offset_mm), *args.offset_mm, std::nullopt};
  if (args.plan.side == laser::Side::on && !args.model.thickness_mm) return Kerf{};
  return predict_kerf(args, session);
}

// --- drawing
// --------------------------------------------------------------------------------------------------

Result<io::Drawing> read_drawing(const LaserArgs& args, Session& session) {
  auto bytes = session.read_input(args.drawing);
  if (!bytes) return bytes.error();
  return job::read_drawing(*bytes, args.drawing, args.units, session.diagnostics);
}

Result<void> parse_copies(const std::string& text, laser::CopyOptions& copies) {
  if (text.empty()) return {};
  const std::string lower = to_lower(text);
  const std::size_t x = lower.find('x');
  const auto columns = parse_integer(std::string_view(lower).substr(0, x));
  const auto rows = x == std::string::npos ? std::optional<long long>(1)
                                           : parse_integer(std::string_view(lower).substr(x + 1));
  if (!columns || !rows || *columns < 1 || *rows < 1 || *columns > 10000 || *rows > 10000) {
    return usage("--copies: " + text + " is not understood (COLUMNSxROWS, such as 3x2)");
  }
  copies.columns = static_cast<int>(*columns);
  copies.rows = static_cast<int>(*rows);
  return {};
}

// --- report
// ---------------------------------------------------------------------------------------------------

Json model_json(const Kerf& kerf) {
  if (!kerf.prediction) return nullptr;
  Json json = to_json(kerf.prediction->model);
  json["permissible"] = kerf.prediction->permissible;  // of this setting, in place of the ranges
  json["interpolated"] = kerf.prediction->interpolated;
  return json;
}

template <class T>
std::string word_of(T value, std::initializer_list<std::pair<T, const char*>> words) {
  for (const auto& [key, word] : words) {
    if (key == value) return word;
  }
  return "";
}

std::string side_word(laser::Side s) {
  return word_of(s, {{laser::Side::automatic, "auto"},
                     {laser::Side::outside, "outside"},
                     {laser::Side::inside, "inside"},
                     {laser::Side::on, "on"}});
}
std::string corner_word(laser::Corners c) {
  return word_of(c, {{laser::Corners::round, "round"},
                     {laser::Corners::loop, "loop"},
                     {laser::Corners::slow, "slow"},
                     {laser::Corners::power, "power"}});
}
std::string lead_word(laser::LeadKind k) {
  return word_of(
      k, {{laser::LeadKind::arc, "arc"}, {laser::LeadKind::line, "line"}, {laser::LeadKind::none, "none"}});
}

void fill_parameters(const Kerf& kerf, const io::Drawing& drawing, const laser::LaserOptions& plan,
                     Session& session) {
  const std::string fit = plan.fit == geom::FitMethod::minimal ? "minimal" : "bisect";
  session.report.parameters = {{"kerf_mm", kerf.kerf_mm},
                               {"offset_mm", kerf.offset_mm},
                               {"kerf_model", model_json(kerf)},
                               {"side", side_word(plan.side)},
                               {"tolerance_mm", plan.tolerance.path_mm},
                               {"join_mm", plan.tolerance.join_mm},
                               {"fit", fit},
                               {"corners", corner_word(plan.corners.kind)},
                               {"lead", lead_word(plan.lead.kind)},
                               {"lead_length_mm", plan.lead.length_mm},
                               {"order", plan.order == laser::Order::inner_first ? "inner-first" : "file"},
                               {"arcs", plan.arcs},
                               {"feed_mm_min", plan.feed_mm_min},
                               {"power_w", plan.power_w},
                               {"dialect", session.common.dialect},
                               {"mm_per_unit", drawing.mm_per_unit},
                               {"units", drawing.units_reason},
                               {"columns", plan.copies.columns},
                               {"rows", plan.copies.rows}};
}

struct PathCounts {
  std::size_t arcs = 0, lines = 0;
};
/// Arcs and lines of the offset contours; without arcs, the chords that went out.
PathCounts path_counts(const laser::LaserJob& job, const laser::LaserOptions& plan) {
  PathCounts n;
  if (!plan.arcs) {
    for (const laser::MoveKind kind : job.toolpath.kind) n.lines += kind == laser::MoveKind::cut;
    return n;
  }
  for (const laser::CutPath& path : job.profile.paths) {
    for (const geom::Segment& s : path.spline.segments) ++(s.is_line() ? n.lines : n.arcs);
  }
  return n;
}

void fill_report(const Kerf& kerf, const io::Drawing& drawing, const laser::LaserOptions& plan,
                 const laser::LaserJob& job, Session& session) {
  fill_parameters(kerf, drawing, plan, session);
  std::size_t outer = 0, holes = 0, open = 0, engraved = 0;
  for (const laser::Outline& o : job.profile.outlines) {
    outer += o.role == laser::Role::outer;
    holes += o.role == laser::Role::hole;
    open += o.role == laser::Role::open;
    engraved += o.role == laser::Role::engrave;
  }
  const PathCounts n = path_counts(job, plan);
  session.report.counts = {{"entities", drawing.entities.size()},
                           {"contours", outer + holes + open},
                           {"outer", outer},
                           {"holes", holes},
                           {"open", open},
                           {"engraved", engraved},
                           {"paths", job.profile.paths.size()},
                           {"arcs", n.arcs},
                           {"lines", n.lines},
                           {"fitted_segments", job.profile.fitted_segments},
                           {"pierces", job.toolpath.pierces.size()}};
  session.report.lengths_mm = {
      {"cut", job.toolpath.cut_mm}, {"rapid", job.toolpath.rapid_mm}, {"lead", job.toolpath.lead_mm}};
  session.report.time_s = {{"machining", job.toolpath.machining_s}};
  // Chords may take the half of the tolerance that the fit left them (profile.cpp).
  const double chord = plan.arcs ? 0.0 : 0.5 * plan.tolerance.path_mm;
  session.report.quality = {{"max_deviation_mm", job.profile.max_deviation_mm + chord},
                            {"g1_breaks", job.profile.g1_breaks}};
  Json ignored = Json::object();
  for (const auto& [kind, count] : drawing.ignored) ignored[kind] = count;
  session.report.extra["ignored"] = ignored;
}

std::vector<view::LaserPicture::Figure> figures(const Kerf& kerf, const laser::LaserJob& job,
                                                const Session& session) {
  const Report& r = session.report;
  std::vector<view::LaserPicture::Figure> rows;
  const auto add = [&](const char* group, const char* name, std::string value) {
    rows.push_back({group, name, std::move(value)});
  };
  const auto mm = [](double v) { return format_fixed(v, 4) + " mm"; };
  add("Process", "kerf", mm(kerf.kerf_mm));
  add("Process", "offset", mm(kerf.offset_mm));
  if (kerf.prediction) {
    const model::KerfModel& m = kerf.prediction->model;
    add("Process", "kerf model",
        m.laser + ", " + m.material + ", " + format_fixed(m.thickness_mm, 3) + " mm, version " +
            std::to_string(m.version));
    add("Process", "source", m.source);
  }
  add("Process", "feed", format_fixed(r.parameters["feed_mm_min"].get<double>(), 1) + " mm/min");
  add("Process", "power", format_fixed(r.parameters["power_w"].get<double>(), 1) + " W");
  add("Process", "corners", r.parameters["corners"].get<std::string>());
  for (const auto& [key, value] : r.counts.items()) add("Counts", key.c_str(), value.dump());
  add("Lengths", "cut", format_fixed(job.toolpath.cut_mm, 1) + " mm");
  add("Lengths", "rapid", format_fixed(job.toolpath.rapid_mm, 1) + " mm");
  add("Lengths", "lead", format_fixed(job.toolpath.lead_mm, 1) + " mm");
  add("Time", "estimated machining", format_fixed(job.toolpath.machining_s, 1) + " s");
  add("Quality", "tolerance", mm(r.parameters["tolerance_mm"].get<double>()));
  add("Quality", "deviation, certified bound",
      format_fixed(r.quality["max_deviation_mm"].get<double>(), 6) + " mm");
  add("Quality", "breaks in smooth pieces", r.quality["g1_breaks"].dump());
  return rows;
}

// --- the run
// --------------------------------------------------------------------------------------------------

Result<laser::LaserOptions> plan_options(const LaserArgs& args, const Kerf& kerf, Session& session) {
  laser::LaserOptions plan = args.plan;
  plan.offset_mm = kerf.offset_mm;
  plan.arcs = !args.no_arcs;
  plan.tolerance.path_mm = session.common.tolerance_mm;
  plan.power_w = args.model.power_w.value_or(0);
  if (args.model.speed_mm_min) {
    plan.feed_mm_min = *args.model.speed_mm_min;
  } else {
    plan.feed_mm_min = 1000;
    session.diagnostics.info("default_feed", "no --speed given: 1000 mm/min is used");
  }
  auto layers = parse_layers(args.layers);
  if (!layers) return layers.error();
  plan.layers = std::move(*layers);
  if (auto ok = parse_copies(args.copies, plan.copies); !ok) return ok.error();
  return plan;
}

Result<void> put_outputs(const io::Drawing& drawing, const Kerf& kerf, const laser::LaserJob& job,
                         const post::NcText& nc, const std::string& nc_path, Session& session) {
  if (auto ok = session.put(nc_path, nc.text); !ok) return ok;
  if (!session.common.cl.empty()) {
    if (auto ok = session.put(session.common.cl, cl::write_apt(job.toolpath.program)); !ok) return ok;
  }
  view::LaserPicture picture;
  picture.profile = &job.profile;
  picture.toolpath = &job.toolpath;
  picture.drawing = &drawing;
  picture.kerf_mm = kerf.kerf_mm;
  picture.title = job.toolpath.program.name;
  picture.command_line = session.command_line;
  picture.nc_text = nc.text;
  picture.nc_line_to_record = nc.line_to_record;
  picture.diagnostics = &session.diagnostics;
  picture.figures = figures(kerf, job, session);
  if (!session.common.svg.empty()) {
    if (auto ok = session.put(session.common.svg, view::laser_svg(picture)); !ok) return ok;
  }
  if (!session.common.html.empty()) {
    if (auto ok = session.put(session.common.html, view::laser_html(picture)); !ok) return ok;
  }
  return {};
}

Result<void> run_laser(const LaserArgs& args, Session& session) {
  const std::string nc_path = session.common.output.empty()
                                  ? fs::path(args.drawing).replace_extension(".ngc").string()
                                  : session.common.output;
  auto dialect = post::find_dialect(session.common.dialect);
  if (!dialect) return dialect.error();
  auto kerf = kerf_of(args, session);
  if (!kerf) return kerf.error();
  auto plan = plan_options(args, *kerf, session);
  if (!plan) return plan.error();
  auto drawing = read_drawing(args, session);
  if (!drawing) return drawing.error();
  // A name given with -o is reserved already.
  if (session.common.output.empty()) {
    if (auto ok = session.reserve_output(nc_path); !ok) return ok;
  }

  auto job = laser::plan_laser(*drawing, *plan, session.diagnostics, session.progress());
  session.end_progress();
  session.diagnostics.locate(args.drawing);
  if (!job) return in_file(job.error(), args.drawing);
  job->toolpath.program.name = fs::path(args.drawing).stem().string();
  auto nc = post::emit(job->toolpath.program, *dialect, {}, session.diagnostics);
  if (!nc) return in_file(nc.error(), args.drawing);
  fill_report(*kerf, *drawing, *plan, *job, session);
  return put_outputs(*drawing, *kerf, *job, *nc, nc_path, session);
}

void add_kerf_options(CLI::App& app, LaserArgs& a) {
  add_kerf_model(app, a.model);
  add_power(app, a.model);
  add_speed(app, a.model);
  add_force(app, a.model);
  add_number(app, "--kerf", a.kerf_mm, kLength, "width of the cut, instead of a prediction");
  add_number(app, "--offset", a.offset_mm, kSignedLength,
             "offset of the beam from the outline; negative: the other side");
}

void add_plan_options(CLI::App& app, LaserArgs& a) {
  laser::LaserOptions& p = a.plan;
  add_drawing(app, p.side, a.units, p.tolerance.join_mm);
  add_choice<geom::FitMethod>(app, "--fit", p.fit,
                              {{"minimal", geom::FitMethod::minimal}, {"bisect", geom::FitMethod::bisect}},
                              "fewest arcs, or the paper's bisection");
  add_choice<laser::Corners>(app, "--corners", p.corners.kind,
                             {{"round", laser::Corners::round},
                              {"loop", laser::Corners::loop},
                              {"slow", laser::Corners::slow},
                              {"power", laser::Corners::power}},
                             "what happens at sharp corners");
  add_choice<laser::LeadKind>(
      app, "--lead", p.lead.kind,
      {{"arc", laser::LeadKind::arc}, {"line", laser::LeadKind::line}, {"none", laser::LeadKind::none}},
      "how the beam comes to the contour");
  add_number(app, "--lead-length", p.lead.length_mm, kPositiveLength, "length of the lead-in (default 2)");
  add_number(app, "--lead-out", p.lead.out_mm, kLength, "length of a lead-out (default 0)");
  add_choice<laser::Order>(app, "--order", p.order,
                           {{"inner-first", laser::Order::inner_first}, {"file", laser::Order::file}},
                           "cutting order");
  add_choice<laser::Direction>(app, "--direction", p.direction,
                               {{"auto", laser::Direction::automatic},
                                {"climb", laser::Direction::climb},
                                {"conventional", laser::Direction::conventional}},
                               "cutting direction");
  add_layers(app, a.layers);
  app.add_flag("--no-arcs", a.no_arcs, "lines only, chords within the tolerance");
  add_number(app, "--overcut", p.overcut_mm, kLength, "cut on past the start of a closed contour");
  add_integer(app, "--micro-joints", p.micro_joints.per_contour, 0, 1000, "bridges left per closed contour");
  add_number(app, "--joint-width", p.micro_joints.width_mm, kPositiveLength,
             "width of a bridge (default 0.3)");
  add_text(app, "--copies", a.copies, "CxR", "columns x rows of copies");
  add_number(app, "--copy-gap", p.copies.gap_mm, kLength, "distance between copies (default 5)");
  add_number(app, "--corner-angle", p.corners.angle_deg, kAngle,
             "corners that turn by more are sharp (default 30)");
  add_number(app, "--engrave-power", p.engrave_power_factor, kFactor,
             "power of engraving, as a part of --power (default 0.2)");
  add_number(app, "--acceleration", p.motion.acceleration_mm_s2,
             {"MM/S2", "an acceleration above 0", 0, 1e7, true},
             "of the machine, for the time estimate (default 3000)");
  add_number(app, "--rapid", p.motion.rapid_mm_min, kSpeed,
             "rapid speed, for the time estimate (default 20000)");
}

}  // namespace

void add_laser(Cli& cli) {
  auto args = std::make_shared<LaserArgs>();
  CLI::App& app = cli.add_command(
      "laser", "cut a DXF or SVG drawing to size: kerf, offset, order, leads, NC",
      "  burin laser part.dxf --thickness 2.0 --power 1800 --speed 4000\n"
      "  burin laser part.dxf --kerf 0.4 --speed 3000 --html report.html\n"
      "  burin laser panel.svg --kerf 0.2 --dialect grbl -o panel.gcode --layers "
      "'MARK=engrave,#0000ff=ignore'\n"
      "  burin laser part.dxf --offset 0.28 --lead none --order file --tolerance 0.001 -o -\n",
      [args](Session& session) { return run_laser(*args, session); });
  app.add_option("drawing", args->drawing, "drawing, .dxf or .svg")->required()->type_name("PART");
  add_kerf_options(app, *args);
  add_plan_options(app, *args);
  cli.add_tolerance(app);
  cli.add_dialect(app);
  cli.add_threads(app);
  cli.add_output(app, "NC program (default: the drawing's name with .ngc)");
  cli.add_cl(app);
  cli.add_json(app);
  cli.add_svg(app);
  cli.add_html(app);
}

}  // namespace burin::cli
