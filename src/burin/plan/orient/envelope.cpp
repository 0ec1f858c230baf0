// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/envelope.h"

#include <algorithm>
#include <cmath>

namespace burin::orient {
namespace {

// Steps of yaw to begin with, over the whole range; no coarser than kCoarsest. Allowed sets narrower than a
// step in yaw may be missed.
constexpr int kYawSteps = 60;
constexpr double kCoarsest = 3 * geom::kPi / 180;
// rad: the yaw where a wall begins is found within this.
constexpr double kFinest = 1e-4;
// Share of the goal that more samples must promise; a part of kOptimumShare, the rest is for the tests.
constexpr double kPromise = kOptimumShare / 4;
constexpr std::size_t kMostNodes = 600;

}  // namespace

Envelope::Envelope(const Setting& setting, const Goal& goal, const CcPoint& at, const Relaxation& known)
    : setting_(setting), goal_(goal), at_(at), known_(known) {
  const AngleRange& range = setting.range;
  const double middle = range.widest().beta;
  const auto stretch = [&](double from, double to) {
    const double width = to - from;
    if (!(width > 0)) return;
    const double share = std::ceil(kYawSteps * width / (range.beta_hi - range.beta_lo));
    const int steps = static_cast<int>(std::max({1.0, share, std::ceil(width / kCoarsest)}));
    for (int k = 1; k <= steps; ++k)
      nodes_.push_back(sample(k == steps ? to : from + k * width / steps, range.alpha_lo));
  };
  nodes_.push_back(sample(range.beta_lo, range.alpha_lo));
  stretch(range.beta_lo, middle);
  stretch(middle, range.beta_hi);
}

Envelope::Node Envelope::sample(double beta, double from) const {
  Node node;
  node.beta = beta;
  node.alpha = known_.first_tilt(beta, from, setting_.range.alpha_hi);
  node.value = node.alpha <= setting_.range.alpha_hi ? goal_.value(at_, {node.alpha, beta}) : kNever;
  return node;
}

std::optional<std::size_t> Envelope::top() const {
  const auto best = std::max_element(nodes_.begin(), nodes_.end(),
                                     [](const Node& a, const Node& b) { return a.value < b.value; });
  if (best == nodes_.end() || !best->possible()) return std::nullopt;
  return static_cast<std::size_t>(best - nodes_.begin());
}

void Envelope::raise(std::size_t i, double alpha, bool exact) {
  Node& node = nodes_[i];
  node.alpha = alpha;
  node.exact = exact;
  node.value = goal_.value(at_, {alpha, node.beta});
}

void Envelope::learn(double found) {
  const std::size_t newest = known_.size() - 1;
  for (Node& node : nodes_) {
    if (node.exact || !(node.value > found) || !known_.blocks(newest, {node.alpha, node.beta})) continue;
    node = sample(node.beta, node.alpha);
  }
}

double Envelope::by_tilts(std::size_t j) const {
  const Node &a = nodes_[j], &b = nodes_[j + 1];
  const double width = b.beta - a.beta;
  double least = setting_.range.alpha_hi;
  const auto extrapolate = [&](const Node& node, const Node* before) {
    if (!node.possible()) return;
    double alpha = node.alpha;
    if (before && before->possible() && before->alpha > alpha)
      alpha -= (before->alpha - alpha) * width / std::abs(node.beta - before->beta);
    least = std::min(least, alpha);
  };
  extrapolate(a, j > 0 ? &nodes_[j - 1] : nullptr);
  extrapolate(b, j + 2 < nodes_.size() ? &nodes_[j + 2] : nullptr);
  least = std::max(least, setting_.range.alpha_lo);
  return std::max(goal_.value(at_, {least, a.beta}), goal_.value(at_, {least, b.beta}));
}

double Envelope::between(std::size_t j, double enough) const {
  const Node &a = nodes_[j], &b = nodes_[j + 1];
  if (!a.possible() && !b.possible()) return kNever;
  const double width = b.beta - a.beta;
  double lines = std::numeric_limits<double>::infinity();
  if (a.possible() && b.possible() && j > 0 && j + 2 < nodes_.size() && nodes_[j - 1].possible() &&
      nodes_[j + 2].possible()) {
    // What the two sides foretell of each other: nothing is missing where they agree.
    const Node &before = nodes_[j - 1], &after = nodes_[j + 2];
    const double rise_a = (a.value - before.value) / (a.beta - before.beta) * width;
    const double rise_b = (b.value - after.value) / (after.beta - b.beta) * width;
    lines = std::max(a.value, b.value) +
            std::max(std::abs(a.value + rise_a - b.value), std::abs(b.value + rise_b - a.value));
    if (lines <= enough) return enough;
  }
  return std::min(lines, by_tilts(j));
}

void Envelope::refine(double found) {
  std::vector<Node> finer;
  for (bool more = true; more && nodes_.size() < kMostNodes;) {
    more = false;
    double best = found;
    for (const Node& node : nodes_) best = std::max(best, node.value);
    if (best == kNever) return;
    const double enough = best * (1 + kPromise);
    finer.clear();
    for (std::size_t j = 0; j < nodes_.size(); ++j) {
      finer.push_back(nodes_[j]);
      if (j + 1 == nodes_.size() || nodes_[j + 1].beta - nodes_[j].beta < kFinest) continue;
      if (!(between(j, enough) > enough)) continue;
      finer.push_back(sample((nodes_[j].beta + nodes_[j + 1].beta) / 2, setting_.range.alpha_lo));
      more = true;
    }
    nodes_.swap(finer);
  }
}

}  // namespace burin::orient
