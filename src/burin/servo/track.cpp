// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/track.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "burin/base/text.h"
#include "burin/geom/gauss.h"
#include "burin/geom/point_tools.h"
#include "burin/servo/cursor.h"

namespace burin::servo {
namespace {

using geom::Point3;
using geom::QuinticNode;
using geom::Vec3;

/// Ends this close are one point (plan.h), and pieces that stay within it are dropped.
constexpr double kSamePoint = 1e-9;
/// A corner of angle theta is passed at v = share J T^2 / theta, or else stopped at. From rest that speed
/// takes 2 sqrt(v / J); below 10 periods it is not worth passing.
constexpr double kStopAngle = 0.02;
/// Pieces are halved until their parameter runs this evenly and they turn by no more than this, or are
/// shorter than the slowest step; so that x is nearly the arc length, and sharp bends stand alone.
constexpr double kEven = 1.25;
constexpr double kTurn = 0.5;
/// Turn of a part beyond which its end is nearer to what comes before than its middle: a hairpin.
constexpr double kBack = std::numbers::pi / 2;
constexpr int kMaxHalvings = 20;
/// Derivatives shorter than this, relative to the coefficients, have no direction left.
constexpr double kVanishing = 1e-7;

struct Derivatives {
  Vec3 d1, d2, d3;
};

Derivatives derivatives(const Piece& piece, double x) {
  Derivatives d;
  double* out[3][3] = {{&d.d1.x, &d.d2.x, &d.d3.x}, {&d.d1.y, &d.d2.y, &d.d3.y}, {&d.d1.z, &d.d2.z, &d.d3.z}};
  for (int k = 0; k < 3; ++k) {
    const double(&c)[6] = piece.c[k];
    *out[k][0] = (((5 * c[5] * x + 4 * c[4]) * x + 3 * c[3]) * x + 2 * c[2]) * x + c[1];
    *out[k][1] = ((20 * c[5] * x + 12 * c[4]) * x + 6 * c[3]) * x + 2 * c[2];
    *out[k][2] = (60 * c[5] * x + 24 * c[4]) * x + 6 * c[3];
  }
  return d;
}

Vec3 velocity(const Piece& piece, double x) {
  const auto slope = [x](const double(&c)[6]) {
    return (((5 * c[5] * x + 4 * c[4]) * x + 3 * c[3]) * x + 2 * c[2]) * x + c[1];
  };
  return {slope(piece.c[0]), slope(piece.c[1]), slope(piece.c[2])};
}

/// How far the piece can reach: sum of the coefficients' sizes.
double extent(const Piece& piece) {
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    for (int i = 1; i < 6; ++i) sum += std::abs(piece.c[k][i]);
  return sum;
}

bool acceptable(const QuinticNode& n) {
  const Vec3 p = n.p - Point3{};
  return std::isfinite(n.t) && is_finite(p) && is_finite(n.d1) && is_finite(n.d2) &&
         std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kMaxCoordinate;
}

/// u and v; a curve has one parameter only, its v is not a number.
bool acceptable_uv(const QuinticNode& n) {
  return std::isfinite(n.t) && std::isfinite(n.p.x) && std::isfinite(n.d1.x) && std::isfinite(n.d2.x) &&
         (std::isfinite(n.p.y) || std::isnan(n.p.y));
}

Error bad(std::size_t stretch, const std::string& what, ErrorCode code = ErrorCode::geometry) {
  return {code, "stretch " + std::to_string(stretch) + ": " + what, {}};
}

Result<void> check(const Stretch& stretch, std::size_t index) {
  const auto& nodes = stretch.path.nodes;
  if (nodes.size() < 2) return bad(index, "a path of fewer than two nodes (two or more)");
  if (!(stretch.feed_mm_min >= 0 && std::isfinite(stretch.feed_mm_min)))
    return bad(index,
               "a feed of " + format_shortest(stretch.feed_mm_min) + " (above 0 mm/min, or 0 for rapid)",
               ErrorCode::usage);
  const bool uv = !stretch.uv.nodes.empty();
  if (uv && stretch.uv.nodes.size() != nodes.size())
    return bad(index,
               "surface parameters of " + std::to_string(stretch.uv.nodes.size()) + " nodes on a path of " +
                   std::to_string(nodes.size()) + " (one for each)",
               ErrorCode::usage);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!acceptable(nodes[i]) || (uv && !acceptable_uv(stretch.uv.nodes[i])))
      return bad(index, "a number of node " + std::to_string(i) +
                            " is not finite or too large (coordinates within 1e7 mm)");
    if (i > 0 && !(nodes[i].t > nodes[i - 1].t))
      return bad(index, "the parameter does not increase at node " + std::to_string(i) + " (strictly)");
  }
  return {};
}

