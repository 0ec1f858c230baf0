// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/corners.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace burin::laser::detail {

using geom::ArcSpline;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

namespace {

/// Sizes of loops tried: the one asked for, and halved so often.
constexpr int kLoopHalvings = 2;
/// A corner that turns by nearly half a turn has its loop far away: beyond this the tip is cut slowly
/// instead.
constexpr double kSharpestLoopDegrees = 165;

double turn_between(Vec2 in, Vec2 out) {
  return std::atan2(geom::cross(in, out), geom::dot(in, out));
}

bool is_corner_arc(const Segment& s) {
  return !s.is_line() && s.source == geom::kCornerSource;
}

struct Loop {
  Segment over, around, back;
};

/// Straight on over the corner point q, around on the waste side and back through q in the new direction.
/// `size` is the larger of the overshoot and the radius: overshoot = radius * tan(turn / 2).
Loop make_loop(Point2 from, Point2 q, Point2 to, Vec2 in, Vec2 out, double turn, double size) {
  const double t = std::tan(std::abs(turn) / 2);
  const double overshoot = t >= 1 ? size : size * t;
  const Point2 e = q + overshoot * in, f = q - overshoot * out;
  // The arc turns against the corner, so its centre is on the other side.
  const double radius = overshoot / t;
  const Vec2 side = turn > 0 ? geom::right(in) : geom::left(in);
  Segment arc;
  arc.a = e;
  arc.b = f;
  arc.center = e + radius * side;
  arc.radius = turn > 0 ? -radius : radius;
  arc.source = geom::kCornerSource;
  return {geom::make_line(from, e, geom::kCornerSource), arc, geom::make_line(f, to, geom::kCornerSource)};
}

bool loop_fits(const Loop& loop, const LeadRoom& room) {
  return has_room(loop.over, true, false, room) && has_room(loop.around, false, false, room) &&
         has_room(loop.back, false, true, room);
}

std::optional<Loop> find_loop(const ArcSpline& spline, const SharpCorner& corner, Waste waste, double size,
                              const LeadRoom& room) {
  const bool away_from_waste =
      (waste == Waste::left && corner.turn < 0) || (waste == Waste::right && corner.turn > 0);
  if (!away_from_waste || std::abs(corner.turn) > geom::radians(kSharpestLoopDegrees)) return std::nullopt;
  Point2 from, to;
  Vec2 in, out;
  if (corner.first == corner.end) {
    if (corner.first == 0) return std::nullopt;  // the start: nothing passes through
    const Segment &before = spline.segments[corner.first - 1], &after = spline.segments[corner.first];
    from = before.b;
    to = after.a;
    in = geom::end_tangent(before);
    out = geom::start_tangent(after);
  } else {
    const Segment &first = spline.segments[corner.first], &last = spline.segments[corner.end - 1];
    from = first.a;
    to = last.b;
    in = geom::start_tangent(first);
    out = geom::end_tangent(last);
  }
  // The tangents at the ends of the arc meet at q.
  const double d = geom::cross(in, out);
  if (d == 0) return std::nullopt;
  const Point2 q = from + (geom::cross(to - from, out) / d) * in;
  for (int k = 0; k <= kLoopHalvings; ++k, size /= 2) {
    const Loop loop = make_loop(from, q, to, in, out, corner.turn, size);
    if (loop_fits(loop, room)) return loop;
  }
  return std::nullopt;
}

}  // namespace

std::vector<SharpCorner> sharp_corners(const ArcSpline& spline, double angle_rad) {
  const auto& all = spline.segments;
  const std::size_t n = all.size();
  std::vector<SharpCorner> corners;
  const auto vertex = [&](std::size_t i) {
    const double turn = turn_between(geom::end_tangent(all[(i + n - 1) % n]), geom::start_tangent(all[i]));
    if (std::abs(turn) > angle_rad) corners.push_back({i, i, turn, all[i].a});
  };
  for (std::size_t i = 0; i < n;) {
    if (i > 0 || spline.closed) vertex(i);
    if (!is_corner_arc(all[i])) {
      ++i;
      continue;
    }
    // One corner may have been cut into several arcs about the same point.
    std::size_t end = i + 1;
    double turn = geom::sweep_of(all[i]);
    while (end < n && is_corner_arc(all[end]) && all[end].center == all[i].center &&
           (all[end].radius > 0) == (all[i].radius > 0)) {
      turn += geom::sweep_of(all[end++]);
    }
    if (std::abs(turn) > angle_rad) {
      corners.push_back({i, end, turn, geom::point_on(all[i], end == i + 1 ? 0.5 : 1.0)});
    }
    i = end;
  }
  return corners;
}

CornerResult treat_corners(const ArcSpline& spline, Waste waste, const CornerOptions& options,
                           const LeadRoom& room) {
  CornerResult result;
  const std::vector<SharpCorner> corners = sharp_corners(spline, geom::radians(options.angle_deg));
  std::vector<Span> slow;
  double at = 0;
  std::size_t next = 0;
  const auto push = [&](const Segment& s, MoveKind kind) {
    result.strokes.push_back({s, kind, false, true});
    at += geom::length_of(s);
  };
  for (std::size_t i = 0; i < spline.segments.size();) {
    std::size_t skip = i;
    for (; next < corners.size() && corners[next].first == i; ++next) {
      const SharpCorner& corner = corners[next];
      std::optional<Loop> loop;
      if (options.kind == Corners::loop) {
        loop = find_loop(spline, corner, waste, options.loop_mm, room);
        if (!loop && (i > 0 || corner.end > 0)) result.no_room.push_back(corner.at);
      }
      const double from = at;
      if (loop) {
        for (const Segment& s : {loop->over, loop->around, loop->back}) {
          if (geom::length_of(s) > room.point_mm) push(s, MoveKind::corner);
        }
        skip = corner.end;
        result.zones.push_back({from, at});
        continue;
      }
      double length = 0;
      for (std::size_t k = corner.first; k < corner.end; ++k) length += geom::length_of(spline.segments[k]);
      result.zones.push_back({from, from + length});
      if (options.kind != Corners::round)
        slow.push_back({from - options.slow_mm, from + length + options.slow_mm});
    }
    if (skip > i) {
      i = skip;
      continue;
    }
    push(spline.segments[i], MoveKind::cut);
    ++i;
  }
  if (slow.empty()) return result;
  const std::vector<Span> spans = normalized(std::move(slow), at, spline.closed);
  result.strokes = marked(result.strokes, spans, room.point_mm, [](Stroke& s) {
    s.slow = s.kind == MoveKind::cut;  // a loop is there to keep the speed
    s.kind = MoveKind::corner;
  });
  result.zones.insert(result.zones.end(), spans.begin(), spans.end());
  return result;
}

}  // namespace burin::laser::detail
