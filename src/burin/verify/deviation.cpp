// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/deviation.h"

namespace burin::verify {

Result<DeviationReport> measure_deviation(const geom::Mesh&, const SampledSurface&, const CheckedPath&,
                                          const DeviationOptions&, ProgressSink*) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}
Histogram histogram(const SampledSurface&, const DeviationReport&, std::size_t) {
  return {};
}

}  // namespace burin::verify