void set_coordinate(Piece& piece, int k, double h, double p0, double d0, double dd0, double p1, double d1,
                    double dd1) {
  const auto c = geom::quintic_coefficients(h, p0, d0, dd0, p1, d1, dd1);
  std::copy(c.begin(), c.end(), piece.c[k]);
}

/// From `from` (the end of what comes before, at most kSamePoint away from a.p) to b.
Piece make_piece(const Stretch& stretch, std::size_t i, Point3 from) {
  const QuinticNode &a = stretch.path.nodes[i], &b = stretch.path.nodes[i + 1];
  const double h = b.t - a.t;
  Piece piece;
  set_coordinate(piece, 0, h, from.x, a.d1.x, a.d2.x, b.p.x, b.d1.x, b.d2.x);
  set_coordinate(piece, 1, h, from.y, a.d1.y, a.d2.y, b.p.y, b.d1.y, b.d2.y);
  set_coordinate(piece, 2, h, from.z, a.d1.z, a.d2.z, b.p.z, b.d1.z, b.d2.z);
  piece.end[0] = b.p.x;
  piece.end[1] = b.p.y;
  piece.end[2] = b.p.z;
  piece.surface = stretch.surface;
  piece.pass = stretch.pass;
  piece.has_uv = !stretch.uv.nodes.empty();
  std::fill(&piece.c[3][0], &piece.c[3][0] + 12, 0.0);
  if (piece.has_uv) {
    const QuinticNode &u = stretch.uv.nodes[i], &w = stretch.uv.nodes[i + 1];
    set_coordinate(piece, 3, h, u.p.x, u.d1.x, u.d2.x, w.p.x, w.d1.x, w.d2.x);
    set_coordinate(piece, 4, h, u.p.y, u.d1.y, u.d2.y, w.p.y, w.d1.y, w.d2.y);
  }
  return piece;
}

/// Direction of the path at an end, also where the first derivatives vanish (then that of the first which
/// does not; at x = 1 the second points backwards). (0, 0, 0): none.
Vec3 direction(const Piece& piece, bool at_end) {
  const double tiny = kVanishing * extent(piece);
  const Derivatives d = derivatives(piece, at_end ? 1 : 0);
  if (geom::norm(d.d1) > tiny) return geom::unit(d.d1);
  if (geom::norm(d.d2) > tiny) return geom::unit(at_end ? -d.d2 : d.d2);
  return geom::norm(d.d3) > tiny ? geom::unit(d.d3) : Vec3{};
}

/// The part [x0, x1] of a piece as a piece.
Piece part_of(const Piece& piece, double x0, double x1) {
  Piece part = piece;
  const double w = x1 - x0;
  for (int k = 0; k < 5; ++k) {
    const double(&c)[6] = piece.c[k];
    double power = 1;
    for (int d = 0; d < 6; ++d, power *= w) {  // Taylor coefficients at x0
      double sum = 0;
      for (int i = 5; i >= d; --i) {
        double binomial = 1;
        for (int b = 0; b < d; ++b) binomial = binomial * (i - b) / (b + 1);
        sum = sum * x0 + binomial * c[i];
      }
      part.c[k][d] = sum * power;
    }
  }
  if (x1 < 1)
    for (int k = 0; k < 3; ++k) part.end[k] = horner(piece.c[k], x1);
  return part;
}

