// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/patterns.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

#include "burin/base/text.h"

namespace burin::rotary {

namespace detail {

double flat_step(double ball_radius, double scallop) {
  return 2 * std::sqrt(scallop * (2 * ball_radius - scallop));
}

Error too_many(const PatternOptions& options, double paths, double points_a_path) {
  const double by_paths = paths / double(options.max_paths);
  const double by_points = paths * points_a_path / double(options.max_points);
  const double factor = 1.02 * std::max({by_paths, by_points, 1.0});
  std::string message = "the pattern would take " + format_fixed(paths, 0) + " paths of about " +
                        format_fixed(points_a_path, 0) + " points (" + std::to_string(options.max_paths) +
                        " paths and " + std::to_string(options.max_points) + " points are allowed: ";
  if (options.side_step) {
    message += "a side step of " + format_fixed(*options.side_step * factor, 4) + " mm would do)";
  } else {
    // Cusps go as the square of the side step.
    message += "a scallop of " + format_fixed(options.scallop * factor * factor, 6) + " mm would do)";
  }
  return {ErrorCode::range, std::move(message), {}};
}

namespace {

std::optional<Error> check(const Part& part, const PatternOptions& o) {
  const auto usage = [](std::string message) { return Error{ErrorCode::usage, std::move(message), {}}; };
  if (!(o.ball_radius > 0) || !std::isfinite(o.ball_radius))
    return usage("the ball's radius must be above 0 mm");
  if (o.side_step && !(*o.side_step > 0 && std::isfinite(*o.side_step))) {
    return usage("the side step must be above 0 mm");
  }
  if (!o.side_step && !(o.scallop > 0 && o.scallop <= 0.5 * o.ball_radius)) {
    return usage("a scallop of " + format_shortest(o.scallop) +
                 " mm is not possible (above 0, at most half of the ball's radius)");
  }
  if (!(o.density_mm > 0) || !std::isfinite(o.density_mm)) return usage("the density must be above 0 mm");
  if (!(part.x_max > part.x_min) || !std::isfinite(part.x_min) || !std::isfinite(part.x_max)) {
    return Error{ErrorCode::geometry, "the part has no length along X", {}};
  }
  return std::nullopt;
}

}  // namespace
}  // namespace detail

Result<PatternResult> make_paths(const Part& part, const PatternOptions& options,
                                 Diagnostics& diagnostics) try {
  if (auto error = detail::check(part, options)) return *error;
  if (part.swept) return detail::swept_paths(*part.swept, options);
  return detail::meshed_paths(part, options, diagnostics);
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::range, "the contact paths do not fit into memory (use a larger scallop)", {}};
} catch (const std::length_error&) {
  return Error{ErrorCode::range, "the contact paths do not fit into memory (use a larger scallop)", {}};
}

}  // namespace burin::rotary
