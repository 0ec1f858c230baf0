// SPDX-License-Identifier: Apache-2.0
// Where the paths lie on a sheet: constant parameter (I1) or constant scallop (I2).
#pragma once

#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/surface/nurbs.h"
#include "burin/plan/cycle/scallop.h"

namespace burin::cycle {

/// The rectangle of parameters to be covered and what is allowed.
struct PassTask {
  geom::Interval t, w;
  /// What of t is machined; I2 plans on the rest as well, to run over edges that it meets at a slant.
  geom::Interval inner_t;
  /// Borders of I2 that are not constant w: between them and w the ball does not fit a valley. On all of t.
  std::optional<Graph> border_lo, border_hi;
  double scallop = 0;
  std::optional<double> side_step;
  double tight_step = 0;  ///< largest side step where the ball does not fit: that of a plane
  double path_mm = 1e-6;
  std::size_t max_paths = 0;
  /// Longer plans are given up: another one that is shorter is at hand.
  double most_length = std::numeric_limits<double>::infinity();
};

struct PairFigures {
  double scallop_min = 0, scallop_max = 0, side_step_max = 0;
  bool last = false, side_step_binds = false;
};

struct Passes {
  std::deque<Pass> passes;         ///< a deque: Before points into it
  std::vector<PairFigures> pairs;  ///< pairs[i]: between passes i and i + 1
  double length = 0;               ///< of the passes so far, by their chords: not too long
  bool given_up = false;           ///< `length` is above most_length; the rest was not planned
};

Result<Passes> iso_parametric(const Sheet& sheet, const PassTask& task);
Result<Passes> iso_scallop(const Sheet& sheet, const PassTask& task);
/// The same on a surface with creases along the paths: each crease is a border of what lies on either side.
/// `surface`: that of the sheet.
Result<Passes> iso_scallop_between_creases(const geom::NurbsSurface& surface, const Sheet& sheet,
                                           const PassTask& task);

/// Decides how far the paths of a sheet that goes on beyond its edges run over them.
void run_over_edges(const Sheet& sheet, const PassTask& task, Passes& passes);

/// A ball at (t, w) cuts into the other flank of a crease across the paths.
bool in_valley(const Sheet& sheet, double t, double w);
/// Pass::fitting.
std::vector<Pass::Section> between_valleys(const Sheet& sheet, const Pass& pass);

// What both share.

/// Total of quintic nodes that one plan may hold (about 1 GB).
inline constexpr std::size_t kMaxNodes = 6'000'000;

/// Parameters t at which paths are compared: every knot span at least thrice (long knot
/// vectors: every knot), about `count` in all.
std::vector<double> samples_along(const Sheet& sheet, geom::Interval t, int count);
/// The border w = const is a single point.
bool collapsed(const Sheet& sheet, geom::Interval t, double w);
/// How much of the limits a cusp uses: 1 = a limit is reached; linear in the step to first order.
double use_of_limits(const PassTask& task, const Cusp& c);
/// A first guess of the step in w at t: flat surface, cut by a cusp of height S.
double first_step(const Sheet& sheet, const PassTask& task, double t, double w);
Pass constant_pass(const Sheet& sheet, const PassTask& task, double w);
/// Counts a pass that is finished; true when the plan is given up with it.
bool too_long(const PassTask& task, Passes& passes, const Pass& pass);
Error too_many_paths(const PassTask& task);
Error too_many_nodes();

}  // namespace burin::cycle
