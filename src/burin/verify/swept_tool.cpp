// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/swept_tool.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "burin/geom/point_tools.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

constexpr std::uint32_t kLeaf = 4;
// Newton from outside converges without overshooting, because f is concave; it is quadratic off the edges.
constexpr int kNewton = 60;
// Steps towards the moment of a stretch that cuts deepest, and how little (of the resolution) another moment
// may change it.
constexpr int kSecant = 8;
constexpr double kFlat = 0.25;

}  // namespace

SweptTool::SweptTool(std::vector<MillBody> bodies, std::vector<Stretch> stretches, std::uint32_t number)
    : bodies_(std::move(bodies)), number_(number) {
  order_.resize(stretches.size());
  std::iota(order_.begin(), order_.end(), 0U);
  if (stretches.empty()) return;
  nodes_.reserve(stretches.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(stretches.size()), stretches);
  stretches_.reserve(stretches.size());
  position_.resize(order_.size());
  for (const std::uint32_t i : order_) {
    position_[i] = static_cast<std::uint32_t>(stretches_.size());
    stretches_.push_back(stretches[i]);
  }
}

void SweptTool::lay(Node& node, std::uint32_t begin, std::uint32_t end,
                    const std::vector<Stretch>& stretches) const {
  geom::Box3 tips;
  Vec3 sum;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Stretch& s = stretches[order_[i]];
    tips.add(s.at(0).tip);
    tips.add(s.at(1).tip);
    sum = sum + s.middle.axis;
  }
  node.tip = lerp(tips.lo, tips.hi, 0.5);
  node.half = 0.5 * (tips.hi - tips.lo);
  node.axis = norm(sum) > 0 ? unit(sum) : stretches[order_[begin]].middle.axis;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Stretch& s = stretches[order_[i]];
    const double lean = std::atan2(norm(cross(node.axis, s.middle.axis)), dot(node.axis, s.middle.axis));
    node.turn = std::max(node.turn, lean + 0.5 * s.angle);
  }
}

void SweptTool::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end,
                      std::vector<Stretch>& stretches) {
  Node laid;
  lay(laid, begin, end, stretches);
  if (end - begin <= kLeaf) {
    laid.first = begin;
    laid.count = end - begin;
    nodes_[node] = laid;
    return;
  }
  // Place in the middle, and axis as far as it matters at the rim of the cutter.
  const double weight = bodies_[0].radius;
  const auto key = [&](std::uint32_t i, std::size_t k) {
    const Stretch& s = stretches[i];
    return k < 3 ? component(s.middle.tip, k) : weight * component(s.middle.axis, k - 3);
  };
  double least[6], most[6];
  std::fill(least, least + 6, std::numeric_limits<double>::infinity());
  std::fill(most, most + 6, -std::numeric_limits<double>::infinity());
  for (std::uint32_t i = begin; i < end; ++i)
    for (std::size_t k = 0; k < 6; ++k) {
      const double x = key(order_[i], k);
      least[k] = std::min(least[k], x);
      most[k] = std::max(most[k], x);
    }
  std::size_t widest = 0;
  for (std::size_t k = 1; k < 6; ++k)
    if (most[k] - least[k] > most[widest] - least[widest]) widest = k;
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double x = key(a, widest), y = key(b, widest);
                     return x != y ? x < y : a < b;
                   });
  laid.first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node] = laid;
  nodes_.resize(nodes_.size() + 2);
  split(laid.first, begin, half, stretches);
  split(laid.first + 1, half, end, stretches);
}

Candidate SweptTool::candidate(std::uint32_t stretch, std::uint32_t body) const {
  const Stretch& s = stretches_[stretch];
  return {&s, Span::whole(s), s.angle, norm(s.way), number_, stretch, body};
}

void SweptTool::lower(SampleLine& line) const {
  if (nodes_.empty()) return;
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) lower(line, Part{number_, b, 0});
}

void SweptTool::lower(SampleLine& line, const Part& part) const {
  if (upper(line, part.body, part.node) > -line.touch()) descend(line, part.body, part.node);
}

