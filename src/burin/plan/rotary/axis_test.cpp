// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/axis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "burin/geom/vec.h"
#include "burin/plan/rotary/chain.h"

namespace burin::rotary {
namespace {

using geom::kPi;

double turned(double a) {
  double t = std::remainder(a, 2 * kPi);
  return t >= kPi ? -kPi : t;
}
AngleInterval interval(double lo, double hi) {
  const double t = turned(lo);
  return {t, t + (hi - lo)};
}
void sort(AngleSet& set) {
  std::sort(set.begin(), set.end(), [](auto& a, auto& b) { return a.lo < b.lo; });
}

/// Two or three cones whose ends walk about; now and then one closes.
std::vector<Layer> random_layers(std::mt19937& random, int count, double step) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Layer> layers;
  double middle[3] = {-2.2, 0.1, 2.1}, half[3] = {0.4, 0.6, 0.3};
  double initial = 0;
  for (int i = 0; i < count; ++i) {
    Layer layer;
    for (int k = 0; k < 3; ++k) {
      middle[k] += step * unit(random);
      half[k] = std::clamp(half[k] + step * unit(random), -0.2, 0.9);
      if (half[k] > 0.02) layer.reachable.push_back(interval(middle[k] - half[k], middle[k] + half[k]));
    }
    sort(layer.reachable);
    // Cones that ran into each other are one.
    AngleSet merged;
    for (const AngleInterval& a : layer.reachable) {
      if (!merged.empty() && a.lo <= merged.back().hi)
        merged.back().hi = std::max(merged.back().hi, a.hi);
      else
        merged.push_back(a);
    }
    if (merged.size() > 1 && merged.back().hi - 2 * kPi >= merged.front().lo) {
      merged.front() = {merged.back().lo, std::max(merged.back().hi, merged.front().hi + 2 * kPi)};
      merged.pop_back();
      sort(merged);
    }
    if (merged.size() == 1 && merged[0].hi - merged[0].lo >= 2 * kPi) merged[0] = {-kPi, kPi};
    layer.reachable = merged;
    initial += 0.05 * unit(random);
    layer.initial = initial;
    layer.normal = initial + 0.3 * unit(random);
    layer.length = 0.1 + 0.05 * unit(random);
    layers.push_back(layer);
  }
  return layers;
}

bool overlap(const AngleInterval& a, const AngleInterval& b) {
  for (int k = -1; k <= 1; ++k)
    if (a.lo <= b.hi + 2 * kPi * k && b.lo + 2 * kPi * k <= a.hi) return true;
  return false;
}

/// Fewest breaks over all ways through the intervals.
int fewest_breaks(const std::vector<Layer>& layers, std::size_t i, std::size_t from) {
  if (i == layers.size()) return 0;
  if (layers[i].reachable.empty()) return (i > 0) + fewest_breaks(layers, i + 1, 0);
  int best = 1 << 20;
  for (std::size_t k = 0; k < layers[i].reachable.size(); ++k) {
    int here = 0;
    if (i > 0) {
      const AngleSet& before = layers[i - 1].reachable;
      here = before.empty() || !overlap(before[from], layers[i].reachable[k]);
      if (here == 1 && !before.empty()) {
        // A gap that is one: nothing goes on, nothing comes from there.
        const auto hits = [&](const AngleInterval& a, const AngleSet& set) {
          return std::any_of(set.begin(), set.end(), [&](const AngleInterval& b) { return overlap(a, b); });
        };
        if (!hits(before[from], layers[i].reachable) && !hits(layers[i].reachable[k], before)) here = 0;
      }
    }
    best = std::min(best, here + fewest_breaks(layers, i + 1, k));
  }
  return best;
}

TEST(Axis, StaysInsideAndKeepsSteps) {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    const auto layers = random_layers(random, 60, round % 2 == 0 ? 0.05 : 0.3);
    AxisOptions options;
    options.clearance = 0.01;
    options.lean = round % 3 == 0 ? 0.2 : 0;
    options.smooth = round % 5 != 0;
    options.start = round;
    const AxisChain chain = choose_axes(layers, options);
    ASSERT_EQ(chain.theta.size(), layers.size());
    double total = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      if (!layers[i].reachable.empty()) {
        EXPECT_TRUE(contains(layers[i].reachable, chain.theta[i])) << round << " " << i;
        const AngleSet kept = narrowed(layers[i].reachable, options.clearance);
        EXPECT_NEAR(nearest(kept, chain.theta[i]), chain.theta[i], 1e-9);
      }
      if (i == 0 || std::binary_search(chain.breaks.begin(), chain.breaks.end(), i)) continue;
      const double step = std::abs(chain.theta[i] - chain.theta[i - 1]);
      EXPECT_LE(step, options.max_step);
      total += step;
      // Between two layers no angle is passed that neither of them reaches, but for gaps of all.
      bool gap = true;
      for (const auto& a : layers[i - 1].reachable)
        for (const auto& b : layers[i].reachable) gap = gap && !overlap(a, b);
      for (int k = 1; k < 16 && !gap && options.smooth; ++k) {
        const double t = chain.theta[i - 1] + (chain.theta[i] - chain.theta[i - 1]) * k / 16;
        EXPECT_TRUE(contains(layers[i - 1].reachable, t) || contains(layers[i].reachable, t) ||
                    nearest(layers[i].reachable, t) - t < options.max_step);
      }
    }
    EXPECT_NEAR(total, chain.turn_total, 1e-9);
  }
}

