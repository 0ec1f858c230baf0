// SPDX-License-Identifier: Apache-2.0
// One path with its axes: CL points, reachable angles, motion between them. Private to plan/rotary.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/base/parallel.h"
#include "burin/geom/mesh/mesh_index.h"
#include "burin/model/tool.h"
#include "burin/plan/rotary/axis.h"
#include "burin/plan/rotary/center_path.h"
#include "burin/plan/rotary/motion.h"
#include "burin/plan/rotary/reach.h"
#include "burin/plan/rotary/rotary.h"

namespace burin::rotary {

/// What all paths of a plan share. `lift`: the tool with everything that it sweeps on its way up along its
/// axis, so that one question answers whether it can leave.
struct Shared {
  const Part& part;
  const model::BallTool& tool;
  const RotaryOptions& options;
  const geom::MeshIndex& mesh;
  const BodyIndex& body;
  const ReachIndex& reach;
  const ReachIndex& lift;
  const SweptDistance* design = nullptr;  ///< of a swept part
  const SectionAxis* section = nullptr;   ///< with Tai::section

  unsigned threads() const { return thread_count(options.threads); }

  /// Of moves that cut: everything within the tolerance of the part itself.
  MotionOptions cutting() const {
    return {options.tolerance_mm, options.tolerance_mm, part.deflection_mm, design};
  }
};

/// Tolerance of SSI: what is left of the whole one by what the check of the motion cannot know (a swept part
/// is asked itself; of others only the mesh is known), less a reserve for the bend of joint-linear motion.
double step_tolerance(const Shared& shared);

/// Dense places by the length of the centre path; straight between them.
class CenterLine {
 public:
  /// `accuracy_mm`: how far a centre may stand from where its contact wants it, when between two places.
  CenterLine(const CenterPath& path, double radius, double accuracy_mm);
  double length() const { return at_.empty() ? 0 : at_.back(); }
  bool closed() const { return path_.closed; }
  /// The place at s; a closed path goes on after length().
  Place at(double s) const;
  /// Number of a dense place and the part of the way to the next one -> length.
  double length_of(double number) const;
  /// Calls visit(place) for the dense places strictly between s = from and s = to.
  template <class Visit>
  void between(double from, double to, Visit&& visit) const {
    for (std::size_t i = first_after(from);; ++i) {
      const double s = length_at(i);
      if (!(s < to)) return;
      visit(place(i));
    }
  }

 private:
  std::size_t first_after(double s) const;
  double length_at(std::size_t i) const;
  const Place& place(std::size_t i) const { return path_.places[i % path_.places.size()]; }

  const CenterPath& path_;
  double radius_, accuracy_;
  std::vector<double> at_;  ///< of each place; closed: one more for the first place again
};

/// A CL point of a path.
struct Node {
  double s = 0;
  Place place;
  AngleSet reachable;
  double initial = 0;
  bool initial_interferes = false;
  double theta = 0;
  bool cut = false;  ///< the motion from the node before is proven
  AxisPose pose() const { return {place.center, theta}; }
  bool open() const { return !reachable.empty(); }
};

struct PathPlan {
  std::vector<Node> nodes;  ///< in cutting order; a closed path has its first place again at the end
  bool closed = false;
  double ssi_mm = 0;    ///< largest undercut of the motion at the contact points between the nodes
  double gouge_mm = 0;  ///< largest depth of the ball, upper bound
  double excess_mm = 0;
  std::size_t tsi = 0, ssi_split = 0, halving_points = 0;
  std::vector<geom::Point3> uncut;  ///< contact points between nodes that are not joined by a cut
};

/// What is known about a path before it is known where the tool comes from.
struct PathBase {
  CenterPath dense;
  SsiResult ssi;
  std::size_t tsi = 0;
  double excess_mm = 0;
  std::vector<Node> nodes;  ///< CL points with their reachable angles
};
/// Places of the ball (TSI, SSI), which depend on the part around the path only; `nodes` stays empty.
PathBase place_path(const Shared& shared, const ContactPath& path);
/// The same places turned about X, moved along X by dx and in w by dw (Suh & Lee, 3.3 A).
PathBase swept_along(const PathBase& base, double turn, double dx, double dw);
/// The CL points and their reachable angles, which depend on the whole part.
void add_nodes(const Shared& shared, PathBase& base, unsigned threads);

/// `start`: where the axis and the ball stood before.
PathPlan plan_path(const Shared& shared, const ContactPath& path, PathBase base, const AxisPose& start);

/// Reachable angles of a place, by the method asked for; and whether the paper's first axis interferes.
void find_reach(const Shared& shared, Node& node);

}  // namespace burin::rotary
