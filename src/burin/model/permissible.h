// SPDX-License-Identifier: Apache-2.0
// The permissible region of settings (power, speed): ranges of speed at known powers, linear between them,
// intersected when it belongs to two sheet thicknesses. Internal to model.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "burin/model/kerf.h"

namespace burin::model {

class PermissibleRegion {
 public:
  /// Each table sorted by power; the region is what all of them permit.
  explicit PermissibleRegion(std::vector<std::vector<PermissibleRange>> tables)
      : tables_(std::move(tables)) {}

  /// Speeds at one power; nothing outside the known powers or where the tables permit nothing in common.
  std::optional<PermissibleRange> at(double power_w) const;
  bool contains(double power_w, double speed_mm_min) const;
  /// Smallest change of speed at the same power; when nothing is permissible there, smallest change of power,
  /// then of speed. Nothing when the region is empty.
  std::optional<std::pair<double, double>> nearest(double power_w, double speed_mm_min) const;
  /// The ranges at every power that a table names and the region permits.
  std::vector<PermissibleRange> table() const;

 private:
  /// Powers at which the limits have a kink, and ends of the parts where they leave a range open.
  std::vector<double> candidate_powers() const;
  std::vector<double> named_powers() const;

  std::vector<std::vector<PermissibleRange>> tables_;
};

}  // namespace burin::model
