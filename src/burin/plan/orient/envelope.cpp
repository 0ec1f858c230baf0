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
// The goal counts as smooth where parabolas through neighbouring samples bend alike within this factor, and
// then rises by at most that times what they say.
constexpr double kSmooth = 3;
constexpr std::size_t kMostNodes = 600;

double bend(const Envelope::Node& a, const Envelope::Node& b, const Envelope::Node& c) {
  const double ab = (b.value - a.value) / (b.beta - a.beta), bc = (c.value - b.value) / (c.beta - b.beta);
  return (bc - ab) / (c.beta - a.beta);
}
/// The parabola through three places, bent downwards, over [lo, hi] of yaw: by how much it rises above
/// `base`, and where.
struct Rise {
  double by = 0, at = 0;
};
Rise parabola(const Envelope::Node& a, const Envelope::Node& b, const Envelope::Node& c, double lo, double hi,
              double base) {
  const double ab = (b.value - a.value) / (b.beta - a.beta), down = bend(a, b, c);
  // value(x) = a + ab (x - a) + down (x - a) (x - b)
  const double x = std::clamp((a.beta + b.beta) / 2 - ab / (2 * down), lo, hi);
  return {a.value + ab * (x - a.beta) + down * (x - a.beta) * (x - b.beta) - base, x};
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
  if (guess) {
    const auto near = std::min_element(yaws.begin(), yaws.end(), [&](double a, double b) {
      return std::abs(a - *guess) < std::abs(b - *guess);
    });
    guessed_ = static_cast<std::size_t>(near - yaws.begin());
  }
  nodes_.reserve(2 * yaws.size());
  for (const double beta : yaws) nodes_.push_back(fresh(beta));
}

Envelope::Node Envelope::fresh(double beta) const {
  Node node;
  node.beta = beta;
  node.alpha = setting_.range.alpha_lo;
  node.value = goal_.value(at_, {node.alpha, beta});
  node.gate = std::numeric_limits<double>::infinity();
  return node;
}

void Envelope::look(Node& node, double gate) const {
  const AngleRange& range = setting_.range;
  const double end =
      gate == kNever ? range.alpha_hi : goal_.tilt_of(at_, gate, node.beta, node.alpha, range.alpha_hi);
  const Relaxation::Reach reach = known_.blocked_from(node.beta, node.alpha, end);
  node.gate = gate;
  node.alpha = reach.alpha;
  if (!reach.covered)
    node.value = goal_.value(at_, {reach.alpha, node.beta});
  else
    node.value = end >= range.alpha_hi ? kNever : gate;
}

std::optional<std::size_t> Envelope::open(double gate) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    if (node.exact || !(node.value > gate)) continue;
    if (node.gate > gate) look(node, gate);
    if (!(node.value > gate)) continue;
    if (!best || node.value > nodes_[*best].value) best = i;
  }
  return best;
}

std::optional<double> Envelope::foretell(std::size_t i) const {
  const bool left = i > 0 && exact(i - 1), right = exact(i + 1);
  if (!left && !right) return std::nullopt;
  const auto line = [&](const Node& a, const Node& b) {
    return a.alpha + (b.alpha - a.alpha) * (nodes_[i].beta - a.beta) / (b.beta - a.beta);
  };
  if (left && right) return line(nodes_[i - 1], nodes_[i + 1]);
  if (left) return i > 1 && exact(i - 2) ? line(nodes_[i - 2], nodes_[i - 1]) : nodes_[i - 1].alpha;
  return exact(i + 2) ? line(nodes_[i + 1], nodes_[i + 2]) : nodes_[i + 1].alpha;
}

void Envelope::raise(std::size_t i, double alpha, bool exact) {
  Node& node = nodes_[i];
  node.alpha = alpha;
  node.exact = exact;
  node.value = goal_.value(at_, {alpha, node.beta});
}

void Envelope::exclude(std::size_t i, double alpha, double gate) {
  nodes_[i].alpha = alpha;
  nodes_[i].value = alpha >= setting_.range.alpha_hi ? kNever : gate;
}

void Envelope::learn(double gate) {
  for (Node& node : nodes_)
    if (!node.exact && node.value > gate && known_.newest_blocks({node.alpha, node.beta})) look(node, gate);
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

/// A hump without a corner between j and j + 1: with one the samples beyond would bend less than those around
/// it.
bool Envelope::smooth(std::size_t j) const {
  const double left = bend(nodes_[j - 1], nodes_[j], nodes_[j + 1]),
               right = bend(nodes_[j], nodes_[j + 1], nodes_[j + 2]);
  const auto alike = [](double a, double b) { return a < 0 && b < 0 && a > kSmooth * b && b > kSmooth * a; };
  return j > 1 && exact(j - 2) && exact(j + 3) && alike(left, right) &&
         alike(left, bend(nodes_[j - 2], nodes_[j - 1], nodes_[j])) &&
         alike(right, bend(nodes_[j + 1], nodes_[j + 2], nodes_[j + 3]));
}

double Envelope::between(std::size_t j, double& beta) const {
  const Node &a = nodes_[j], &b = nodes_[j + 1];
  beta = (a.beta + b.beta) / 2;
  // Where neither comes near the best nothing between them is expected to.
  if (!a.exact && !b.exact) return kNever;
  const double most = by_tilts(j);
  if (!a.exact || !b.exact) return most;
  const Node* before = j > 0 && exact(j - 1) ? &nodes_[j - 1] : nullptr;
  const Node* after = exact(j + 2) ? &nodes_[j + 2] : nullptr;
  const double base = std::max(a.value, b.value), width = b.beta - a.beta;
  if (before && after && smooth(j)) {
    const Rise one = parabola(*before, a, b, a.beta, b.beta, base),
               two = parabola(a, b, *after, a.beta, b.beta, base);
    const Rise& more = one.by > two.by ? one : two;
    // Not at the samples themselves.
    beta = std::clamp(more.at, a.beta + 0.1 * width, b.beta - 0.1 * width);
    return std::min(most, base + kSmooth * std::max(more.by, 0.0));
  }
  // A corner may stand between them: as high as the lines from either side go.
  const double rise_a = before ? std::max(0.0, (a.value - before->value) / (a.beta - before->beta)) : 0;
  const double rise_b = after ? std::max(0.0, (b.value - after->value) / (after->beta - b.beta)) : 0;
  if (before && after && rise_a > 0 && rise_b > 0) {
    const double x = std::clamp((b.value - a.value + rise_b * width) / (rise_a + rise_b), 0.0, width);
    beta = a.beta + std::clamp(x, 0.1 * width, 0.9 * width);
    return std::min(most, a.value + rise_a * x);
  }
  if (!before && !after) return most;
  return std::min(most, std::max(a.value + rise_a * width, b.value + rise_b * width));
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
    if (between(j, beta) > enough) finer.push_back(fresh(beta));
  }
  const bool more = finer.size() > nodes_.size();
  nodes_.swap(finer);
  return more;
}

}  // namespace burin::orient
