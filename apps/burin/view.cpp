// SPDX-License-Identifier: Apache-2.0
// burin view: one HTML file that shows and plays tool paths and reports.
#include <memory>
#include <string>
#include <vector>

#include "burin/view/scene.h"
#include "cli.h"
#include "commands.h"
#include "view_files.h"

namespace burin::cli {
namespace {

struct ViewArgs {
  std::vector<std::string> files;
  ViewOptions options;
  bool serve = false;
  int port = 0;
};

Result<void> run_view(const ViewArgs& args, Session& session) {
  if (!args.serve && session.common.output.empty())
    return Error{ErrorCode::usage, "nowhere to put the page (-o FILE.html or --serve)", {}};
  auto scene = scene_of_files(args.files, args.options, session);
  if (!scene) return scene.error();
  auto page = view::viewer_page(*scene);
  if (!page) return page.error();
  session.report.counts["nodes"] = scene->path.point.size();
  return session.put(session.common.output, *std::move(page));
}

}  // namespace

void add_view(Cli& cli) {
  auto args = std::make_shared<ViewArgs>();
  CLI::App& app = cli.add_command("view", "one page that shows and plays tool paths, parts and reports",
                                  "  burin view path.cl -o path.html\n"
                                  "  burin view part.step path.nc --machine xyzac-trunnion -o path.html\n"
                                  "  burin view part.dxf part.ngc --kerf 0.28 -o part.html\n",
                                  [args](Session& session) { return run_view(*args, session); });
  app.add_option("FILE", args->files,
                 "CL, NC, STEP, IGES, STL, DXF, SVG and JSON reports, told by their content")
      ->required()
      ->type_name("FILE");
  add_text(app, "--machine", args->options.machine, "NAME",
           "preset or machine file: rotary words of NC programs, turning table, speeds of rapids");
  add_number(app, "--kerf", args->options.kerf_mm, kPositiveLength, "width of the cut of a beam");
  cli.add_output(app, "the page");
}

}  // namespace burin::cli
