// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/scene_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::orient::detail {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

Local lerp(const Local& a, const Local& b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.h + t * (b.h - a.h)};
}
double radius2(const Local& q) {
  return q.x * q.x + q.y * q.y;
}

/// The part of a triangle within from <= h <= to: at most five corners.
struct Section {
  std::array<Local, 5> at;
  int count = 0;

  Section(const Corners& t, double from, double to) {
    std::array<Local, 4> above;
    int n = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Local &a = t[i], &b = t[i == 2 ? 0 : i + 1];
      if (a.h >= from) above[static_cast<std::size_t>(n++)] = a;
      if ((a.h < from) != (b.h < from)) above[static_cast<std::size_t>(n++)] = cut(a, b, from);
    }
    for (int i = 0; i < n; ++i) {
      const Local &a = above[static_cast<std::size_t>(i)], &b = above[static_cast<std::size_t>((i + 1) % n)];
      if (a.h <= to) at[static_cast<std::size_t>(count++)] = a;
      if ((a.h > to) != (b.h > to)) at[static_cast<std::size_t>(count++)] = cut(a, b, to);
    }
  }
  /// The same place from both ends of an edge.
  static Local cut(const Local& a, const Local& b, double h) {
    if (a.h > b.h) return cut(b, a, h);
    Local q = lerp(a, b, std::clamp((h - a.h) / (b.h - a.h), 0.0, 1.0));
    q.h = h;
    return q;
  }
  const Local& operator[](int i) const { return at[static_cast<std::size_t>(i)]; }
  Local middle() const {
    Local m;
    for (int i = 0; i < count; ++i) m = {m.x + at[i].x, m.y + at[i].y, m.h + at[i].h};
    return {m.x / count, m.y / count, m.h / count};
  }
};

struct Nearest {
  double radius2 = kFar;
  Local at;
};

/// The place nearest to the axis.
Nearest nearest_to_axis(const Section& s) {
  Nearest best;
  bool left = s.count > 2, right = left;
  for (int i = 0; i < s.count; ++i) {
    const Local &a = s[i], &b = s[i + 1 == s.count ? 0 : i + 1];
    const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
    const double along = -(a.x * dx + a.y * dy);
    const double t = length2 > 0 ? std::clamp(along / length2, 0.0, 1.0) : 0;
    const Local q = lerp(a, b, t);
    const double r2 = radius2(q), turn = a.x * dy - a.y * dx;
    if (r2 < best.radius2) best = {r2, q};
    left &= turn > 0;
    right &= turn < 0;
  }
  if (!left && !right) return best;
  // The axis goes through: a fan of triangles about the first corner, by areas.
  for (int i = 1; i + 1 < s.count; ++i) {
    const Local &a = s[0], &b = s[i], &c = s[i + 1];
    const double wa = b.x * c.y - b.y * c.x, wb = c.x * a.y - c.y * a.x, wc = a.x * b.y - a.y * b.x;
    const double sum = wa + wb + wc;
    if (sum == 0 || wa / sum < 0 || wb / sum < 0 || wc / sum < 0) continue;
    best = {0, {0, 0, (wa * a.h + wb * b.h + wc * c.h) / sum}};
    break;
  }
  // In no triangle of the fan by a rounding: the axis meets one of its inner edges; best stays.
  return best;
}

/// Half the square of the distance from the disc at height h0 along an edge, and its derivative: convex.
struct DiscDistance {
  const Local &a, &b;
  double radius, h0;
  struct Value {
    double distance, slope;
  };
  Value operator()(double t) const {
    const double dx = b.x - a.x, dy = b.y - a.y, dh = b.h - a.h;
    const double x = a.x + t * dx, y = a.y + t * dy, up = a.h + t * dh - h0;
    const double r = std::sqrt(x * x + y * y), out = r > radius ? r - radius : 0;
    const double distance = std::sqrt(out * out + up * up);
    if (distance == 0) return {0, 0};
    const double dr = out > 0 ? (x * dx + y * dy) / r : 0;
    return {distance, (out * dr + up * dh) / distance};
  }
};

