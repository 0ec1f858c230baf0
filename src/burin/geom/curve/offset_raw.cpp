// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/offset_raw.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/geom/curve/segment_meet.h"

namespace burin::geom::detail {
namespace {

/// Arcs of larger radius become chords: their centres would carry the rounding of numbers this large.
constexpr double kMaxRadius = 1e7;
/// Deviation of those chords, mm; a tenth of the guarantee.
constexpr double kChordSagitta = 1e-7;
constexpr double kMaxChords = 1e5;

/// Arcs of less sagitta become lines, mm: their ends may be moved without turning them into full circles.
constexpr double kFlat = 1e-10;

/// One piece of the offset of one contour, before the joins.
struct Piece {
  Segment s;      // shifted; for a collapsed arc a = b = its centre
  Vec2 n0, n1;    // unit normals to the right at both ends
  Point2 vertex;  // end of the input segment
  bool collapsed = false;
};

enum class Join : std::uint8_t { smooth, convex, trimmed, connector };

/// Later along the segment than q.
bool later(const Segment& s, Point2 p, Point2 q) {
  if (s.is_line()) return dot(p - q, s.b - s.a) > 0;
  const double turn = cross(q - s.center, p - s.center);
  return s.radius > 0 ? turn > 0 : turn < 0;
}

/// Strictly between the ends.
bool strictly_on(const Segment& s, Point2 p) {
  if (s.is_line()) {
    const Vec2 u = s.b - s.a;
    return dot(p - s.a, u) > 0 && dot(s.b - p, u) > 0;
  }
  const double side = cross(p - s.a, s.b - s.a);
  return s.radius > 0 ? side > 0 : side < 0;
}

/// Cuts both pieces where they cross beside a concave vertex. The loop cut off (along p to its end, to the
/// vertex, to the start of q, along q) is covered by both strips, or by one strip and the region.
bool trim(Piece& p, Piece& q, double d) {
  Point2 x;
  if (p.s.is_line() && q.s.is_line()) {
    const double cosine = dot(p.n1, q.n0);
    if (cosine < -0.999) return false;
    x = p.vertex + (d / (1 + cosine)) * (p.n1 + q.n0);
    if (!(dot(x - p.s.a, left(p.n1)) > 0 && dot(q.s.b - x, left(q.n0)) > 0)) return false;
  } else {
    const Candidates c = carriers_meet(p.s, q.s, 0);
    int last = -1, first = -1;
    for (int i = 0; i < c.count; ++i) {
      const Point2 at = c.p[static_cast<std::size_t>(i)];
      if (!strictly_on(p.s, at) || !strictly_on(q.s, at)) continue;
      if (last < 0 || later(p.s, at, c.p[static_cast<std::size_t>(last)])) last = i;
      if (first < 0 || later(q.s, c.p[static_cast<std::size_t>(first)], at)) first = i;
    }
    if (last < 0 || last != first) return false;
    x = c.p[static_cast<std::size_t>(last)];
  }
  p.s.b = x;
  q.s.a = x;
  return true;
}

Piece shifted(const Segment& s, double d, double collapse_mm) {
  Piece piece;
  piece.vertex = s.b;
  piece.s = s;
  if (s.is_line()) {
    piece.n0 = piece.n1 = right(unit(s.b - s.a));
    piece.s.a = s.a + d * piece.n0;
    piece.s.b = s.b + d * piece.n0;
    return piece;
  }
  piece.n0 = (s.a - s.center) / s.radius;
  piece.n1 = (s.b - s.center) / s.radius;
  piece.s.radius = s.radius + d;
  if (s.radius < 0 && piece.s.radius > -collapse_mm) {
    piece.collapsed = true;
    piece.s.a = piece.s.b = s.center;
    return piece;
  }
  piece.s.a = s.a + d * piece.n0;
  piece.s.b = s.b + d * piece.n1;
  if (distance2(piece.s.a, piece.s.b) < 8 * kFlat * std::abs(piece.s.radius)) piece.s.radius = 0;
  return piece;
}

class RawBuilder {
 public:
  RawBuilder(RawCurves& out, double d, double join_mm) : out_(out), d_(d), join_mm_(join_mm) {}

