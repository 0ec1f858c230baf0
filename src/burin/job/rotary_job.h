// SPDX-License-Identifier: Apache-2.0
// The job file of `burin rotary` (TOML) and what it leads to: part, plan, joint moves. Nothing is printed or
// written here. mm, degrees in the file, radians in the types.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/job/file_source.h"
#include "burin/kinematics/joint_path.h"
#include "burin/model/tool.h"
#include "burin/plan/rotary/rotary.h"
#include "burin/verify/motion_check.h"

namespace burin::job {

struct SectionPart {
  std::string file;
  std::vector<rotary::Station> stations;
};
struct LoftPart {
  struct Section {
    std::string file;
    double x = 0;
  };
  std::vector<Section> sections;
};
struct SurfacePart {
  std::string file;  ///< STEP or IGES
};
struct MeshPart {
  std::string file;  ///< STL
  double scale = 1;  ///< mm per unit
};
using RotaryPartSource = std::variant<SectionPart, LoftPart, SurfacePart, MeshPart>;

struct RotaryJobFile {
  RotaryPartSource part;
  model::BallTool tool;
  rotary::RotaryOptions options;
  std::string machine = "xyza";
  double spindle_rpm = 0;  ///< 0: no spindle words
};

/// Share of the tolerance by which the part's mesh may leave the design: of swept parts, whose section is
/// asked itself where the mesh does not decide; and of lofts and CAD faces, where it is lost to the steps.
inline constexpr double kMeshShare = 0.2, kFacetShare = 0.1;

/// Every key checked; errors with file, line, column and what would be accepted.
Result<RotaryJobFile> read_rotary_job(std::string_view toml, const std::string& file_name);

/// Paths of the job are relative to `folder`.
Result<rotary::Part> load_rotary_part(const RotaryJobFile& job, const std::string& folder,
                                      const FileSource& read, Diagnostics& diagnostics);

/// Of part.mesh: what a ball beside the part is to finish. Not so end faces and what lies outside of x_min to
/// x_max: it must not be cut, but need not be reached.
std::vector<bool> machined_triangles(const rotary::Part& part);

struct RotaryJob {
  rotary::Part part;
  rotary::RotaryPlan plan;
  cl::Program cl;
  kinematics::JointPath joints;
};

/// The joint moves against the part by verify/motion_check, which shares nothing with the planner. End faces
/// and what lies outside of x_min to x_max must not be cut, but need not be reached.
struct RotaryCheck {
  verify::SampledDesign design;
  verify::MotionCheckReport report;
  double bound_mm = 0;  ///< of the check, the mesh's deflection included
};
RotaryCheck check_rotary_moves(const rotary::Part& part, const model::BallTool& tool,
                               const std::vector<verify::CheckedMove>& moves,
                               const kinematics::Kinematics& machine, double tolerance_mm);
RotaryCheck check_rotary_job(const RotaryJobFile& file, const RotaryJob& job,
                             const kinematics::Kinematics& machine);

/// The whole of it on a machine with one rotary axis in the table, along X. Error (unsupported): another
/// machine.
Result<RotaryJob> make_rotary_job(const RotaryJobFile& job, const kinematics::Kinematics& machine,
                                  const std::string& name, const std::string& folder, const FileSource& read,
                                  Diagnostics& diagnostics, ProgressSink* progress);

}  // namespace burin::job