/// Least distance of an edge from a disc, or any distance below `enough`, or any lower bound that is not
/// below `enough`. The next place is where the tangents at both ends of the bracket meet: their value there
/// is a lower bound.
struct EdgeLeast {
  double distance = kFar, t = 0;
};
EdgeLeast least_on_edge(const DiscDistance& f, double enough, bool exactly) {
  constexpr int kSteps = 60;
  constexpr double kShare = 1e-14;  // of the distance: rounding
  double lo = 0, hi = 1;
  DiscDistance::Value at_lo = f(0), at_hi = f(1);
  EdgeLeast best =
      at_lo.distance <= at_hi.distance ? EdgeLeast{at_lo.distance, 0} : EdgeLeast{at_hi.distance, 1};
  if (at_lo.slope >= 0) return {at_lo.distance, 0};
  if (at_hi.slope <= 0) return {at_hi.distance, 1};
  for (int i = 0; i < kSteps; ++i) {
    if (!exactly && best.distance < enough) break;
    const double step =
        (at_hi.distance - at_lo.distance - at_hi.slope * (hi - lo)) / (at_lo.slope - at_hi.slope);
    const double bound = at_lo.distance + at_lo.slope * step;
    if (bound >= enough) return {std::min(best.distance, std::max(bound, enough)), best.t};
    if (best.distance - bound <= kShare * best.distance) break;
    double t = lo + step;
    // Every third step halves: tangents alone crawl where the distance is nearly straight on one side.
    if (i % 3 == 2 || !(t > lo && t < hi)) t = 0.5 * (lo + hi);
    if (!(t > lo && t < hi)) break;
    const auto at = f(t);
    if (at.distance < best.distance) best = {at.distance, t};
    if (at.slope == 0) break;
    (at.slope < 0 ? lo : hi) = t;
    (at.slope < 0 ? at_lo : at_hi) = at;
  }
  return best;
}

/// The place of the triangle with the areas of `q` (in its plane), which is `q` itself up to rounding; false
/// where q lies outside. n: the face's normal, not unit.
bool in_face(const Corners& t, const std::array<double, 3>& n, Local& q) {
  std::array<double, 3> w;
  for (std::size_t i = 0; i < 3; ++i) {
    const Local &a = t[i], &b = t[i == 2 ? 0 : i + 1];
    const double ux = b.x - a.x, uy = b.y - a.y, uh = b.h - a.h;
    const double vx = q.x - a.x, vy = q.y - a.y, vh = q.h - a.h;
    w[i == 0 ? 2 : i - 1] =
        n[0] * (uy * vh - uh * vy) + n[1] * (uh * vx - ux * vh) + n[2] * (ux * vy - uy * vx);
    if (w[i == 0 ? 2 : i - 1] < 0) return false;
  }
  const double sum = w[0] + w[1] + w[2];
  if (!(sum > 0)) return false;
  q = lerp(lerp(t[0], t[1], w[0] + w[1] > 0 ? w[1] / (w[0] + w[1]) : 0), t[2], w[2] / sum);
  return true;
}

double disc_distance(const Local& q, double radius, double h0) {
  const double out = std::max(std::sqrt(radius2(q)) - radius, 0.0);
  return std::sqrt(out * out + (q.h - h0) * (q.h - h0));
}

