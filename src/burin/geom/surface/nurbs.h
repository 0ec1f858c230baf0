// SPDX-License-Identifier: Apache-2.0
// NURBS curves and surfaces in space: data, validation, and what does not need speed. Piegl & Tiller, The
// NURBS Book; Koo & Jee 2007, eq. 1 to 3 (the paper's eq. 1 swaps the arguments of the two bases).
//   S(u,v) = sum w_ij N_i,p(u) N_j,q(v) P_ij / sum w_ij N_i,p(u) N_j,q(v),  i = 0..n (u), j = 0..m (v)
// mm; parameters have no unit.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/geom/vec.h"

namespace burin::geom {

/// Homogeneous control point (w X, w Y, w Z, w), w > 0.
struct HPoint {
  double x = 0, y = 0, z = 0, w = 1;
  bool operator==(const HPoint&) const = default;
};
constexpr HPoint operator+(HPoint a, HPoint b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
constexpr HPoint operator-(HPoint a, HPoint b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
}
constexpr HPoint operator*(double s, HPoint a) {
  return {s * a.x, s * a.y, s * a.z, s * a.w};
}
constexpr HPoint homogeneous(Point3 p, double w) {
  return {w * p.x, w * p.y, w * p.z, w};
}
constexpr Point3 project(HPoint h) {
  return {h.x / h.w, h.y / h.w, h.z / h.w};
}

inline constexpr int kMaxSurfaceDegree = 25;
/// More control points than this in one surface (or curve) are refused.
inline constexpr int kMaxControlPoints = 4'000'000;

struct Interval {
  double lo = 0, hi = 1;
  double length() const { return hi - lo; }
  bool operator==(const Interval&) const = default;
};

/// knots.size() == points.size() + degree + 1, nondecreasing, clamped (first and last degree + 1 equal),
/// inner multiplicity at most degree (C0 at least).
struct NurbsCurve {
  int degree = 0;
  std::vector<double> knots;
  std::vector<HPoint> points;

  Interval domain() const { return {knots.front(), knots.back()}; }
  bool operator==(const NurbsCurve&) const = default;
};

enum class Direction { u, v };
constexpr Direction other(Direction d) {
  return d == Direction::u ? Direction::v : Direction::u;
}

/// Both knot vectors as in NurbsCurve. points[i + j * count_u], i along u (u runs fastest).
struct NurbsSurface {
  int degree_u = 0, degree_v = 0;
  int count_u = 0, count_v = 0;
  std::vector<double> knots_u, knots_v;
  std::vector<HPoint> points;

  const HPoint& at(int i, int j) const {
    return points[static_cast<std::size_t>(i) +
                  static_cast<std::size_t>(j) * static_cast<std::size_t>(count_u)];
  }
  HPoint& at(int i, int j) {
    return points[static_cast<std::size_t>(i) +
                  static_cast<std::size_t>(j) * static_cast<std::size_t>(count_u)];
  }
  int degree(Direction d) const { return d == Direction::u ? degree_u : degree_v; }
  int count(Direction d) const { return d == Direction::u ? count_u : count_v; }
  const std::vector<double>& knots(Direction d) const { return d == Direction::u ? knots_u : knots_v; }
  Interval domain(Direction d) const { return {knots(d).front(), knots(d).back()}; }
  bool operator==(const NurbsSurface&) const = default;
};

/// Shape, finiteness, weights > 0, sizes, knots. The error (geometry) says which number is wrong and what
/// would be accepted.
Result<void> validate(const NurbsCurve& curve);
Result<void> validate(const NurbsSurface& surface);

/// 0 .. 0, 1/k, 2/k, .., 1 .. 1 (clamped uniform) for `count` points; the default of surface blocks without
/// K.
std::vector<double> clamped_uniform_knots(int count, int degree);
/// Inner knots with their multiplicities, ascending.
struct Knot {
  double value = 0;
  int multiplicity = 0;
};
std::vector<Knot> inner_knots(const std::vector<double>& knots, int degree);
/// The index i with knots[i] <= t < knots[i+1] (at the end of the domain the last span that is not empty).
int find_span(const std::vector<double>& knots, int degree, int count, double t);

/// Contains the curve or surface (convex hull of the control points; weights are positive).
Box3 bounds(const NurbsCurve& curve);
Box3 bounds(const NurbsSurface& surface);

}  // namespace burin::geom
