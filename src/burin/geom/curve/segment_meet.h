// SPDX-License-Identifier: Apache-2.0
// Where two segments (lines, arcs of at most a half turn) meet, with a tolerance; no trigonometry.
#pragma once

#include <array>
#include <variant>

#include "burin/geom/curve/arc_spline.h"

namespace burin::geom::detail {

/// Precondition of everything here: arcs sweep at most a half turn (plus rounding), so that a point of the
/// circle is on the arc exactly when it lies on the arc's side of the chord.

struct NoMeet {};
struct OneMeet {
  Point2 p;
};
struct TwoMeets {
  Point2 p, q;
};
/// Ends of one that lie on the other within the tolerance (touching ends, T joints, runs along each other)
/// and the crossings besides; points may repeat.
struct Overlap {
  std::array<Point2, 6> points;
  int count = 0;
};
using Meeting = std::variant<NoMeet, OneMeet, TwoMeets, Overlap>;

/// Points in which the infinite lines or full circles of both meet, at most two. Where they miss each other
/// by less than `eps`, the point of closest approach counts.
struct Candidates {
  std::array<Point2, 2> p;
  int count = 0;
};
Candidates carriers_meet(const Segment& s, const Segment& t, double eps);

/// Every crossing deeper than eps is reported, and every end of one segment within eps of the other; each
/// point reported is within 2 eps of both.
Meeting meet(const Segment& s, const Segment& t, double eps);

/// The same for t that starts where s ends (bit by bit): the common point is not reported, nor anything
/// within eps of it, and smooth joints are not mistaken for crossings.
Meeting meet_neighbours(const Segment& s, const Segment& t, double eps);

/// Moves the centre onto the bisector of the ends and takes the radius from it, after the ends were changed.
Segment refitted(Segment s);
/// Of an arc: whether it sweeps more than a half turn, as far as the ends tell.
bool more_than_half_turn(const Segment& s);
/// Middle of the arc or line; any sweep.
Point2 middle_of(const Segment& s);
/// Box without trigonometry.
Box2 quick_bounds(const Segment& s);

}  // namespace burin::geom::detail
