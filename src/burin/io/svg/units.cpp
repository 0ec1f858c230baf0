// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/units.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "burin/base/text.h"
#include "burin/io/svg/scanner.h"

namespace burin::io::svg {
namespace {

constexpr double kMmPerInch = 25.4;
constexpr double kPxPerEm = 16.0;  // the default font size of browsers

struct UnitName {
  std::string_view name;
  Unit unit;
};
constexpr UnitName kUnits[] = {{"", Unit::number}, {"px", Unit::px},  {"pt", Unit::pt}, {"pc", Unit::pc},
                               {"mm", Unit::mm},   {"cm", Unit::cm},  {"in", Unit::in}, {"q", Unit::q},
                               {"em", Unit::em},   {"rem", Unit::em}, {"ex", Unit::ex}, {"%", Unit::percent}};

}  // namespace

bool Length::physical() const {
  return unit == Unit::mm || unit == Unit::cm || unit == Unit::in || unit == Unit::pt || unit == Unit::pc ||
         unit == Unit::q;
}

std::optional<Length> parse_length(std::string_view text) {
  text = trim(text);
  Scanner scan(text);
  const auto value = scan.number();
  if (!value) return std::nullopt;
  const std::string unit = to_lower(trim(text.substr(scan.position())));
  for (const UnitName& known : kUnits) {
    if (known.name == unit) return Length{*value, known.unit};
  }
  return std::nullopt;
}

double length_mm(Length length, double px_per_inch) {
  const double mm_per_px = kMmPerInch / px_per_inch;
  switch (length.unit) {
    case Unit::mm:
      return length.value;
    case Unit::cm:
      return length.value * 10;
    case Unit::q:
      return length.value / 4;
    case Unit::in:
      return length.value * kMmPerInch;
    case Unit::pt:
      return length.value * kMmPerInch / 72;
    case Unit::pc:
      return length.value * kMmPerInch / 6;
    case Unit::em:
      return length.value * kPxPerEm * mm_per_px;
    case Unit::ex:
      return length.value * kPxPerEm / 2 * mm_per_px;
    default:
      return length.value * mm_per_px;
  }
}

std::optional<double> length_in_user_units(Length length, double px_per_inch, const Viewport& viewport,
                                           Axis axis) {
  if (length.unit == Unit::number || length.unit == Unit::px) return length.value;
  if (length.unit != Unit::percent) return length_mm(length, px_per_inch) * px_per_inch / kMmPerInch;
  if (!viewport.known) return std::nullopt;
  const double whole = axis == Axis::x   ? viewport.width
                       : axis == Axis::y ? viewport.height
                                         : std::hypot(viewport.width, viewport.height) / std::sqrt(2.0);
  return length.value / 100 * whole;
}

std::optional<geom::Point2> parse_origin(std::string_view text, double px_per_inch,
                                         const Viewport& viewport) {
  std::vector<std::string> words;
  for (text = trim(text); !text.empty() && words.size() < 3; text = trim(text)) {
    const std::size_t end = std::min(text.find_first_of(" \t\n\r,"), text.size());
    words.push_back(to_lower(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (words.empty() || !text.empty()) return std::nullopt;
  if (words.size() == 1) words.emplace_back("center");
  // Keywords may stand in either order: "top left".
  if (words[0] == "top" || words[0] == "bottom" || words[1] == "left" || words[1] == "right") {
    std::swap(words[0], words[1]);
  }
  const auto place = [&](const std::string& word, Axis axis) -> std::optional<double> {
    const bool low = word == (axis == Axis::x ? "left" : "top"),
               high = word == (axis == Axis::x ? "right" : "bottom");
    if (low) return 0.0;
    const auto length = high               ? std::optional(Length{100, Unit::percent})
                        : word == "center" ? std::optional(Length{50, Unit::percent})
                                           : parse_length(word);
    return length ? length_in_user_units(*length, px_per_inch, viewport, axis) : std::nullopt;
  };
  const auto x = place(words[0], Axis::x), y = place(words[1], Axis::y);
  if (!x || !y) return std::nullopt;
  return geom::Point2{*x, *y};
}

std::optional<ViewBox> parse_view_box(std::string_view text) {
  std::vector<double> v;
  if (!read_numbers(text, 4, v) || v.size() != 4 || !(v[2] > 0) || !(v[3] > 0)) return std::nullopt;
  return ViewBox{v[0], v[1], v[2], v[3]};
}

AspectRatio parse_aspect_ratio(std::string_view text) {
  AspectRatio ratio;
  text = trim(text);
  if (text.starts_with("defer")) text = trim(text.substr(5));
  if (text.starts_with("none")) {
    ratio.keep = false;
    return ratio;
  }
  if (text.size() < 8 || text[0] != 'x' || text[4] != 'Y') return ratio;
  const auto align = [](std::string_view word) { return word == "Min" ? 0.0 : word == "Max" ? 1.0 : 0.5; };
  ratio.align_x = align(text.substr(1, 3));
  ratio.align_y = align(text.substr(5, 3));
  ratio.slice = trim(text.substr(8)) == "slice";
  return ratio;
}

geom::Affine2 view_box_map(const ViewBox& box, double x, double y, double width, double height,
                           const AspectRatio& ratio) {
  double sx = width / box.width, sy = height / box.height;
  if (ratio.keep) sx = sy = ratio.slice ? std::max(sx, sy) : std::min(sx, sy);
  if (ratio.keep) {
    x += ratio.align_x * (width - sx * box.width);
    y += ratio.align_y * (height - sy * box.height);
  }
  return {sx, 0, 0, sy, x - sx * box.x, y - sy * box.y};
}

}  // namespace burin::io::svg
