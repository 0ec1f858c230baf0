// SPDX-License-Identifier: Apache-2.0
// A machine as data: kinematic chain of linear and rotary axes from the workpiece to the tool, limits, speeds
// (TOML; spec: docs/machines.md). The kinematics that use it stand with the post.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/vec.h"

namespace burin::model {

enum class AxisKind { linear, rotary };
enum class AxisSide { table, head };  ///< table: moves or turns the part; head: moves or tilts the tool

struct Axis {
  char letter = 0;  ///< X Y Z A B C
  AxisKind kind = AxisKind::linear;
  AxisSide side = AxisSide::table;
  geom::Vec3 direction;              ///< unit; positive angle right-handed about it
  geom::Point3 point;                ///< on the axis, mm, part frame at zero position
  double min = -99999, max = 99999;  ///< mm or degrees
  double speed = 0;                  ///< mm/min or deg/min
  double acceleration = 0;           ///< mm/s^2 or deg/s^2
};

struct Machine {
  std::string name;
  std::string description;
  double pivot_length = 0;  ///< mm
  std::string dialect;      ///< default dialect, may be empty
  std::vector<Axis> axes;   ///< from the workpiece outwards
  const Axis* axis(char letter) const;
};

std::vector<std::string> machine_names();
/// A preset by name, else a TOML file by path. Errors: usage (unknown name: names the presets), io, syntax.
Result<Machine> find_machine(const std::string& name_or_path);
/// Unknown keys are errors that name the nearest known key.
Result<Machine> parse_machine(std::string_view toml, const std::string& file_name);

}  // namespace burin::model
