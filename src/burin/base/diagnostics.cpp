// SPDX-License-Identifier: Apache-2.0
#include "burin/base/diagnostics.h"

#include <algorithm>

namespace burin {

bool Diagnostics::anything_left_out() const {
  return std::any_of(warnings_.begin(), warnings_.end(),
                     [](const Warning& w) { return w.severity == Severity::left_out; });
}

std::size_t Diagnostics::count(std::string_view code) const {
  return static_cast<std::size_t>(
      std::count_if(warnings_.begin(), warnings_.end(), [&](const Warning& w) { return w.code == code; }));
}

}  // namespace burin