  void add(const Segment* segments, std::size_t n, std::uint32_t contour) {
    const std::size_t begin = out_.segments.size();
    pieces_.clear();
    joins_.clear();
    for (std::size_t i = 0; i < n; ++i) pieces_.push_back(shifted(segments[i], d_, join_mm_));
    for (std::size_t i = 0; i < n; ++i) joins_.push_back(join(pieces_[i], pieces_[i + 1 < n ? i + 1 : 0]));
    for (std::size_t i = 0; i < n; ++i) {
      const Piece& p = pieces_[i];
      if (!p.collapsed) emit(p.s, false);
      emit_join(joins_[i], p, pieces_[i + 1 < n ? i + 1 : 0]);
    }
    if (out_.segments.size() == begin) return;
    out_.first.push_back(static_cast<std::uint32_t>(out_.segments.size()));
    out_.contour.push_back(contour);
  }

 private:
  Join join(Piece& p, Piece& q) {
    const double turn = cross(p.n1, q.n0), cosine = dot(p.n1, q.n0);
    // A turn back by a half turn within rounding is the tip of a spike: a sector is right, whichever it is.
    constexpr double kHalfTurn = 1e-9;
    const double gap = d_ * std::abs(turn);
    if (cosine > 0 && gap <= join_mm_ && !flips(p, gap) && !flips(q, gap)) {
      if (!p.collapsed && !q.collapsed && !(p.s.b == q.s.a)) {
        const Point2 middle = lerp(p.s.b, q.s.a, 0.5);
        p.s.b = q.s.a = middle;
        p.s = refitted(p.s);
        q.s = refitted(q.s);
      }
      return Join::smooth;
    }
    if (turn > 0 || (cosine < 0 && turn > -kHalfTurn)) return Join::convex;
    if (!p.collapsed && !q.collapsed && &p != &q && trim(p, q, d_)) return Join::trimmed;
    return Join::connector;
  }

  /// Whether moving an end by the gap could turn a short arc into nearly a full circle.
  static bool flips(const Piece& p, double gap) {
    return !p.collapsed && !p.s.is_line() && distance2(p.s.a, p.s.b) < 16 * gap * gap;
  }

  void emit(const Segment& s, bool inside) {
    if (s.a == s.b) return;
    out_.segments.push_back(s);
    out_.inside.push_back(inside ? 1 : 0);
  }
  void emit_connector(Point2 a, Point2 b) { emit(make_line(a, b, kCornerSource), true); }

  void emit_join(Join how, const Piece& p, const Piece& q) {
    const Point2 from = p.s.b, to = q.s.a, v = p.vertex;
    switch (how) {
      case Join::smooth:
        emit_connector(from, to);  // nothing unless an arc collapsed
        return;
      case Join::trimmed:
        return;
      case Join::connector:
        emit_connector(from, v);
        emit_connector(v, to);
        return;
      case Join::convex:
        break;
    }
    const Point2 a = p.collapsed ? v + d_ * p.n1 : from, b = q.collapsed ? v + d_ * q.n0 : to;
    emit_connector(from, a);
    Segment arc{a, b, v, d_, kCornerSource};
    // Too short to tell its direction from the ends.
    if (distance2(a, b) < 8 * kFlat * d_ && dot(p.n1, q.n0) > 0) arc.radius = 0;
    if (dot(p.n1, q.n0) < -0.9) {
      // Near a half turn: two arcs, split in the direction between the tangent and the one turned back.
      const Point2 middle = v + d_ * unit(left(p.n1) - left(q.n0));
      Segment half = arc;
      half.b = arc.a = middle;
      emit(half, false);
    }
    emit(arc, false);
    emit_connector(b, to);
  }

