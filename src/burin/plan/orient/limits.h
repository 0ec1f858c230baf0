// SPDX-License-Identifier: Apache-2.0
// Stroke-over: whether a machine can take a pose within its travel.
#pragma once

#include <memory>

#include "burin/kinematics/kinematics.h"

namespace burin::orient {

/// Immutable; any number of threads may ask.
class MachineLimits {
 public:
  MachineLimits();  ///< no machine: everything is within
  /// Keeps a copy. Knows the directions a machine reaches beforehand, so that most questions cost little.
  explicit MachineLimits(const kinematics::Kinematics& machine);
  ~MachineLimits();
  MachineLimits(MachineLimits&&) noexcept;
  MachineLimits& operator=(MachineLimits&&) noexcept;

  /// Some solution of the inverse kinematics keeps all limits of travel.
  bool within(const cl::Pose& pose) const;
  bool unlimited() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace burin::orient
