// SPDX-License-Identifier: Apache-2.0
// What a plan does, measured on its setpoints by differences, and against its path. mm, s.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "burin/servo/interpolator.h"

namespace burin::servo {

struct Quality {
  double feed_fluctuation_max =
      0;  ///< |chord / T - planned| / planned where the planned feed is steady (relative)
  double feed_fluctuation_rms = 0;
  double chord_error_max_mm = 0;  ///< distance of the chord between setpoints from the path
  double accel_max_mm_s2 = 0;     ///< largest second difference of any axis / T^2
  double jerk_max_mm_s3 = 0;      ///< third
  std::size_t setpoints = 0;
};
/// All setpoints of the plan, from the start on.
std::vector<Setpoint> run(const Plan& plan);
Quality measure(const Plan& plan, const std::vector<Setpoint>& setpoints);

/// NumPy .npy (version 1.0) of shape (n, 9), little-endian float64, columns t_s, x_mm, y_mm, z_mm,
/// feed_mm_min, surface, path, u, v. Text of the CSV with the same columns, at least 9 decimals, u and v
/// empty where there are none.
std::string to_npy(const std::vector<Setpoint>& setpoints);
std::string to_csv(const std::vector<Setpoint>& setpoints);

}  // namespace burin::servo
