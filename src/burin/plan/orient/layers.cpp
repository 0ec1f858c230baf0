// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/layers.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

namespace burin::orient {
namespace {

/// A state is a choice with one of its solutions; without a machine there is one.
int branches(const Choice& choice) {
  return std::max(choice.rotary.count, 1);
}

struct State {
  double cost = std::numeric_limits<double>::infinity();
  std::uint32_t before = 0;  // index of the state in the layer before
};

}  // namespace

double edge_cost(const EdgeCost& cost, const Choice& a, int branch_a, const Choice& b, int branch_b,
                 double way) {
  const AxisMotion::Step step = cost.motion->step(a.pose, a.rotary, branch_a, b.pose, b.rotary, branch_b);
  const double tip = geom::distance(a.pose.tip, b.pose.tip);
  const double over = step.minutes * cost.motion->feed_mm_min() - tip;
  return std::max(0.0, tip - way) + cost.turn_weight * step.turn +
         cost.overspeed_weight * std::max(0.0, over);
}

std::vector<std::size_t> cheapest_way(const std::vector<Layer>& layers, const std::vector<double>& ways,
                                      const EdgeCost& cost) {
  if (layers.empty()) return {};
  // States of a layer in the order of its choices, both solutions of a choice after each other.
  std::vector<std::vector<State>> states(layers.size());
  std::vector<std::vector<std::pair<std::uint32_t, int>>> which(layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    for (std::size_t c = 0; c < layers[i].size(); ++c)
      for (int b = 0; b < branches(layers[i][c]); ++b)
        which[i].emplace_back(static_cast<std::uint32_t>(c), b);
    states[i].resize(which[i].size());
  }
  for (std::size_t s = 0; s < states[0].size(); ++s) states[0][s].cost = layers[0][which[0][s].first].loss;
  std::vector<std::uint32_t> cheap_first;  // states of the layer before
  for (std::size_t i = 1; i < layers.size(); ++i) {
    cheap_first.resize(states[i - 1].size());
    std::iota(cheap_first.begin(), cheap_first.end(), 0U);
    std::sort(cheap_first.begin(), cheap_first.end(), [&](std::uint32_t a, std::uint32_t b) {
      const double ca = states[i - 1][a].cost, cb = states[i - 1][b].cost;
      return ca != cb ? ca < cb : a < b;
    });
    for (std::size_t s = 0; s < states[i].size(); ++s) {
      const auto [c, b] = which[i][s];
      const Choice& to = layers[i][c];
      State& state = states[i][s];
      for (const std::uint32_t r : cheap_first) {
        const double so_far = states[i - 1][r].cost;
        if (so_far >= state.cost) break;  // no edge costs less than nothing
        const auto [from, from_branch] = which[i - 1][r];
        const double sum = so_far + edge_cost(cost, layers[i - 1][from], from_branch, to, b, ways[i - 1]);
        if (sum < state.cost) state = {sum, r};
      }
      state.cost += to.loss;
    }
  }
  std::vector<std::size_t> way(layers.size());
  const auto& last = states.back();
  std::size_t at = static_cast<std::size_t>(
      std::min_element(last.begin(), last.end(),
                       [](const State& a, const State& b) { return a.cost < b.cost; }) -
      last.begin());
  for (std::size_t i = layers.size(); i-- > 0; at = states[i][at].before) way[i] = which[i][at].first;
  return way;
}

}  // namespace burin::orient
