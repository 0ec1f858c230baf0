// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/removal.h"

namespace burin::removal {

class Field {};

Removal::Removal(std::unique_ptr<Field> field) : field_(std::move(field)) {}
Removal::Removal(Removal&&) noexcept = default;
Removal& Removal::operator=(Removal&&) noexcept = default;
Removal::~Removal() = default;
double Removal::stock_mm3() const {
  return 0;
}
double Removal::removed_mm3() const {
  return 0;
}
double Removal::resolution_mm() const {
  return 0;
}
const std::vector<StockContact>& Removal::contacts() const {
  static const std::vector<StockContact> none;
  return none;
}
geom::Mesh Removal::mesh() const {
  return {};
}
StockClock Removal::clock(std::size_t) const {
  return {};
}
Result<Removal> remove_material(const Stock&, const verify::CheckedPath&, const RemovalOptions&,
                                ProgressSink*) {
  return Error{ErrorCode::unsupported, "not there yet", {}};
}

}  // namespace burin::removal