  RawCurves& out_;
  double d_, join_mm_;
  std::vector<Piece> pieces_;
  std::vector<Join> joins_;
};

/// Spreads the lower 16 bits to the even places.
std::uint32_t spread(std::uint32_t v) {
  v = (v | (v << 8)) & 0x00ff00ffu;
  v = (v | (v << 4)) & 0x0f0f0f0fu;
  v = (v | (v << 2)) & 0x33333333u;
  return (v | (v << 1)) & 0x55555555u;
}

/// To an integer of 16 bits; not yet checked input may be anything.
std::uint32_t grid(double v) {
  return v > 0 ? static_cast<std::uint32_t>(std::min(v, 65535.0)) : 0;
}

/// Many contours in the order of a Z curve, so that neighbours in the arrays are neighbours in the plane.
std::vector<std::uint32_t> spatial_order(const std::vector<ArcSpline>& contours) {
  const std::size_t n = contours.size();
  std::vector<std::uint32_t> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = static_cast<std::uint32_t>(i);
  if (n < 8) return order;
  Box2 all;
  for (const ArcSpline& c : contours) all.add(c.segments.front().a);
  const double size = std::max({all.width(), all.height(), std::numeric_limits<double>::min()});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> keys(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 at = (65535.0 / size) * (contours[i].segments.front().a - all.lo);
    keys[i] = {spread(grid(at.x)) | (spread(grid(at.y)) << 1), order[i]};
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < n; ++i) order[i] = keys[i].second;
  return order;
}

Error bad(std::size_t contour, std::size_t segment, const std::string& what) {
  return {ErrorCode::geometry,
          "contour " + std::to_string(contour) + ", segment " + std::to_string(segment) + ": " + what,
          {}};
}

class Cleaner {
 public:
  Cleaner(CleanContours& out, double point_mm) : out_(out), point_mm_(point_mm) {}

  Result<void> add(const ArcSpline& spline, std::size_t index, bool reverse) {
    if (Result<void> ok = check(spline, index); !ok) return ok;
    const std::size_t begin = out_.segments.size();
    run(spline, reverse, point_mm_);
    if (out_.segments.size() - begin < 2) {  // smaller than a point: keep it as it is
      out_.segments.resize(begin);
      run(spline, reverse, 0);
    }
    if (out_.segments.size() == begin) return {};
    out_.first.push_back(static_cast<std::uint32_t>(out_.segments.size()));
    out_.contour.push_back(static_cast<std::uint32_t>(index));
    return {};
  }

 private:
  Result<void> check(const ArcSpline& spline, std::size_t index) {
    const std::size_t n = spline.segments.size();
    if (!spline.closed) return bad(index, 0, "the contour is open (a closed contour is needed)");
    if (n < 2) return bad(index, 0, "fewer than two segments (a circle is two arcs)");
    const Segment* before = &spline.segments.back();
    for (std::size_t i = 0; i < n; ++i) {
      const Segment& s = spline.segments[i];
      const double most = std::max({std::abs(s.a.x), std::abs(s.a.y), std::abs(s.b.x), std::abs(s.b.y)});
      if (!(most <= kMaxCoordinate))
        return bad(index, i, "a coordinate is not finite or beyond 1e7 mm (up to 1e7 mm)");
      if (!(before->b == s.a) && distance(before->b, s.a) > std::max(point_mm_, 1e-7)) {
        return bad(index, i, "does not start where the one before ends (within 1e-7 mm)");
      }
      before = &s;
      scale_ = std::max(scale_, most);
      if (s.is_line()) continue;
      const double r = std::abs(s.radius);
      const double slack = 2 * kArcConsistency * (r + 1);
      if (!std::isfinite(r) || !std::isfinite(s.center.x) || !std::isfinite(s.center.y) ||
          !(std::abs(distance(s.a, s.center) - r) <= slack) ||
          !(std::abs(distance(s.b, s.center) - r) <= slack)) {
        return bad(index, i, "the arc's ends, centre and radius disagree (within 1e-9 (radius + 1))");
      }
      if (r > kMaxRadius && chords_of(s) > kMaxChords) {
        return bad(index, i, "an arc too flat and too long (radius up to 1e7 mm, or a line)");
      }
      if (s.a == s.b) return bad(index, i, "an arc that ends where it starts (a full circle is two arcs)");
      if (r <= kMaxRadius) scale_ = std::max(scale_, r + most);
    }
    out_.scale = std::max(out_.scale, scale_);
    return {};
  }

  void run(const ArcSpline& spline, bool reverse, double tiny) {
    const std::size_t begin = out_.segments.size(), n = spline.segments.size();
    const Point2 start = reverse ? spline.segments.back().b : spline.segments.front().a;
    at_ = start;
    tiny2_ = tiny * tiny;
    for (std::size_t i = 0; i < n; ++i) {
      const Segment& s = spline.segments[reverse ? n - 1 - i : i];
      if (reverse) {
        add_segment({s.b, s.a, s.center, s.radius == 0 ? 0 : -s.radius, s.source});
      } else {
        add_segment(s);
      }
    }
    if (out_.segments.size() == begin) return;
    Segment& last = out_.segments.back();
    if (!(last.b == start)) {
      const Vec2 chord = last.b - last.a;
      last.b = start;
      if (!last.is_line() && turned_or_flat(last, chord)) last.radius = 0;
      last = refitted(last);
      if (last.a == last.b) out_.segments.pop_back();
    }
  }

