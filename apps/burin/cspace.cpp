// SPDX-License-Identifier: Apache-2.0
// burin cspace: which tilts and yaws are free at one contact point of a `burin orient` job -> CSV, picture.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "burin/base/text.h"
#include "burin/plan/orient/orient.h"
#include "burin/view/cspace_picture.h"
#include "cli.h"
#include "commands.h"
#include "orient_setup.h"

namespace burin::cli {
namespace {

namespace fs = std::filesystem;
using geom::degrees;

struct Grid {
  int tilts = 90, yaws = 45;
};
struct CSpaceArgs {
  std::string job, csv, png;
  int path = 0, point = 0;
  Grid grid;
  std::optional<double> tolerance;
};

/// Nodes of a map: more than a picture shows and a table wants.
constexpr int kMostNodes = 2000;

Grid read_grid(const std::string& text) {
  const std::size_t x = text.find_first_of("xX");
  const auto part = [&](std::size_t from, std::size_t count) {
    return parse_integer(text.substr(from, count));
  };
  if (x != std::string::npos) {
    const auto a = part(0, x), b = part(x + 1, std::string::npos);
    if (a && b && *a >= 2 && *b >= 2 && *a <= kMostNodes && *b <= kMostNodes)
      return {static_cast<int>(*a), static_cast<int>(*b)};
  }
  throw CLI::ValidationError("--grid", "\"" + text + "\" is no grid (tilts x yaws, 2x2 to " +
                                           std::to_string(kMostNodes) + "x" + std::to_string(kMostNodes) +
                                           ", such as 90x45)");
}

const char* word_of(orient::Cause cause) {
  return cause == orient::Cause::none ? "feasible" : orient::word(cause);
}

std::string number(double value) {
  return std::isinf(value) ? "inf" : format_shortest(value);
}

std::string map_csv(const orient::CSpaceMap& map, const model::Mill& mill) {
  std::string text = "alpha_deg,beta_deg,cause,rho_mm\n";
  for (int i = 0; i < map.tilts; ++i) {
    for (int j = 0; j < map.yaws; ++j) {
      const orient::Angles at = map.node(i, j);
      text += number(degrees(at.alpha)) + "," + number(degrees(at.beta)) + "," + word_of(map.at(i, j)) + "," +
              number(orient::effective_radius(at, mill)) + "\n";
    }
  }
  return text;
}

/// The place of `number` among the paths; error (usage) that says which there are.
template <class Paths>
Result<std::size_t> find_path(const Paths& paths, int number) {
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (paths[i].number == number) return i;
  return Error{ErrorCode::usage,
               "--path " + std::to_string(number) + " is not there (" + std::to_string(paths.size()) +
                   " paths, " + std::to_string(paths.front().number) + " to " +
                   std::to_string(paths.back().number) + ")",
               {}};
}

/// The point asked for, with its angles as `burin orient` finds them along its path.
Result<orient::OrientedPoint> find_point(const CSpaceArgs& args, const OrientSetup& setup,
                                         const orient::Scene& scene, const orient::MachineLimits& limits,
                                         Session& session) {
  std::vector<orient::CcPath> contacts;
  if (!setup.contacts.empty()) {  // paths of a file are worked out on their own
    const auto at = find_path(setup.contacts, args.path);
    if (!at) return at.error();
    contacts = {setup.contacts[*at]};
  }
  const auto workers = session.workers();
  auto plan = orient::plan(setup.part, scene, limits, contacts, setup.machine_or_null(), setup.file.options,
                           *workers, session.diagnostics, session.progress());
  if (!plan) return plan.error();
  if (plan->paths.empty())
    return Error{ErrorCode::geometry, "the job has no contact points (faces that its paths cross)", {}};
  const auto at = find_path(plan->paths, args.path);
  if (!at) return at.error();
  const std::vector<orient::OrientedPoint>& points = plan->paths[*at].points;
  if (static_cast<std::size_t>(args.point) < points.size())
    return points[static_cast<std::size_t>(args.point)];
  return Error{ErrorCode::usage,
               "--point " + std::to_string(args.point) + " is not there (path " + std::to_string(args.path) +
                   " has " + std::to_string(points.size()) + " points, from 0)",
               {}};
}

void fill_report(const CSpaceArgs& args, const OrientSetup& setup, const orient::OrientedPoint& point,
                 const orient::CSpaceMap& map, Session& session) {
  const orient::OrientOptions& o = setup.file.options;
  std::size_t causes[5] = {};
  for (const orient::Cause cause : map.cells) ++causes[static_cast<std::size_t>(cause)];
  const auto count = [&](orient::Cause cause) { return causes[static_cast<std::size_t>(cause)]; };
  Report& r = session.report;
  r.parameters = {{"path", args.path},
                  {"point", args.point},
                  {"grid", {map.tilts, map.yaws}},
                  {"tilt_deg", {degrees(o.range.alpha_lo), degrees(o.range.alpha_hi)}},
                  {"yaw_deg", {degrees(o.range.beta_lo), degrees(o.range.beta_hi)}},
                  {"tolerance_mm", o.tolerance_mm},
                  {"clearance_mm", o.clearance_mm},
                  {"machine", setup.file.machine}};
  r.counts = {{"nodes", map.cells.size()},
              {"feasible", count(orient::Cause::none)},
              {"gouge", count(orient::Cause::gouge)},
              {"collision", count(orient::Cause::collision)},
              {"limit", count(orient::Cause::limit)}};
  const auto angles = [&](bool found, const orient::Angles& a, double rho) -> Json {
    if (!found) return nullptr;
    return {{"alpha_deg", degrees(a.alpha)},
            {"beta_deg", degrees(a.beta)},
            {"rho_mm", std::isfinite(rho) ? Json(rho) : Json("inf")}};
  };
  r.quality = {{"feasible_share", static_cast<double>(count(orient::Cause::none)) /
                                      static_cast<double>(std::max<std::size_t>(map.cells.size(), 1))},
               {"initial", angles(point.initial_found, point.initial, point.rho_initial)},
               {"optimum", angles(point.reachable, point.angles, point.rho)}};
}

Result<void> run_cspace(const CSpaceArgs& args, Session& session) {
  // Without an output the map goes to standard output.
  const Common& common = session.common;
  const bool nothing = args.csv.empty() && args.png.empty() && common.svg.empty() && common.json.empty();
  const std::string csv = nothing ? "-" : args.csv;
  for (const std::string& path : {csv, args.png}) {
    if (path.empty()) continue;
    if (auto ok = session.reserve_output(path); !ok) return ok;
  }
  auto setup = load_orient(args.job, args.tolerance, session);
  if (!setup) return setup.error();
  const orient::Scene scene = setup->scene();
  const orient::MachineLimits limits = setup->limits();
  auto point = find_point(args, *setup, scene, limits, session);
  session.end_progress();
  session.diagnostics.locate(args.job);
  if (!point) return in_file(point.error(), args.job);
  const model::Mill& mill = setup->file.mill;
  orient::Scene::Memory memory;
  const orient::CSpaceMap map = orient::make_map(orient::setting_of(scene, limits, setup->file.options),
                                                 point->cc, args.grid.tilts, args.grid.yaws, memory);
  fill_report(args, *setup, *point, map, session);
  view::CSpacePicture picture;
  picture.title = fs::path(args.job).stem().string() + ", path " + std::to_string(args.path) + ", point " +
                  std::to_string(args.point);
  picture.map = &map;
  picture.mill = &mill;
  if (point->initial_found) picture.marks.push_back({"initial", point->initial});
  if (point->reachable) picture.marks.push_back({"optimum", point->angles});
  if (auto ok = session.put_made(csv, [&] { return map_csv(map, mill); }); !ok) return ok;
  if (auto ok = session.put_made(args.png, [&] { return view::cspace_png(picture); }); !ok) return ok;
  return session.put_made(common.svg, [&] { return view::cspace_svg(picture); });
}

}  // namespace

void add_cspace(Cli& cli) {
  auto args = std::make_shared<CSpaceArgs>();
  CLI::App& app = cli.add_command(
      "cspace", "tilts and yaws that are free at one contact point, as picture and table",
      "  burin cspace blade.toml --path 3 --point 12 --png map.png\n"
      "  burin cspace blade.toml --path 0 --point 0 --grid 181x361 --csv map.csv\n"
      "\nThe job file is that of burin orient. Paths and points count from 0, as in its --points file. The "
      "picture\n"
      "shows what stands in the way (gouge, collision, limit), contours of the effective radius, and the "
      "initial\n"
      "and the chosen angles.\n",
      [args](Session& session) { return run_cspace(*args, session); });
  add_text(app, "JOB.toml", args->job, "FILE", "part, tool, operation and machine")->required();
  add_integer(app, "--path", args->path, 0, 100'000'000, "number of the path")->required();
  add_integer(app, "--point", args->point, 0, 100'000'000, "number of the contact point on it")->required();
  app.add_option_function<std::string>(
         "--grid", [args](const std::string& text) { args->grid = read_grid(text); },
         "nodes: tilts x yaws, ends included (default 90x45)")
      ->type_name("AxB");
  add_text(app, "--csv", args->csv, "FILE",
           "alpha_deg,beta_deg,cause,rho_mm of every node; - is standard output (default, when nothing is "
           "asked for)");
  add_text(app, "--png", args->png, "FILE", "picture of the map");
  add_number(app, "--tolerance", args->tolerance, kPositiveLength, "instead of the job's tolerance");
  cli.add_threads(app);
  cli.add_json(app);
  cli.add_svg(app);
}

}  // namespace burin::cli
