// SPDX-License-Identifier: Apache-2.0
// Internal to the fit: what fit.cpp asks of the two methods.
#pragma once

#include <optional>
#include <vector>

#include "burin/geom/curve/certificate.h"

namespace burin::geom::fit {

inline constexpr std::size_t kMaxSegments = 1'000'000;

struct FittedPiece {
  std::vector<Run> runs;
  Deviation deviation;
};

/// A point of the path with what the searches need of it.
struct Sample {
  Point2 p;
  Vec2 t;
  double tau = 0;
  double turn = 0;  ///< angle of t, continuous along the path, 0 at the start
};
/// Samples so dense that an arc spline within `tolerance` has at least about 16 of them on each arc.
std::vector<Sample> sample_path(const Path& path, double tolerance);

/// Largest distance of samples [first, last] from a biarc; gives up above `enough`.
double deviation_at_samples(const Biarc& biarc, const Sample* first, const Sample* last, double enough);
/// The biarc between the ends that comes closest to the samples; false when there is none.
bool best_biarc(Point2 a, Vec2 ta, Point2 b, Vec2 tb, const Sample* first, const Sample* last,
                double good_enough, Biarc& best, double& deviation);

/// One arc or line for the whole piece, its end tangents within `tangent_rad` of the path's; nothing if none
/// fits.
std::optional<FittedPiece> fit_single(const Target& target, double tangent_rad);
/// Fewest segments; nothing when the search fails (the caller falls back to bisection).
std::optional<FittedPiece> fit_minimal(const Target& target);
/// Park's bisection; nothing beyond kMaxSegments.
std::optional<FittedPiece> fit_bisect(const Target& target);

}  // namespace burin::geom::fit
