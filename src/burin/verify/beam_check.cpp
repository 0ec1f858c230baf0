// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/beam_check.h"

namespace burin::verify {

Result<BeamReport> check_beam(const std::vector<Outline>&, const cl::Program&, const BeamCheckOptions&) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}

}  // namespace burin::verify