TEST(Axis, FewestBreaks) {
  std::mt19937 random(2);
  int broken = 0;
  for (int round = 0; round < 400; ++round) {
    auto layers = random_layers(random, 9, 0.35);
    AxisOptions options;
    options.max_step = 3;
    options.start = layers[0].initial;
    const AxisChain chain = choose_axes(layers, options);
    const int fewest = fewest_breaks(layers, 0, 0);
    broken += fewest > 0;
    EXPECT_EQ(static_cast<int>(chain.breaks.size()), fewest) << round;
  }
  EXPECT_GT(broken, 10);
}

TEST(Axis, TurnsWithThePart) {
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    const auto layers = random_layers(random, 80, 0.1);
    AxisOptions options;
    options.clearance = 0.01;
    const AxisChain chain = choose_axes(layers, options);
    const double by = 0.37 * (round + 1);
    auto other = layers;
    for (Layer& layer : other) {
      for (AngleInterval& i : layer.reachable)
        if (i.hi - i.lo < 2 * kPi) i = interval(i.lo + by, i.hi + by);
      sort(layer.reachable);
      layer.initial += by;
      layer.normal += by;
    }
    options.start += by;
    const AxisChain same = choose_axes(other, options);
    ASSERT_EQ(same.breaks, chain.breaks);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      if (layers[i].reachable.empty()) continue;
      EXPECT_NEAR(same.theta[i] - by, chain.theta[i], 1e-5) << round << " " << i;
    }
  }
}

/// Round and round a cylinder: the axis follows evenly and never turns back.
TEST(Axis, AccumulatesTurns) {
  std::vector<Layer> layers;
  constexpr int kTurns = 20, kEach = 100;
  for (int i = 0; i <= kTurns * kEach; ++i) {
    const double t = 2 * kPi * i / kEach;
    layers.push_back({{interval(t - kPi / 2, t + kPi / 2)}, turned(t), turned(t), 0.5});
  }
  AxisOptions options;
  options.clearance = 0.01;
  options.start = 3 * 2 * kPi;
  const AxisChain chain = choose_axes(layers, options);
  EXPECT_TRUE(chain.breaks.empty());
  EXPECT_EQ(chain.reversals, 0u);
  EXPECT_NEAR(chain.theta.front(), options.start, 1.0);
  EXPECT_NEAR(chain.theta.back() - chain.theta.front(), 2 * kPi * kTurns, 2.0);
  EXPECT_LT(chain.step_max, 1.01 * 2 * kPi / kEach);
}

TEST(Axis, LeansWhereItCan) {
  std::vector<Layer> layers;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.01 * i;
    layers.push_back({{interval(t - 1, t + 1)}, t, t, 0.5});
  }
  // No room for it in the middle.
  for (int i = 40; i < 60; ++i)
    layers[i].reachable = {interval(layers[i].normal - 0.1, layers[i].normal + 0.1)};
  AxisOptions options;
  options.lean = 0.2;
  const AxisChain chain = choose_axes(layers, options);
  EXPECT_TRUE(chain.breaks.empty());
  for (int i = 0; i < 100; ++i) {
    if (i >= 20 && i < 80) continue;  // on the way there and back
    EXPECT_GE(std::abs(turned(chain.theta[i] - layers[i].normal)), 0.2 - 1e-6) << i;
  }
}

