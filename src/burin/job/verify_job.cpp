// SPDX-License-Identifier: Apache-2.0
#include "burin/job/verify_job.h"

namespace burin::job {

bool VerifyResult::clean() const {
  return collisions.empty() && deviation.unmachined_area_mm2 == 0;
}
Result<VerifyInput> read_verify_input(const VerifyOptions&, const FileSource&, Diagnostics&, ProgressSink*) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}
Result<VerifyResult> run_verify(const VerifyInput&, const VerifyOptions&, Diagnostics&, ProgressSink*) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}

}  // namespace burin::job
