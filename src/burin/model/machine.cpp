// SPDX-License-Identifier: Apache-2.0
#include "burin/model/machine.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>

#include "burin/base/embedded.h"
#include "burin/base/file.h"
#include "burin/base/text.h"
#include "burin/model/toml_reader.h"

namespace burin::embedded {
std::vector<File> machines();
}

namespace burin::model {
namespace {

constexpr std::uint64_t kMaxFileBytes = 1 << 20;
constexpr double kMaxTravel = 99999;  ///< mm or degrees: what stands for "no limit" in machine files
constexpr double kMaxSpeed = 1e7, kMaxAcceleration = 1e7;
/// Sine of the angle below which two linear axes count as parallel: no machine is built like that.
constexpr double kParallelSine = 1e-3;

std::string stem(std::string_view file_name) {
  return std::string(file_name.substr(0, file_name.rfind(".toml")));
}

geom::Vec3 vector_of(const std::vector<double>& v) {
  return {v[0], v[1], v[2]};
}

Axis read_axis(TomlReader& reader, const toml::table& table) {
  reader.only_keys(table,
                   {"letter", "kind", "side", "direction", "point", "min", "max", "speed", "acceleration"});
  Axis axis;
  const std::string letter = reader.text(table, "letter");
  const bool known = letter.size() == 1 && std::string_view("XYZABC").find(letter) != std::string_view::npos;
  if (!known) reader.fail(table, "axis letter \"" + letter + "\" is not known (X, Y, Z, A, B, C)");
  axis.letter = known ? letter[0] : 'X';

  const std::string kind = reader.text(table, "kind");
  if (kind != "rotary" && kind != "linear")
    reader.fail(table, "axis kind \"" + kind + "\" is not known (rotary, linear)");
  axis.kind = kind == "rotary" ? AxisKind::rotary : AxisKind::linear;
  const bool rotary_letter = axis.letter <= 'C';
  if (rotary_letter != (axis.kind == AxisKind::rotary)) {
    reader.fail(table, "axis " + letter + " cannot be " + kind + " (X, Y, Z are linear, A, B, C rotary)");
  }

  const std::string side = reader.text(table, "side");
  if (side != "table" && side != "head")
    reader.fail(table, "axis side \"" + side + "\" is not known (table, head)");
  axis.side = side == "head" ? AxisSide::head : AxisSide::table;

  const geom::Vec3 direction = vector_of(reader.triple(table, "direction"));
  axis.direction = geom::unit(direction);
  if (!(geom::norm(axis.direction) > 0.5))
    reader.fail(table, "axis " + letter + " has no direction (a vector that is not zero)");
  const geom::Vec3 point = vector_of(reader.triple(table, "point", std::vector<double>{0, 0, 0}));
  axis.point = {point.x, point.y, point.z};

  axis.min = reader.number(table, "min", -kMaxTravel, kMaxTravel, -kMaxTravel);
  axis.max = reader.number(table, "max", -kMaxTravel, kMaxTravel, kMaxTravel);
  if (axis.min >= axis.max) reader.fail(table, "axis " + letter + " has no travel (min below max)");
  axis.speed = reader.number(table, "speed", 0, kMaxSpeed, 0.0);
  axis.acceleration = reader.number(table, "acceleration", 0, kMaxAcceleration, 0.0);
  return axis;
}

/// What only shows in the chain as a whole.
void check_chain(TomlReader& reader, const toml::table& root, const Machine& machine) {
  if (machine.axes.empty()) reader.fail(root, "no axes ([[axes]], from the workpiece outwards)");
  int rotary = 0;
  bool head_seen = false, head_turns = false;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const Axis& axis = machine.axes[i];
    const std::string letter(1, axis.letter);
    rotary += axis.kind == AxisKind::rotary ? 1 : 0;
    if (axis.side == AxisSide::head) head_seen = true;
    if (axis.side == AxisSide::table && head_seen) {
      reader.fail(root, "axis " + letter +
                            " on the table comes after an axis of the head (from the workpiece outwards)");
    }
    head_turns = head_turns || (axis.side == AxisSide::head && axis.kind == AxisKind::rotary);
    for (std::size_t j = 0; j < i; ++j) {
      const Axis& other = machine.axes[j];
      if (other.letter == axis.letter)
        reader.fail(root, "axis " + letter + " stands twice (each letter once)");
      if (axis.kind == AxisKind::linear && other.kind == AxisKind::linear &&
          geom::norm(geom::cross(axis.direction, other.direction)) < kParallelSine) {
        reader.fail(root, "axes " + std::string(1, other.letter) + " and " + letter +
                              " are parallel (independent directions)");
      }
    }
  }
  if (rotary > 2) reader.fail(root, "three rotary axes (at most two)", ErrorCode::unsupported);
  if (machine.pivot_length > 0 && !head_turns) {
    reader.fail(root, "pivot_length without a rotary axis in the head (0 when nothing turns in the head)");
  }
}

}  // namespace

const Axis* Machine::axis(char letter) const {
  const auto found =
      std::find_if(axes.begin(), axes.end(), [letter](const Axis& a) { return a.letter == letter; });
  return found == axes.end() ? nullptr : &*found;
}

std::vector<std::string> machine_names() {
  std::vector<std::string> names;
  for (const embedded::File& file : embedded::machines()) names.push_back(stem(file.name));
  std::sort(names.begin(), names.end());
  return names;
}

Result<Machine> find_machine(const std::string& name_or_path) {
  for (const embedded::File& file : embedded::machines()) {
    if (stem(file.name) == name_or_path) return parse_machine(file.text, std::string(file.name));
  }
  const bool looks_like_path = name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml");
  if (!looks_like_path) {
    std::string list;
    const auto names = machine_names();
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    const std::string near = nearest_word(name_or_path, names);
    return Error{ErrorCode::usage,
                 "unknown machine \"" + name_or_path + "\" (" +
                     (near.empty() ? "" : "did you mean " + near + "? ") + "one of: " + list +
                     "; or a file NAME.toml)",
                 {}};
  }
  auto text = read_file(name_or_path, kMaxFileBytes);
  if (!text) return text.error();
  return parse_machine(*text, name_or_path);
}

Result<Machine> parse_machine(std::string_view toml, const std::string& file_name) {
  try {
    TomlReader reader(file_name);
    const toml::table root = reader.parse(toml);
    if (reader.error()) return *reader.error();
    reader.only_keys(root, {"name", "description", "pivot_length", "dialect", "axes"});
    Machine machine;
    machine.name = reader.text(root, "name");
    if (!reader.error() && trim(machine.name).empty()) reader.fail(root, "\"name\" is empty (a name)");
    machine.description = reader.text(root, "description", "");
    machine.pivot_length = reader.number(root, "pivot_length", 0, kMaxTravel, 0.0);
    machine.dialect = reader.text(root, "dialect", "");
    for (const auto* table : reader.tables(root, "axes")) machine.axes.push_back(read_axis(reader, *table));
    if (!reader.error()) check_chain(reader, root, machine);
    if (reader.error()) return *reader.error();
    return machine;
  } catch (const std::exception& problem) {
    return Error{ErrorCode::internal, problem.what(), {.file = file_name}};
  }
}

}  // namespace burin::model
