// SPDX-License-Identifier: Apache-2.0
// The swept section as a surface: exact points and normals from the section and the sweep, never from a mesh.
//   S(u, x) = Rot(X, turn(x)) c(u) + x e_x,  N = S_u x S_x / |S_u x S_x|
//   with c the section, t its unit tangent, k = d turn / dx:  N ~ (k c.t, right(t) turned)
#pragma once

#include <cstddef>
#include <vector>

#include "burin/plan/rotary/part.h"

namespace burin::rotary::detail {

/// A place on the section: point, unit tangent, curvature (positive: turning left), length from the start.
struct SectionPoint {
  geom::Point2 c;
  geom::Vec2 t;
  double curvature = 0;
  double s = 0;
};

class Sweep {
 public:
  /// `swept` must outlive it and have passed make_swept.
  explicit Sweep(const SweptSection& swept);

  std::size_t pieces() const { return starts_.size() - 1; }
  double length() const { return starts_.back(); }
  double piece_start(std::size_t i) const { return starts_[i]; }
  double piece_length(std::size_t i) const { return starts_[i + 1] - starts_[i]; }
  SectionPoint at(std::size_t piece, double f) const;
  /// By length from the start; at a joint the piece that begins there (`after`) or ends there.
  SectionPoint at_length(double s, bool after = true) const;

  double x_min() const { return swept_->stations.front().x; }
  double x_max() const { return swept_->stations.back().x; }
  /// Radians per mm of the stretch that holds x; at a station that of the stretch after (before).
  double rate(double x, bool after = true) const;
  /// The twists that occur, without repetition, ascending.
  const std::vector<double>& rates() const { return rates_; }
  const SweptSection& swept() const { return *swept_; }

  /// The contact above p at x. The twist `rate` is given because it jumps at stations.
  Contact lift(const SectionPoint& p, double x, double rate) const;
  /// With the turn given: for parts of the sweep that are only imagined (an endless helix).
  Contact lift(const SectionPoint& p, double x, double turn, double rate) const;

 private:
  const SweptSection* swept_;
  std::vector<double> starts_;  ///< lengths at which the pieces begin, and the whole
  std::vector<double> rates_;
};

/// A contact of a ring before it is placed along X: a point of the section; at a convex corner a normal that
/// is turned by the part `f` of the way from that of `a` to that of `b` (the same point).
struct RingNode {
  SectionPoint a, b;
  double f = 0;
};
Contact lift(const Sweep& sweep, const RingNode& node, double x, double turn, double rate);

/// The nodes of a closed ring, the first not repeated: so dense that the centre path of a ring is left by
/// less than `density` (for every twist of the sweep), and points at most `longest` mm apart. A concave
/// corner gives two nodes, a convex one as many as the ball's turn takes.
std::vector<RingNode> ring_nodes(const Sweep& sweep, double ball_radius, double density, double longest);
/// How many nodes that would be, at most; stops counting above `limit`.
std::size_t count_ring_nodes(const Sweep& sweep, double ball_radius, double density, double longest,
                             std::size_t limit);

/// Turns the normal of the last contact evenly to n, the place standing still: the ball rolls over a convex
/// edge. Ends with n.
void append_fan(std::vector<Contact>& points, const Contact& to, double ball_radius, double density);

inline geom::Point3 center_of(const Contact& c, double radius) {
  return c.p + radius * c.n;
}
/// Unit vector on the shorter great circle from a to b.
geom::Vec3 turned(geom::Vec3 a, geom::Vec3 b, double f);
inline double angle_between(geom::Vec3 a, geom::Vec3 b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

}  // namespace burin::rotary::detail
