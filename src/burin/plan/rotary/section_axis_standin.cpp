// SPDX-License-Identifier: Apache-2.0
// Until the section method is there: nothing is reachable by it.
#include "burin/plan/rotary/reach.h"

namespace burin::rotary {

struct SectionAxis::State {};
SectionAxis::SectionAxis(const geom::Mesh&, const std::vector<std::array<geom::Vec3, 3>>&, double) {}
SectionAxis::~SectionAxis() = default;
SectionReach SectionAxis::at(geom::Point3, geom::Vec3) const {
  return {};
}

}  // namespace burin::rotary
