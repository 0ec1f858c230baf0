// SPDX-License-Identifier: Apache-2.0
// Places of the part while the tool turns with the tilt at one yaw: circles in the tool's frame, and when
// they leave a piece. Internal to plan/orient. See docs/tool-interference.md.
#pragma once

#include <array>

#include "burin/plan/orient/scene_piece.h"
#include "burin/plan/orient/tool_angles.h"

namespace burin::orient::detail {

/// A place relative to the line about which the tool turns: along n, along d (the yaw's direction), along e.
struct Place {
  double n = 0, d = 0, e = 0;
};

/// The tool at contact point and yaw. At tilt a
///   x = n sin(a) - d cos(a) - arm,  y = e,  h = n cos(a) + d sin(a) + corner
class Turn {
 public:
  Turn(const CcPoint& at, double beta, const model::Mill& mill);
  Place place(const geom::Point3& q) const;
  geom::Point3 point(const Place& p) const;
  /// Sine and cosine of a tilt.
  struct Tilt {
    double s, c;
    explicit Tilt(double alpha);
  };
  Local at(const Place& p, const Tilt& tilt) const;
  Place back(const Local& q, const Tilt& tilt) const;
  /// orient::pose up to rounding.
  cl::Pose pose(const Tilt& tilt) const;
  /// From the line about which it turns towards the tool axis, across it.
  geom::Vec3 across(const Tilt& tilt) const { return tilt.s * n_ - tilt.c * d_; }
  double arm() const { return arm_; }
  double corner() const { return corner_; }

  /// The last tilt up to which `p`, blocking at `alpha`, blocks without a break: at most `to`; `alpha` where
  /// it does not block. Never beyond the truth by more than rounding.
  double until(const Place& p, const Piece& piece, double alpha, double to) const;
  /// The first such tilt before `alpha`, at least `from`.
  double since(const Place& p, const Piece& piece, double alpha, double from) const;

  struct Left {
    double alpha = 0;
    Place last;  ///< blocks just below alpha
  };
  /// At least so far a triangle, blocking at `alpha`, blocks: as its corners and one place of it do.
  Left at_least(const std::array<Place, 3>& t, const Piece& piece, double alpha, double to) const;
  /// The same for a triangle; `alpha` unchanged where it does not block. Every tilt between is proved blocked
  /// by some place of it. Ends early when it gains less than this share of what is found.
  Left until(const std::array<Place, 3>& t, const Piece& piece, double alpha, double to, double coarse) const;

 private:
  geom::Point3 pivot_;  // on the line about which it turns
  geom::Vec3 n_, d_, e_;
  double arm_ = 0, corner_ = 0;
};

}  // namespace burin::orient::detail
