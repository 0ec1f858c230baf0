// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/reach_exact.h"

#include <algorithm>
#include <cmath>

namespace burin::rotary::detail {

namespace {

using geom::Vec3;

/// Place of a corner seen along the axis: x and l across it, h along it.
struct Seen {
  double x, l, h;
};

/// At most a corner more for each of the two planes.
struct Polygon {
  std::array<Seen, 5> at;
  int n = 0;
};

/// The part with sign * h >= sign * limit.
Polygon clipped(const Polygon& in, double limit, double sign) {
  Polygon out;
  for (int i = 0; i < in.n; ++i) {
    const Seen &a = in.at[i], &b = in.at[(i + 1) % in.n];
    const double da = sign * (a.h - limit), db = sign * (b.h - limit);
    if (da >= 0 && out.n < 5) out.at[out.n++] = a;
    if ((da >= 0) != (db >= 0) && out.n < 5) {
      const double t = da / (da - db);
      out.at[out.n++] = {a.x + t * (b.x - a.x), a.l + t * (b.l - a.l), limit};
    }
  }
  return out;
}

/// Square of the distance of the axis from the polygon.
double distance2(const Polygon& p) {
  double least = std::numeric_limits<double>::infinity();
  int left = 0, right = 0;
  for (int i = 0; i < p.n; ++i) {
    const Seen &a = p.at[i], &b = p.at[(i + 1) % p.n];
    const double dx = b.x - a.x, dl = b.l - a.l, dd = dx * dx + dl * dl;
    const double t = dd > 0 ? std::clamp(-(a.x * dx + a.l * dl) / dd, 0.0, 1.0) : 0.0;
    const double x = a.x + t * dx, l = a.l + t * dl;
    least = std::min(least, x * x + l * l);
    const double side = a.x * b.l - a.l * b.x;
    left += side > 0;
    right += side < 0;
  }
  return (left > 0) != (right > 0) ? 0 : least;
}

/// The angles (as turns) at which a triangle may begin to touch the piece: each of the ways in which corners,
/// edges and the face can meet its side and its two rims. Too many do no harm.
class Candidates {
 public:
  explicit Candidates(const Piece& piece) : piece_(piece) {}

  void corner(const Vec3& v) {
    const double rho2 = v.y * v.y + v.z * v.z, s2 = piece_.radius * piece_.radius - v.x * v.x;
    if (s2 >= 0 && rho2 >= s2) around(v, std::sqrt(rho2 - s2), std::sqrt(s2));
    for (const double h : {piece_.h0, piece_.h1}) {
      if (rho2 >= h * h) around(v, h, std::sqrt(rho2 - h * h));
    }
  }

  void edge(const Vec3& a, const Vec3& b) {
    const Vec3 d = b - a, m = cross(a, d);
    const double rr = piece_.radius * piece_.radius;
    // The side: (A.m)^2 = r^2 |A x d|^2 with A = (0, sin, cos).
    const double ss = m.y * m.y - rr * (d.x * d.x + d.z * d.z), cc = m.z * m.z - rr * (d.x * d.x + d.y * d.y);
    const double sc = m.y * m.z + rr * d.y * d.z, root2 = sc * sc - ss * cc;
    if (root2 >= 0) {
      const double q = -(sc + std::copysign(std::sqrt(root2), sc));
      both(ss, q);
      both(q, cc);
    }
    // The rims: points of the edge as far from the centre as the rim.
    for (const double h : {piece_.h0, piece_.h1}) {
      if (!std::isfinite(h)) continue;
      const double dd = dot(d, d), ad = dot(a, d), in = ad * ad - dd * (dot(a, a) - (h * h + rr));
      if (!(in >= 0 && dd > 0)) continue;
      for (const double sign : {-1.0, 1.0}) {
        const Vec3 p = a + ((-ad + sign * std::sqrt(in)) / dd) * d;
        around(p, h, std::sqrt(std::max(0.0, p.y * p.y + p.z * p.z - h * h)));
      }
    }
  }

  /// The plane against the rims: h c -+ r sqrt(1 - c^2) = n.p with c = n.A.
  void face(const Corners& t) {
    const Vec3 n = unit(cross(t[1] - t[0], t[2] - t[0]));
    const double across = std::hypot(n.y, n.z), d = dot(n, t[0]), r = piece_.radius;
    if (!(across > 0)) return;
    for (const double h : {piece_.h0, piece_.h1}) {
      if (!std::isfinite(h)) continue;
      const double to2 = h * h + r * r, in = to2 - d * d;
      if (!(in >= 0)) continue;
      for (const double sign : {-1.0, 1.0}) {
        const double c = (h * d + sign * r * std::sqrt(in)) / to2 / across;
        if (std::abs(c) <= 1) around(n, c, std::sqrt(1 - c * c));
      }
    }
  }

  /// Ascending.
  const double* sorted() {
    std::sort(turns_.begin(), turns_.begin() + n_);
    return turns_.data();
  }
  int size() const { return n_; }

 private:
  void put(double c, double s) {
    const double t = turn_of(c, s);
    if (std::isfinite(t)) turns_[static_cast<std::size_t>(n_++)] = t;
  }
  /// The direction of v turned by +- the angle of (c, s).
  void around(const Vec3& v, double c, double s) {
    put(v.z * c - v.y * s, v.y * c + v.z * s);
    put(v.z * c + v.y * s, v.y * c - v.z * s);
  }
  void both(double c, double s) {
    put(c, s);
    put(-c, -s);
  }

  // 3 corners x 3 x 2, 3 edges x (2 x 2 + 2 rims x 2 x 2), a face x 2 rims x 2 x 2
  std::array<double, 62> turns_;
  int n_ = 0;
  const Piece& piece_;
};

bool touches_at_turn(const Corners& triangle, const Piece& piece, double turn) {
  const double angle = angle_of_turn(turn);
  return touches(triangle, piece, std::cos(angle), std::sin(angle));
}

}  // namespace

bool touches(const Corners& triangle, const Piece& piece, double cosine, double sine) {
  Polygon p;
  for (const Vec3& v : triangle) p.at[p.n++] = {v.x, v.y * cosine - v.z * sine, v.y * sine + v.z * cosine};
  p = clipped(p, piece.h0, 1);
  if (std::isfinite(piece.h1)) p = clipped(p, piece.h1, -1);
  return distance2(p) < piece.radius * piece.radius;
}

void forbid_exactly(const Corners& triangle, const Piece& piece, Arcs& arcs) {
  Candidates candidates(piece);
  for (std::size_t i = 0; i < 3; ++i) {
    candidates.corner(triangle[i]);
    candidates.edge(triangle[i], triangle[(i + 1) % 3]);
  }
  candidates.face(triangle);
  const int n = candidates.size();
  if (n == 0) {
    if (touches(triangle, piece, 1, 0)) arcs.add_all();
    return;
  }
  const double* turns = candidates.sorted();
  if (touches_at_turn(triangle, piece, std::remainder(0.5 * (turns[n - 1] + turns[0]) + 2, 4.0))) {
    if (turns[n - 1] > turns[0]) {
      arcs.add(turns[n - 1], turns[0]);
    } else {
      arcs.add_all();
    }
  }
  for (int i = 1; i < n; ++i) {
    if (turns[i] > turns[i - 1] && touches_at_turn(triangle, piece, 0.5 * (turns[i] + turns[i - 1])))
      arcs.add(turns[i - 1], turns[i]);
  }
}

}  // namespace burin::rotary::detail
