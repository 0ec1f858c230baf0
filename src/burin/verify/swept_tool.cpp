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
  for (const std::uint32_t i : order_) stretches_.push_back(stretches[i]);
}

void SweptTool::lay(Node& node, std::uint32_t begin, std::uint32_t end,
                    const std::vector<Stretch>& stretches) const {
  geom::Box3 tips;
  Vec3 sum;
  const auto last = [](const Stretch& s) { return s.at(1).axis; };
  for (std::uint32_t i = begin; i < end; ++i) {
    const Stretch& s = stretches[order_[i]];
    tips.add(s.from.tip);
    tips.add(s.from.tip + s.way);
    sum = sum + s.from.axis + last(s);
  }
  node.tip = lerp(tips.lo, tips.hi, 0.5);
  node.half = 0.5 * (tips.hi - tips.lo);
  node.axis = norm(sum) > 0 ? unit(sum) : stretches[order_[begin]].from.axis;
  // Both ends of an arc of a great circle within a cap of less than half the sphere: so is the arc.
  const auto lean = [&](Vec3 a) { return std::atan2(norm(cross(node.axis, a)), dot(node.axis, a)); };
  for (std::uint32_t i = begin; i < end; ++i) {
    const Stretch& s = stretches[order_[i]];
    node.turn = std::max({node.turn, lean(s.from.axis), lean(last(s))});
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
    return k < 3 ? component(s.from.tip, k) + 0.5 * component(s.way, k)
                 : weight * component(s.from.axis, k - 3);
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
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) descend(line, b, 0);
}

void SweptTool::lower(SampleLine& line, const Candidate& candidate) const {
  lower(line, candidate, candidate.whole);
}

/// What the tool has to come into to lower the line: from the sample up to `top`, or the sample alone.
void SweptTool::descend(SampleLine& line, std::uint32_t body, std::uint32_t index) const {
  const Node& node = nodes_[index];
  if (node.count > 0) {
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) lower(line, candidate(i, body));
    return;
  }
  const auto bound = [&](std::uint32_t child) {
    const double top = body == 0 ? std::max(0.0, line.best - line.resolution) : 0;
    const BoxExtent extent{line.q + (0.5 * top) * line.n,
                           0.5 * top,
                           {line.n, 0.5 * top, -0.5 * top},
                           {(0.5 * top) * line.n, Vec3{}, Vec3{}}};
    return upper(bodies_[body], nodes_[child], extent, -line.touch());
  };
  const double a = bound(node.first), b = bound(node.first + 1);
  const std::uint32_t first = a >= b ? node.first : node.first + 1;
  if (std::max(a, b) > -line.touch()) descend(line, body, first);
  const std::uint32_t second = a >= b ? node.first + 1 : node.first;
  // The first may have brought the line down.
  if (std::min(a, b) > -line.touch() && bound(second) > -line.touch()) descend(line, body, second);
}

/// Lowers `best` by what the tool does in the span, or proves that it does nothing there: below the surface
/// both the sample and the height asked for must be in it at once, above it any place from the sample up to
/// that height.
void SweptTool::lower(SampleLine& line, const Candidate& c, const Span& span) const {
  const MillBody& body = bodies_[c.body];
  const double best = c.body == 0 ? line.best : std::min(line.best, 0.0);
  const double top = best - line.resolution, touch = line.touch();
  if (top <= -line.reach) return;
  const Stretch& stretch = *c.stretch;
  // Whether a place up to `below` under p may be inside.
  double along = 0;
  const auto reached = [&](Point3 p, double below) {
    const BodyAt b = body_at(body, span.at.tip, span.at.axis, p);
    const Vec3 from_tip = p - span.at.tip, motion = -(stretch.way + cross(stretch.turn, from_tip));
    const double far = norm(from_tip) + below + c.way_rate * span.half;
    const double bend = 0.5 * c.turn_rate * (c.turn_rate * far + 2 * c.way_rate) * span.half * span.half;
    for (std::size_t i = 0; i < b.count; ++i) {
      const Vec3 g = b.sides[i].gradient;
      double more = bend + span.half * std::abs(dot(g, motion));
      if (below > 0) {
        // Lower on the line it may be more, and may move otherwise.
        more += std::max(0.0, -dot(g, line.n)) * below;
        if (c.turn_rate > 0) more += span.half * std::abs(dot(cross(g, stretch.turn), line.n)) * below;
      }
      if (b.sides[i].f + more <= -touch) return false;
    }
    along = dot(b.sides[b.least].gradient, motion);
    return true;
  };
  if (!reached(line.q + top * line.n, std::max(0.0, top))) return;
  if (top < 0 && !reached(line.q, 0)) return;

  // Where the line enters at the middle: f is concave along it, so that tangents lead there from below.
  const auto f_at = [&](double h) { return body_at(body, span.at.tip, span.at.axis, line.q + h * line.n); };
  const BodyAt there = f_at(0);
  double h = 0;
  if (there.f >= -touch) {
    const BodySide& side = there.sides[there.least];
    const double slope = dot(side.gradient, line.n);
    h = slope > 0 ? std::max(-line.reach, -std::max(0.0, side.f) / slope) : -line.reach;
  } else if (top < 0) {
    h = line.best;
  }
  // When it does not, tangents say how far it is from that: f <= low + g . (place - the place at height `at`)
  // on all of the line that matters.
  BodySide before, low{std::numeric_limits<double>::infinity(), {}};
  double at = top, slope_before = 0;
  for (int i = 0; i < kNewton && h < best; ++i) {
    const BodyAt here = f_at(h);
    if (here.f >= -touch) {
      line.best = h;
      line.tool = c.tool;
      line.stretch = c.index;
      line.time = span.middle;
      low.f = std::numeric_limits<double>::infinity();
      break;
    }
    const BodySide& side = here.sides[here.least];
    const double slope = dot(side.gradient, line.n);
    if (slope <= 0) {  // it only gets less; so it does below, or the tangent from there came too far
      const double share = i > 0 ? -slope / (slope_before - slope) : 0;
      low = {(1 - share) * side.f, share * before.gradient + (1 - share) * side.gradient};
      at = h;
      break;
    }
    low = {side.f + slope * (top - h), side.gradient};
    before = side;
    slope_before = slope;
    h += -side.f / slope;
  }
  if (low.f < 0) {
    const Vec3 from_tip = line.q + at * line.n - span.at.tip;
    const double range = std::max(std::abs(at), std::abs(top - at));
    const double far = norm(from_tip) + range + c.way_rate * span.half;
    const double bend = 0.5 * c.turn_rate * (c.turn_rate * far + 2 * c.way_rate) * span.half * span.half;
    const double varies = std::abs(dot(cross(low.gradient, stretch.turn), line.n)) * range;
    const double moves = std::abs(dot(low.gradient, stretch.way + cross(stretch.turn, from_tip)));
    if (low.f + bend + span.half * (moves + varies) <= -touch) return;
  }
  // So short a time changes nothing any more.
  const double far = distance(line.q, span.at.tip) + line.reach;
  if (span.half * (c.way_rate + c.turn_rate * far) <= touch) return;
  const std::array<Span, 2> parts = span.halves(stretch);
  lower(line, c, parts[along < 0 ? 0 : 1]);
  lower(line, c, parts[along < 0 ? 1 : 0]);
}

}  // namespace burin::verify
