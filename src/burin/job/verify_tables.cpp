// SPDX-License-Identifier: Apache-2.0
#include "burin/job/verify_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "burin/geom/point_tools.h"
#include "burin/job/job_tables.h"
#include "burin/model/toml_reader.h"

namespace burin::job {
namespace {

using geom::Point3;
using geom::Vec3;
using model::TomlReader;

constexpr double kMaxLength = 1e5;  ///< mm: beyond 100 m everything is a slip
constexpr double kSmallest = 1e-4;

Point3 point(TomlReader& reader, const toml::table& table, std::string_view key, Point3 fallback = {}) {
  const std::vector<double> v =
      reader.triple(table, key, std::vector<double>{fallback.x, fallback.y, fallback.z});
  if (reader.error() || v.size() != 3) return fallback;
  for (const double x : v)
    if (!(std::abs(x) <= kMaxLength))
      reader.fail(*table.get(key), "\"" + std::string(key) + "\" is beyond 100 m");
  return {v[0], v[1], v[2]};
}

/// The shapes of [part] that only `burin rotary` knows, what only its [operation] says, or its machine with a
/// ball.
bool is_rotary(const toml::table& root, const toml::table& part) {
  for (const char* key : {"section", "sections", "scale"})
    if (part.contains(key)) return true;
  for (const char* key : {"propeller", "faces", "flip", "obstacles", "contacts"})
    if (part.contains(key)) return false;
  if (const toml::table* operation = root["operation"].as_table())
    for (const char* key : {"pattern", "tsi", "tai", "clearance_angle", "lean_angle"})
      if (operation->contains(key)) return true;
  const bool ball = root["tool"]["kind"].value_or<std::string>("ball") == "ball";
  return ball && root["machine"]["name"].value_or<std::string>("") == "xyza";
}

JobTool read_tool(TomlReader& reader, const toml::table& table, bool rotary) {
  JobTool tool;
  const std::string kind = reader.choice<std::string>(
      table, "kind", {{"ball", "ball"}, {"flat", "flat"}, {"bull", "bull"}}, rotary ? "ball" : "flat");
  if (table.contains("number")) {
    const double number = reader.number(table, "number", 0, 999'999);
    if (number != std::floor(number))
      reader.fail(*table.get("number"), "\"number\" is not a whole number (0 to 999999)");
    tool.number = static_cast<int>(number);
  }
  if (kind == "ball")
    tool.shape = read_ball_tool(reader, table, {"number"});
  else
    tool.shape = read_mill(reader, table, {"number"});
  return tool;
}

void read_tools(TomlReader& reader, const toml::table& root, VerifyTables& tables) {
  const toml::node* one = root.get("tool");
  const toml::node* many = root.get("tools");
  if (one && many) {
    reader.fail(*many, "\"tools\" beside \"tool\" (one or the other)");
  } else if (one && one->is_table()) {
    tables.tools.push_back(read_tool(reader, *one->as_table(), tables.rotary));
  } else if (one || many) {
    for (const toml::table* table : reader.tables(root, one ? "tool" : "tools")) {
      JobTool tool = read_tool(reader, *table, tables.rotary);
      for (const JobTool& other : tables.tools)
        if (other.number == tool.number)
          reader.fail(*table,
                      tool.number
                          ? "tool " + std::to_string(*tool.number) + " a second time (one of each number)"
                          : "several tools without \"number\" (number = 1, as T1 in the program)");
      tables.tools.push_back(std::move(tool));
    }
  }
}

Vec3 margin(TomlReader& reader, const toml::table& table) {
  const toml::node* node = table.get("margin");
  if (node && node->is_array()) {
    const Point3 m = point(reader, table, "margin");
    if (m.x < 0 || m.y < 0 || m.z < 0) reader.fail(*node, "\"margin\" below 0 (mm on each side, 0 or more)");
    return {m.x, m.y, m.z};
  }
  const double m = reader.number(table, "margin", 0, kMaxLength, kStockMargin_mm);
  return {m, m, m};
}

StockTable read_block(TomlReader& reader, const toml::table& table) {
  reader.only_keys(table, {"kind", "margin", "lo", "hi"});
  BlockTable block;
  block.margin = margin(reader, table);
  if (table.contains("lo")) block.lo = point(reader, table, "lo");
  if (table.contains("hi")) block.hi = point(reader, table, "hi");
  if (block.lo && block.hi && !reader.error())
    if (!(block.lo->x < block.hi->x && block.lo->y < block.hi->y && block.lo->z < block.hi->z))
      reader.fail(*table.get("hi"), "\"hi\" is not above \"lo\" in X, Y and Z");
  return block;
}

StockTable read_cylinder(TomlReader& reader, const toml::table& table, bool rotary) {
  reader.only_keys(table, {"kind", "margin", "radius", "length", "axis", "base"});
  CylinderTable cylinder;
  cylinder.margin = reader.number(table, "margin", 0, kMaxLength, kStockMargin_mm);
  if (rotary) cylinder.axis = {1, 0, 0};
  if (const toml::node* node = table.get("axis")) {
    if (node->is_string()) {
      cylinder.axis = reader.choice<Vec3>(
          table, "axis", {{"x", {1, 0, 0}}, {"y", {0, 1, 0}}, {"z", {0, 0, 1}}}, cylinder.axis);
    } else {
      const Point3 a = point(reader, table, "axis");
      const Vec3 v{a.x, a.y, a.z};
      if (!reader.error() && !(norm(v) > 0))
        reader.fail(*node, "\"axis\" has no direction (\"x\", or three numbers)");
      cylinder.axis = unit(v);
    }
  }
  if (table.contains("base")) {
    cylinder.point = point(reader, table, "base");
    cylinder.from = dot(cylinder.point - Point3{}, cylinder.axis);
  }
  if (table.contains("radius")) cylinder.radius = reader.number(table, "radius", kSmallest, kMaxLength);
  if (table.contains("length")) cylinder.length = reader.number(table, "length", kSmallest, kMaxLength);
  return cylinder;
}

StockTable read_stock(TomlReader& reader, const toml::table& table, bool rotary) {
  const bool file = table.contains("file");
  // `burin rotary` knows a round bar by its radius only.
  const std::string otherwise = file ? "file" : table.contains("radius") ? "cylinder" : "block";
  const std::string kind = reader.choice<std::string>(
      table, "kind", {{"block", "block"}, {"cylinder", "cylinder"}, {"file", "file"}}, otherwise);
  if (kind == "block") return read_block(reader, table);
  if (kind == "cylinder") return read_cylinder(reader, table, rotary);
  reader.only_keys(table, {"kind", "file"});
  return StockFile{reader.text(table, "file")};
}

geom::Box3 box_of(const geom::Mesh& mesh) {
  geom::Box3 box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.add(mesh.vertices[v]);
  return box;
}

removal::Stock make(const BlockTable& table, const geom::Mesh& design) {
  const geom::Box3 box = box_of(design);
  removal::BlockStock block{box.lo - table.margin, box.hi + table.margin};
  if (table.lo) block.lo = *table.lo;
  if (table.hi) block.hi = *table.hi;
  return block;
}

removal::Stock make(const CylinderTable& table, const geom::Mesh& design) {
  double lo = 0, hi = 0, radius = 0;
  bool any = false;
  for (const auto& t : design.triangles)
    for (const std::uint32_t v : t) {
      const Vec3 from = design.vertices[v] - table.point;
      const double along = dot(from, table.axis);
      lo = any ? std::min(lo, along) : along;
      hi = any ? std::max(hi, along) : along;
      radius = std::max(radius, norm(from - along * table.axis));
      any = true;
    }
  removal::CylinderStock cylinder;
  cylinder.axis = table.axis;
  const double from = table.from ? 0 : lo - table.margin;  // from the point along the axis
  cylinder.base = table.point + from * table.axis;
  cylinder.radius = table.radius.value_or(radius + table.margin);
  cylinder.length = table.length.value_or(hi + table.margin - from);
  return cylinder;
}

}  // namespace

Result<VerifyTables> read_verify_tables(std::string_view text, const std::string& file_name) {
  TomlReader reader(file_name);
  const toml::table root = reader.parse(text);
  if (reader.error()) return *reader.error();
  VerifyTables tables;
  const toml::table& part = reader.subtable(root, "part");
  tables.rotary = is_rotary(root, part);
  if (tables.rotary)
    tables.section = read_rotary_part(reader, part);
  else
    read_orient_part(reader, part, false, tables.faces);
  read_tools(reader, root, tables);
  if (root.contains("operation")) {
    const toml::table& operation = reader.subtable(root, "operation");
    if (operation.contains("tolerance"))
      tables.tolerance_mm = reader.number(operation, "tolerance", 1e-5, 10);
  }
  if (root.contains("machine")) tables.machine = read_machine(reader, reader.subtable(root, "machine"));
  if (root.contains("stock"))
    tables.stock = read_stock(reader, reader.subtable(root, "stock"), tables.rotary);
  if (reader.error()) return *reader.error();
  return tables;
}

Result<removal::Stock> make_stock(const StockTable& table, const geom::Mesh& design, geom::Mesh file) {
  removal::Stock stock;
  if (const auto* block = std::get_if<BlockTable>(&table))
    stock = make(*block, design);
  else if (const auto* cylinder = std::get_if<CylinderTable>(&table))
    stock = make(*cylinder, design);
  else
    stock = removal::MeshStock{std::move(file)};
  if (auto ok = removal::validate(stock); !ok) return ok.error();
  return stock;
}

}  // namespace burin::job