/// The angle between the directions at both ends, and how unevenly the parameter runs.
struct Shape {
  double turn = 0, uneven = 1;
};
Shape shape_of(const Piece& piece, double x0, double x1) {
  double low = 1e300, high = 0;
  Vec3 first, last;
  for (int i = 0; i <= 4; ++i) {
    const Vec3 d = velocity(piece, x0 + (x1 - x0) * i / 4);
    const double speed = geom::norm(d);
    low = std::min(low, speed);
    high = std::max(high, speed);
    if (i == 0) first = d;
    last = d;
  }
  return {std::atan2(geom::norm(geom::cross(first, last)), geom::dot(first, last)),
          low > 0 ? high / low : 1e300};
}

void append(Track& track, const Piece& piece, double x0, double x1, double length, double feed) {
  Piece part = x0 == 0 && x1 == 1 ? piece : part_of(piece, x0, x1);
  if (x0 > 0)
    for (int k = 0; k < 3; ++k) part.c[k][0] = track.pieces.back().end[k];
  part.length = length;
  track.pieces.push_back(part);
  track.feed.push_back(feed);
}

/// Where the path stops going the way it had at x0; it does not at x1.
double turning_point(const Piece& piece, double x0, double x1) {
  const Vec3 way = velocity(piece, x0);
  double lo = x0, hi = x1;
  for (;;) {
    const double mid = 0.5 * (lo + hi);
    if (!(mid > lo && mid < hi)) return hi;
    (geom::dot(velocity(piece, mid), way) > 0 ? lo : hi) = mid;
  }
}

/// A part shorter than the slowest step in which the path turns back: the stop is at the tip of the hairpin.
/// Behind it the distance from setpoints before decreases, and no chord would meet the end of the part.
void add_hairpin(Track& track, const Piece& piece, double x0, double x1, double length, double feed) {
  const double tip = turning_point(piece, x0, x1);
  const double before = arc_length(piece, x0, tip), after = arc_length(piece, tip, x1);
  if (before < kSamePoint) {
    if (!track.pieces.empty()) track.pieces.back().rest_after = true;
    return append(track, piece, x0, x1, length, feed);
  }
  if (after < kSamePoint) {
    append(track, piece, x0, x1, length, feed);
    track.pieces.back().rest_after = true;
    return;
  }
  append(track, piece, x0, tip, before, feed);
  track.pieces.back().rest_after = true;
  append(track, piece, tip, x1, after, feed);
}

/// Appends [x0, x1] of the piece, halved as far as needed.
void add_parts(Track& track, const Piece& piece, double x0, double x1, double feed, double shortest,
               int depth) {
  const Shape shape = shape_of(piece, x0, x1);
  const double length = arc_length(piece, x0, x1);
  const bool smooth = shape.uneven <= kEven && shape.turn <= kTurn;
  if (!smooth && length > shortest && depth < kMaxHalvings) {
    const double mid = 0.5 * (x0 + x1);
    add_parts(track, piece, x0, mid, feed, shortest, depth + 1);
    return add_parts(track, piece, mid, x1, feed, shortest, depth + 1);
  }
  if (shape.turn > kBack) return add_hairpin(track, piece, x0, x1, length, feed);
  append(track, piece, x0, x1, length, feed);
  track.pieces.back().rest_after = shape.turn > kTurn;  // a corner, or all but one
}

Result<void> add_stretch(Track& track, const Stretch& stretch, const Limits& limits) {
  const double feed = (stretch.feed_mm_min > 0 ? stretch.feed_mm_min : limits.rapid_mm_min) / 60;
  const double shortest = safe_speed(limits) * limits.period_s;
  for (std::size_t i = 0; i + 1 < stretch.path.nodes.size(); ++i) {
    Point3 from = track.start;
    if (!track.pieces.empty()) {
      const Piece& last = track.pieces.back();
      from = {last.end[0], last.end[1], last.end[2]};
    }
    Piece piece = make_piece(stretch, i, from);
    const double reach = extent(piece);
    if (!(reach <= 1e3 * kMaxCoordinate))
      return Error{
          ErrorCode::geometry,
          "derivatives at node " + std::to_string(i) + " carry the path out of range (within 1e7 mm)",
          {}};
    if (reach < kSamePoint) continue;
    add_parts(track, piece, 0, 1, feed, shortest, 0);
  }
  return {};
}

