// SPDX-License-Identifier: Apache-2.0
#include "burin/job/verify_laser.h"

namespace burin::job {

bool is_drawing(std::string_view) {
  return false;
}
Result<LaserOutlines> read_laser_outlines(std::string_view, const std::string&, const LaserOutlineOptions&,
                                          Diagnostics&) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}
Result<cl::Program> read_laser_program(std::string_view, const std::string&, Diagnostics&) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}

}  // namespace burin::job
