// SPDX-License-Identifier: Apache-2.0
// burin post: CL data of any origin -> NC of one dialect and machine.
#include "burin/post/emit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "burin/cl/apt.h"
#include "burin/model/machine.h"
#include "burin/post/emit_tcp.h"
#include "cli.h"
#include "commands.h"
#include "joint_options.h"

namespace burin::cli {
namespace {

struct PostArgs {
  std::string path, machine;
  JointOptions joints;
  bool tcp = false, as_joints = false;
};

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

Result<post::NcText> upright_nc(const cl::Program& program, const model::Machine& machine,
                                const post::Dialect& dialect, const PostArgs& args, Session& session) {
  if (auto upright = check_upright(program, machine, args.path); !upright) return upright.error();
  post::EmitOptions options;
  options.write_z = machine.axis('Z') != nullptr;
  return post::emit(program, dialect, options, session.diagnostics);
}

/// Joint coordinates of a machine with rotary axes, or the tip and its rotary axes.
Result<post::NcText> rotary_nc(const cl::Program& program, const model::Machine& machine,
                               const post::Dialect& dialect, const PostArgs& args, Session& session) {
  auto kinematics = kinematics::Kinematics::make(machine);
  if (!kinematics) return kinematics.error();
  kinematics::JointPathOptions options;
  options.tolerance_mm = session.common.tolerance_mm;
  options.tool_centre = args.tcp;
  options.keep_acceleration = args.joints.keep_acceleration;
  auto path = kinematics::make_joint_path(*kinematics, program, options);
  if (!path) {
    Error error = path.error();
    error.where.file = args.path;
    return error;
  }
  report_joints(*path, session);
  session.report.quality["max_deviation_mm"] = path->deviation_mm;
  const kinematics::RotaryShares shares =
      kinematics::rotary_shares(*kinematics, path->moves, options.axis_tolerance_rad);
  session.report.quality["rotary_speed_share"] = std::max(shares.speed[0], shares.speed[1]);
  session.report.quality["rotary_acceleration_share"] =
      std::max(shares.acceleration[0], shares.acceleration[1]);
  post::JointEmitOptions emit;
  emit.write_z = true;
  emit.feed = args.joints.feed;
  return args.tcp ? post::emit_tcp(program, *kinematics, *path, dialect, emit, session.diagnostics)
                  : post::emit_joints(program, *kinematics, *path, dialect, emit, session.diagnostics);
}

Result<void> run_post(const PostArgs& args, Session& session) {
  auto machine = model::find_machine(args.machine);
  if (!machine) return machine.error();
  auto dialect = post::find_dialect(session.common.dialect);
  if (!dialect) return dialect.error();
  auto text = session.read_input(args.path);
  if (!text) return text.error();
  cl::AptOptions apt;
  apt.file_name = args.path;
  auto program = cl::read_apt(*text, apt, session.diagnostics);
  if (!program) return program.error();
  const bool rotary = std::any_of(machine->axes.begin(), machine->axes.end(), [](const model::Axis& axis) {
    return axis.kind == model::AxisKind::rotary;
  });
  if (args.tcp && !rotary)
    return Error{
        ErrorCode::usage,
        "--tcp: machine " + machine->name + " has no rotary axes (a machine with rotary axes, or no --tcp)",
        {}};
  auto nc = (rotary ? rotary_nc : upright_nc)(*program, *machine, *dialect, args, session);
  if (!nc) return nc.error();
  session.report.parameters["machine"] = machine->name;
  session.report.parameters["dialect"] = dialect->name;
  session.report.parameters["tolerance_mm"] = session.common.tolerance_mm;
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
  CLI::App& app =
      cli.add_command("post", "NC program from a CL file, for machines of three to five axes",
                      "  burin post path.cl --machine xyz --dialect linuxcnc -o path.ngc\n"
                      "  burin post path.cl --machine laser-xy --dialect grbl -o -\n"
                      "  burin post blade.cl --machine xyzac-trunnion --tolerance 0.005 -o blade.ngc\n"
                      "  burin post blade.cl --machine xyzac-trunnion --dialect fanuc --tcp -o blade.nc\n",
                      [args](Session& session) { return run_post(*args, session); });
  add_text(app, "PATH.cl", args->path, "FILE", "tool path as APT CL text")->required();
  add_text(app, "--machine", args->machine, "NAME",
           "a preset (laser-xy, xyz, xyza, xyzac-trunnion, ...) or a machine file NAME.toml")
      ->required();
  CLI::Option* tcp =
      app.add_flag("--tcp", args->tcp,
                   "tip and rotary axes for controls with tool-centre-point control (G43.4; dialect fanuc)");
  app.add_flag("--joints", args->as_joints, "joint coordinates (default)")->excludes(tcp);
  add_feed_mode(app, args->joints, "joint coordinates of machines with rotary axes: ");
  add_keep_acceleration(app, args->joints);
  cli.add_tolerance(app);
  cli.add_dialect(app);
  cli.add_output(app, "NC program (default: the CL file's name with .ngc)");
  cli.add_json(app);
}

}  // namespace burin::cli
