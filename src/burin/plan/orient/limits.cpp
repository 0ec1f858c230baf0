// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::orient {
namespace {

using geom::Point3;
using geom::Vec3;
using kinematics::Joints;
using kinematics::Kinematics;

constexpr double kTurn = 2 * geom::kPi;
// Cells along an edge of the cube of directions: 24 kB, and cells of less than 1.3 degrees.
constexpr int kCells = 64;
// Directions this near to a boundary of what the rotary axes reach are asked exactly: far more than the slack
// of limits and the reach that the kinematics grants where a circle of reach shrinks to a point.
constexpr double kBoundarySlack = 5e-3;
// Sine of the angle between the second rotary axis and the tool below which a map of directions is of no use:
// the machine then hardly tilts the tool.
constexpr double kNoTilting = 1e-3;

Vec3 turned_z(const model::Axis& axis, double angle) {
  return kinematics::turned({0, 0, 1}, axis.direction, angle);
}

/// A cone of directions about an axis, on which the set of reachable directions may end.
struct Boundary {
  Vec3 axis;
  double half_angle = 0;
};

double angle_between(Vec3 a, Vec3 b) {
  return std::atan2(norm(geom::cross(a, b)), dot(a, b));
}

double sign_of(const model::Axis& axis) {
  return axis.side == model::AxisSide::table ? -1 : 1;
}

/// Where "some angles within the limits of the rotary axes point the tool there" can change: where an angle
/// stands at a limit, and where the two solutions meet.
std::vector<Boundary> boundaries(const Kinematics& machine) {
  const model::Axis &first = machine.rotary_axis(0), &second = machine.rotary_axis(1);
  std::vector<Boundary> found;
  const Vec3 a = first.direction, b = second.direction, z{0, 0, 1};
  if (first.max - first.min < 360) {
    for (const double limit : {first.min, first.max})
      found.push_back({kinematics::turned(b, a, sign_of(first) * geom::radians(limit)), angle_between(b, z)});
  }
  if (second.max - second.min < 360) {
    for (const double limit : {second.min, second.max})
      found.push_back({a, angle_between(a, turned_z(second, sign_of(second) * geom::radians(limit)))});
  }
  // Farthest along and against a: b carries z there in the plane of a and b.
  const double ab = angle_between(a, b), bz = angle_between(b, z);
  found.push_back({a, std::abs(ab - bz)});
  found.push_back({a, std::min(ab + bz, kTurn - ab - bz)});
  return found;
}

enum class Reach : std::uint8_t { none, all, ask };

/// Cell of the cube of directions: face by the largest component, then the other two over it.
std::size_t cell_of(const Vec3& u) {
  const double x = std::abs(u.x), y = std::abs(u.y), z = std::abs(u.z);
  double major = u.z, s = u.x, t = u.y;
  std::size_t face = 4;
  if (x >= y && x >= z)
    major = u.x, s = u.y, t = u.z, face = 0;
  else if (y >= z)
    major = u.y, s = u.z, t = u.x, face = 2;
  const double scale = 0.5 * kCells / std::abs(major);
  if (major < 0) ++face;
  const auto index = [&](double v) {
    return static_cast<std::size_t>(std::min(kCells - 1, static_cast<int>(v * scale + 0.5 * kCells)));
  };
  return (face * kCells + index(t)) * kCells + index(s);
}

Vec3 cell_center(std::size_t cell) {
  const std::size_t i = cell % kCells, j = cell / kCells % kCells, face = cell / kCells / kCells;
  const double s = (2.0 * static_cast<double>(i) + 1) / kCells - 1;
  const double t = (2.0 * static_cast<double>(j) + 1) / kCells - 1;
  const double major = face % 2 == 0 ? 1 : -1;
  const Vec3 v = face / 2 == 0 ? Vec3{major, s, t} : face / 2 == 1 ? Vec3{t, major, s} : Vec3{s, t, major};
  return unit(v);
}

}  // namespace

struct MachineLimits::State {
  explicit State(const Kinematics& k) : machine(k) {
    find_room();
    find_reach();
  }

  Kinematics machine;
  std::vector<Reach> reach;  ///< of the rotary axes, by cell; empty: always ask
  double room = 0;           ///< tips no farther from the origin than this (by component) never meet a limit

  /// Whatever the rotary angles, X, Y and Z are no farther out than the tip with the axes' offsets and twice
  /// the pivot length.
  void find_room() {
    double least = std::numeric_limits<double>::infinity(), added = 2 * machine.machine().pivot_length;
    for (const model::Axis& axis : machine.machine().axes)
      if (axis.kind == model::AxisKind::linear) least = std::min({least, -axis.min, axis.max});
    for (int i = 0; i < machine.rotary_count(); ++i)
      added += 2 * norm(machine.rotary_axis(i).point - Point3{});
    // |p| is at most the root of three times the largest component.
    room = (least - added) / std::sqrt(3.0);
  }