/// What the tool has to come into to lower the line: from the sample up to `top`, or the sample alone.
double SweptTool::upper(const SampleLine& line, std::uint32_t body, std::uint32_t node) const {
  const double top = body == 0 ? std::max(0.0, line.best - line.resolution) : 0;
  const Vec3 half = (0.5 * top) * line.n;
  const BoxExtent extent{line.q + half, 0.5 * top, {line.n, 0.5 * top, -0.5 * top}, {half, Vec3{}, Vec3{}}};
  return upper(bodies_[body], nodes_[node], extent, -line.touch());
}

void SweptTool::descend(SampleLine& line, std::uint32_t body, std::uint32_t index) const {
  const Node& node = nodes_[index];
  if (node.count > 0) {
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) lower(line, candidate(i, body));
    return;
  }
  const double a = upper(line, body, node.first), b = upper(line, body, node.first + 1);
  const std::uint32_t first = a >= b ? node.first : node.first + 1;
  if (std::max(a, b) > -line.touch()) descend(line, body, first);
  const std::uint32_t second = a >= b ? node.first + 1 : node.first;
  // The first may have brought the line down.
  if (std::min(a, b) > -line.touch() && upper(line, body, second) > -line.touch())
    descend(line, body, second);
}

/// One line against one piece of the tool on one stretch.
class SweptTool::Crossing {
 public:
  Crossing(SampleLine& line, const Candidate& c, const MillBody& body)
      : line_(line), c_(c), stretch_(*c.stretch), body_(body), touch_(line.touch()) {}

  void run() {
    aim();
    if (done()) return;
    const Times whole{0, 1, 0.5, stretch_.middle};
    if (!possible(whole)) return;

    const double t = best_time();
    prove({0, 1, t, stretch_.at(t)});
  }

 private:
  /// From `lo` to `hi`, looked at from `at`.
  struct Times {
    double lo, hi, t;
    Placed at;
    double half() const { return std::max(t - lo, hi - t); }
  };

  /// The height asked for: lower entries than this are looked for.
  void aim() {
    best_ = c_.body == 0 ? line_.best : std::min(line_.best, 0.0);
    top_ = best_ - line_.resolution;
  }
  bool done() const { return top_ <= -line_.reach; }
  BodyAt at_height(const Placed& at, double h) const {
    return body_at(body_, at.tip, at.axis, line_.q + h * line_.n);
  }
  Vec3 motion(Vec3 from_tip) const { return -(stretch_.way + cross(stretch_.turn, from_tip)); }
  /// What a function of gradient g at a place may grow by over the times; `range`: for places so far from it
  /// on the line.
  double growth(const Times& times, Vec3 g, Vec3 from_tip, double range) const {
    const double along = dot(g, motion(from_tip)), half = times.half();
    double more = std::max(along * (times.hi - times.t), along * (times.lo - times.t));
    if (c_.turn_rate > 0) {
      const double far = norm(from_tip) + range + c_.way_rate * half;
      more += 0.5 * c_.turn_rate * (c_.turn_rate * far + 2 * c_.way_rate) * half * half;
      if (range > 0) more += half * std::abs(dot(cross(g, stretch_.turn), line_.n)) * range;
    }
    return more;
  }
  /// Whether the place at height h, or one up to `below` under it, may be inside at one of the times.
  bool may_hold(const Times& times, double h, double below) const {
    const BodyAt b = at_height(times.at, h);
    const Vec3 from_tip = line_.q + h * line_.n - times.at.tip;
    const auto outside = [&](double f, Vec3 g) {
      return f + std::max(0.0, -dot(g, line_.n)) * below + growth(times, g, from_tip, below) <= -touch_;
    };
    for (std::size_t i = 0; i < b.count; ++i)
      if (outside(b.sides[i].f, b.sides[i].gradient)) return false;
    // At a sharp edge: the mean of bottom and side that does not change with time.
    const Vec3 bottom = b.sides[0].gradient, side = b.sides[1].gradient, moves = motion(from_tip);
    const double one = dot(bottom, moves), two = dot(side, moves);
    if ((one > 0) == (two > 0) || one == two) return true;
    const double share = two / (two - one);
    return !outside(share * b.sides[0].f + (1 - share) * b.sides[1].f, share * bottom + (1 - share) * side);
  }
  /// Below the surface both the sample and the height asked for must be inside at once, above it any place
  /// from the sample up to that height.
  bool possible(const Times& times) const {
    return may_hold(times, top_, std::max(0.0, top_)) && (top_ >= 0 || may_hold(times, 0, 0));
  }