void cut_into_runs(Track& track) {
  const std::size_t n = track.pieces.size();
  double s = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < n; ++i) {
    track.pieces[i].start = s;
    s += track.pieces[i].length;
    Junction joint;
    joint.stop = i + 1 == n;
    if (i + 1 < n) joint = junction(track.pieces[i], track.pieces[i + 1]);
    joint.stop = joint.stop || track.pieces[i].rest_after;
    track.junctions.push_back(joint);
    track.pieces[i].rest_after = joint.stop;
    if (!joint.stop) continue;
    track.runs.push_back({first, i + 1, s});
    first = i + 1;
    s = 0;
  }
}

}  // namespace

double safe_speed(const Limits& l) {
  const double t = l.period_s;
  return 0.1 * std::min({l.jerk_mm_s3 * t * t, l.accel_mm_s2 * t, 5 * l.chord_error_mm / t});
}

ArcDerivatives arc_derivatives(const Piece& piece, double x) {
  Derivatives d = derivatives(piece, x);
  double speed = geom::norm(d.d1);
  const double tiny = kVanishing * extent(piece);
  for (double step = 1e-4; !(speed > tiny) && step < 0.5; step *= 4) {
    d = derivatives(piece, x < 0.5 ? x + step : x - step);
    speed = geom::norm(d.d1);
  }
  if (!(speed > 0)) return {};
  const double g = 1 / speed, rate = geom::dot(d.d1, d.d2) * g;
  const double rate2 = (geom::dot(d.d2, d.d2) + geom::dot(d.d1, d.d3) - rate * rate) * g;
  ArcDerivatives a;
  a.d1 = g * d.d1;
  a.d2 = (g * g) * (d.d2 - (rate * g) * d.d1);
  a.d3 = (g * g * g) * (d.d3 - (3 * rate * g) * d.d2 + (3 * rate * rate * g * g - rate2 * g) * d.d1);
  return a;
}

double arc_length(const Piece& piece, double x0, double x1) {
  return geom::gauss5([&piece](double x) { return geom::norm(velocity(piece, x)); }, x0, x1);
}

Junction junction(const Piece& before, const Piece& after) {
  Junction joint;
  const Vec3 in = direction(before, true), out = direction(after, false);
  const double angle = std::atan2(geom::norm(geom::cross(in, out)), geom::dot(in, out));
  const bool known = in != Vec3{} && out != Vec3{};
  joint.stop = !known || !(angle <= kStopAngle);
  if (joint.stop) return joint;
  const Vec3 turn = out - in, bend = arc_derivatives(after, 0).d2 - arc_derivatives(before, 1).d2;
  const double t[3] = {turn.x, turn.y, turn.z}, b[3] = {bend.x, bend.y, bend.z};
  for (int k = 0; k < 3; ++k) {
    joint.turn[k] = std::abs(t[k]);
    joint.bend[k] = std::abs(b[k]);
  }
  return joint;
}

Result<Track> make_track(const std::vector<Stretch>& stretches, const Limits& limits) {
  Track track;
  if (stretches.empty()) return track;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    if (auto fine = check(stretches[i], i); !fine) return fine.error();
    if (i == 0) continue;
    const double gap = geom::distance(stretches[i - 1].path.end(), stretches[i].path.start());
    if (gap > kSamePoint)
      return bad(i,
                 "starts " + format_shortest(gap) + " mm from the end of the one before (at most 1e-9 mm)");
  }
  track.start = stretches.front().path.start();
  for (std::size_t i = 0; i < stretches.size(); ++i)
    if (auto fine = add_stretch(track, stretches[i], limits); !fine) return bad(i, fine.error().message);
  cut_into_runs(track);
  return track;
}

}  // namespace burin::servo
