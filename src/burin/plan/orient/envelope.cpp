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
// Share of the goal that more samples must promise: a part of kOptimumShare.
constexpr double kPromise = kOptimumShare / 2;
// Where the goal has a corner between samples it rises by up to four times what parabolas through them say.
constexpr double kCorner = 4;
constexpr std::size_t kMostNodes = 600;

/// The parabola through three places, over [lo, hi] of yaw: by how much it rises above `base`, and where.
struct Rise {
  double by = 0, at = 0;
};
Rise parabola(const Envelope::Node& a, const Envelope::Node& b, const Envelope::Node& c, double lo, double hi,
              double base) {
  const double ab = (b.value - a.value) / (b.beta - a.beta), bc = (c.value - b.value) / (c.beta - b.beta);
  const double bend = (bc - ab) / (c.beta - a.beta);
  if (!(bend < 0)) return {0, (lo + hi) / 2};
  // value(x) = a + ab (x - a) + bend (x - a) (x - b)
  const double x = std::clamp((a.beta + b.beta) / 2 - ab / (2 * bend), lo, hi);
  return {a.value + ab * (x - a.beta) + bend * (x - a.beta) * (x - b.beta) - base, x};
}

}  // namespace

Envelope::Envelope(const Setting& setting, const Goal& goal, const CcPoint& at, const Relaxation& known,
                   std::optional<double> guess)
    : setting_(setting), goal_(goal), at_(at), known_(known) {
  const AngleRange& range = setting.range;
  const double middle = range.widest().beta;
  std::vector<double> yaws{range.beta_lo};
  const auto stretch = [&](double from, double to) {
    const double width = to - from;
    if (!(width > 0)) return;
    const double share = std::ceil(kYawSteps * width / (range.beta_hi - range.beta_lo));
    const int steps = static_cast<int>(std::max({1.0, share, std::ceil(width / kCoarsest)}));
    for (int k = 1; k <= steps; ++k) yaws.push_back(k == steps ? to : from + k * width / steps);
  };
  stretch(range.beta_lo, middle);
  stretch(middle, range.beta_hi);
  if (guess && *guess > range.beta_lo && *guess < range.beta_hi) {
    const auto after = std::lower_bound(yaws.begin(), yaws.end(), *guess);
    if (*after - *guess > kFinest && *guess - *(after - 1) > kFinest) yaws.insert(after, *guess);
  }
  nodes_.reserve(2 * yaws.size());
  for (const double beta : yaws) nodes_.push_back(sample(beta, range.alpha_lo));
}

Envelope::Node Envelope::sample(double beta, double from) const {
  Node node;
  node.beta = beta;
  node.alpha = known_.first_tilt(beta, from, setting_.range.alpha_hi);
  node.value = node.alpha <= setting_.range.alpha_hi ? goal_.value(at_, {node.alpha, beta}) : kNever;
  return node;
}

std::optional<std::size_t> Envelope::open(double gate) const {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    if (node.exact || !(node.value > gate)) continue;
    if (!best || node.value > nodes_[*best].value) best = i;
  }
  return best;
}

void Envelope::raise(std::size_t i, double alpha, bool exact) {
  Node& node = nodes_[i];
  node.alpha = alpha;
  node.exact = exact;
  node.value = goal_.value(at_, {alpha, node.beta});
}

void Envelope::learn(double gate) {
  const std::size_t newest = known_.size() - 1;
  for (Node& node : nodes_) {
    if (node.exact || !(node.value > gate) || !known_.blocks(newest, {node.alpha, node.beta})) continue;
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

double Envelope::between(std::size_t j, double& beta) const {
  const Node &a = nodes_[j], &b = nodes_[j + 1];
  beta = (a.beta + b.beta) / 2;
  if (!a.possible() && !b.possible()) return kNever;
  double curves = std::numeric_limits<double>::infinity();
  if (a.exact && b.exact) {
    const double base = std::max(a.value, b.value), width = b.beta - a.beta;
    // Not at the samples themselves.
    const double lo = a.beta + 0.1 * width, hi = b.beta - 0.1 * width;
    Rise most{0, beta};
    int curved = 0;
    for (const bool left : {true, false}) {
      if (left ? !(j > 0 && exact(j - 1)) : !exact(j + 2)) continue;
      const Rise rise =
          left ? parabola(nodes_[j - 1], a, b, lo, hi, base) : parabola(a, b, nodes_[j + 2], lo, hi, base);
      if (rise.by > most.by) most = rise;
      ++curved;
    }
    if (curved > 0) {
      curves = base + kCorner * most.by;
      beta = most.at;
    }
  }
  return std::min(curves, by_tilts(j));
}

bool Envelope::refine(double found) {
  const double enough = found * (1 + kPromise);
  if (nodes_.size() >= kMostNodes) return false;
  std::vector<Node> finer;
  finer.reserve(nodes_.size() + 8);
  for (std::size_t j = 0; j < nodes_.size(); ++j) {
    finer.push_back(nodes_[j]);
    if (j + 1 == nodes_.size() || nodes_[j + 1].beta - nodes_[j].beta < kFinest) continue;
    double beta = 0;
    if (between(j, beta) > enough) finer.push_back(sample(beta, setting_.range.alpha_lo));
  }
  const bool more = finer.size() > nodes_.size();
  nodes_.swap(finer);
  return more;
}

}  // namespace burin::orient
