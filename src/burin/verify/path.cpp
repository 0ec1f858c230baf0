// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/path.h"

namespace burin::verify {

std::size_t CheckedPath::piece_count() const {
  std::size_t n = 0;
  for (const ToolPath& t : tools) n += t.pieces.size();
  return n;
}
Result<CheckedPath> make_checked_path(const cl::Program&, const ToolSource&, const PathOptions&) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}
Result<CheckedPath> make_checked_path(const cl::Program&, const std::vector<kinematics::Joints>&,
                                      const std::vector<bool>&, const kinematics::Kinematics&,
                                      const ToolSource&, const PathOptions&) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}

}  // namespace burin::verify
