// SPDX-License-Identifier: Apache-2.0
// burin post: CL data of any origin -> NC of one dialect, for machines whose tool stands upright.
#include "burin/post/emit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "burin/cl/apt.h"
#include "burin/model/machine.h"
#include "cli.h"
#include "commands.h"

namespace burin::cli {
namespace {

struct PostArgs {
  std::string path, machine;
};

/// The machine has to be one that burin can post for today: linear axes only.
Result<model::Machine> linear_machine(const std::string& name) {
  auto machine = model::find_machine(name);
  if (!machine) return machine.error();
  for (const model::Axis& axis : machine->axes) {
    if (axis.kind == model::AxisKind::rotary) {
      return Error{ErrorCode::unsupported,
                   "machine " + machine->name + " has the rotary axis " + std::string(1, axis.letter) +
                       " (machines with linear axes only: laser-xy, xyz, or a file of your own)",
                   {}};
    }
  }
  return machine;
}

/// Error for the first pose whose axis is not upright: it needs a machine that can tilt.
Result<void> check_upright(const cl::Program& program, const model::Machine& machine,
                           const std::string& file) {
  /// Sine of the tilt below which an axis counts as upright: the 1e-9 to which CL files keep axes, with room.
  constexpr double kUprightSine = 1e-6;
  std::size_t move = 0;
  for (std::size_t i = 0; i < program.records.size(); ++i) {
    const cl::Pose* pose = cl::pose_of(program.records[i]);
    if (pose == nullptr) continue;
    if (std::hypot(pose->axis.x, pose->axis.y) > kUprightSine || pose->axis.z < 0) {
      return Error{ErrorCode::unsupported,
                   "move " + std::to_string(move) + " tilts the tool axis, which machine " + machine.name +
                       " cannot do (poses with the axis 0,0,1)",
                   {.file = file, .line = static_cast<int>(program.source[i])}};
    }
    ++move;
  }
  return {};
}

Result<void> run_post(const PostArgs& args, Session& session) {
  auto machine = linear_machine(args.machine);
  if (!machine) return machine.error();
  auto dialect = post::find_dialect(session.common.dialect);
  if (!dialect) return dialect.error();
  auto text = session.read_input(args.path);
  if (!text) return text.error();
  cl::AptOptions apt;
  apt.file_name = args.path;
  auto program = cl::read_apt(*text, apt, session.diagnostics);
  if (!program) return program.error();
  if (auto upright = check_upright(*program, *machine, args.path); !upright) return upright.error();

  post::EmitOptions options;
  options.write_z = machine->axis('Z') != nullptr;
  auto nc = post::emit(*program, *dialect, options, session.diagnostics);
  if (!nc) return nc.error();
  session.report.parameters["machine"] = machine->name;
  session.report.parameters["dialect"] = dialect->name;
  session.report.counts["moves"] = nc->moves;
  session.report.counts["nc_lines"] = nc->line_to_record.size();
  const std::string output = session.common.output.empty()
                                 ? std::filesystem::path(args.path).replace_extension(".ngc").string()
                                 : session.common.output;
  return session.put(output, std::move(nc->text));
}

}  // namespace

void add_post(Cli& cli) {
  auto args = std::make_shared<PostArgs>();
  CLI::App& app = cli.add_command("post", "NC program from a CL file, for machines without rotary axes",
                                  "  burin post path.cl --machine xyz --dialect linuxcnc -o path.ngc\n"
                                  "  burin post path.cl --machine laser-xy --dialect grbl -o -\n",
                                  [args](Session& session) { return run_post(*args, session); });
  add_text(app, "PATH.cl", args->path, "FILE", "tool path as APT CL text")->required();
  add_text(app, "--machine", args->machine, "NAME", "a preset (laser-xy, xyz) or a machine file NAME.toml")
      ->required();
  cli.add_dialect(app);
  cli.add_output(app, "NC program (default: the CL file's name with .ngc)");
  cli.add_json(app);
}

}  // namespace burin::cli
