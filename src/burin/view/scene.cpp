// SPDX-License-Identifier: Apache-2.0
#include "burin/view/scene.h"

namespace burin::view {

Result<void> validate(const Scene&) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}
Result<std::string> scene_bytes(const Scene&, const SceneOptions&) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}
Result<std::string> viewer_page(const Scene&, const SceneOptions&) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}
std::string viewer_shell(const std::string&) {
  return {};
}

}  // namespace burin::view