  void find_reach() {
    if (machine.rotary_count() < 2) return;
    if (std::hypot(machine.rotary_axis(1).direction.x, machine.rotary_axis(1).direction.y) < kNoTilting)
      return;
    const std::vector<Boundary> ends = boundaries(machine);
    const double radius = std::sqrt(2.0) / kCells;  // of a cell, from its centre; the sphere only shrinks it
    reach.resize(std::size_t{6} * kCells * kCells);
    for (std::size_t cell = 0; cell < reach.size(); ++cell) {
      const Vec3 u = cell_center(cell);
      const bool near_end = std::any_of(ends.begin(), ends.end(), [&](const Boundary& end) {
        return std::abs(angle_between(end.axis, u) - end.half_angle) <= radius + kBoundarySlack;
      });
      reach[cell] = near_end ? Reach::ask : rotary_within(u) ? Reach::all : Reach::none;
    }
  }

  /// An angle's whole turns within the travel; nothing when there is none.
  static bool place(double& angle, const model::Axis& axis) {
    constexpr double kSlack = 1e-6;  // as Kinematics grants
    const double lo = geom::radians(axis.min) - kSlack, hi = geom::radians(axis.max) + kSlack;
    angle += kTurn * std::ceil((lo - angle) / kTurn);
    return angle <= hi;
  }
  bool place(Joints& joints) const {
    for (int i = 0; i < machine.rotary_count(); ++i)
      if (!place(joints.rotary[static_cast<std::size_t>(i)], machine.rotary_axis(i))) return false;
    return true;
  }

  bool rotary_within(const Vec3& u) const {
    kinematics::Solutions solutions = machine.inverse_all({{}, u});
    for (std::size_t i = 0; i < static_cast<std::size_t>(solutions.count); ++i)
      if (place(solutions.joints[i])) return true;
    return false;
  }

  bool exactly(const cl::Pose& pose) const {
    kinematics::Solutions solutions = machine.inverse_all(pose);
    for (std::size_t k = 0; k < 2; ++k)
      if (solutions.count > 0 && solutions.free[k]) return with_free_axis(pose, k);
    for (std::size_t i = 0; i < static_cast<std::size_t>(solutions.count); ++i)
      if (place(solutions.joints[i]) && !machine.violation(solutions.joints[i])) return true;
    return false;
  }

  /// Any angle of axis k will do: X, Y and Z go round with it as m + A cos + C sin. The angles that keep all
  /// limits are closed intervals; each begins where a linear axis meets a limit or the rotary one does.
  bool with_free_axis(const cl::Pose& pose, std::size_t k) const {
    const auto at = [&](double angle) {
      Joints free;
      free.rotary[k] = angle;
      return machine.inverse_all(pose, free).joints[0];
    };
    const auto within = [&](double angle) {
      Joints joints = at(angle);
      return place(joints) && !machine.violation(joints);
    };
    const model::Axis& rotary = machine.rotary_axis(static_cast<int>(k));
    if (within(geom::radians(std::clamp(0.0, rotary.min, rotary.max))) || within(geom::radians(rotary.min)) ||
        within(geom::radians(rotary.max)))
      return true;
    const Joints zero = at(0), quarter = at(geom::kPi / 2), half = at(geom::kPi);
    for (const model::Axis& axis : machine.machine().axes) {
      if (axis.kind != model::AxisKind::linear) continue;
      const std::size_t i = static_cast<std::size_t>(axis.letter - 'X');
      const double m = 0.5 * (zero.linear[i] + half.linear[i]), c = 0.5 * (zero.linear[i] - half.linear[i]);
      const double s = quarter.linear[i] - m, swing = std::hypot(c, s), phase = std::atan2(s, c);
      for (const double limit : {axis.min, axis.max}) {
        if (!(std::abs(limit - m) <= swing)) continue;
        const double off = std::acos((limit - m) / swing);
        if (within(phase + off) || within(phase - off)) return true;
      }
    }
    return false;
  }
};

MachineLimits::MachineLimits() = default;
MachineLimits::MachineLimits(const Kinematics& machine) : state_(std::make_unique<State>(machine)) {}
MachineLimits::~MachineLimits() = default;
MachineLimits::MachineLimits(MachineLimits&&) noexcept = default;
MachineLimits& MachineLimits::operator=(MachineLimits&&) noexcept = default;

bool MachineLimits::unlimited() const {
  return state_ == nullptr;
}

bool MachineLimits::within(const cl::Pose& pose) const {
  if (!state_) return true;
  const State& state = *state_;
  if (state.reach.empty() || !(std::abs(dot(pose.axis, pose.axis) - 1) < 0.5)) return state.exactly(pose);
  const Reach reach = state.reach[cell_of(pose.axis)];
  if (reach == Reach::none) return false;
  const Point3& p = pose.tip;
  if (reach == Reach::all && std::abs(p.x) <= state.room && std::abs(p.y) <= state.room &&
      std::abs(p.z) <= state.room)
    return true;
  return state.exactly(pose);
}

}  // namespace burin::orient
