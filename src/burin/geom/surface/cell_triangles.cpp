// SPDX-License-Identifier: Apache-2.0
// Lawson's insertion of points; segments by flipping what crosses them (Sloan 1993).
#include "burin/geom/surface/cell_triangles.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace burin::geom::detail {
namespace {

constexpr int kNone = -1;
/// Rounding of the in-circle test, over its terms: below, corners count as on one circle.
constexpr double kOnCircle = 1e-10;
/// Crossings of segments within crossings: rounding makes no more sense of it.
constexpr int kMostDepth = 24;

class Triangulation {
 public:
  Triangulation(std::vector<CellPoint> points, double width_share)
      : points_(std::move(points)), scale_(width_share) {
    start_.assign(points_.size(), kNone);
    corner_ = {0, 1, 2, 0, 2, 3};
    for (int e = 0; e < 6; ++e) push(), start_[at(corner_[at(e)])] = e;
    twin_[2] = 3, twin_[3] = 2;
    for (std::size_t i = 4; i < points_.size(); ++i) insert(static_cast<int>(i));
  }

  void add(int a, int b, bool odd, int depth = 0);
  CellTriangles result(bool left_inside) const;

 private:
  // Half-edge e runs from corner_[e]; triangle e / 3.
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  static int next(int e) { return e % 3 == 2 ? e - 2 : e + 1; }
  static int before(int e) { return e % 3 == 0 ? e + 2 : e - 1; }
  int from(int e) const { return corner_[at(e)]; }
  int to(int e) const { return corner_[at(next(e))]; }
  int apex(int e) const { return corner_[at(before(e))]; }
  const CellPoint& point(int v) const { return points_[at(v)]; }

  void push() { twin_.push_back(kNone), fixed_.push_back(0), odd_.push_back(0); }

