// SPDX-License-Identifier: Apache-2.0
// Computed style of an element: cascade of attributes, style sheets and style attributes, and inheritance.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "burin/io/svg/style_sheet.h"

namespace burin::io::svg {

struct Paint {
  enum class Kind { none, color, current_color, server };
  Kind kind = Kind::none;
  std::uint32_t rgb = 0;
};

/// What children inherit.
struct InheritedStyle {
  Paint stroke{Paint::Kind::none, 0};
  Paint fill{Paint::Kind::color, 0};
  std::uint32_t color = 0;
  bool visible = true;

  /// Colour of the stroke, else of the fill, else black.
  std::uint32_t entity_color() const;
  bool painted() const { return stroke.kind != Paint::Kind::none || fill.kind != Paint::Kind::none; }
};

struct ElementStyle {
  InheritedStyle inherited;
  bool displayed = true;
  bool clipped = false;  ///< has a clip-path or mask
  std::optional<std::string_view> transform_origin;
  std::optional<std::string_view> transform;  ///< of the property or the attribute
};

/// Styles of the elements of one document; what an element declares is worked out once.
class Styles {
 public:
  explicit Styles(const Document& document)
      : document_(document), sheet_(document), cache_(document.elements.size()) {}

  int skipped_rules() const { return sheet_.skipped_rules(); }
  Result<ElementStyle> of(int element, const InheritedStyle& parent);

 private:
  Result<const CascadedStyle*> cascaded(int element);

  const Document& document_;
  StyleSheet sheet_;
  std::vector<std::unique_ptr<CascadedStyle>> cache_;
};

}  // namespace burin::io::svg
