// SPDX-License-Identifier: Apache-2.0
// The evenest chain of numbers through boxes. Private to plan/rotary.
#pragma once

#include <vector>

namespace burin::rotary {

/// Minimises  sum_i stiff[i] (x[i] - x[i-1])^2 + pull[i] (x[i] - goal[i])^2  with  lo[i] <= x[i] <= hi[i]
/// (stiff[0] is not used; stiff > 0, pull >= 0). Primal-dual interior point, each step one tridiagonal solve:
/// linear in the number of elements. `x` comes in as a first guess and is inside of the boxes at the end.
struct ChainProblem {
  std::vector<double> stiff, pull, goal, lo, hi;
};
void solve_chain(const ChainProblem& problem, std::vector<double>& x);
/// The sum that solve_chain makes small.
double chain_cost(const ChainProblem& problem, const std::vector<double>& x);

}  // namespace burin::rotary
