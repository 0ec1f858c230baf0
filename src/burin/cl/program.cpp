// SPDX-License-Identifier: Apache-2.0
#include "burin/cl/program.h"

#include <cmath>
#include <optional>
#include <string>

#include "burin/base/text.h"
#include "burin/geom/point_tools.h"

namespace burin::cl {
namespace {

using geom::Point3;
using geom::Vec3;

// Axes and normals may come from files with six or seven decimals.
constexpr double kUnitTolerance = 1e-6;

/// The part of `v` in the plane normal to the unit vector `n`.
Vec3 in_plane(Vec3 v, Vec3 n) {
  return v - dot(v, n) * n;
}

struct Checker {
  double tolerance;
  std::optional<Pose> at;
  bool feed_set = false;
  std::size_t index = 0;
  std::size_t move = 0;

  Error error(ErrorCode code, const std::string& what, bool motion = false) const {
    std::string place = "record " + std::to_string(index);
    if (motion) place += ", move " + std::to_string(move);
    return Error{code, place + ": " + what, {}};
  }

  Result<void> axis(Vec3 v, const char* name) const {
    if (!is_finite(v) || std::abs(norm(v) - 1) > kUnitTolerance)
      return error(ErrorCode::range,
                   std::string(name) + " of length " + format_shortest(norm(v)) + " (a unit vector)", true);
    return {};
  }

  Result<void> pose(const Pose& p) const {
    if (!is_finite(p.tip))
      return error(ErrorCode::range, "a coordinate is not finite (finite numbers)", true);
    return axis(p.axis, "tool axis");
  }

  Result<void> feed_known() const {
    if (!feed_set)
      return error(ErrorCode::range, "feed move without a feed (a FeedRate before the first feed move)",
                   true);
    return {};
  }

  Result<void> motion(const Rapid& r) const { return pose(r.to); }

  Result<void> motion(const Feed& f) const {
    if (auto ok = pose(f.to); !ok) return ok;
    return feed_known();
  }

  Result<void> motion(const Arc& a) const {
    if (auto ok = pose(a.to); !ok) return ok;
    if (auto ok = axis(a.normal, "arc normal"); !ok) return ok;
    if (!is_finite(a.center) || !std::isfinite(a.radius) || a.radius <= 0)
      return error(ErrorCode::range,
                   "arc with a radius of " + format_shortest(a.radius) +
                       " or a centre that is not finite (a radius above 0)",
                   true);
    if (!at)
      return error(ErrorCode::geometry, "an arc whose start is not known (a move, or FROM, before it)", true);
    const Vec3 start = at->tip - a.center, end = a.to.tip - a.center;
    const double off_start = std::abs(norm(in_plane(start, a.normal)) - a.radius);
    const double off_end = std::abs(norm(in_plane(end, a.normal)) - a.radius);
    if (!(off_start <= tolerance && off_end <= tolerance))
      return error(ErrorCode::geometry,
                   "arc ends lie " + format_fixed(off_start, 6) + " and " + format_fixed(off_end, 6) +
                       " mm off the circle (at most " + format_shortest(tolerance) + ")",
                   true);
    // The centre of a helix may be given at the height of either end.
    const double height = std::min(std::abs(dot(start, a.normal)), std::abs(dot(end, a.normal)));
    if (!(height <= tolerance))
      return error(ErrorCode::geometry,
                   "arc centre lies " + format_fixed(height, 6) +
                       " mm outside the plane of the arc (at most " + format_shortest(tolerance) + ")",
                   true);
    return feed_known();
  }

