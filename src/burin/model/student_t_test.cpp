// SPDX-License-Identifier: Apache-2.0
#include "burin/model/student_t.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace burin::model {
namespace {

TEST(StudentT, QuantilesOfThePrintedTables) {
  // Two-sided 95 %: any table of the t distribution.
  const struct {
    int degrees;
    double t;
  } table[] = {{1, 12.706204736}, {2, 4.302652730},  {3, 3.182446305},   {5, 2.570581836},
               {10, 2.228138852}, {30, 2.042272456}, {100, 1.983971519}, {1000000, 1.959966361}};
  for (const auto& row : table)
    EXPECT_NEAR(student_t_quantile(0.975, row.degrees), row.t, 2e-8 * row.t) << row.degrees;
}

TEST(StudentT, ClosedFormsOfOneAndTwoDegrees) {
  for (double t = -50; t <= 50; t += 0.37) {
    EXPECT_NEAR(student_t_cdf(t, 1), 0.5 + std::atan(t) / std::numbers::pi, 1e-12);
    EXPECT_NEAR(student_t_cdf(t, 2), 0.5 + t / (2 * std::sqrt(2 + t * t)), 1e-12);
  }
}

TEST(StudentT, QuantileInvertsTheDistribution) {
  for (int degrees : {1, 2, 3, 7, 40, 5000}) {
    for (double p : {0.001, 0.025, 0.3, 0.5, 0.8, 0.99}) {
      EXPECT_NEAR(student_t_cdf(student_t_quantile(p, degrees), degrees), p, 1e-12);
    }
  }
}

}  // namespace
}  // namespace burin::model