  /// How fast the place at the best height gets deeper at a time.
  double along(double t) const {
    const Placed at = stretch_.at(t);
    const BodyAt b = at_height(at, best_);
    return dot(b.sides[b.least].gradient, motion(line_.q + best_ * line_.n - at.tip));
  }
  /// When the best height is deepest in the tool (it is concave in time but for the turning): a secant
  /// between times at which it rises and falls, the older one's rate halved when it stays (or it would
  /// creep).
  double best_time() {
    double a = 0.5, rate_a = along(a), b = rate_a > 0 ? 1 : 0, rate_b = along(b);
    enter({0, 1, a, stretch_.middle});
    if ((rate_a > 0) == (rate_b > 0)) {
      enter({0, 1, b, stretch_.at(b)});
      return b;
    }
    double t = a;
    for (int i = 0; i < kSecant && std::abs(rate_a - rate_b) > 0 && !done(); ++i) {
      t = a + rate_a / (rate_a - rate_b) * (b - a);
      enter({0, 1, t, stretch_.at(t)});
      const double rate = along(t);
      if (std::abs(rate * (b - a)) <= kFlat * line_.resolution) break;
      if ((rate > 0) == (rate_a > 0)) {
        a = t, rate_a = rate, rate_b *= 0.5;
      } else {
        b = t, rate_b = rate, rate_a *= 0.5;
      }
    }
    return t;
  }

  /// Lowers the best by where the line enters at time t. f is concave along it, so that tangents lead there
  /// from below. When it does not enter, tangents say how far it is from that: true when that proves the
  /// times.
  bool enter(const Times& times) {
    const BodyAt there = at_height(times.at, 0);
    double h = 0;
    if (there.f >= -touch_) {
      const BodySide& side = there.sides[there.least];
      const double slope = dot(side.gradient, line_.n);
      h = slope > 0 ? std::max(-line_.reach, -std::max(0.0, side.f) / slope) : -line_.reach;
    } else if (top_ < 0) {
      return false;
    }
    // f <= low.f + low.gradient . (place - the place at height `at`) on all of the line that matters.
    BodySide before, low{std::numeric_limits<double>::infinity(), {}};
    double at = top_, slope_before = 0;
    for (int i = 0; i < kNewton && h < best_; ++i) {
      const BodyAt here = at_height(times.at, h);
      if (here.f >= -touch_) {
        line_.best = h;
        line_.at = {c_.tool, c_.index, c_.body, static_cast<float>(times.t)};
        aim();
        return false;
      }
      const BodySide& side = here.sides[here.least];
      const double slope = dot(side.gradient, line_.n);
      if (slope <= 0) {  // it only gets less; so it does below, or the tangent from there came too far
        const double share = i > 0 ? -slope / (slope_before - slope) : 0;
        low = {(1 - share) * side.f, share * before.gradient + (1 - share) * side.gradient};
        at = h;
        break;
      }
      low = {side.f + slope * (top_ - h), side.gradient};
      before = side;
      slope_before = slope;
      h += -side.f / slope;
    }
    if (!(low.f < 0)) return false;
    const double range = std::max(std::abs(at), std::abs(top_ - at));
    return low.f + growth(times, low.gradient, line_.q + at * line_.n - times.at.tip, range) <= -touch_;
  }

  /// Nothing lower at any of the times, or it is found.
  void prove(const Times& times) {
    if (done() || !possible(times) || enter(times)) return;
    // So short a time changes nothing any more.
    const double far = distance(line_.q, times.at.tip) + line_.reach;
    if ((times.hi - times.lo) * (c_.way_rate + c_.turn_rate * far) <= touch_) return;
    const auto part = [&](double lo, double hi) {
      if (lo < hi) prove({lo, hi, 0.5 * (lo + hi), stretch_.at(0.5 * (lo + hi))});
    };
    part(times.lo, times.t);
    part(times.t, times.hi);
  }

  SampleLine& line_;
  const Candidate& c_;
  const Stretch& stretch_;
  const MillBody& body_;
  double touch_, best_ = 0, top_ = 0;
};

void SweptTool::lower(SampleLine& line, const Candidate& candidate) const {
  Crossing(line, candidate, bodies_[candidate.body]).run();
}

}  // namespace burin::verify
