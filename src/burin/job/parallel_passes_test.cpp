// SPDX-License-Identifier: Apache-2.0
#include "burin/job/parallel_passes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace burin::job {
namespace {

geom::Composite plane(double size_x, double size_y, double slope) {
  geom::JoinedSurface s;
  s.surface.degree_u = s.surface.degree_v = 1;
  s.surface.count_u = s.surface.count_v = 2;
  s.surface.knots_u = s.surface.knots_v = {0, 0, 1, 1};
  for (const double y : {0.0, size_y})
    for (const double x : {0.0, size_x}) s.surface.points.push_back({x, y, slope * x, 1});
  return {{s}, {}};
}

TEST(ParallelPasses, OnPlanes) {
  const double step = std::sqrt(8 * 0.01 * 3);
  EXPECT_NEAR(*parallel_length(plane(40, 30, 0), 3, 0.01, {}), 40 * 30 / step, 1e-6);
  EXPECT_NEAR(*parallel_length(plane(40, 30, 0), 3, 0.01, 0.1), 40 * 30 / 0.1, 1e-6);
  // Up the slope (passes along X): the planes stand one step apart, every pass is longer by sqrt(1 +
  // slope^2).
  EXPECT_NEAR(*parallel_length(plane(40, 30, 1), 3, 0.01, {}), 40 * 30 * std::sqrt(2.0) / step, 1e-6);
}

}  // namespace
}  // namespace burin::job