/// Least distance of a triangle from the disc at height h0 (with `enough` and `exactly` as above). What lies
/// beyond the disc's plane counts too: the caller has looked at it already.
Deepest least_from_disc(const Corners& t, double radius, double h0, double enough, bool exactly) {
  const double ux = t[1].x - t[0].x, uy = t[1].y - t[0].y, uh = t[1].h - t[0].h;
  const double vx = t[2].x - t[0].x, vy = t[2].y - t[0].y, vh = t[2].h - t[0].h;
  const std::array<double, 3> n{uy * vh - uh * vy, uh * vx - ux * vh, ux * vy - uy * vx};
  const double across = std::sqrt(n[0] * n[0] + n[1] * n[1]);
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  Deepest best{kFar, t[0]};
  if (length > 0) {
    // The place of the disc that is nearest to the plane, and its foot there. The normal of a needle is
    // uncertain: `unsure` bounds what that makes of the distance.
    const double sides = std::sqrt((ux * ux + uy * uy + uh * uh) * (vx * vx + vy * vy + vh * vh));
    const double away = std::sqrt(radius2(t[0])) + std::abs(t[0].h - h0) + radius;
    const double unsure = away * (16 * std::numeric_limits<double>::epsilon() * sides / length);
    const double off = (n[0] * t[0].x + n[1] * t[0].y + n[2] * (t[0].h - h0)) / length;
    const double reach = radius * across / length, gap = std::abs(off) - reach;
    if (gap - unsure >= enough) return {gap - unsure, t[0]};
    if (gap > 0) {
      const double side = off > 0 ? 1 : -1, k = across > 0 ? side * radius / across : 0,
                   s = side * gap / length;
      Local q{n[0] * (k + s), n[1] * (k + s), h0 + n[2] * s};
      constexpr double kSure = 1e-10;  // mm
      if (in_face(t, n, q)) {
        best = {disc_distance(q, radius, h0), q};
        if (unsure < kSure || (!exactly && best.value < enough)) return best;
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Local &a = t[i], &b = t[i == 2 ? 0 : i + 1];
    const EdgeLeast e = least_on_edge({a, b, radius, h0}, std::min(enough, best.value), exactly);
    if (e.distance < best.value) best = {e.distance, lerp(a, b, e.t)};
    if (!exactly && best.value < enough) break;
  }
  return best;
}

/// Strictly inside: from the place nearest to the axis towards the middle of the section.
Local inwards(const Local& nearest, const Section& s, double radius) {
  const Local m = s.middle();
  const double near = std::sqrt(radius2(nearest)), mid = std::sqrt(radius2(m));
  const double share = mid > near ? std::min(1.0, 0.5 * (radius - near) / (mid - near)) : 1.0;
  return lerp(nearest, m, share);
}

struct Span {
  double lo, hi;
};
Span heights(const Corners& t) {
  return {std::min({t[0].h, t[1].h, t[2].h}), std::max({t[0].h, t[1].h, t[2].h})};
}

}  // namespace

double excess(const Local& q, const Piece& piece) {
  const double r = std::sqrt(radius2(q)), out = r - piece.radius, below = piece.from - q.h,
               above = q.h - piece.to;
  if (piece.grow <= 0) return std::max({out, below, above});
  const double side = std::max(out, 0.0), end = std::max({below, above, 0.0});
  return std::sqrt(side * side + end * end) - piece.grow;
}

bool meets(const Corners& t, const Piece& piece) {
  const auto [lo, hi] = heights(t);
  const double g = std::max(piece.grow, 0.0), wide = piece.radius + g;
  if (!(hi > piece.from - g && lo < piece.to + g) || !(wide > 0)) return false;
  const bool within = g > 0 ? hi >= piece.from && lo <= piece.to : hi > piece.from && lo < piece.to;
  if (within && nearest_to_axis(Section(t, piece.from, piece.to)).radius2 < wide * wide) return true;
  if (g <= 0) return false;
  // Beyond the ends: straight under the cylinder, or beside its rim.
  if (nearest_to_axis(Section(t, piece.from - g, piece.to + g)).radius2 >= wide * wide) return false;
  for (const bool lower : {true, false}) {
    const double h0 = lower ? piece.from : piece.to;
    if (lower ? !(lo < h0) : !(hi > h0)) continue;
    const Section s(t, lower ? h0 - g : h0, lower ? h0 : h0 + g);
    if (s.count == 0) continue;
    const Nearest near = nearest_to_axis(s);
    // On the outer plane itself it only touches.
    if (near.radius2 < piece.radius * piece.radius && excess(inwards(near.at, s, piece.radius), piece) < 0)
      return true;
    if (least_from_disc(t, piece.radius, h0, g, false).value < g) return true;
  }
  return false;
}

Deepest deepest(const Corners& t, const Piece& piece) {
  const auto [lo, hi] = heights(t);
  const double g = std::max(piece.grow, 0.0);
  if (g <= 0) {
    if (!(hi > piece.from && lo < piece.to)) return {std::max(piece.from - hi, lo - piece.to), t[0]};
    const Section s(t, piece.from, piece.to);
    const Nearest near = nearest_to_axis(s);
    const double value = std::sqrt(near.radius2) - piece.radius;
    return {value, value < 0 ? inwards(near.at, s, piece.radius) : near.at};
  }
  Deepest best{kFar, t[0]};
  if (hi >= piece.from && lo <= piece.to) {
    const Nearest near = nearest_to_axis(Section(t, piece.from, piece.to));
    best = {std::max(std::sqrt(near.radius2) - piece.radius, 0.0), near.at};
  }
  for (const bool lower : {true, false}) {
    const double h0 = lower ? piece.from : piece.to;
    if (best.value <= 0 || (lower ? !(lo < h0) : !(hi > h0))) continue;
    const Deepest d = least_from_disc(t, piece.radius, h0, best.value, true);
    if (d.value < best.value) best = d;
    if (lo == hi) {
      // A level face over the disc: any of its places there.
      const Nearest near = nearest_to_axis(Section(t, lo, hi));
      const double out = std::max(std::sqrt(near.radius2) - piece.radius, 0.0), up = lo - h0;
      const double distance = std::sqrt(out * out + up * up);
      if (distance < best.value) best = {distance, near.at};
    }
  }
  best.value -= g;
  return best;
}

}  // namespace burin::orient::detail
