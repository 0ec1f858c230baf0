// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/deviation.h"

namespace burin::verify {

Result<SampledSurface> sample_surface(const geom::Mesh&, const std::vector<bool>&,
                                      const std::vector<geom::Vec3>&, const SampleOptions&) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}

}  // namespace burin::verify
