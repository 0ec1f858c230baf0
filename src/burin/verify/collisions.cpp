// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/collisions.h"

namespace burin::verify {

std::string_view name(Body body) {
  return body == Body::cutter ? "cutter" : body == Body::shank ? "shank" : "holder";
}
std::string_view name(Against against) {
  return against == Against::part ? "part" : against == Against::stock ? "stock" : "obstacle";
}
Result<CollisionReport> find_collisions(const geom::Mesh&, const geom::Mesh&, const CheckedPath&,
                                        const CollisionOptions&, ProgressSink*) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}

}  // namespace burin::verify
