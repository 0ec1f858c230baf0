// SPDX-License-Identifier: Apache-2.0
// The motion of a face-milling job against everything in its part, by verify/mill_check, which shares nothing
// with the planner. mm.
#pragma once

#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/kinematics/joint_path.h"
#include "burin/model/tool.h"
#include "burin/plan/orient/part.h"
#include "burin/verify/mill_check.h"

namespace burin::job {

/// As the joints run when there are some (all moves, rapids too), else as tool-centre-point control moves
/// the tool (a rapid as a straight line). Depths are against the part's triangles; its deflection comes on
/// top. A program without motion gives a report without findings.
Result<verify::MillCheckReport> check_orient_motion(const orient::Part& part, const model::Mill& mill,
                                                    const cl::Program& program,
                                                    const kinematics::Kinematics* machine,
                                                    const kinematics::JointPath* joints,
                                                    double tolerance_mm, unsigned threads);

}  // namespace burin::job
