// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/stock.h"

namespace burin::removal {

Result<void> validate(const Stock&) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}
geom::Box3 bounds(const Stock&) {
  return {};
}

}  // namespace burin::removal
