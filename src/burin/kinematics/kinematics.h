// SPDX-License-Identifier: Apache-2.0
// Joints of a machine from tool poses and back: any machine with X, Y, Z along the frame's axes and at most
// two rotary axes, in the table, in the head, or one in each. mm, radians.
//   tool axis   u = R1(s1 a) R2(s2 b) z      first axis next to the workpiece; s = -1: turns the part, +1:
//   the tool linear axes X = p' + L u' - (0, 0, L)    p', u': tip and axis after the table axes, L: pivot
//   length
// Both rotary angles from u: Paden & Kahan, subproblem 2 (Murray, Li, Sastry 1994, 3.3.2).
#pragma once

#include <array>
#include <optional>
#include <string>

#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/model/machine.h"

namespace burin::kinematics {

/// Positions of the axes; rotary ones in the order from the workpiece to the tool.
struct Joints {
  std::array<double, 3> linear{};  ///< X, Y, Z, mm
  std::array<double, 2> rotary{};  ///< radians, any number of turns; unused ones 0
  bool operator==(const Joints&) const = default;
};

/// All ways to take a pose, but for whole turns: at most two.
struct Solutions {
  std::array<Joints, 2> joints;  ///< rotary angles in [-pi, pi], those that do not matter as they were asked
  int count = 0;                 ///< 0: the machine cannot bring the tool axis there, whatever its limits
  /// Rotary axes that do not turn the tool axis there (it runs along them): any angle of theirs is a
  /// solution. With one of them free the two solutions are one.
  std::array<bool, 2> free{};
};

/// An axis beyond its travel.
struct LimitViolation {
  char letter = 0;
  double value = 0, min = 0, max = 0;  ///< mm or degrees
  std::string text() const;            ///< "A 130.5 deg (-120 to 120)"
};

class Kinematics {
 public:
  /// Error (unsupported): linear axes that are missing, doubled or not along the frame, rotary axes that are
  /// more than two or parallel, table axes that stand nearer to the tool than head axes, an offset head axis.
  static Result<Kinematics> make(const model::Machine& machine);

  const model::Machine& machine() const { return machine_; }
  int rotary_count() const { return rotary_count_; }
  const model::Axis& rotary_axis(int i) const { return rotary_[static_cast<std::size_t>(i)]; }
  /// The rotary axes tilt or turn the part only: joint coordinates are tip coordinates.
  bool table_only() const;

  cl::Pose forward(const Joints& joints) const;

  /// `free`: the angles of axes that do not matter. Limits of travel are not looked at.
  Solutions inverse_all(const cl::Pose& pose, const Joints& free = {}) const;

  /// The solution nearest to `near` by the larger of the two turns (whole turns included, within the limits
  /// where there are some); where the first rotary axis does not matter (u along it) it stays as it is. Error
  /// (unsupported): a tool axis that this machine cannot reach, whatever its limits. Limits of travel are not
  /// checked unless a whole turn less or more keeps them; see violation().
  Result<Joints> inverse(const cl::Pose& pose, const Joints& near) const;

  /// The joints that hold the tip there with the rotary axes at these angles.
  Joints with_rotary(const geom::Point3& tip, const std::array<double, 2>& rotary) const;

  /// The first axis beyond its limits, by more than rounding.
  std::optional<LimitViolation> violation(const Joints& joints) const;

 private:
  geom::Point3 to_machine(geom::Point3 p, const std::array<double, 2>& rotary) const;
  geom::Point3 to_part(geom::Point3 p, const std::array<double, 2>& rotary) const;
  geom::Vec3 head_axis(const std::array<double, 2>& rotary) const;
  double sign(int i) const;
  /// Rotary angles that bring the tool axis to u.
  struct Turns {
    std::array<std::array<double, 2>, 2> angles{};
    int count = 0;
    std::array<bool, 2> free{};
  };
  Turns turns_to(geom::Vec3 u) const;

  model::Machine machine_;
  int rotary_count_ = 0;
  std::array<model::Axis, 2> rotary_;
  std::array<std::optional<model::Axis>, 3> linear_;
};

/// v turned by `angle` about the unit vector `axis`, right-handed.
geom::Vec3 turned(geom::Vec3 v, geom::Vec3 axis, double angle);

}  // namespace burin::kinematics
