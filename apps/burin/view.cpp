// SPDX-License-Identifier: Apache-2.0
// burin view: one HTML file that shows and plays tool paths and reports.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "burin/view/scene.h"
#include "cli.h"
#include "commands.h"
#include "serve.h"
#include "view_files.h"

namespace burin::cli {
namespace {

struct ViewArgs {
  std::vector<std::string> files;
  ViewOptions options;
  bool serve = false;
  int port = 0;
};

/// Larger scenes than one file should hold are no matter here.
Result<void> serve_view(const ViewArgs& args, const view::Scene& scene) {
  Served served;
  served.page = view::viewer_shell(scene.title);
  auto bytes = view::scene_bytes(scene);
  if (!bytes) return bytes.error();
  served.scene = *std::move(bytes);
  return serve(served, args.port, [](const std::string& url) {
    std::fprintf(stdout, "%s\n", url.c_str());
    std::fflush(stdout);
  });
}

Result<void> run_view(const ViewArgs& args, Session& session) {
  if (args.serve == !session.common.output.empty())
    return Error{ErrorCode::usage, "one place for the page is needed (-o FILE.html, or --serve)", {}};
  auto scene = scene_of_files(args.files, args.options, session);
  if (!scene) return scene.error();
  if (args.serve) return serve_view(args, *scene);
  auto page = view::viewer_page(*scene);
  if (!page) return page.error();
  return session.put(session.common.output, *std::move(page));
}

}  // namespace

void add_view(Cli& cli) {
  auto args = std::make_shared<ViewArgs>();
  CLI::App& app = cli.add_command(
      "view", "one page that shows and plays tool paths, parts and reports",
      "  burin view path.cl -o path.html\n"
      "  burin view blade.toml blade.ngc --verify --stock block -o blade.html\n"
      "  burin view part.step path.nc --machine xyzac-trunnion -o path.html\n"
      "  burin view part.dxf part.ngc --kerf 0.28 --verify -o part.html\n"
      "  burin view --serve large.cl\n"
      "\nThe page is one file and needs no network. Files are told by their content: at most one tool path "
      "(CL or\n"
      "NC), parts (job files, STEP, IGES, STL, surface programs), drawings (DXF, SVG) and reports of burin "
      "(JSON).\n",
      [args](Session& session) { return run_view(*args, session); });
  job::VerifyOptions& check = args->options.check;
  app.add_option("FILE", args->files, "tool path, parts, drawings, reports")->required()->type_name("FILE");
  add_text(app, "--machine", args->options.machine, "NAME",
           "a preset or a file NAME.toml: rotary words of NC programs, turning table, speeds of rapids");
  app.add_flag("--verify", args->options.verify,
               "measure what the path leaves of the part and show it (as burin verify does)");
  add_text(app, "--stock", args->options.stock, "STOCK",
           "show the stock being cut: block or cylinder 1 mm larger than the part, or a closed STL file");
  add_number(app, "--resolution", check.resolution_mm, kPositiveLength,
             "of the stock (default: 1/200 of its longest side)");
  add_number(app, "--tool-diameter", check.tool_diameter, kPositiveLength,
             "instead of the job's and of CUTTER/ in CL data");
  add_number(app, "--tool-corner", check.tool_corner, kLength, "corner radius; half the diameter is a ball");
  add_number(app, "--tool-length", check.tool_length, kPositiveLength, "of the cutter, from the tip");
  add_number(app, "--kerf", check.kerf_mm, kPositiveLength, "width of the cut of a beam");
  app.add_flag("--serve", args->serve, "show the page at a local address until Ctrl-C; nothing is written");
  add_integer(app, "--port", args->port, 0, 65535, "of --serve (default: any that is free)");
  cli.add_threads(app);
  cli.add_output(app, "the page");
}

}  // namespace burin::cli
