// SPDX-License-Identifier: Apache-2.0
#include "orient_setup.h"

#include <filesystem>

#include "burin/job/machine_file.h"

namespace burin::cli {
namespace fs = std::filesystem;

orient::MachineLimits OrientSetup::limits() const {
  if (!machine) return {};
  constexpr double kInside_deg = 0.01;
  model::Machine inside = machine->machine();
  for (model::Axis& axis : inside.axes) {
    if (axis.kind != model::AxisKind::rotary || axis.max - axis.min <= 4 * kInside_deg) continue;
    axis.min += kInside_deg;
    axis.max -= kInside_deg;
  }
  const auto kinematics = kinematics::Kinematics::make(inside);
  return orient::MachineLimits(kinematics ? *kinematics : *machine);
}

orient::Scene OrientSetup::scene() const {
  const orient::OrientOptions& o = file.options;
  return {part.mesh, file.mill, orient::tool_body(file.mill, o.tolerance_mm, o.clearance_mm)};
}

Result<OrientSetup> load_orient(const std::string& job_path, std::optional<double> tolerance,
                                Session& session) {
  auto text = session.read_input(job_path);
  if (!text) return text.error();
  auto file = job::read_orient_job(*text, job_path);
  if (!file) return file.error();
  OrientSetup setup;
  setup.file = std::move(*file);
  if (tolerance) setup.file.options.tolerance_mm = setup.file.options.paths.chord_mm = *tolerance;
  const fs::path folder = fs::path(job_path).parent_path();
  const auto read = [&session](const std::string& path) { return session.read_input(path); };
  auto machine = job::load_machine(setup.file.machine, folder.string(), read);
  if (!machine) return machine.error();
  setup.machine = std::move(*machine);
  if (!setup.file.contacts.empty()) {
    const std::string path = (folder / setup.file.contacts).string();
    auto csv = read(path);
    if (!csv) return csv.error();
    auto contacts = orient::read_contacts(*csv, path);
    if (!contacts) return contacts.error();
    setup.contacts = std::move(*contacts);
  }
  auto part = job::load_orient_part(setup.file, folder.string(), read, session.diagnostics);
  if (!part) return part.error();
  setup.part = std::move(*part);
  return setup;
}

const char* const kOrientJobHelp =
    "\nA job file (paths are relative to it; mm, degrees):\n"
    "  [part]                        # what is milled: one of surface, propeller, mesh\n"
    "  surface = \"blade.step\"        # STEP or IGES; faces = [1, 3] selects, flip = true is the other "
    "side\n"
    "  # propeller = { blades = 5, diameter = 1000.0, pitch_ratio = 1.0, area_ratio = 0.75,\n"
    "  #               hub_ratio = 0.18, side = \"face\" }       # Wageningen B series; also: rake\n"
    "  # mesh = \"part.stl\"           # needs contacts\n"
    "  # contacts = \"points.csv\"     # path,x,y,z,nx,ny,nz,fx,fy,fz instead of generated paths\n"
    "  obstacles = [\"hub.stl\"]       # STL, STEP, IGES: not milled, not touched\n"
    "  [tool]\n"
    "  kind = \"flat\"                 # flat, bull (with corner_radius)\n"
    "  radius = 125.0\n"
    "  length = 60.0                 # cutting body above the tip\n"
    "  holder = [{ radius = 80.0, height = 150.0 }]      # also: shank below it, head above it\n"
    "  [operation]\n"
    "  paths = \"iso-u\"               # iso-u, iso-v, plane (with plane_normal = [x, y, z])\n"
    "  tilt = [1.5, 20.0]\n"
    "  yaw = [-90.0, 90.0]\n"
    "  tolerance = 0.01              # a gouge may have\n"
    "  clearance = 1.0               # of shank, holder and head\n"
    "  objective = \"radius\"          # radius, strip\n"
    "  search = \"optimal\"            # optimal, contour (Park & Lee), sturz (one tilt; sturz_tilt)\n"
    "  smooth = false                # true: angles that turn evenly along a path\n"
    "  scallop = 0.05                # decides how far paths are apart; or side_step, or path_count\n"
    "  feed = 1000.0                 # mm/min; also: max_step, edge, safety, spindle\n"
    "  [machine]\n"
    "  name = \"propeller-head-head\"  # a preset, a file NAME.toml, or none: no limits, no NC\n";

}  // namespace burin::cli
