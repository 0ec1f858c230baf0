// SPDX-License-Identifier: Apache-2.0
// What a few places of the part alone forbid at one contact point: a superset of the allowed angles that
// costs no feasibility test. mm, radians. docs/cspace.md
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "burin/plan/orient/cspace.h"

namespace burin::orient {

class Relaxation {
 public:
  /// Keeps pointers: scene and `at` must outlive it.
  Relaxation(const Scene& scene, const CcPoint& at);

  /// False: nothing new (the same place and piece, or the list is full).
  bool add(const Witness& witness);
  std::size_t size() const { return witnesses_.size(); }
  const Witness& witness(std::size_t i) const { return witnesses_[i]; }
  /// How often the witness raised a tilt or forbade a pose: which ones the neighbour should get.
  std::size_t uses(std::size_t i) const { return uses_[i]; }

  /// Some witness that forbids the angles.
  std::optional<std::size_t> blocked(const Angles& angles) const;

  /// Up to where the witnesses alone block a yaw from `from` on: no smaller tilt is allowed. covered: all of
  /// [from, to]. A lower bound within kTiltStep of the best that the witnesses give.
  struct Reach {
    double alpha = 0;
    bool covered = false;
  };
  Reach blocked_from(double beta, double from, double to) const;
  /// The newest witness alone at one pose.
  bool newest_blocks(const Angles& angles) const;
  static constexpr double kTiltStep = 1e-4;  ///< rad

 private:
  /// Witnesses after each other, from the centre of the corner's tube at the contact, in (f, t, n).
  struct Place {
    double f, t, n, radius, radius2, from, to, grow;
    /// What it blocks at a yaw is one interval of tilts: the piece stands between the tool's axis and the
    /// line about which the tilt turns (docs/cspace.md).
    bool simple;
  };
  /// The same at one yaw: along the tilt's plane, across it squared.
  struct AtYaw {
    double d, e2;
  };
  AtYaw at_yaw(const Place& place, double sb, double cb) const {
    const double e = place.t * cb - place.f * sb;
    return {place.f * cb + place.t * sb, e * e};
  }
  bool inside(const Place& place, const AtYaw& q, double sa, double ca) const;

  const Scene* scene_;
  const CcPoint* at_;
  double corner_, wide_;
  std::vector<Witness> witnesses_;
  std::vector<Place> places_;
  mutable std::vector<std::size_t> uses_;
  mutable std::vector<AtYaw> yaw_;
  mutable std::vector<std::size_t> holding_;
};

}  // namespace burin::orient
