// SPDX-License-Identifier: Apache-2.0
// For the tests: small DXF texts. Groups are written "code value|code value|...".
#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <string_view>

#include "burin/io/dxf/read_dxf.h"

namespace burin::io::dxf_text {

/// "0 LINE|10 1.5" -> "0\nLINE\n10\n1.5\n".
inline std::string groups(std::string_view shorthand) {
  std::string text;
  while (!shorthand.empty()) {
    const auto bar = shorthand.find('|');
    const std::string_view group = shorthand.substr(0, bar);
    const auto blank = group.find(' ');
    text.append(group.substr(0, blank)) += '\n';
    if (blank != std::string_view::npos) text.append(group.substr(blank + 1));
    text += '\n';
    shorthand.remove_prefix(bar == std::string_view::npos ? shorthand.size() : bar + 1);
  }
  return text;
}

struct Parts {
  std::string header, tables, blocks, entities;  // in shorthand
};

inline std::string section(const char* name, std::string_view shorthand) {
  return groups(std::string("0 SECTION|2 ") + name) + groups(shorthand) + groups("0 ENDSEC");
}
inline std::string layer_table(std::string_view layers) {
  return "0 TABLE|2 LAYER|70 9|" + std::string(layers) + "|0 ENDTAB";
}

inline std::string file(const Parts& parts) {
  std::string text;
  if (!parts.header.empty()) text += section("HEADER", parts.header);
  if (!parts.tables.empty()) text += section("TABLES", parts.tables);
  if (!parts.blocks.empty()) text += section("BLOCKS", parts.blocks);
  return text + section("ENTITIES", parts.entities) + groups("0 EOF");
}
inline std::string file(const std::string& entities) {
  Parts parts;
  parts.entities = entities;
  return file(parts);
}

inline Result<Drawing> try_read(std::string_view text, Diagnostics& diagnostics, ReadOptions options = {}) {
  options.file_name = "t.dxf";
  return read_dxf(text, options, diagnostics);
}
/// Reads what must be readable.
inline Drawing read(std::string_view text, Diagnostics& diagnostics, ReadOptions options = {}) {
  auto drawing = try_read(text, diagnostics, options);
  if (!drawing) {
    ADD_FAILURE() << drawing.error().to_string();
    return {};
  }
  return std::move(*drawing);
}
inline Drawing read(std::string_view text, ReadOptions options = {}) {
  Diagnostics diagnostics;
  return read(text, diagnostics, options);
}
/// Reads what must be refused.
inline Error refuse(std::string_view text, ReadOptions options = {}) {
  Diagnostics diagnostics;
  auto drawing = try_read(text, diagnostics, options);
  EXPECT_FALSE(drawing.ok());
  return drawing.ok() ? Error{} : drawing.error();
}

inline std::string number(double value) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  out << value;
  return out.str();
}

inline void expect_near(geom::Point2 a, geom::Point2 b, double within = 1e-9) {
  EXPECT_NEAR(a.x, b.x, within);
  EXPECT_NEAR(a.y, b.y, within);
}

/// The only curve of an entity.
inline const geom::Curve2& only_curve(const Drawing& drawing, std::size_t entity = 0) {
  static const geom::Curve2 none;
  if (drawing.entities.size() <= entity || drawing.entities[entity].paths.size() != 1 ||
      drawing.entities[entity].paths[0].curves.size() != 1) {
    ADD_FAILURE() << "not one curve in entity " << entity << " of " << drawing.entities.size();
    return none;
  }
  return drawing.entities[entity].paths[0].curves[0];
}

}  // namespace burin::io::dxf_text
