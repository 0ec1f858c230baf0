// SPDX-License-Identifier: Apache-2.0
// SVG path data -> curves, in the coordinates of the data (y as written). SVG 1.1 chapter 8, appendix F.6 for
// arcs.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "burin/base/result.h"
#include "burin/io/drawing/drawing.h"

namespace burin::io::svg {

/// The subpaths of one element.
struct Outline {
  std::vector<Path> paths;
  int points_dropped = 0;  ///< subpaths that are a single point
};

/// Collects connected curves. Pieces of exactly zero length are left out; Z adds the closing line when the
/// end differs from the start by more than the rounding of relative coordinates.
class OutlineBuilder {
 public:
  void move_to(geom::Point2 p);
  void line_to(geom::Point2 p);
  void quadratic_to(geom::Point2 c, geom::Point2 p);
  void cubic_to(geom::Point2 c1, geom::Point2 c2, geom::Point2 p);
  void arc_to(double rx, double ry, double rotation_deg, bool large, bool sweep, geom::Point2 p);
  void close();
  /// Where the next piece starts.
  geom::Point2 current() const { return current_; }
  std::size_t curve_count() const { return curve_count_; }
  Outline finish();

 private:
  void begin_if_needed();
  void add(geom::Curve2 curve, geom::Point2 end);
  void flush(bool closed);
  void note(geom::Point2 p);
  double closing_rounding() const;
  void snap_end_to_start();

  Outline outline_;
  std::vector<geom::Curve2> curves_;
  std::size_t curve_count_ = 0;
  geom::Point2 start_, current_;
  bool pending_ = false;   // a subpath has been started and not flushed
  double magnitude_ = 0;   // largest coordinate of the subpath
  std::size_t steps_ = 0;  // commands of the subpath
};

/// The arc from `from` to `to` by the end-point parametrization: radii too small are enlarged, a zero radius
/// gives the line. A circular arc is an Arc2. Precondition: from != to.
geom::Curve2 arc_between(geom::Point2 from, geom::Point2 to, double rx, double ry, double rotation_deg,
                         bool large, bool sweep);

/// All commands M L H V C S Q T A Z, absolute and relative, with implicit repeats. Errors: syntax (the
/// message has the character position, from 1), range (more than `max_curves`).
Result<Outline> parse_path_data(std::string_view data, std::size_t max_curves);

}  // namespace burin::io::svg