  /// Twice the area: positive when c lies to the left of a b.
  static std::int64_t side(const CellPoint& a, const CellPoint& b, const CellPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  std::int64_t side(int a, int b, int c) const { return side(point(a), point(b), point(c)); }

  /// What an edge keeps when its triangles change.
  struct Outer {
    int twin = kNone;
    char fixed = 0, odd = 0;
  };
  Outer outer(int e) const { return {twin_[at(e)], fixed_[at(e)], odd_[at(e)]}; }
  void set(int e, int corner, const Outer& o) {
    corner_[at(e)] = corner, twin_[at(e)] = o.twin, fixed_[at(e)] = o.fixed, odd_[at(e)] = o.odd;
    if (o.twin != kNone) twin_[at(o.twin)] = e;
    start_[at(corner)] = e;
  }
  int add_triangle() {
    const int e = static_cast<int>(corner_.size());
    for (int k = 0; k < 3; ++k) corner_.push_back(0), push();
    return e;
  }

  void flip(int e);
  void insert(int v);
  void split_triangle(int t, int v);
  void split_edge(int e, int v);
  int locate(const CellPoint& p, int& edge) const;
  void legalize(std::vector<int>& edges);
  bool in_circle(int a, int b, int c, int d) const;
  int find_edge(int a, int b) const;
  template <class Visit>
  int around(int v, Visit&& visit) const;
  void mark(int e, bool odd);
  void cross_at(int a, int b, int e, bool odd, int depth);
  bool flip_away(int a, int b, std::deque<std::array<int, 2>> crossing);

  std::vector<CellPoint> points_;
  std::vector<int> corner_, twin_;
  std::vector<char> fixed_, odd_;
  std::vector<int> start_;  ///< some half-edge that starts at the point
  mutable int last_ = 0;    ///< where the last point was found
  double scale_;
};

/// Half-edges that start at v, all of them, until visit says true; that one.
template <class Visit>
int Triangulation::around(int v, Visit&& visit) const {
  const int first = start_[at(v)];
  int e = first;
  do {
    if (visit(e)) return e;
    e = twin_[at(before(e))];
  } while (e != kNone && e != first);
  if (e == first) return kNone;
  for (e = twin_[at(first)]; e != kNone; e = twin_[at(e)]) {
    e = next(e);
    if (visit(e)) return e;
  }
  return kNone;
}

/// The half-edge a b (or b a where only that one exists).
int Triangulation::find_edge(int a, int b) const {
  const int e = around(a, [&](int h) { return to(h) == b; });
  if (e != kNone) return e;
  return around(b, [&](int h) { return to(h) == a; });
}

void Triangulation::flip(int e) {
  const int f = twin_[at(e)];
  const int a = from(e), b = from(f), c = apex(e), d = apex(f);
  const Outer bc = outer(next(e)), ca = outer(before(e)), ad = outer(next(f)), db = outer(before(f));
  const int s = e - e % 3, t = f - f % 3;
  set(s, a, ad), set(s + 1, d, {}), set(s + 2, c, ca);
  set(t, d, db), set(t + 1, b, bc), set(t + 2, c, {});
  twin_[at(s + 1)] = t + 2, twin_[at(t + 2)] = s + 1;
}

/// d inside of the circle through the triangle a b c.
bool Triangulation::in_circle(int a, int b, int c, int d) const {
  const CellPoint o = point(d);
  double x[3], y[3], q[3];
  const int v[3] = {a, b, c};
  for (int k = 0; k < 3; ++k) {
    x[k] = scale_ * double(point(v[k]).x - o.x), y[k] = double(point(v[k]).y - o.y);
    q[k] = x[k] * x[k] + y[k] * y[k];
  }
  double sum = 0, size = 0;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    sum += q[k] * (x[l] * y[m] - x[m] * y[l]);
    size += q[k] * (std::abs(x[l] * y[m]) + std::abs(x[m] * y[l]));
  }
  return sum > kOnCircle * size;
}

void Triangulation::legalize(std::vector<int>& edges) {
  // Rounding could make flips go round in a ring.
  std::size_t left = 100 + 20 * corner_.size();
  while (!edges.empty() && left-- > 0) {
    const int e = edges.back(), f = twin_[at(e)];
    edges.pop_back();
    if (f == kNone || fixed_[at(e)]) continue;
    const int a = from(e), b = to(e), c = apex(e), d = apex(f);
    if (!in_circle(a, b, c, d)) continue;
    if (side(a, d, c) <= 0 || side(d, b, c) <= 0) continue;
    flip(e);
    const int s = e - e % 3, t = f - f % 3;
    edges.insert(edges.end(), {s, s + 2, t, t + 1});
  }
  edges.clear();
}

/// The triangle (first half-edge) that holds p; `edge`: the one p lies on.
int Triangulation::locate(const CellPoint& p, int& edge) const {
  const int count = static_cast<int>(corner_.size()) / 3;
  const auto out_of = [&](int t) {
    edge = kNone;
    for (int e = t; e < t + 3; ++e) {
      const std::int64_t s = side(point(from(e)), point(to(e)), p);
      if (s < 0) return e;
      if (s == 0) edge = e;
    }
    return kNone;
  };
  int t = last_;
  for (int steps = 0; steps < count; ++steps) {
    const int e = out_of(t);
    if (e == kNone) return last_ = t;
    if (twin_[at(e)] == kNone) break;
    t = twin_[at(e)] - twin_[at(e)] % 3;
  }
  for (t = 0; t < 3 * count; t += 3)
    if (out_of(t) == kNone) return last_ = t;
  return kNone;
}

void Triangulation::split_triangle(int t, int v) {
  const int a = from(t), b = from(t + 1), c = from(t + 2);
  const Outer ab = outer(t), bc = outer(t + 1), ca = outer(t + 2);
  const int p = add_triangle(), q = add_triangle();
  set(t, a, ab), set(t + 1, b, {}), set(t + 2, v, {});
  set(p, b, bc), set(p + 1, c, {}), set(p + 2, v, {});
  set(q, c, ca), set(q + 1, a, {}), set(q + 2, v, {});
  const auto pair = [&](int e, int f) { twin_[at(e)] = f, twin_[at(f)] = e; };
  pair(t + 1, p + 2), pair(p + 1, q + 2), pair(q + 1, t + 2);
  std::vector<int> edges{t, p, q};
  legalize(edges);
}

void Triangulation::split_edge(int e, int v) {
  const int f = twin_[at(e)];
  const int a = from(e), b = to(e), c = apex(e);
  const Outer ab = outer(e), bc = outer(next(e)), ca = outer(before(e));
  const Outer half{kNone, ab.fixed, ab.odd};
  const auto pair = [&](int g, int h) { twin_[at(g)] = h, twin_[at(h)] = g; };
  const int s = e - e % 3, p = add_triangle();
  std::vector<int> edges;
  if (f == kNone) {
    set(s, a, half), set(s + 1, v, {}), set(s + 2, c, ca);
    set(p, v, half), set(p + 1, b, bc), set(p + 2, c, {});
    pair(s + 1, p + 2);
    edges = {s + 2, p + 1};
  } else {
    const int d = apex(f), t = f - f % 3, q = add_triangle();
    const Outer ad = outer(next(f)), db = outer(before(f));
    set(s, a, half), set(s + 1, v, {}), set(s + 2, c, ca);
    set(p, v, half), set(p + 1, b, bc), set(p + 2, c, {});
    set(t, v, half), set(t + 1, a, ad), set(t + 2, d, {});
    set(q, b, half), set(q + 1, v, {}), set(q + 2, d, db);
    pair(s + 1, p + 2), pair(t + 2, q + 1), pair(s, t), pair(p, q);
    edges = {s + 2, p + 1, t + 1, q + 2};
  }
  legalize(edges);
}

void Triangulation::insert(int v) {
  int edge = kNone;
  const int t = locate(point(v), edge);
  if (t == kNone) return;
  if (edge == kNone) {
    split_triangle(t, v);
  } else {
    split_edge(edge, v);
  }
}

void Triangulation::mark(int e, bool odd) {
  for (const int h : {e, twin_[at(e)]}) {
    if (h == kNone) continue;
    fixed_[at(h)] = 1;
    if (odd) odd_[at(h)] ^= 1;
  }
}

/// The segment a b meets the fixed edge e: both go through a new point there.
void Triangulation::cross_at(int a, int b, int e, bool odd, int depth) {
  const int p = from(e), q = to(e);
  const auto sp = double(side(a, b, p)), sq = double(side(a, b, q));
  const double t = sp / (sp - sq);
  const CellPoint place{point(p).x + std::llround(t * double(point(q).x - point(p).x)),
                        point(p).y + std::llround(t * double(point(q).y - point(p).y))};
  int v = kNone;
  for (const int known : {p, q, a, b})
    if (point(known) == place) v = known;
  const bool edge_odd = odd_[at(e)] != 0;
  for (const int h : {e, twin_[at(e)]})
    if (h != kNone) fixed_[at(h)] = 0, odd_[at(h)] = 0;
  if (v == kNone) {
    int on = kNone;
    const int triangle = locate(place, on);
    for (int h = triangle; triangle != kNone && h < triangle + 3; ++h)
      if (point(from(h)) == place) v = from(h);
    if (v == kNone) {
      v = static_cast<int>(points_.size());
      points_.push_back(place), start_.push_back(kNone);
      insert(v);
    }
  }
  if (v != p && v != q) {
    add(p, v, edge_odd, depth + 1), add(v, q, edge_odd, depth + 1);
  } else {
    add(p, q, edge_odd, kMostDepth);  // the edge is still there: only its marks come back
  }
  if (v != a) add(a, v, odd, depth + 1);
  if (v != b) add(v, b, odd, depth + 1);
}

void Triangulation::add(int a, int b, bool odd, int depth) {
  if (a == b) return;
  if (const int e = find_edge(a, b); e != kNone) return mark(e, odd);
  if (depth >= kMostDepth) return;
  // The triangle at a through which the segment leaves, or a point on it.
  int through = kNone;
  const CellPoint &pa = point(a), &pb = point(b);
  int e = around(a, [&](int h) {
    for (const int v : {to(h), apex(h)}) {
      const CellPoint& p = point(v);
      if (side(pa, pb, p) == 0 && (p.x - pa.x) * (pb.x - pa.x) + (p.y - pa.y) * (pb.y - pa.y) > 0) {
        through = v;
        return true;
      }
    }
    return side(a, b, to(h)) < 0 && side(a, b, apex(h)) > 0;
  });
  if (e == kNone) return;
  if (through == kNone) {
    std::deque<std::array<int, 2>> crossing;
    for (e = next(e);;) {
      if (fixed_[at(e)]) return cross_at(a, b, e, odd, depth);
      crossing.push_back({from(e), to(e)});
      const int f = twin_[at(e)];
      if (f == kNone) return;
      const int v = apex(f);
      if (v == b) break;
      const std::int64_t s = side(a, b, v);
      if (s == 0) {
        through = v;
        break;
      }
      // f runs from the left to the right point; the next edge again from right to left.
      e = s > 0 ? next(f) : before(f);
    }
    if (through == kNone) {
      if (!flip_away(a, b, std::move(crossing))) return;
      if (const int done = find_edge(a, b); done != kNone) mark(done, odd);
      return;
    }
  }
  add(a, through, odd, depth + 1);
  add(through, b, odd, depth + 1);
}

bool Triangulation::flip_away(int a, int b, std::deque<std::array<int, 2>> crossing) {
  std::size_t left = 1000 + 50 * crossing.size() * crossing.size();
  while (!crossing.empty()) {
    if (left-- == 0) return false;
    const auto [p, q] = crossing.front();
    crossing.pop_front();
    const int e = find_edge(p, q);
    if (e == kNone || twin_[at(e)] == kNone) continue;
    const int x = from(e), y = to(e), c = apex(e), d = apex(twin_[at(e)]);
    if (side(x, d, c) <= 0 || side(d, y, c) <= 0) {
      crossing.push_back({p, q});
      continue;
    }
    flip(e);
    const bool ends = c == a || c == b || d == a || d == b;
    if (!ends && (side(a, b, c) > 0) != (side(a, b, d) > 0)) crossing.push_back({c, d});
  }
  return true;
}

CellTriangles Triangulation::result(bool left_inside) const {
  const auto count = corner_.size() / 3;
  std::vector<char> seen(count, 0), in(count, 0);
  std::vector<int> open;
  constexpr std::int64_t kMiddle = kCell / 2;
  for (int e = 0; e < static_cast<int>(corner_.size()); ++e) {
    const CellPoint &p = point(from(e)), &q = point(to(e));
    const bool left_side = twin_[at(e)] == kNone && p.x == 0 && q.x == 0;
    if (!left_side || p.y <= kMiddle || q.y > kMiddle) continue;
    seen[at(e / 3)] = 1, in[at(e / 3)] = left_inside ? 1 : 0;
    open.push_back(e / 3);
  }
  while (!open.empty()) {
    const int t = open.back();
    open.pop_back();
    for (int e = 3 * t; e < 3 * t + 3; ++e) {
      const int f = twin_[at(e)];
      if (f == kNone || seen[at(f / 3)]) continue;
      seen[at(f / 3)] = 1;
      in[at(f / 3)] = static_cast<char>(in[at(t)] ^ odd_[at(e)]);
      open.push_back(f / 3);
    }
  }
  CellTriangles out;
  out.points = points_;
  for (std::size_t t = 0; t < count; ++t) {
    if (!in[t]) continue;
    const auto corner = [&](std::size_t k) { return static_cast<std::uint32_t>(corner_[3 * t + k]); };
    out.inside.push_back({corner(0), corner(1), corner(2)});
  }
  return out;
}

}  // namespace

CellTriangles triangulate_cell(std::vector<CellPoint> points, const std::vector<CellSegment>& segments,
                               bool left_inside, double width_share) {
  Triangulation cell(std::move(points), width_share);
  for (const CellSegment& s : segments) cell.add(static_cast<int>(s.from), static_cast<int>(s.to), true);
  return cell.result(left_inside);
}

}  // namespace burin::geom::detail