  void add_segment(const Segment& s) {
    if (s.is_line()) {
      push(s);
      return;
    }
    const Vec2 chord = s.b - s.a;
    const double r = std::abs(s.radius);
    const double inner = s.radius > 0 ? cross(chord, s.center - s.a) : -cross(chord, s.center - s.a);
    if (inner < -1e-9 * r * norm(chord)) {  // more than a half turn
      Segment head = s, tail = s;
      head.b = tail.a = middle_of(s);
      push(head);
      push(tail);
      return;
    }
    if (r > kMaxRadius) {
      push_chords(s);
      return;
    }
    push(s);
  }

  static double chords_of(const Segment& s) {
    return distance(s.a, s.b) / std::sqrt(8 * std::abs(s.radius) * kChordSagitta);
  }

  void push_chords(const Segment& s) {
    const int count = 1 + static_cast<int>(chords_of(s));
    Point2 from = s.a;
    for (int i = 1; i <= count; ++i) {
      const Point2 to = i == count ? s.b : point_on(s, static_cast<double>(i) / count);
      push(make_line(from, to, s.source));
      from = to;
    }
  }

  void push(Segment s) {
    if (distance2(at_, s.b) <= tiny2_) return;
    const bool moved = !(s.a == at_);
    const Vec2 chord = s.b - s.a;
    s.a = at_;
    if (!s.is_line()) {
      // Also takes out what disagreement between ends and centre the input was allowed.
      const double off = norm2(s.a - s.center) - s.radius * s.radius;
      const double off_b = norm2(s.b - s.center) - s.radius * s.radius;
      const double slack = 1e-14 * (s.radius * s.radius);
      if (moved && turned_or_flat(s, chord)) {
        s.radius = 0;
      } else if (moved || std::abs(off) > slack || std::abs(off_b) > slack) {
        s = refitted(s);
      }
    }
    at_ = s.b;
    out_.segments.push_back(s);
  }

  /// An arc with a moved end that would go round the other way, or has no curvature to lose.
  bool turned_or_flat(const Segment& s, Vec2 old_chord) const {
    const Vec2 chord = s.b - s.a;
    return dot(chord, old_chord) <= 0 || norm2(chord) < 8 * 0.1 * point_mm_ * std::abs(s.radius);
  }

  CleanContours& out_;
  double point_mm_, tiny2_ = 0, scale_ = 1;
  Point2 at_;
};

}  // namespace

Result<CleanContours> clean_contours(const std::vector<ArcSpline>& contours, double point_mm, bool reverse) {
  CleanContours out;
  std::size_t total = 0;
  for (std::size_t i = 0; i < contours.size(); ++i) {
    if (contours[i].segments.empty()) return bad(i, 0, "the contour is empty (at least two segments)");
    total += contours[i].segments.size();
  }
  // A segment gives at most four raw ones, which are counted with 32 bits.
  if (total > (1u << 28)) {
    return Error{
        ErrorCode::range, "too many segments to offset: " + std::to_string(total) + " (up to 2^28)", {}};
  }
  out.segments.reserve(total);
  out.first.push_back(0);
  Cleaner cleaner(out, point_mm);
  for (const std::uint32_t i : spatial_order(contours)) {
    if (Result<void> ok = cleaner.add(contours[i], i, reverse); !ok) return ok.error();
  }
  return out;
}

RawCurves raw_curves(const CleanContours& contours, double d, double join_mm) {
  RawCurves out;
  out.first.push_back(0);
  if (d == 0) {
    out.segments = contours.segments;
    out.inside.assign(out.segments.size(), 0);
    out.first = contours.first;
    out.contour = contours.contour;
    return out;
  }
  out.segments.reserve(2 * contours.segments.size());
  out.inside.reserve(2 * contours.segments.size());
  RawBuilder builder(out, d, join_mm);
  for (std::size_t k = 0; k < contours.count(); ++k) {
    const std::size_t begin = contours.first[k];
    builder.add(contours.segments.data() + begin, contours.first[k + 1] - begin, contours.contour[k]);
  }
  return out;
}

}  // namespace burin::geom::detail
