// SPDX-License-Identifier: Apache-2.0
// <style> elements: the part of CSS 2.1 that drawing programs write.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "burin/base/result.h"
#include "burin/io/svg/document.h"

namespace burin::io::svg {

/// The properties that matter for cutting.
enum class Property {
  color,
  stroke,
  fill,
  display,
  visibility,
  transform,
  transform_origin,
  clip_path,
  mask
};
inline constexpr std::size_t kPropertyCount = 9;
std::optional<Property> property_of(std::string_view name);

struct Declaration {
  Property property;
  std::string_view value;
  bool important = false;
};
/// "stroke:red; fill : none !important"; unknown properties and damaged declarations are left out, as CSS
/// says.
std::vector<Declaration> parse_declarations(std::string_view text);

/// Winning declarations of one element; unset ones have no value.
class CascadedStyle {
 public:
  std::optional<std::string_view> get(Property property) const {
    return slots_[static_cast<std::size_t>(property)].value;
  }
  /// A later or stronger declaration replaces the one before. `origin`: 0 presentation attribute, 1 style
  /// sheet, 2 style attribute.
  void apply(const Declaration& declaration, int origin, std::uint32_t specificity);

 private:
  struct Slot {
    std::optional<std::string_view> value;
    std::uint64_t rank = 0;
  };
  std::array<Slot, kPropertyCount> slots_;
};

/// Rules of all <style> elements. Selectors: element, *, .class, #id, [attribute], [attribute="value"],
/// combined, with descendant and child combinators. Rules with other selectors and @-rules are skipped and
/// counted.
class StyleSheet {
 public:
  /// Comments are removed first. `document` must outlive the sheet.
  explicit StyleSheet(const Document& document);

  int skipped_rules() const { return skipped_; }
  bool empty() const { return selectors_.empty(); }
  /// Applies the rules that match. Error (range): the sheet asks for more matching work than any real
  /// drawing.
  Result<void> apply(int element, CascadedStyle& style);

 private:
  struct AttributeTest {
    std::string_view name;
    std::optional<std::string_view> value;
  };
  struct Compound {
    std::string_view element;  // "" any
    std::vector<std::string_view> ids, classes;
    std::vector<AttributeTest> attributes;
    bool child_of_previous = false;  // ">" stands before it
  };
  struct Selector {
    std::vector<Compound> compounds;
    std::uint32_t specificity = 0;
    int rule = 0;
    int order = 0;
  };

  void parse(std::string_view text);
  void add_rule(std::string_view selectors, std::string_view body);
  bool parse_selector(std::string_view text, Selector& selector) const;
  static bool parse_compound(std::string_view text, Compound& compound, std::uint32_t& specificity);
  void index_selector(int selector);
  void collect(const std::unordered_map<std::string_view, std::vector<int>>& index, std::string_view key,
               std::vector<int>& out) const;
  bool matches(const Selector& selector, std::size_t compound, int element);
  bool compound_matches(const Compound& compound, int element);
  const Element& at(int index) const { return document_.elements[static_cast<std::size_t>(index)]; }

  const Document& document_;
  std::vector<std::string> texts_;
  std::vector<std::vector<Declaration>> rules_;
  std::vector<Selector> selectors_;
  std::unordered_map<std::string_view, std::vector<int>> by_id_, by_class_, by_element_;
  std::vector<int> universal_;
  int skipped_ = 0;
  std::int64_t work_left_ = 0;
};

}  // namespace burin::io::svg
