// SPDX-License-Identifier: Apache-2.0
// Internal general entities of a DOCTYPE (<!ENTITY ns_svg "http://...">), as Adobe Illustrator writes them.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "burin/base/result.h"

namespace burin::io::svg {

class InternalEntities {
 public:
  /// Reads the declarations out of the text of a DOCTYPE. Parameter entities and external ones are skipped.
  static InternalEntities from_doctype(std::string_view doctype);

  bool empty() const { return values_.empty(); }
  /// Replaces &name; by the declared text, nested ones too. Names that are not declared stay as they are.
  /// Errors: range (nested deeper than 8 or longer than 64 KiB in one attribute: a decompression bomb).
  Result<std::string> expand(std::string_view text) const;
  /// True when the text refers to an entity whose content is markup, which would be drawn.
  bool refers_to_markup(std::string_view text) const;

 private:
  Result<void> expand_into(std::string_view text, int depth, std::string& out) const;

  std::map<std::string, std::string, std::less<>> values_;
};

}  // namespace burin::io::svg
