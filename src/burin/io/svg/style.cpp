// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/style.h"

#include "burin/base/text.h"
#include "burin/io/svg/color.h"

namespace burin::io::svg {
namespace {

/// Keywords only; long values are no keywords.
std::string keyword(std::string_view value) {
  constexpr std::size_t kLongest = 32;
  return value.size() > kLongest ? std::string() : to_lower(trim(value));
}

/// A value that is no paint leaves the inherited one, as CSS says.
Paint parse_paint(std::string_view value, const Paint& inherited) {
  const std::string word = keyword(value);
  if (word == "inherit" || word == "unset") return inherited;
  if (word == "none" || word == "transparent") return {Paint::Kind::none, 0};
  if (word == "currentcolor") return {Paint::Kind::current_color, 0};
  if (word == "context-stroke" || word == "context-fill") return {Paint::Kind::color, 0};
  value = trim(value);
  if (value.starts_with("url(")) {
    // A gradient or pattern: painted, with the fallback colour behind it when there is one.
    const std::size_t end = value.find(')');
    const auto fallback = end == std::string_view::npos ? std::nullopt : parse_color(value.substr(end + 1));
    return {Paint::Kind::server, fallback.value_or(0)};
  }
  if (const auto rgb = parse_color(value)) return {Paint::Kind::color, *rgb};
  return inherited;
}

std::uint32_t resolve(const Paint& paint, std::uint32_t color) {
  return paint.kind == Paint::Kind::current_color ? color : paint.rgb;
}

}  // namespace

std::uint32_t InheritedStyle::entity_color() const {
  if (stroke.kind != Paint::Kind::none) return resolve(stroke, color);
  if (fill.kind != Paint::Kind::none) return resolve(fill, color);
  return 0;
}

Result<const CascadedStyle*> Styles::cascaded(int element) {
  auto& slot = cache_[static_cast<std::size_t>(element)];
  if (slot) return slot.get();
  auto style = std::make_unique<CascadedStyle>();
  const Element& e = document_.elements[static_cast<std::size_t>(element)];
  std::string_view style_attribute;
  for (const Attribute& attribute : e.attributes) {
    if (attribute.ns != Namespace::none) continue;
    if (attribute.name == "style") style_attribute = attribute.value;
    if (const auto property = property_of(attribute.name))
      style->apply({*property, attribute.value, false}, 0, 0);
  }
  if (!sheet_.empty()) {
    if (auto done = sheet_.apply(element, *style); !done) return done.error();
  }
  for (const Declaration& declaration : parse_declarations(style_attribute)) style->apply(declaration, 2, 0);
  slot = std::move(style);
  return slot.get();
}

Result<ElementStyle> Styles::of(int element, const InheritedStyle& parent) {
  const auto found = cascaded(element);
  if (!found) return found.error();
  const CascadedStyle& declared = **found;
  ElementStyle style;
  style.inherited = parent;
  if (const auto value = declared.get(Property::color)) {
    if (const auto rgb = parse_color(*value)) style.inherited.color = *rgb;
  }
  if (const auto value = declared.get(Property::stroke))
    style.inherited.stroke = parse_paint(*value, parent.stroke);
  if (const auto value = declared.get(Property::fill))
    style.inherited.fill = parse_paint(*value, parent.fill);
  if (const auto value = declared.get(Property::visibility)) {
    const std::string word = keyword(*value);
    if (word == "visible") style.inherited.visible = true;
    if (word == "hidden" || word == "collapse") style.inherited.visible = false;
  }
  if (const auto value = declared.get(Property::display)) style.displayed = keyword(*value) != "none";
  for (const Property property : {Property::clip_path, Property::mask}) {
    if (const auto value = declared.get(property)) style.clipped = style.clipped || keyword(*value) != "none";
  }
  style.transform_origin = declared.get(Property::transform_origin);
  style.transform = declared.get(Property::transform);
  return style;
}

}  // namespace burin::io::svg
