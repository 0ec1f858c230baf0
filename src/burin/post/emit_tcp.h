// SPDX-License-Identifier: Apache-2.0
// CL data -> NC for controls with tool-centre-point control (G43.4): tip and rotary angles.
#pragma once

#include "burin/post/emit.h"

namespace burin::post {

/// X, Y, Z of the tip on the part and the rotary words of the machine in each block, feed per minute of the
/// tip; the control keeps the tip on its line. Rotary angles by make_joint_path's choice (nearest solution,
/// no unwinding). Before a pole is passed within a feed move, points are put between so that the rotary axes
/// keep their speed. Errors as emit_joints, and (unsupported) a dialect without `tcp_on`.
Result<NcText> emit_tcp(const cl::Program& program, const kinematics::Kinematics& machine,
                        const kinematics::JointPath& path, const Dialect& dialect, const EmitOptions& options,
                        Diagnostics& diagnostics);

}  // namespace burin::post
