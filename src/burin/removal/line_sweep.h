// SPDX-License-Identifier: Apache-2.0
// The part of a line that a moving convex piece of a tool covers: closed forms of the envelope, no steps of
// time. Internal to removal. mm, radians. docs/removal.md
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "burin/geom/vec.h"
#include "burin/verify/mill_body.h"
#include "burin/verify/mill_motion.h"

namespace burin::removal {

/// A short piece of motion about its middle, times from -1/2 to 1/2: tip + t way, axis turned by t turn.
struct Motion {
  geom::Point3 tip;
  geom::Vec3 axis, way, turn;
  bool turns = false;

  /// The part from time `from` to `to` (0 to 1) of a stretch.
  static Motion part(const verify::Stretch& stretch, double from, double to);
  /// How many parts a stretch needs so that places up to `span` from the tip leave the straight way that
  /// line() takes them to go by at most `tolerance`.
  static int parts(const verify::Stretch& stretch, double span, double tolerance);
};

/// What it covers of a line, from a to b along it.
struct Covered {
  double a = std::numeric_limits<double>::infinity(), b = -std::numeric_limits<double>::infinity();
  double time_a = 0, time_b = 0;  ///< when each end is covered

  bool empty() const { return !(a < b); }
  void add(double h, double time) {
    if (h < a) a = h, time_a = time;
    if (h > b) b = h, time_b = time;
  }
};

/// One piece of a tool, one motion, no place farther than `reach` from the tip of interest, lines along the
/// coordinate axis `along`; a line is named by its places on the next axes u and v.
class LineSweep {
 public:
  LineSweep(const verify::MillBody& body, const Motion& motion, std::size_t along, double tolerance,
            double reach);
  LineSweep(const LineSweep&) = delete;
  LineSweep& operator=(const LineSweep&) = delete;

  /// A little more than line() would find, or nothing when it finds nothing: quickly.
  struct Bounds {
    double a = 0, b = -1;
  };
  Bounds around(double u, double v) const;

  /// Exact for a constant axis but at the rounded edge of a bull nose (there within the tolerance); ends of
  /// a turning one are those of a tool displaced by at most the tolerance.
  Covered line(double u, double v);
  /// Outwards from the tool at the ends of what line() found last.
  geom::Vec3 normal_a(const Covered& covered) const { return normal(*frame_a_, covered.a, covered.time_a); }
  geom::Vec3 normal_b(const Covered& covered) const { return normal(*frame_b_, covered.b, covered.time_b); }

 private:
  /// The axes of the tool with the first along the part of the way across its axis, and the line's direction
  /// (e) and the way in them. The way has no second component.
  struct Frame {
    geom::Vec3 first, second, axis;
    double e1 = 0, e2 = 0, e3 = 0, w1 = 0, w3 = 0;
    double way = 0;  ///< length of the way
  };
  struct Place {
    double x = 0, y = 0, z = 0;
  };
  Frame frame(geom::Vec3 way) const;
  Place place(const Frame& f, double du, double dv) const;
  Covered solve(const Frame& f, double du, double dv) const;
  Covered turning(double du, double dv);
  static void cylinder(const Frame& f, const Place& p, double radius, double low, double high, Covered& out);
  static void moment(const Frame& f, const Place& p, double time, double radius, double low, double high,
                     Covered& out);
  static void slab_edge(const Frame& f, const Place& p, double radius, double height, Covered& out);
  static void sphere(const Frame& f, const Place& p, double radius, double height, Covered& out);
  void rounded_edge(const Frame& f, const Place& p, Covered& out) const;
  double nearest_to_disc(const Frame& f, const Place& p, double h, double& time, double& slope) const;
  geom::Vec3 normal(const Frame& f, double h, double time) const;
  geom::Vec3 rim_normal(const Frame& f, const Place& at, double up) const;

  verify::MillBody body_;
  Motion motion_;
  std::size_t along_, u_, v_;
  double tolerance_;
  geom::Vec3 along_turn_;  ///< turn x direction of the line: how the way changes along it
  /// The piece about its middle, grown by half of what its places move: for around().
  struct Grown {
    double radius2 = 0, low = 0, high = 0, center = 0, per_e = 0, per_e3 = 0;
    bool ball = false;
  } grown_;
  double tip_u_ = 0, tip_v_ = 0, tip_h_ = 0;
  double du_ = 0, dv_ = 0;  ///< of the line looked at last
  Frame straight_, turned_, turned_a_, turned_b_;
  const Frame *frame_a_ = &straight_, *frame_b_ = &straight_;
};

}  // namespace burin::removal
