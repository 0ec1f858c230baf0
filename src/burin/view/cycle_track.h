// SPDX-License-Identifier: Apache-2.0
// The tool's way through a surface program, thinned out for a picture. mm, s, mm/min, mm/s2.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "burin/view/cycle_html.h"

namespace burin::view {

enum class TrackKind : std::uint8_t {
  rapid,
  plunge,
  cut,
  link,
  program,  ///< moves of the program outside the groups
  curve,    ///< G06.2
};

/// What a stretch of the way is. Indices are -1 where there is none; surface and pass count inside the group.
struct TrackLabel {
  TrackKind kind = TrackKind::program;
  int group = -1, surface = -1, pass = -1;
  double lift_max = 0;
  bool operator==(const TrackLabel&) const = default;
};

/// One sample of the way before thinning: a setpoint, or a point of a motion when there are no setpoints.
struct TrackSample {
  geom::Point3 p;
  double feed = 0;
  double u = 0, v = 0;
};

struct TrackPoint {
  std::uint32_t index = 0;  ///< of the sample; times Track::step the time (or the length, without setpoints)
  geom::Point3 p;
  double feed = 0, tangential = 0, axis = 0;  ///< tip speed, its change, largest acceleration of an axis
  double lift = 0;                            ///< above where the surface alone would have the tip
  /// Of the surface towards the tool; up where none is known. The ball touches at p + R (k - normal).
  geom::Vec3 normal{0, 0, 1};
};

/// Points `first` .. end of the next run; the segment that ends in a point is of the point's run.
struct TrackRun {
  std::size_t first = 0;
  TrackLabel label;
  int row = -1;  ///< in Track::rows
};

/// Figures of one path, or of several when there are too many for the page.
struct PassRow {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  int group = -1, surface = -1, pass = -1, pass_last = -1;
  std::uint32_t first = 0, last = 0;  ///< samples
  double length = 0, seconds = 0;
  double feed_min = kNone, feed_mean = kNone, feed_max = kNone, axis_max = kNone;
  double scallop_min = kNone, scallop_max = kNone, side_step = kNone, lift = 0;
  bool last_pass = false, side_step_binds = false;
};

struct Track {
  bool timed = false;
  double step = 1;  ///< s; without setpoints mm
  std::size_t samples = 0;
  std::vector<TrackPoint> points;
  std::vector<TrackRun> runs;
  std::vector<PassRow> rows;
  /// Within these of the samples, linear in the sample's number between points.
  double position_mm = 0, feed_mm_min = 0, accel_mm_s2 = 0;
  double feed_max = 0, axis_max = 0, tangential_max = 0, lift_max = 0;
};

struct TrackLimits {
  std::size_t most_points = 80'000;
  std::size_t most_rows = 10'000;
};

Track make_track(const CyclePicture& picture, const TrackLimits& limits = {});

}  // namespace burin::view
