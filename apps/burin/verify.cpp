// SPDX-License-Identifier: Apache-2.0
// burin verify: what a tool path does to a design, found without the planners.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "burin/io/stl/stl.h"
#include "burin/job/verify_job.h"
#include "burin/view/verify_scene.h"
#include "cli.h"
#include "commands.h"
#include "layer_options.h"
#include "verify_report.h"

namespace burin::cli {
namespace {

struct VerifyArgs {
  job::VerifyOptions options;
  VerifyLimits limits;
  std::string machine, stock, csv, stl;
  std::optional<int> samples;
  std::vector<std::string> layers;
};

Result<job::VerifyOptions> options_of(const VerifyArgs& args, const Session& session) {
  job::VerifyOptions options = args.options;
  if (!args.machine.empty()) options.machine = args.machine;
  if (!args.stock.empty()) options.stock = args.stock;
  if (args.samples) options.samples = static_cast<std::size_t>(*args.samples);
  options.threads = static_cast<unsigned>(session.common.threads);
  options.keep_times = !session.common.html.empty();
  auto layers = parse_layers(args.layers);
  if (!layers) return layers.error();
  options.laser.layers = std::move(*layers);
  return options;
}

Result<std::string> page_of(const VerifyArgs& args, const job::VerifyInput& input,
                            const job::VerifyResult& result, const Session& session) {
  const auto name = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  view::VerifySceneOptions options;
  options.title = name(args.options.design) + ", " + name(args.options.path);
  options.command_line = session.command_line;
  options.program_name = name(args.options.path);
  auto scene = view::verify_scene(input, &result, &session.diagnostics, options);
  if (!scene) return scene.error();
  return view::viewer_page(*scene);
}

Result<void> put_outputs(const VerifyArgs& args, const job::VerifyInput& input,
                         const job::VerifyResult& result, Session& session) {
  if (auto ok = session.put_made(args.csv, [&] { return verify_csv(result); }); !ok) return ok;
  if (!args.stl.empty()) {
    if (!result.removal)
      return Error{ErrorCode::usage, "--stl: there is no stock (--stock, or [stock] in the job)", {}};
    if (auto ok = session.put(args.stl, io::write_stl(result.removal->mesh())); !ok) return ok;
  }
  if (session.common.html.empty()) return {};
  auto page = page_of(args, input, result, session);
  if (!page) return page.error();
  return session.put(session.common.html, *std::move(page));
}

Result<void> run_verify_command(const VerifyArgs& args, Session& session) {
  for (const std::string& path : {args.csv, args.stl})
    if (!path.empty())
      if (auto ok = session.reserve_output(path); !ok) return ok;
  auto options = options_of(args, session);
  if (!options) return options.error();
  const auto read = [&session](const std::string& path) { return session.read_input(path); };
  auto input = job::read_verify_input(*options, read, session.diagnostics, session.progress());
  if (!input) return input.error();
  if (!args.stl.empty() && !input->stock)
    return Error{ErrorCode::usage, "--stl: there is no stock (--stock, or [stock] in the job)", {}};
  auto result = job::run_verify(*input, *options, session.diagnostics, session.progress());
  if (!result) return result.error();
  fill_verify_report(*options, *input, *result, session);
  judge_verify(*input, *result, args.limits, session);
  session.print(verify_summary(*input, *result));
  return put_outputs(args, *input, *result, session);
}

void add_inputs(CLI::App& app, VerifyArgs& args) {
  job::VerifyOptions& o = args.options;
  add_text(app, "DESIGN", o.design, "FILE",
           "job file (rotary, orient, or any with [part]), STEP, IGES, STL, surface program, DXF or SVG")
      ->required();
  add_text(app, "--path", o.path, "FILE", "tool path: APT CL data or NC, told by content")->required();
  add_text(app, "--machine", args.machine, "NAME",
           "a preset or a file NAME.toml, instead of the job's: NC with rotary axes needs one");
  CLI::Option* tcp =
      app.add_flag("--tcp", o.tcp,
                   "CL data as tool-centre-point control runs them: tip straight, axis along the "
                   "great circle (default but for rotary jobs)");
  app.add_flag("--joints", o.joints, "CL data as joint moves of the machine")->excludes(tcp);
  add_number(app, "--tool-diameter", o.tool_diameter, kPositiveLength,
             "instead of the job's and of CUTTER/ in CL data");
  add_number(app, "--tool-corner", o.tool_corner, kLength, "corner radius; half the diameter is a ball");
  add_number(app, "--tool-length", o.tool_length, kPositiveLength, "of the cutter, from the tip");
  add_text(app, "--stock", args.stock, "STOCK",
           "block or cylinder 1 mm larger than the part, or a closed STL file; instead of the job's [stock]");
  add_number(app, "--resolution", o.resolution_mm, kPositiveLength,
             "of the stock (default: 1/200 of its longest side)");
  add_number(app, "--kerf", o.kerf_mm, kPositiveLength, "laser: width of the cut");
  add_layers(app, args.layers);
  add_drawing(app, o.laser.side, o.laser.units, o.laser.join_mm);
}

}  // namespace

void add_verify(Cli& cli) {
  auto args = std::make_shared<VerifyArgs>();
  CLI::App& app = cli.add_command(
      "verify", "what a tool path does to a part: gouge, excess, collisions, with the error of the check",
      "  burin verify blade.toml --path blade.cl --json blade.json\n"
      "  burin verify blade.toml --path blade.ngc --max-gouge 0.01 --max-excess 0.06\n"
      "  burin verify part.step --path part.nc --tool-diameter 6 --tool-corner 3 --csv part.csv\n"
      "  burin verify part.stl --path five.ngc --machine xyzbc-trunnion --tool-diameter 10 --stock block "
      "--stl left.stl\n"
      "  burin verify clock.nc --path clock.ngc --html clock.html\n"
      "  burin verify plate.dxf --kerf 0.2 --path plate.ngc\n"
      "\nGouge: how far below the surface material is gone. Excess: how far above it material is left. Both "
      "along\n"
      "its normal, over the whole motion. Any job file will do: of it [part], [tool] (or several [[tools]] "
      "with\n"
      "number), [operation] tolerance, [machine] and [stock] are read.\n"
      "\nExit code 1: also when --max-gouge or --max-excess is passed (reports are written all the same);\n"
      "3: collisions, or places that nothing machines.\n",
      [args](Session& session) { return run_verify_command(*args, session); });
  job::VerifyOptions& o = args->options;
  add_inputs(app, *args);
  add_number(app, "--max-gouge", args->limits.gouge_mm, kLength, "a deeper gouge is a failure");
  add_number(app, "--max-excess", args->limits.excess_mm, kLength, "more excess is a failure");
  add_number(app, "--tolerance", o.tolerance_mm, kPositiveLength,
             "what areas count above, and how near triangles follow faces; instead of the job's");
  add_number(app, "--reach", o.reach_mm, kPositiveLength,
             "where nothing is cut within it, the part is not machined (default 5)");
  CLI::Option* spacing =
      add_number(app, "--spacing", o.spacing_mm, kPositiveLength, "distance of the samples on the surface");
  add_integer(app, "--samples", args->samples, 1, 2'000'000'000, "about so many samples instead")
      ->excludes(spacing);
  add_text(app, "--csv", args->csv, "FILE", "samples as x,y,z,nx,ny,nz,deviation_mm (negative: gouge)");
  add_text(app, "--stl", args->stl, "FILE", "what is left of the stock");
  cli.add_threads(app);
  cli.add_json(app);
  cli.add_html(app);
}

}  // namespace burin::cli
