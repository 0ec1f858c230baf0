// SPDX-License-Identifier: Apache-2.0
#include "burin/job/orient_job.h"

#include <algorithm>
#include <cmath>

#include "burin/base/text.h"
#include "burin/job/job_tables.h"
#include "burin/model/machine.h"
#include "burin/model/toml_reader.h"

namespace burin::job {
namespace {

using geom::degrees;
using geom::radians;
using model::TomlReader;

constexpr double kMaxLength = 1e4;  ///< mm: tools, steps and heights beyond 10 m are slips
constexpr double kSmallest = 1e-4;  ///< mm: lengths below are slips too
constexpr std::size_t kMostFiles = 1000;
constexpr std::size_t kMostFaces = 100'000;
constexpr double kMaxTilt = 89;  ///< degrees: beyond, a mill lies on its side

bool has(const toml::table& table, std::string_view key) {
  return table.get(key) != nullptr;
}

/// Fails at each of `keys` that is there: they mean nothing beside `what`.
void none_of(TomlReader& reader, const toml::table& table, const std::vector<std::string>& keys,
             const std::string& what) {
  for (const std::string& key : keys)
    if (const toml::node* node = table.get(key)) reader.fail(*node, "\"" + key + "\" " + what);
}

int whole(TomlReader& reader, const toml::table& table, std::string_view key, int min, int max,
          std::optional<int> fallback) {
  const std::optional<double> default_value =
      fallback ? std::optional<double>(*fallback) : std::optional<double>();
  const double value = reader.number(table, key, min, max, default_value);
  if (value == std::floor(value)) return static_cast<int>(value);
  reader.fail(*table.get(key), "\"" + std::string(key) + "\" is not a whole number (" + std::to_string(min) +
                                   " to " + std::to_string(max) + ")");
  return min;
}

/// Names of files, none of them empty.
std::vector<std::string> files(TomlReader& reader, const toml::table& table, std::string_view key) {
  std::vector<std::string> names;
  const toml::node* node = table.get(key);
  if (node == nullptr) return names;
  const std::string wanted = " ([\"a.stl\", \"b.step\"], up to " + std::to_string(kMostFiles) + ")";
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() > kMostFiles) {
    reader.fail(*node, "\"" + std::string(key) + "\" is not a list of files" + wanted);
    return names;
  }
  for (const toml::node& entry : *array) {
    const auto* name = entry.as_string();
    if (name == nullptr || trim(name->get()).empty()) {
      reader.fail(entry, "\"" + std::string(key) + "\" holds something that is no file" + wanted);
      return names;
    }
    names.push_back(name->get());
  }
  return names;
}

std::string file(TomlReader& reader, const toml::table& table, std::string_view key) {
  std::string name = reader.text(table, key);
  if (!reader.error() && trim(name).empty())
    reader.fail(*table.get(key), "\"" + std::string(key) + "\" is empty (a file)");
  return name;
}

// --- [part]

std::vector<int> read_faces(TomlReader& reader, const toml::table& table) {
  std::vector<int> faces;
  const toml::node* node = table.get("faces");
  if (node == nullptr) return faces;
  const std::string wanted = " ([1, 3]: numbers of faces in the file, from 1, each once)";
  const toml::array* array = node->as_array();
  if (array == nullptr || array->empty() || array->size() > kMostFaces) {
    reader.fail(*node, "\"faces\" is not a list of faces" + wanted);
    return faces;
  }
  for (const toml::node& entry : *array) {
    const auto* number = entry.as_integer();
    const bool fine = number != nullptr && number->get() >= 1 && number->get() <= 1'000'000;
    if (!fine) {
      reader.fail(entry, "\"faces\" holds something that is no face" + wanted);
      return faces;
    }
    faces.push_back(static_cast<int>(number->get()));
  }
  std::vector<int> sorted = faces;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    reader.fail(*node, "\"faces\" names face " + std::to_string(*twice) + " twice" + wanted);
  return faces;
}

model::PropellerData read_propeller(TomlReader& reader, const toml::table& table) {
  const toml::node& node = *table.get("propeller");
  model::PropellerData p;
  const toml::table* inner = node.as_table();
  if (inner == nullptr) {
    reader.fail(node,
                "\"propeller\" is not a table ({ blades = 5, diameter = 1000.0, pitch_ratio = 1.0, "
                "area_ratio = 0.75, hub_ratio = 0.18, side = \"face\" })");
    return p;
  }
  reader.only_keys(*inner, {"blades", "diameter", "pitch_ratio", "area_ratio", "hub_ratio", "rake", "side"});
  // What the series covers is the propeller's own check; here only slips of the keyboard.
  p.blades = whole(reader, *inner, "blades", 1, 100, p.blades);
  p.diameter = reader.number(*inner, "diameter", kSmallest, 1e5, p.diameter);
  p.pitch_ratio = reader.number(*inner, "pitch_ratio", 0, 100, p.pitch_ratio);
  p.area_ratio = reader.number(*inner, "area_ratio", 0, 100, p.area_ratio);
  p.hub_ratio = reader.number(*inner, "hub_ratio", 0, 1, p.hub_ratio);
  p.rake = radians(reader.number(*inner, "rake", -89, 89, degrees(p.rake)));
  p.side = reader.choice<model::BladeSide>(
      *inner, "side", {{"face", model::BladeSide::face}, {"back", model::BladeSide::back}}, p.side);
  if (!reader.error())
    if (auto fine = model::validate(p); !fine) reader.fail(node, fine.error().message, fine.error().code);
  return p;
}

}  // namespace

