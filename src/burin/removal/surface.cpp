// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/field.h"

namespace burin::removal {

geom::Mesh surface(const Grid&, const std::vector<DexelField>&) {
  return {};
}
StockClock make_clock(const Stock&, const verify::CheckedPath&, const CutLimits&, unsigned, std::size_t) {
  return {};
}

}  // namespace burin::removal
