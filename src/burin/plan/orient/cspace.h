// SPDX-License-Identifier: Apache-2.0
// The C-space of one contact point: which tilts and yaws are free of gouge, collision and stroke-over; its
// map on a grid; the best angles in it (Park & Lee 2001, 3; docs/orient.md). mm, radians.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burin/plan/orient/limits.h"
#include "burin/plan/orient/scene.h"

namespace burin::orient {

/// What is asked about every contact point alike. Keeps pointers: scene and limits must outlive it.
struct Setting {
  const Scene* scene = nullptr;
  const MachineLimits* limits = nullptr;
  AngleRange range;
};

/// gouge before collision before limit.
Cause cause_at(const Setting& setting, const CcPoint& at, const Angles& angles, Scene::Memory& memory);

/// The smallest tilt from `from` on at which scene and machine allow the pose at this yaw; `cause` of what
/// ends there (limit without witness).
Scene::FirstFree first_allowed(const Setting& setting, const CcPoint& at, double beta, double from,
                               Scene::Memory& memory);

/// Nodes (i, j), both ends of both ranges included: alpha_lo + i (alpha_hi - alpha_lo) / (tilts - 1).
struct CSpaceMap {
  AngleRange range;
  int tilts = 0, yaws = 0;
  std::vector<Cause> cells;  ///< [i + j * tilts]
  Angles node(int i, int j) const;
  Cause at(int i, int j) const {
    return cells[static_cast<std::size_t>(i) + static_cast<std::size_t>(j) * static_cast<std::size_t>(tilts)];
  }
};
/// tilts, yaws >= 2.
CSpaceMap make_map(const Setting& setting, const CcPoint& at, int tilts, int yaws, Scene::Memory& memory);

/// What is maximised. Must not grow with the tilt at a fixed yaw: the best tilt of a yaw is then the first
/// allowed one.
class Goal {
 public:
  virtual ~Goal() = default;
  virtual double value(const CcPoint& at, const Angles& angles) const = 0;
  /// The greatest tilt in [lo, hi] at which the goal is at least `value` (about: within 1e-6 rad, not below);
  /// lo when there is none. By bisection where there is no formula.
  virtual double tilt_of(const CcPoint& at, double value, double beta, double lo, double hi) const;
};
/// effective_radius
class RadiusGoal final : public Goal {
 public:
  explicit RadiusGoal(const model::Mill& mill) : mill_(&mill) {}
  double value(const CcPoint& at, const Angles& angles) const override;
  double tilt_of(const CcPoint& at, double value, double beta, double lo, double hi) const override;

 private:
  const model::Mill* mill_;
};

struct Optimum {
  bool found = false;  ///< false: no allowed angles were found; the rest then says what stood in the way
  Angles angles;
  double value = 0;  ///< of the goal
  Angles initial;    ///< the paper's initial solution (step 1 and 2 of docs/orient.md)
  double initial_value = 0;
  bool initial_found = false;
  Cause cause = Cause::none;  ///< what ends the allowed set at `angles` towards a greater value; not found:
                              ///< the cause met most often
  std::uint32_t tests = 0;    ///< feasibility tests
};

/// The paper's initial solution alone: the corner of the largest radius, else the first allowed place on the
/// rational quadratic curve over (alpha_hi, same yaw) to (alpha_hi, an end of the yaws), either end; else
/// enumeration.
Optimum find_initial(const Setting& setting, const Goal& goal, const CcPoint& at, Scene::Memory& memory);

/// The paper's procedure (search = "contour"), monotonic and non-monotonic, for the effective radius.
Optimum find_by_contour(const Setting& setting, const CcPoint& at, Scene::Memory& memory);

/// What a contact point learnt that its neighbour on the path can use. Fresh for each path.
struct Experience {
  std::vector<Witness> witnesses;
  bool has_angles = false;
  Angles angles;
};
/// The true optimum within `kOptimumShare` of the goal's value, for allowed sets that are not narrower than
/// the sampling of the yaws (docs/orient.md says which).
inline constexpr double kOptimumShare = 5e-4;
Optimum find_optimal(const Setting& setting, const Goal& goal, const CcPoint& at, Scene::Memory& memory,
                     Experience& experience);

}  // namespace burin::orient
