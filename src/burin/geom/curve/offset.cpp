// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/offset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "burin/geom/curve/arrangement.h"
#include "burin/geom/curve/offset_raw.h"

namespace burin::geom {
namespace {

using detail::ArrangementFailure;
using detail::ArrangementOptions;
using detail::ArrangementResult;
using detail::Boundary;
using detail::CleanContours;
using detail::RawCurves;

/// Points of the arrangement that are one, mm: far above the rounding of part coordinates, far below
/// point_mm.
constexpr double kMeetMm = 1e-9;
/// ... and never below this many units in the last place of the largest coordinate.
constexpr double kMeetUlps = 16;

/// One try at the arrangement. Configurations that contradict themselves within rounding (three boundaries
/// through one point, boundaries that run along each other at just the tolerance) are left behind by another
/// tolerance or by an offset that differs by far less than the guarantee of 1e-6 mm.
struct Attempt {
  double eps_factor;
  double d_shift_mm;
  bool connectors;  ///< let connectors take part as possible boundary
};
constexpr std::array<Attempt, 14> kAttempts{{{1, 0, false},
                                             {1, 0, true},
                                             {16, 0, true},
                                             {0.125, 0, true},
                                             {1, 3.1e-9, true},
                                             {1, -4.7e-9, true},
                                             {1, 2.3e-8, true},
                                             {1, -3.7e-8, true},
                                             {8, 7.9e-8, true},
                                             {8, -9.1e-8, true},
                                             {1, 1.7e-7, true},
                                             {1, -1.9e-7, true},
                                             {1, 3.7e-7, true},
                                             {1, -4.1e-7, true}}};

/// Joins neighbouring arcs of one circle and one source that cleaning or the corners had split.
void join_split_arcs(std::vector<Segment>& loop) {
  const auto same_circle = [](const Segment& s, const Segment& t) {
    return !s.is_line() && s.source == t.source && s.radius == t.radius && s.center == t.center;
  };
  // A circle stays two arcs.
  constexpr double kMost = 1.9 * kPi;
  std::size_t last = 0;
  for (std::size_t i = 1; i < loop.size(); ++i) {
    if (same_circle(loop[last], loop[i]) && i - last + 1 < loop.size() &&
        std::abs(sweep_of(loop[last])) + std::abs(sweep_of(loop[i])) < kMost) {
      loop[last].b = loop[i].b;
    } else {
      loop[++last] = loop[i];
    }
  }
  loop.resize(last + 1);
}

/// The other direction, with the same first segment.
void turn_round(std::vector<Segment>& loop) {
  std::reverse(loop.begin() + 1, loop.end());
  for (Segment& s : loop) s = reversed(s);
}

OffsetResult as_result(Boundary boundary, const std::vector<ArcSpline>& contours, bool reverse) {
  OffsetResult out;
  out.degenerate_places = boundary.degenerate_places;
  out.contours.reserve(boundary.loops.size());
  for (detail::BoundaryLoop& loop : boundary.loops) {
    join_split_arcs(loop.segments);
    if (reverse) turn_round(loop.segments);
    out.contours.push_back({std::move(loop.segments), true});
    out.from.push_back(loop.contour);
  }
  for (std::size_t i = 0; i < contours.size(); ++i) {
    if (!boundary.used[i]) out.vanished.push_back(static_cast<std::uint32_t>(i));
  }
  return out;
}

}  // namespace

Result<OffsetResult> offset_region(const std::vector<ArcSpline>& contours, double d_mm,
                                   const OffsetOptions& options) {
  if (!std::isfinite(d_mm) || std::abs(d_mm) > detail::kMaxCoordinate) {
    return Error{ErrorCode::usage, "the offset is not finite or too large (up to 1e7 mm)", {}};
  }
  if (!(options.point_mm > 0 && options.point_mm <= 1e-3)) {
    return Error{ErrorCode::usage, "point tolerance out of range (above 0, up to 1e-3 mm)", {}};
  }
  // Less than a point is no offset at all.
  const double d = std::abs(d_mm) < options.point_mm ? 0 : std::abs(d_mm);
  const bool shrink = d_mm < 0 && d > 0;
  Result<CleanContours> clean = detail::clean_contours(contours, options.point_mm, shrink);
  if (!clean) return clean.error();
  const double ulp = (clean->scale + d) * std::numeric_limits<double>::epsilon();
  const double eps = std::max(kMeetMm, kMeetUlps * ulp);
  for (const Attempt& attempt : kAttempts) {
    const double shift = std::min(std::abs(attempt.d_shift_mm), 0.25 * d);
    RawCurves raw = detail::raw_curves(*clean, d == 0 ? 0 : d + std::copysign(shift, attempt.d_shift_mm),
                                       options.point_mm);
    if (attempt.connectors) std::fill(raw.inside.begin(), raw.inside.end(), std::uint8_t{0});
    ArrangementOptions how;
    how.base = shrink ? 1 : 0;
    how.eps = eps * attempt.eps_factor;
    how.point_mm = options.point_mm;
    how.contours = contours.size();
    ArrangementResult result = detail::positive_boundary(raw, how);
    if (result.boundary) return as_result(std::move(*result.boundary), contours, shrink);
    if (result.failure == ArrangementFailure::too_many) {
      return Error{
          ErrorCode::range,
          "the offset boundaries cross each other too often (fewer segments within the offset of each other)",
          {}};
    }
  }
  return Error{
      ErrorCode::geometry, "no consistent offset found (contours that cross themselves or each other?)", {}};
}

}  // namespace burin::geom