TEST(Axis, AWallIsNotCrossed) {
  // Two corridors side by side; the left one ends, the right one goes on.
  std::vector<Layer> layers;
  for (int i = 0; i < 50; ++i) {
    Layer layer{{interval(0.55, 1.0)}, 0, 0, 0.1};
    if (i < 25) layer.reachable.insert(layer.reachable.begin(), interval(0.0, 0.5));
    layers.push_back(layer);
  }
  AxisChain chain = choose_axes(layers, {});
  EXPECT_TRUE(chain.breaks.empty());
  for (const double t : chain.theta) EXPECT_GE(t, 0.55 - 1e-9);
  // The right one opens only later: one break, where both are open or one follows the other.
  for (int i = 0; i < 20; ++i) layers[i].reachable.pop_back();
  chain = choose_axes(layers, {});
  EXPECT_EQ(chain.breaks.size(), 1u);
}

TEST(Axis, EmptyLayersBreak) {
  std::vector<Layer> layers(10, Layer{{{-0.5, 0.5}}, 0, 0, 1});
  layers[4].reachable.clear();
  layers[5].reachable.clear();
  const AxisChain chain = choose_axes(layers, {});
  EXPECT_EQ(chain.breaks, (std::vector<std::size_t>{4, 5, 6}));
  EXPECT_TRUE(choose_axes({}, {}).theta.empty());
  EXPECT_EQ(choose_axes({Layer{}}, {}).theta.size(), 1u);
  // The whole circle, no lengths, no normal.
  const Layer free{{{-kPi, kPi}}, std::nan(""), 2.0, 0};
  const AxisChain round = choose_axes(std::vector<Layer>(5, free), {});
  EXPECT_TRUE(round.breaks.empty());
  for (const double t : round.theta) EXPECT_TRUE(std::isfinite(t));
}

// --- the chain

/// Projected Gauss-Seidel to the end: slow, and another way.
std::vector<double> relaxed(const ChainProblem& p) {
  std::vector<double> x(p.lo.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::clamp(p.goal[i], p.lo[i], p.hi[i]);
  for (int sweep = 0; sweep < 200'000; ++sweep) {
    double moved = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      double a = p.pull[i], b = p.pull[i] * p.goal[i];
      if (i > 0) a += p.stiff[i], b += p.stiff[i] * x[i - 1];
      if (i + 1 < x.size()) a += p.stiff[i + 1], b += p.stiff[i + 1] * x[i + 1];
      const double next = std::clamp(b / a, p.lo[i], p.hi[i]);
      moved = std::max(moved, std::abs(next - x[i]));
      x[i] = next;
    }
    if (moved < 1e-13) break;
  }
  return x;
}

TEST(Chain, SameAsRelaxation) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 200; ++round) {
    const std::size_t n = 1 + round % 25;
    ChainProblem p;
    std::vector<double> x;
    for (std::size_t i = 0; i < n; ++i) {
      p.stiff.push_back(std::pow(10, 2 * unit(random) - 1));
      p.pull.push_back(0.01 + 0.1 * unit(random));
      p.goal.push_back(4 * unit(random));
      p.lo.push_back(3 * unit(random));
      const double width = unit(random);
      p.hi.push_back(p.lo.back() + (width < 0.1 ? 0 : width < 0.2 ? 1e-4 : 2 * width));
      x.push_back((p.lo.back() + p.hi.back()) / 2);
    }
    solve_chain(p, x);
    const auto slow = relaxed(p);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_GE(x[i], p.lo[i]);
      EXPECT_LE(x[i], p.hi[i]);
      EXPECT_NEAR(x[i], slow[i], 1e-5) << round << " " << i;
    }
    EXPECT_LE(chain_cost(p, x), chain_cost(p, slow) * (1 + 1e-7) + 1e-9);
  }
}

TEST(Axis, LinearInLayers) {
  std::mt19937 random(5);
  const auto layers = random_layers(random, 100'000, 0.02);
  const auto begin = std::chrono::steady_clock::now();
  AxisOptions options;
  options.lean = 0.17;
  const AxisChain chain = choose_axes(layers, options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  RecordProperty("seconds", std::to_string(seconds));
  EXPECT_EQ(chain.theta.size(), layers.size());
  // Ten times of what is asked for: debug builds, busy machines.
  EXPECT_LT(seconds, 10);
}

}  // namespace
}  // namespace burin::rotary
