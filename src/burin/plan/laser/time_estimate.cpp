// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include "burin/plan/laser/toolpath.h"

namespace burin::laser {

using geom::Point3;
using geom::Vec3;

namespace {

/// The change of velocity at a corner may take this long, s.
constexpr double kCornerTime = 1e-3;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

struct Move {
  double length = 0;
  double speed = 0;  ///< highest, mm/s
  Vec3 first, last;  ///< directions at the ends
  bool stop_before = true;
};

/// Collects moves, and the times that are not motion.
struct Collector {
  const MotionLimits& limits;
  double feed;  ///< mm/s
  double waiting = 0;
  std::vector<Move> moves{};
  Point3 at{};
  bool known = false, stop = true, beam = false, rapid = false;

  void wait(double seconds) {
    if (std::isfinite(seconds) && seconds > 0) waiting += seconds;
    stop = true;
  }
  void add(Move move, bool is_rapid, Point3 to) {
    at = to;
    known = true;
    if (!(move.length > 0) || !std::isfinite(move.length)) return;
    move.stop_before = stop || is_rapid != rapid;
    stop = false;
    rapid = is_rapid;
    moves.push_back(move);
  }
  void straight(Point3 to, double speed, bool is_rapid) {
    if (!known) {  // where the machine stands before the first move is not known
      at = to;
      known = true;
      return;
    }
    const Vec3 u = geom::unit(to - at);
    add({geom::norm(to - at), speed, u, u, true}, is_rapid, to);
  }
  void arc(const cl::Arc& arc);
};

void Collector::arc(const cl::Arc& arc) {
  if (!known) return straight(arc.to.tip, feed, false);
  const Vec3 n = geom::unit(arc.normal);
  const Vec3 from = at - arc.center, to = arc.to.tip - arc.center;
  const double rise = geom::dot(arc.to.tip - at, n);
  double sweep = std::atan2(geom::dot(n, geom::cross(from, to)),
                            geom::dot(from, to) - geom::dot(from, n) * geom::dot(to, n));
  // Two ends that are one point mean a full turn; anything else less.
  const bool full = geom::norm((to - from) - rise * n) <= 1e-9 * (1 + arc.radius);
  if (full) {
    sweep = 2 * geom::kPi;
  } else if (sweep <= 0) {
    sweep += 2 * geom::kPi;
  }
  const double round = arc.radius * sweep;
  const double length = std::hypot(round, rise);
  if (!(length > 0)) return straight(arc.to.tip, feed, false);
  const auto direction = [&](Vec3 r) {
    return geom::unit((round / length) * geom::unit(geom::cross(n, r)) + (rise / length) * n);
  };
  // v^2 / r <= a, v seen in the plane of the circle.
  const double centripetal =
      std::sqrt(limits.acceleration_mm_s2 * arc.radius) * length / std::max(round, 1e-300);
  add({length, std::min(feed, centripetal), direction(from), direction(to), true}, false, arc.to.tip);
}

Collector collect(const cl::Program& program, const MotionLimits& limits, double feed_mm_min) {
  Collector c{limits, feed_mm_min / 60};
  if (program.from) {
    c.at = program.from->tip;
    c.known = true;
  }
  for (const cl::Record& record : program.records) {
    if (const auto* rapid = std::get_if<cl::Rapid>(&record)) {
      c.straight(rapid->to.tip, limits.rapid_mm_min / 60, true);
    } else if (const auto* line = std::get_if<cl::Feed>(&record)) {
      c.straight(line->to.tip, c.feed, false);
    } else if (const auto* arc = std::get_if<cl::Arc>(&record)) {
      c.arc(*arc);
    } else if (const auto* feed = std::get_if<cl::FeedRate>(&record)) {
      if (feed->mm_min > 0) c.feed = feed->mm_min / 60;
    } else if (const auto* dwell = std::get_if<cl::Dwell>(&record)) {
      c.wait(dwell->seconds);
    } else if (const auto* beam = std::get_if<cl::Beam>(&record)) {
      if (beam->on && !c.beam) c.wait(limits.pierce_s);
      if (!beam->on) c.stop = true;
      c.beam = beam->on;
    }
  }
  return c;
}

/// Highest speed between two moves: |v2 - v1| = 2 v sin(a / 2) <= acceleration * kCornerTime.
double junction_speed(const Move& a, const Move& b, double acceleration) {
  if (b.stop_before) return 0;
  const double change = geom::norm(b.first - a.last);  // 2 sin(a / 2)
  const double corner = change > 0 ? acceleration * kCornerTime / change : kUnlimited;
  return std::min({a.speed, b.speed, corner});
}

/// Rise from v0, hold, fall to v1 within the length.
double move_time(const Move& m, double v0, double v1, double a) {
  if (!std::isfinite(a)) return m.length / m.speed;
  const double peak = std::min(m.speed, std::sqrt(a * m.length + (v0 * v0 + v1 * v1) / 2));
  const double ramps = (2 * peak * peak - v0 * v0 - v1 * v1) / (2 * a);
  return (2 * peak - v0 - v1) / a + std::max(0.0, m.length - ramps) / peak;
}

}  // namespace

double estimate_time(const cl::Program& program, const MotionLimits& limits, double feed_mm_min) {
  MotionLimits used = limits;
  // Values that make no sense limit nothing.
  if (!(used.acceleration_mm_s2 > 0)) used.acceleration_mm_s2 = kUnlimited;
  if (!(used.rapid_mm_min > 0)) used.rapid_mm_min = kUnlimited;
  if (!(feed_mm_min > 0)) feed_mm_min = kUnlimited;
  const Collector c = collect(program, used, feed_mm_min);
  const double a = used.acceleration_mm_s2;
  const std::size_t n = c.moves.size();
  // Speed before every move, lowered so that it can be reached from the one before and braked to the one
  // after.
  std::vector<double> speed(n + 1, 0);
  for (std::size_t i = 1; i < n; ++i) speed[i] = junction_speed(c.moves[i - 1], c.moves[i], a);
  for (std::size_t i = n; i-- > 0;) {
    speed[i] = std::min(speed[i], std::sqrt(speed[i + 1] * speed[i + 1] + 2 * a * c.moves[i].length));
  }
  double time = c.waiting;
  for (std::size_t i = 0; i < n; ++i) {
    speed[i + 1] = std::min(speed[i + 1], std::sqrt(speed[i] * speed[i] + 2 * a * c.moves[i].length));
    time += move_time(c.moves[i], speed[i], speed[i + 1], a);
  }
  return time;
}

}  // namespace burin::laser