void read_orient_part(TomlReader& reader, const toml::table& table, bool contacts, OrientJobFile& job) {
  reader.only_keys(table, {"surface", "mesh", "propeller", "faces", "flip", "obstacles", "contacts"});
  std::string kind;
  for (const std::string key : {"surface", "mesh", "propeller"}) {
    if (!has(table, key)) continue;
    if (!kind.empty())
      reader.fail(*table.get(key),
                  "\"" + key + "\" beside \"" + kind + "\" (one of surface, mesh, propeller)");
    kind = key;
  }
  if (kind.empty()) reader.fail(table, "[part] has no design surface (surface, mesh or propeller)");
  const bool flip = reader.flag(table, "flip", false);
  job.obstacles = files(reader, table, "obstacles");
  if (has(table, "contacts")) job.contacts = file(reader, table, "contacts");
  if (kind == "surface") {
    job.part = OrientSurface{file(reader, table, "surface"), read_faces(reader, table), flip};
    return;
  }
  none_of(reader, table, {"faces"}, "without \"surface\" (it selects faces of a STEP or IGES file)");
  if (kind == "propeller") {
    none_of(reader, table, {"flip"},
            "beside \"propeller\" (propeller = { side = \"back\" } is its other side)");
    job.part = read_propeller(reader, table);
    return;
  }
  if (kind == "mesh") {
    job.part = OrientMesh{file(reader, table, "mesh"), flip};
    if (contacts && !has(table, "contacts"))
      reader.fail(*table.get("mesh"),
                  "\"mesh\" without \"contacts\": triangles have no paths of their own (contacts = "
                  "\"points.csv\": path,x,y,z,nx,ny,nz,fx,fy,fz)");
  }
}

// --- [tool]

namespace {

void read_pieces(TomlReader& reader, const toml::table& table, std::string_view key, model::Mill& mill) {
  for (const toml::table* piece : reader.tables(table, key)) {
    reader.only_keys(*piece, {"radius", "height"});
    mill.holder.push_back({reader.number(*piece, "radius", kSmallest, kMaxLength),
                           reader.number(*piece, "height", kSmallest, kMaxLength)});
  }
}

}  // namespace

model::Mill read_mill(TomlReader& reader, const toml::table& table, const std::vector<std::string>& besides) {
  std::vector<std::string> keys = {"kind", "radius", "corner_radius", "length", "shank", "holder", "head"};
  keys.insert(keys.end(), besides.begin(), besides.end());
  reader.only_keys(table, keys);
  model::Mill mill;
  mill.kind = reader.choice<model::MillKind>(
      table, "kind", {{"flat", model::MillKind::flat}, {"bull", model::MillKind::bull}}, mill.kind);
  mill.radius = reader.number(table, "radius", kSmallest, kMaxLength);
  mill.corner_radius = reader.number(table, "corner_radius", 0, kMaxLength, 0.0);
  if (!reader.error() && !has(table, "length"))
    reader.fail(table, "the tool has no \"length\" (height of the cutting body above the tip in mm, " +
                           format_shortest(kSmallest) + " to " + format_shortest(kMaxLength) +
                           "; the holder stands on it)");
  mill.length = reader.number(table, "length", kSmallest, kMaxLength);
  for (const char* key : {"shank", "holder", "head"}) read_pieces(reader, table, key, mill);
  if (!reader.error())
    if (auto fine = model::validate(mill); !fine) reader.fail(table, fine.error().message, fine.error().code);
  return mill;
}

// --- [operation]

