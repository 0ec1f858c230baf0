// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/patterns.h"

namespace burin::rotary::detail {

Result<PatternResult> meshed_paths(const Part&, const PatternOptions&, Diagnostics&) {
  return Error{ErrorCode::unsupported, "paths on general parts are not there yet", {}};
}

}  // namespace burin::rotary::detail