  Result<void> state(const FeedRate& f) {
    if (!std::isfinite(f.mm_min) || f.mm_min <= 0)
      return error(ErrorCode::range, "feed of " + format_shortest(f.mm_min) + " mm/min (above 0)");
    feed_set = true;
    return {};
  }
  Result<void> non_negative(double value, const char* name) const {
    if (!std::isfinite(value) || value < 0)
      return error(ErrorCode::range, std::string(name) + " of " + format_shortest(value) + " (0 or more)");
    return {};
  }
  Result<void> state(const Spindle& s) const { return non_negative(s.rpm, "spindle speed"); }
  Result<void> state(const Beam& b) const { return non_negative(b.power_w, "beam power"); }
  Result<void> state(const Dwell& d) const { return non_negative(d.seconds, "dwell"); }
  Result<void> state(const ToolChange& t) const {
    if (t.number < 0)
      return error(ErrorCode::range, "tool number " + std::to_string(t.number) + " (0 or more)");
    if (auto ok = non_negative(t.diameter, "tool diameter"); !ok) return ok;
    return non_negative(t.corner_radius, "corner radius");
  }
  Result<void> state(const Coolant&) const { return {}; }
  Result<void> one_line(const std::string& text) const {
    if (text.find_first_of("\n\r") != std::string::npos || text.find('\0') != std::string::npos)
      return error(ErrorCode::range, "text of more than one line (one line)");
    return {};
  }
  Result<void> state(const Comment& c) const { return one_line(c.text); }
  Result<void> state(const Unknown& u) const { return one_line(u.text); }

  template <class T>
  Result<void> operator()(const T& record) {
    if constexpr (std::is_same_v<T, Rapid> || std::is_same_v<T, Feed> || std::is_same_v<T, Arc>) {
      if (auto ok = motion(record); !ok) return ok;
      at = record.to;
      ++move;
      return {};
    } else {
      return state(record);
    }
  }
};

}  // namespace

bool is_motion(const Record& record) {
  return pose_of(record) != nullptr;
}

const Pose* pose_of(const Record& record) {
  if (const auto* rapid = std::get_if<Rapid>(&record)) return &rapid->to;
  if (const auto* feed = std::get_if<Feed>(&record)) return &feed->to;
  if (const auto* arc = std::get_if<Arc>(&record)) return &arc->to;
  return nullptr;
}

std::size_t Program::move_count() const {
  std::size_t count = 0;
  for (const Record& record : records) count += is_motion(record) ? 1 : 0;
  return count;
}

double arc_sweep(const Point3& start, const Arc& arc) {
  const Vec3 a = in_plane(start - arc.center, arc.normal);
  const Vec3 b = in_plane(arc.to.tip - arc.center, arc.normal);
  if (norm(b - a) <= kSamePoint_mm) return 2 * geom::kPi;
  const double angle = std::atan2(dot(cross(a, b), arc.normal), dot(a, b));
  return angle > 0 ? angle : angle + 2 * geom::kPi;
}

double arc_length(const Point3& start, const Arc& arc) {
  return std::hypot(arc.radius * arc_sweep(start, arc), dot(arc.to.tip - start, arc.normal));
}

Result<void> validate(const Program& program, double tolerance_mm) {
  if (program.source.size() != program.records.size())
    return Error{ErrorCode::internal,
                 "the program has " + std::to_string(program.records.size()) + " records and " +
                     std::to_string(program.source.size()) + " sources (one for each)",
                 {}};
  Checker checker{tolerance_mm, program.from};
  if (program.from) {
    if (auto ok = checker.pose(*program.from); !ok) return ok;
  }
  if (auto ok = checker.one_line(program.name); !ok) return ok;
  for (const Record& record : program.records) {
    if (auto ok = std::visit(checker, record); !ok) return ok;
    ++checker.index;
  }
  return {};
}

Totals totals(const Program& program) {
  Totals sum;
  std::optional<Point3> at;
  if (program.from) at = program.from->tip;
  for (const Record& record : program.records) {
    if (const auto* dwell = std::get_if<Dwell>(&record)) sum.dwell_s += dwell->seconds;
    const Pose* pose = pose_of(record);
    if (!pose) continue;
    ++sum.moves;
    if (at) {
      const auto* arc = std::get_if<Arc>(&record);
      const double length = arc ? arc_length(*at, *arc) : distance(*at, pose->tip);
      (std::holds_alternative<Rapid>(record) ? sum.rapid_mm : sum.feed_mm) += length;
    }
    at = pose->tip;
  }
  return sum;
}

}  // namespace burin::cl