namespace {

const std::vector<std::string> kOperationKeys = {
    "paths",     "plane_normal", "tilt",       "yaw",      "tolerance", "clearance",
    "objective", "search",       "smooth",     "scallop",  "feed",      "spindle",
    "side_step", "path_count",   "sturz_tilt", "max_step", "edge",      "safety"};

void read_paths(TomlReader& reader, const toml::table& table, bool contacts, orient::OrientOptions& o) {
  orient::PathOptions& paths = o.paths;
  paths.pattern = reader.choice<orient::Pattern>(table, "paths",
                                                 {{"iso-u", orient::Pattern::iso_u},
                                                  {"iso-v", orient::Pattern::iso_v},
                                                  {"plane", orient::Pattern::plane}},
                                                 paths.pattern);
  paths.chord_mm = o.tolerance_mm;
  if (contacts)
    none_of(reader, table, {"plane_normal", "side_step", "path_count", "max_step", "edge"},
            "beside \"contacts\", which has its own paths (one or the other)");
  if (const toml::node* node = table.get("plane_normal")) {
    if (paths.pattern != orient::Pattern::plane)
      reader.fail(*node, "\"plane_normal\" without paths = \"plane\" (one with the other)");
    const std::vector<double> n = reader.triple(table, "plane_normal");
    const double length = std::hypot(n[0], n[1], n[2]);
    if (!reader.error() && !(length > 0 && std::isfinite(length)))
      reader.fail(*node, "\"plane_normal\" has no direction (three numbers that are not all 0)");
    if (length > 0) paths.plane_normal = {n[0] / length, n[1] / length, n[2] / length};
  }
  if (has(table, "side_step")) o.side_step_mm = reader.number(table, "side_step", kSmallest, kMaxLength);
  if (has(table, "path_count"))
    o.path_count = whole(reader, table, "path_count", 1, orient::kMostPaths, std::nullopt);
  if (o.side_step_mm && o.path_count)
    reader.fail(*table.get("path_count"), "\"path_count\" beside \"side_step\" (one or the other)");
  if (has(table, "max_step")) paths.max_step_mm = reader.number(table, "max_step", kSmallest, kMaxLength);
  paths.edge_mm = reader.number(table, "edge", 0, kMaxLength, paths.edge_mm);
}

orient::OrientOptions read_operation(TomlReader& reader, const toml::table& table, bool contacts) {
  reader.only_keys(table, kOperationKeys);
  orient::OrientOptions o;
  const auto tilt =
      reader.range(table, "tilt", 0, kMaxTilt, {degrees(o.range.alpha_lo), degrees(o.range.alpha_hi)});
  const auto yaw = reader.range(table, "yaw", -90, 90, {degrees(o.range.beta_lo), degrees(o.range.beta_hi)});
  o.range = {radians(tilt.first), radians(tilt.second), radians(yaw.first), radians(yaw.second)};
  o.tolerance_mm = reader.number(table, "tolerance", 1e-5, 10, o.tolerance_mm);
  o.clearance_mm = reader.number(table, "clearance", 0, 1e3, o.clearance_mm);
  o.objective = reader.choice<orient::Objective>(
      table, "objective", {{"radius", orient::Objective::radius}, {"strip", orient::Objective::strip}},
      o.objective);
  o.search = reader.choice<orient::Search>(table, "search",
                                           {{"optimal", orient::Search::optimal},
                                            {"contour", orient::Search::contour},
                                            {"sturz", orient::Search::sturz}},
                                           o.search);
  o.smooth = reader.flag(table, "smooth", o.smooth);
  o.scallop_mm = reader.number(table, "scallop", 1e-6, 1e3, o.scallop_mm);
  o.feed_mm_min = reader.number(table, "feed", 1e-3, 1e6, o.feed_mm_min);
  o.spindle_rpm = reader.number(table, "spindle", 0, 1e6, o.spindle_rpm);
  o.safety_mm = reader.number(table, "safety", 1e-3, kMaxLength, o.safety_mm);
  if (has(table, "sturz_tilt")) o.sturz_tilt = radians(reader.number(table, "sturz_tilt", 0, kMaxTilt));
  if (o.search == orient::Search::contour && o.objective == orient::Objective::strip)
    reader.fail(*table.get("search"),
                "search = \"contour\" with objective = \"strip\" (the paper's procedure follows contours of "
                "the radius: objective = \"radius\", or search = \"optimal\")");
  if (o.search == orient::Search::sturz && o.smooth)
    reader.fail(*table.get("smooth"),
                "smooth = true with search = \"sturz\" (its angles are equal at all points already)");
  read_paths(reader, table, contacts, o);
  return o;
}

// --- [machine]

}  // namespace

std::string read_machine(TomlReader& reader, const toml::table& table) {
  reader.only_keys(table, {"name"});
  std::string name = reader.text(table, "name");
  if (reader.error() || name == "none" || name.ends_with(".toml")) return name;
  std::vector<std::string> known = model::machine_names();
  known.push_back("none");
  if (std::find(known.begin(), known.end(), name) != known.end()) return name;
  std::string list;
  for (const std::string& word : known) list += (list.empty() ? "" : ", ") + word;
  const std::string near = nearest_word(name, known);
  reader.fail(*table.get("name"), "machine \"" + name + "\" is not known (one of: " + list +
                                      "; or a file NAME.toml beside the job" +
                                      (near.empty() ? "" : "; did you mean " + near + "?") + ")");
  return name;
}

Result<OrientJobFile> read_orient_job(std::string_view text, const std::string& file_name) {
  TomlReader reader(file_name);
  const toml::table root = reader.parse(text);
  if (reader.error()) return *reader.error();
  reader.only_keys(root, {"part", "tool", "operation", "machine", "stock"});  // [stock]: `burin verify`
  OrientJobFile job;
  read_orient_part(reader, reader.subtable(root, "part"), true, job);
  job.mill = read_mill(reader, reader.subtable(root, "tool"));
  const toml::table no_table;
  const toml::table& operation = has(root, "operation") ? reader.subtable(root, "operation") : no_table;
  job.options = read_operation(reader, operation, !job.contacts.empty());
  if (has(root, "machine")) job.machine = read_machine(reader, reader.subtable(root, "machine"));
  if (reader.error()) return *reader.error();
  return job;
}

}  // namespace burin::job
