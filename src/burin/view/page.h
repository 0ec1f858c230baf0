// SPDX-License-Identifier: Apache-2.0
// What the report pages have in common: numbers and texts as JSON, and the page around them. Private to view.
#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/geom/vec.h"
#include "burin/view/mesh_shape.h"

namespace burin::view {

inline constexpr double kSteps16 = 65535, kSteps15 = 32767, kSteps7 = 127;

nlohmann::json number_or_null(double v);
/// Not finite: 0.
float single(double v);
/// lo .. lo + size as 0 .. 65535; 0 without size.
std::uint16_t scaled(double v, double lo, double size);
/// Of -1 to 1.
std::int16_t signed16(double v);
std::int8_t signed8(double v);

/// Points as 16 bit numbers in the box of the shape, normals as 8 bit: 36 characters a triangle. `of`: how
/// many triangles there were before it was reduced.
nlohmann::json shape_json(const Shape& shape, std::size_t of);

/// "title", "command", "warnings" and "warningCount", "nc" (its beginning, whole lines) and "ncLines".
void put_texts(nlohmann::json& data, const std::string& title, const std::string& command_line,
               const Diagnostics* diagnostics, const std::string& nc_text);

/// Rows {group, name, value}.
template <class Figure>
nlohmann::json figures_json(const std::vector<Figure>& figures) {
  nlohmann::json list = nlohmann::json::array();
  for (const Figure& f : figures) list.push_back({f.group, f.name, f.value});
  return list;
}

/// The page `file` of data/pages with the shared style and script, its title and its data.
std::string make_page(std::string_view file, const std::string& title, const nlohmann::json& data);

}  // namespace burin::view
