// SPDX-License-Identifier: Apache-2.0
#include "burin/base/error.h"

namespace burin {

std::string Where::to_string() const {
  std::string text = file;
  if (line > 0) text += ":" + std::to_string(line);
  if (line > 0 && column > 0) text += ":" + std::to_string(column);
  if (!entity.empty()) text += text.empty() ? entity : ": " + entity;
  return text;
}

std::string Error::to_string() const {
  const std::string place = where.to_string();
  return place.empty() ? message : place + ": " + message;
}

}  // namespace burin
