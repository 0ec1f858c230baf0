// SPDX-License-Identifier: Apache-2.0
// From proven stretches to the tool's whole way: links, retracts, rapids, approaches. Private to plan/rotary.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/plan/rotary/path_plan.h"

namespace burin::rotary {

class Linker {
 public:
  Linker(const Shared& shared, RotaryPlan& plan);

  /// Appends the path's points and its legs.
  void add(PathPlan path, std::size_t number);
  /// Retracts at the end; says which points were not cut.
  void finish();
  /// Where the tool stands after what was added.
  AxisPose at() const { return at_; }

 private:
  struct Run {
    std::vector<AxisPose> poses;
    std::vector<std::size_t> points;
  };
  std::vector<Run> runs_of(const PathPlan& path, std::size_t number);
  void add_run(Run run, std::size_t path);
  /// Angles moved by whole turns to be within the machine's limits and near where the axis stands. False:
  /// the run does not fit as a whole.
  bool place(Run& run) const;
  bool fits(const Run& run, double turns) const;
  /// A whole ring that would make the axis turn back by a turn first is cut the other way round.
  bool better_backwards(const PathPlan& path) const;
  std::vector<Run> cut_to_limits(const Run& run) const;
  bool can_lift(const AxisPose& pose) const;
  bool link(const AxisPose& to, std::size_t path);
  void retract(std::size_t path);
  bool approach(const Run& run, std::size_t path);
  AxisPose above(const AxisPose& pose) const;
  AxisPose lifted(const AxisPose& pose, double by) const;
  void leg(LegKind kind, std::vector<AxisPose> poses, std::size_t path, std::vector<std::size_t> points = {});

  const Shared& shared_;
  RotaryPlan& plan_;
  double clear_z_;  ///< of the ball's centre in the machine: the tool is above part and stock
  AxisPose at_;
  bool started_ = false, up_ = true;
  std::vector<std::size_t> left_;  ///< points of runs that no way led to
  std::vector<AxisPose> behind_;   ///< the cut that ends where the tool stands, for a way back
};

/// Length of the tip's way in the part frame over a joint-linear move.
double tip_length(const AxisPose& from, const AxisPose& to, double radius);

}  // namespace burin::rotary
