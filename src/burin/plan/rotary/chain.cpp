// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/chain.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace burin::rotary {
namespace {

// A box narrower than this (radians) is a point.
constexpr double kThin = 1e-9;
constexpr int kMaxIterations = 80;
// Complementarity at which the chain is at rest, relative to the stiffness: angles are then right to about
// 1e-7.
constexpr double kRest = 1e-13;

/// The state of the interior-point iteration. Slacks are kept on their own so that they never round to 0.
class Solver {
 public:
  Solver(const ChainProblem& problem, std::vector<double>& x) : p_(problem), x_(x), n_(x.size()) {
    scale();
    place();
    for (auto* v : {&diagonal_, &rhs_, &dx_, &upper_}) v->resize(n_);
  }

  void run() {
    for (int i = 0; i < kMaxIterations; ++i) {
      const double mu = complementarity();
      residual(mu);
      if (mu < kRest && residual_max_ < 1e-9) break;
      step(mu);
    }
    for (std::size_t i = 0; i < n_; ++i) x_[i] = std::clamp(x_[i], p_.lo[i], p_.hi[i]);
  }

 private:
  double stiff(std::size_t i) const { return i == 0 || i >= n_ ? 0 : p_.stiff[i] * scale_; }

  void scale() {
    double sum = 0;
    for (std::size_t i = 0; i < n_; ++i) sum += (i > 0 ? p_.stiff[i] : 0) + p_.pull[i];
    scale_ = sum > 0 ? static_cast<double>(n_) / (2 * sum) : 1;
  }

  void place() {
    fixed_.assign(n_, 0);
    for (auto* v : {&below_, &above_, &push_up_, &push_down_}) v->assign(n_, 1.0);
    for (std::size_t i = 0; i < n_; ++i) {
      const double width = p_.hi[i] - p_.lo[i];
      if (!(width > kThin)) {
        fixed_[i] = 1;
        x_[i] = (p_.lo[i] + p_.hi[i]) / 2;
        continue;
      }
      x_[i] = std::clamp(x_[i], p_.lo[i] + 0.05 * width, p_.hi[i] - 0.05 * width);
      below_[i] = x_[i] - p_.lo[i];
      above_[i] = p_.hi[i] - x_[i];
      push_up_[i] = 1e-2 / below_[i];
      push_down_[i] = 1e-2 / above_[i];
    }
  }

  double complementarity() const {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      if (fixed_[i]) continue;
      sum += below_[i] * push_up_[i] + above_[i] * push_down_[i];
      count += 2;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0;
  }

  double gradient(std::size_t i) const {
    double g = 2 * p_.pull[i] * scale_ * (x_[i] - p_.goal[i]);
    if (i > 0) g += 2 * stiff(i) * (x_[i] - x_[i - 1]);
    if (i + 1 < n_) g += 2 * stiff(i + 1) * (x_[i] - x_[i + 1]);
    return g;
  }

  /// Newton's system with the pushes of the walls eliminated.
  void residual(double mu) {
    const double target = 0.1 * mu;
    residual_max_ = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      if (fixed_[i]) {
        diagonal_[i] = 1;
        rhs_[i] = 0;
        continue;
      }
      const double g = gradient(i);
      residual_max_ = std::max(residual_max_, std::abs(g - push_up_[i] + push_down_[i]));
      diagonal_[i] = 2 * (stiff(i) + stiff(i + 1) + p_.pull[i] * scale_) + push_up_[i] / below_[i] +
                     push_down_[i] / above_[i];
      rhs_[i] = -g + target / below_[i] - target / above_[i];
    }
  }

  /// -2 stiff between i - 1 and i; fixed elements do not move, so nothing hangs on them.
  double off(std::size_t i) const { return fixed_[i] || fixed_[i - 1] ? 0 : -2 * stiff(i); }

  void tridiagonal() {
    upper_[0] = 0;
    dx_[0] = rhs_[0] / diagonal_[0];
    double pivot = diagonal_[0];
    for (std::size_t i = 1; i < n_; ++i) {
      const double o = off(i);
      upper_[i] = o / pivot;
      pivot = diagonal_[i] - o * upper_[i];
      dx_[i] = (rhs_[i] - o * dx_[i - 1]) / pivot;
    }
    for (std::size_t i = n_ - 1; i-- > 0;) dx_[i] -= upper_[i + 1] * dx_[i + 1];
  }

  void step(double mu) {
    tridiagonal();
    const double target = 0.1 * mu;
    double primal = 1, dual = 1;
    const auto limit = [](double value, double change, double& length) {
      if (change < 0) length = std::min(length, -0.995 * value / change);
    };
    for (std::size_t i = 0; i < n_; ++i) {
      if (fixed_[i]) continue;
      limit(below_[i], dx_[i], primal);
      limit(above_[i], -dx_[i], primal);
      limit(push_up_[i], change_up(i, target), dual);
      limit(push_down_[i], change_down(i, target), dual);
    }
    for (std::size_t i = 0; i < n_; ++i) {
      if (fixed_[i]) continue;
      const double up = change_up(i, target), down = change_down(i, target);
      x_[i] += primal * dx_[i];
      below_[i] += primal * dx_[i];
      above_[i] -= primal * dx_[i];
      push_up_[i] += dual * up;
      push_down_[i] += dual * down;
    }
  }
  double change_up(std::size_t i, double target) const {
    return (target - push_up_[i] * dx_[i]) / below_[i] - push_up_[i];
  }
  double change_down(std::size_t i, double target) const {
    return (target + push_down_[i] * dx_[i]) / above_[i] - push_down_[i];
  }

  const ChainProblem& p_;
  std::vector<double>& x_;
  std::size_t n_;
  double scale_ = 1, residual_max_ = 0;
  std::vector<char> fixed_;
  std::vector<double> below_, above_, push_up_, push_down_, diagonal_, rhs_, dx_, upper_;
};

}  // namespace

void solve_chain(const ChainProblem& problem, std::vector<double>& x) {
  if (!x.empty()) Solver(problem, x).run();
}

double chain_cost(const ChainProblem& p, const std::vector<double>& x) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i > 0) sum += p.stiff[i] * (x[i] - x[i - 1]) * (x[i] - x[i - 1]);
    sum += p.pull[i] * (x[i] - p.goal[i]) * (x[i] - p.goal[i]);
  }
  return sum;
}

}  // namespace burin::rotary
