// SPDX-License-Identifier: Apache-2.0
#include "burin/base/diagnostics.h"

#include <algorithm>

namespace burin {

bool Diagnostics::anything_left_out() const {
  return std::any_of(warnings_.begin(), warnings_.end(),
                     [](const Warning& w) { return w.severity == Severity::left_out; });
}

void Diagnostics::locate(const std::string& file) {
  for (Warning& w : warnings_) {
    if (w.where.file.empty() && (w.where.line > 0 || !w.where.entity.empty())) w.where.file = file;
  }
}

std::size_t Diagnostics::count(std::string_view code) const {
  return static_cast<std::size_t>(
      std::count_if(warnings_.begin(), warnings_.end(), [&](const Warning& w) { return w.code == code; }));
}

}  // namespace burin
