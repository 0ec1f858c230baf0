// SPDX-License-Identifier: Apache-2.0
// How deep the tool of a face-milling job gets into the part: the whole program against the triangles of
// design and obstacles, by code that shares nothing with the planner (verify/mill_check). mm.
#pragma once

#include <cstddef>

#include "burin/base/result.h"
#include "burin/kinematics/joint_path.h"
#include "burin/model/tool.h"
#include "burin/plan/orient/part.h"
#include "burin/verify/mill_check.h"

namespace burin::job {

struct OrientCheckOptions {
  double resolution_mm = 0.001;
  double motion_mm = 0.0005;  ///< joint moves
  unsigned threads = 1;       ///< 0: as many as there are; the result is the same for any number
};

struct OrientCheck {
  /// `move`: the record of the CL program that the move belongs to; `triangle`: below part.design_triangles
  /// it is the design. The pieces of the holder all count as holder, shank stays 0.
  verify::MillFinding cutter, holder;
  double bound_mm =
      0;  ///< deeper than found by at most this, the deflection of the design's triangles included
  std::size_t moves = 0;
  double gouge_max_mm() const;
};

/// The program as tool-centre-point control runs it: tip straight, axis along the great circle; rapids the
/// same. Errors: of make_checked_path and check_mill.
Result<OrientCheck> check_orient_job(const orient::Part& part, const model::Mill& mill,
                                     const cl::Program& program, const OrientCheckOptions& options = {});
/// The same program as joint moves of a machine. The first move ends where the check begins.
Result<OrientCheck> check_orient_job(const orient::Part& part, const model::Mill& mill,
                                     const kinematics::Kinematics& machine, const kinematics::JointPath& path,
                                     const OrientCheckOptions& options = {});

/// The mill as the check takes it: cutter to `length`, the holder's pieces stacked above.
verify::CheckedMill checked_mill(const model::Mill& mill);

}  // namespace burin::job
