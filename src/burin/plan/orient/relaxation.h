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
  bool blocks(std::size_t witness, const Angles& angles) const;
  /// The smallest tilt from `from` on that no witness forbids; above `to`: none up to there. Never too great.
  double first_tilt(double beta, double from, double to) const;

 private:
  struct Place {
    double f, t, n;  ///< from the centre of the corner's tube at the contact
    double radius2, radius, from, to, grow, grow2;
  };
  bool inside(const Place& place, double xd, double y2, double sa, double ca) const;
  std::optional<std::size_t> blocked_at(double beta, double alpha) const;

  const Scene* scene_;
  const CcPoint* at_;
  double corner_, wide_;
  std::vector<Witness> witnesses_;
  std::vector<Place> places_;
  mutable std::vector<std::size_t> uses_;
  mutable std::size_t hot_ = 0;
};

}  // namespace burin::orient
