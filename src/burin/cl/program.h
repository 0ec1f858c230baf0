// SPDX-License-Identifier: Apache-2.0
// The hub: one tool-path type for all operations. Planners write it; posts, servo, verification and pictures
// read it; nothing here knows a surface or a G-code dialect. mm, mm/min, s, W; axes are unit vectors from the
// tip to the holder, part frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/vec.h"

namespace burin::cl {

/// Tool reference point and axis.
struct Pose {
  geom::Point3 tip;
  geom::Vec3 axis{0, 0, 1};
  bool operator==(const Pose&) const = default;
};

// --- motion: what counts as a move (GOTO), numbered from 0
// ---------------------------------------------------

/// To `to` as fast as the machine can; the way between is the machine's.
struct Rapid {
  Pose to;
  bool operator==(const Rapid&) const = default;
};
/// Tip straight to `to` at the feed, axis turning evenly along the great circle.
struct Feed {
  Pose to;
  bool operator==(const Feed&) const = default;
};
/// Tip along a circle about `center`, counter-clockwise seen against `normal` (right-handed), to `to`;
/// `radius` > 0. A component of the travel along `normal` makes a helix. Less than or exactly one full turn
/// (start == end, seen along `normal`, within kSamePoint_mm).
struct Arc {
  geom::Point3 center;
  geom::Vec3 normal{0, 0, 1};
  double radius = 0;
  Pose to;
  bool operator==(const Arc&) const = default;
};

// --- state
// ----------------------------------------------------------------------------------------------------

struct FeedRate {
  double mm_min = 0;
  bool operator==(const FeedRate&) const = default;
};
enum class Rotation { off, clockwise, counter_clockwise };
struct Spindle {
  Rotation rotation = Rotation::off;
  double rpm = 0;
  bool operator==(const Spindle&) const = default;
};
/// Laser, plasma or water jet. `power_w` is the power while on (0 when off).
struct Beam {
  bool on = false;
  double power_w = 0;
  bool operator==(const Beam&) const = default;
};
struct Dwell {
  double seconds = 0;
  bool operator==(const Dwell&) const = default;
};
/// Loads tool `number`; diameter and corner radius as in CUTTER/d,r (0 when unknown).
struct ToolChange {
  int number = 0;
  double diameter = 0;
  double corner_radius = 0;
  bool operator==(const ToolChange&) const = default;
};
struct Coolant {
  bool on = false;
  bool operator==(const Coolant&) const = default;
};
struct Comment {
  std::string text;  ///< one line
  bool operator==(const Comment&) const = default;
};
/// A statement of another system that burin does not know: kept as it stood.
struct Unknown {
  std::string text;
  bool operator==(const Unknown&) const = default;
};

using Record =
    std::variant<Rapid, Feed, Arc, FeedRate, Spindle, Beam, Dwell, ToolChange, Coolant, Comment, Unknown>;

bool is_motion(const Record& record);
/// The pose a motion record ends in, nullptr for state records.
const Pose* pose_of(const Record& record);

/// Records in order. `source[i]` says where record i came from: an index the producer defines (contour, line
/// of an NC program, entity); kNoSource when it has none. Parallel to `records`.
struct Program {
  static constexpr std::uint32_t kNoSource = 0xffffffffu;

  std::string name;  ///< PARTNO
  /// FROM/: where the tool stands before the first move, when that is known. No move itself.
  std::optional<Pose> from;
  std::vector<Record> records;
  std::vector<std::uint32_t> source;

  void add(Record record, std::uint32_t record_source = kNoSource) {
    records.push_back(std::move(record));
    source.push_back(record_source);
  }
  std::size_t move_count() const;
};

/// Start and end of an arc this close (seen along its normal) mean a full turn: the default of
/// Tolerance::point_mm.
inline constexpr double kSamePoint_mm = 1e-7;
/// The angle an arc turns that begins at `start`: in (0, 2 pi].
double arc_sweep(const geom::Point3& start, const Arc& arc);
/// Length of the tip's way along an arc that begins at `start`, the rise of a helix included, mm.
double arc_length(const geom::Point3& start, const Arc& arc);

/// Checks every record: finite numbers, unit axes (1e-6), arcs whose start and end lie at `radius` from the
/// centre and in a plane normal to `normal` (within `tolerance_mm`), positive feed before the first feed
/// move, dwell >= 0, text of one line. The error (geometry or range) names the record and, for motion, the
/// move number.
Result<void> validate(const Program& program, double tolerance_mm = 1e-4);

struct Totals {
  double feed_mm = 0;  ///< length of feed and arc moves
  double rapid_mm = 0;
  double dwell_s = 0;
  std::size_t moves = 0;
};
Totals totals(const Program& program);

}  // namespace burin::cl
