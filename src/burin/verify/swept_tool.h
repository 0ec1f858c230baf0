// SPDX-License-Identifier: Apache-2.0
// The volume a moving tool goes through, as an index that is asked where lines enter it. Internal to verify.
// mm. docs/verify-deviation.md
#pragma once

#include <cstdint>
#include <vector>

#include "burin/verify/mill_body.h"
#include "burin/verify/mill_bound.h"
#include "burin/verify/mill_motion.h"

namespace burin::verify {

/// When: a stretch, as the index of a tool numbers them, and its time.
struct Moment {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t tool = kNone, stretch = kNone;
  std::uint32_t body = 0;
  float time = 0;
  bool found() const { return stretch != kNone; }
};

/// The line q + h n of a sample and the lowest entry found so far: of the intervals of h that the tool covers
/// at any moment, those that reach up to h >= 0 count.
struct SampleLine {
  geom::Point3 q;
  geom::Vec3 n;
  double reach = 0;       ///< looked at from -reach to reach
  double resolution = 0;  ///< what may be left to find
  double best = 0;        ///< begins as reach
  Moment at{};            ///< when that is; none: nowhere up to reach

  bool found() const { return at.found(); }
  /// As if every piece were so much larger all around: what is touched to a rounding error counts as inside.
  double touch() const { return 0.01 * resolution; }
};

/// A stretch in the order of the index, as the search wants it.
struct Candidate {
  const Stretch* stretch = nullptr;
  Span whole;
  double turn_rate = 0, way_rate = 0;
  std::uint32_t tool = 0, index = 0;
  std::uint32_t body = 0;
};

class SweptTool {
 public:
  /// bodies[0] cuts; the others count only where they get below the surface. `number` comes back in lines.
  SweptTool(std::vector<MillBody> bodies, std::vector<Stretch> stretches, std::uint32_t number = 0);

  std::size_t bodies() const { return bodies_.size(); }
  const MillBody& body(std::size_t i) const { return bodies_[i]; }
  /// Position in the list given of the stretch that a line or a candidate names.
  std::uint32_t original(std::uint32_t stretch) const { return order_[stretch]; }
  /// And back.
  std::uint32_t position(std::uint32_t original) const { return position_[original]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(stretches_.size()); }
  const Stretch& stretch(std::uint32_t i) const { return stretches_[i]; }
  Candidate candidate(std::uint32_t stretch, std::uint32_t body) const;

  /// A part of the index for one of the bodies.
  struct Part {
    std::uint32_t tool = 0, body = 0, node = 0;
  };
  /// The whole of it, for all bodies.
  void add_all(std::vector<Part>& parts) const {
    for (std::uint32_t b = 0; b < bodies_.size() && !nodes_.empty(); ++b) parts.push_back({number_, b, 0});
  }
  /// Adds to `parts` what of the part may come into both extents, or nearer than `margin`: divided until each
  /// is no larger than the extents or one leaf.
  template <class Extent>
  void narrow(const Part& part, const Extent& one, const Extent& other, double margin,
              std::vector<Part>& parts) const {
    const Node& node = nodes_[part.node];
    const MillBody& body = bodies_[part.body];
    if (upper(body, node, one, -margin) <= -margin) return;
    if (&one != &other && upper(body, node, other, -margin) <= -margin) return;
    if (node.count > 0 || norm(node.half) + node.turn * body.radius <= one.radius) {
      parts.push_back(part);
      return;
    }
    narrow({part.tool, part.body, node.first}, one, other, margin, parts);
    narrow({part.tool, part.body, node.first + 1}, one, other, margin, parts);
  }

  /// Calls visit(candidate) for every stretch of the part that may come into both extents or nearer than
  /// `margin`.
  template <class Extent, class Visit>
  void gather(const Part& part, const Extent& one, const Extent& other, double margin, Visit&& visit) const {
    const Node& node = nodes_[part.node];
    const MillBody& body = bodies_[part.body];
    if (upper(body, node, one, -margin) <= -margin || upper(body, node, other, -margin) <= -margin) return;
    if (node.count == 0) {
      gather({part.tool, part.body, node.first}, one, other, margin, visit);
      gather({part.tool, part.body, node.first + 1}, one, other, margin, visit);
      return;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(candidate(i, part.body));
  }

  /// Lowers the line's best by one stretch, by a part, by all.
  void lower(SampleLine& line, const Candidate& candidate) const;
  void lower(SampleLine& line, const Part& part) const;
  void lower(SampleLine& line) const;

 private:
  class Crossing;
  /// Stretches near each other in place and axis.
  struct Node {
    geom::Point3 tip;  ///< in the middle
    geom::Vec3 half;   ///< of the box of the tips
    geom::Vec3 axis;
    double turn = 0;                     ///< no axis leans more against `axis`
    std::uint32_t first = 0, count = 0;  ///< stretches; count 0: the first of two children
  };
  static constexpr double kWidestTurn = 1;

  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end, std::vector<Stretch>& stretches);
  void lay(Node& node, std::uint32_t begin, std::uint32_t end, const std::vector<Stretch>& stretches) const;
  double upper(const SampleLine& line, std::uint32_t body, std::uint32_t node) const;
  void descend(SampleLine& line, std::uint32_t body, std::uint32_t node) const;

  /// No place of the extent is deeper in the body at any time of the node's stretches; only its sign says how
  /// far outside. As upper_bound, the places of the tips being one more extent and the turn a rotation by at
  /// most `turn` about the tip, which moves a place at d by at most turn |d x g| + turn^2 |d| / 2 along g.
  template <class Extent>
  double upper(const MillBody& body, const Node& node, const Extent& extent, double enough) const {
    const geom::Vec3 d = extent.center - node.tip;
    const double spread = extent.radius + norm(node.half), far = norm(d);
    double least = body.span() + spread - far;
    if (least <= enough || node.turn > kWidestTurn) return least;
    const auto tips = [&](geom::Vec3 g) {
      return std::abs(g.x) * node.half.x + std::abs(g.y) * node.half.y + std::abs(g.z) * node.half.z;
    };
    const double more = node.turn * spread + 0.5 * node.turn * node.turn * (far + spread);
    const BodyAt at = body_at(body, node.tip, node.axis, extent.center);
    for (std::size_t i = 0; i < at.count; ++i) {
      const geom::Vec3 g = at.sides[i].gradient;
      const double turned = node.turn > 0 ? node.turn * norm(cross(d, g)) + more : 0;
      least = std::min(least, at.sides[i].f + extent.most(extent.directions(g)) + tips(g) + turned);
      if (least <= enough) return least;
    }
    const geom::Vec3 n = extent.plane.normal;
    return std::min(
        least, body.reach(node.axis, -n) + dot(n, d) + extent.plane.most + tips(n) + node.turn * body.span());
  }

  std::vector<MillBody> bodies_;
  std::vector<Stretch> stretches_;  // in the order of the tree
  std::vector<std::uint32_t> order_, position_;
  std::vector<Node> nodes_;
  std::uint32_t number_ = 0;
};

}  // namespace burin::verify
