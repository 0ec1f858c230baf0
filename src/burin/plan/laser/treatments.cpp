// SPDX-License-Identifier: Apache-2.0
// Which entities are cut, engraved or ignored: by layer name or stroke colour.
#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "burin/base/text.h"
#include "burin/plan/laser/join_parts.h"

namespace burin::laser::detail {
namespace {

std::string hex_color(std::uint32_t color) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text = "#";
  for (int shift = 20; shift >= 0; shift -= 4) text += digits[(color >> shift) & 15U];
  return text;
}

/// "#f00" and "#FF0000" as 0xff0000.
std::optional<std::uint32_t> parse_color(const std::string& key) {
  if ((key.size() != 4 && key.size() != 7) || key[0] != '#') return std::nullopt;
  std::uint32_t color = 0;
  for (std::size_t i = 1; i < key.size(); ++i) {
    const char c = key[i];
    std::uint32_t digit = 0;
    if (c >= '0' && c <= '9') {
      digit = static_cast<std::uint32_t>(c - '0');
    } else if (c >= 'a' && c <= 'f') {
      digit = static_cast<std::uint32_t>(c - 'a') + 10;
    } else if (c >= 'A' && c <= 'F') {
      digit = static_cast<std::uint32_t>(c - 'A') + 10;
    } else {
      return std::nullopt;
    }
    color = color * 16 + digit;
    if (key.size() == 4) color = color * 16 + digit;
  }
  return color;
}

struct Names {
  std::vector<std::string> layers, colors;  // sorted
};

Names names_of(const io::Drawing& drawing) {
  std::set<std::string> layers(drawing.layers.begin(), drawing.layers.end());
  std::set<std::string> colors;
  for (const io::Entity& entity : drawing.entities) {
    layers.insert(entity.layer);
    colors.insert(hex_color(entity.color));
  }
  return {{layers.begin(), layers.end()}, {colors.begin(), colors.end()}};
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 40;  // a message, not a catalogue
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMost; ++i) text += (i ? ", \"" : "\"") + names[i] + "\"";
  if (names.size() > kMost) text += ", and " + std::to_string(names.size() - kMost) + " more";
  return names.empty() ? "none" : text;
}

Error unknown(const std::string& key, const Names& names) {
  const bool color = parse_color(key).has_value();
  const std::vector<std::string>& known = color ? names.colors : names.layers;
  std::string message = (color ? "no entity has the colour \"" : "the drawing has no layer \"") + key + "\"";
  const std::string near = nearest_word(key, known);
  if (!near.empty()) message += ", did you mean \"" + near + "\"?";
  message += std::string(" (") + (color ? "colours" : "layers") + " of the drawing: " + listed(known) + ")";
  return {ErrorCode::usage, std::move(message), {}};
}

/// The layers that each key names: the one of exactly this name, else all that differ in case only.
std::map<std::string, Treatment> by_exact_name(const std::map<std::string, Treatment>& keys,
                                               const Names& names) {
  std::map<std::string, Treatment> exact;
  std::map<std::string, Treatment> lower;
  for (const auto& [key, treatment] : keys) {
    if (std::binary_search(names.layers.begin(), names.layers.end(), key)) {
      exact[key] = treatment;
    } else {
      lower[to_lower(key)] = treatment;
    }
  }
  for (const std::string& name : names.layers) {
    const auto found = lower.find(to_lower(name));
    if (found != lower.end()) exact.insert({name, found->second});
  }
  return exact;
}

}  // namespace

Result<std::vector<Treatment>> treatments(const io::Drawing& drawing,
                                          const std::map<std::string, Treatment>& layers) {
  std::vector<Treatment> result(drawing.entities.size(), Treatment::cut);
  if (layers.empty()) return result;
  const Names names = names_of(drawing);
  std::map<std::uint32_t, Treatment> colors;
  std::map<std::string, Treatment> keys;
  for (const auto& item : layers) {
    const std::string& key = item.first;
    const Treatment treatment = item.second;
    const bool is_layer = std::any_of(names.layers.begin(), names.layers.end(), [&](const std::string& name) {
      return to_lower(name) == to_lower(key);
    });
    const std::optional<std::uint32_t> color = parse_color(key);
    if (is_layer) {
      keys[key] = treatment;
    } else if (color && std::binary_search(names.colors.begin(), names.colors.end(), hex_color(*color))) {
      colors[*color] = treatment;
    } else {
      return unknown(key, names);
    }
  }
  const std::map<std::string, Treatment> exact = by_exact_name(keys, names);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const io::Entity& entity = drawing.entities[i];
    const auto layer = exact.find(entity.layer);
    if (layer != exact.end()) result[i] = layer->second;
    const auto color =
        colors.find(entity.color & 0xffffffU);  // the entity's own property: stronger than its layer
    if (color != colors.end()) result[i] = color->second;
  }
  return result;
}

}  // namespace burin::laser::detail
