// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/modify.h"

#include <algorithm>
#include <cassert>
#include <string>

#include "burin/geom/surface/rows.h"

namespace burin::geom {
namespace {

using detail::Rows;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

Result<void> check_degree(int degree, int by) {
  assert(by >= 0);
  if (degree + by <= kMaxSurfaceDegree) return {};
  return Error{
      ErrorCode::range,
      "degree " + std::to_string(degree + by) + " (at most " + std::to_string(kMaxSurfaceDegree) + ")",
      {}};
}

/// Removes the knot once, computing from both ends (The NURBS Book, A5.8, one pass). The result is near the
/// old spline only if the knot can be removed.
Rows removed_once(const Rows& rows, double value) {
  const auto& t = rows.knots;
  const int p = rows.degree;
  const auto [from, to] = std::equal_range(t.begin(), t.end(), value);
  const int s = static_cast<int>(to - from), r = static_cast<int>(to - t.begin()) - 1;
  const int first = r - p, last = r - s, off = first - 1;

  Rows out = rows;
  const auto knot = [&](int i) { return t[index(i)]; };
  int i = first, j = last;
  for (; j - i > 0; ++i, --j) {
    const double a = (value - knot(i)) / (knot(i + p + 1) - knot(i));
    const double b = (value - knot(j)) / (knot(j + p + 1) - knot(j));
    for (int c = 0; c < rows.width; ++c) {
      const HPoint left = out.row(i - 1)[c], right = out.row(j + 1)[c];
      out.row(i)[c] = (1 / a) * (rows.row(i)[c] - (1 - a) * left);
      out.row(j)[c] = (1 / (1 - b)) * (rows.row(j)[c] - b * right);
    }
  }
  // Two values for one point (left of the meeting place and right of it): the mean of both is at most as far
  // off.
  if (j < i && i - 1 >= first && j + 1 <= last && i - 1 > off) {
    for (int c = 0; c < rows.width; ++c) {
      const HPoint mean = 0.5 * (out.row(i - 1)[c] + out.row(j + 1)[c]);
      out.row(i - 1)[c] = mean;
      out.row(j + 1)[c] = mean;
    }
  }
  const int gone = (2 * r - s - p) / 2;
  out.points.erase(out.points.begin() + static_cast<std::ptrdiff_t>(gone) * rows.width,
                   out.points.begin() + static_cast<std::ptrdiff_t>(gone + 1) * rows.width);
  out.knots.erase(out.knots.begin() + r);
  return out;
}

/// Bound of the distance between two splines over the same knots. With D = A' - A, d = w' - w:
/// S' - S = (D - S d) / w', a quotient of convex sums, and S lies within `radius` of `centre`.
double distance_bound(const Rows& a, const Rows& b) {
  Box3 box;
  double weight = std::numeric_limits<double>::infinity();
  for (const HPoint& h : a.points) box.add(project(h));
  for (const HPoint& h : b.points) weight = std::min(weight, h.w);
  if (!(weight > 0)) return std::numeric_limits<double>::infinity();
  const Point3 centre = lerp(box.lo, box.hi, 0.5);
  const double radius = 0.5 * box.diagonal();
  double most = 0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const HPoint d = b.points[i] - a.points[i];
    const Vec3 shift{d.x - centre.x * d.w, d.y - centre.y * d.w, d.z - centre.z * d.w};
    most = std::max(most, norm(shift) + radius * std::abs(d.w));
  }
  return most / weight;
}

std::vector<Interval> spans(const std::vector<double>& knots) {
  std::vector<Interval> out;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    if (knots[i] < knots[i + 1]) out.push_back({knots[i], knots[i + 1]});
  return out;
}

/// All inner knots as often as the degree.
void to_bezier(Rows& rows) {
  std::vector<double> values;
  for (const Interval& span : spans(rows.knots)) values.insert(values.end(), index(rows.degree), span.lo);
  detail::insert(rows, values);
}

std::vector<double> bezier_knots(Interval t, int degree) {
  std::vector<double> knots(index(degree + 1), t.lo);
  knots.insert(knots.end(), index(degree + 1), t.hi);
  return knots;
}

}  // namespace

NurbsCurve insert_knots(const NurbsCurve& curve, std::span<const double> values) {
  Rows rows = detail::rows_of(curve);
  detail::insert(rows, values);
  return detail::curve_of(std::move(rows));
}

NurbsSurface insert_knots(const NurbsSurface& surface, Direction direction, std::span<const double> values) {
  Rows rows = detail::rows_of(surface, direction);
  detail::insert(rows, values);
  return detail::surface_of(std::move(rows), direction, surface);
}

KnotRemoval remove_knot(const NurbsSurface& surface, Direction direction, double value, int times,
                        double tolerance_mm) {
  const Rows original = detail::rows_of(surface, direction);
  Rows rows = original;
  KnotRemoval out{surface, 0, 0};
  if (!(value > rows.knots.front() && value < rows.knots.back())) return out;
  while (out.removed < times && std::binary_search(rows.knots.begin(), rows.knots.end(), value)) {
    Rows fewer = removed_once(rows, value);
    Rows again = fewer;
    const std::vector<double> back(index(out.removed + 1), value);
    detail::insert(again, back);
    const double bound = distance_bound(original, again);
    const bool positive =
        std::all_of(fewer.points.begin(), fewer.points.end(), [](const HPoint& h) { return h.w > 0; });
    if (!positive || !(bound <= tolerance_mm)) break;
    rows = std::move(fewer);
    ++out.removed;
    out.deviation_mm = bound;
  }
  if (out.removed > 0) out.surface = detail::surface_of(std::move(rows), direction, surface);
  return out;
}

Result<NurbsCurve> elevate_degree(const NurbsCurve& curve, int by) {
  if (auto ok = check_degree(curve.degree, by); !ok) return std::move(ok).error();
  Rows rows = detail::rows_of(curve);
  for (int i = 0; i < by; ++i) detail::elevate_once(rows);
  return detail::curve_of(std::move(rows));
}

Result<NurbsSurface> elevate_degree(const NurbsSurface& surface, Direction direction, int by) {
  if (auto ok = check_degree(surface.degree(direction), by); !ok) return std::move(ok).error();
  if (by == 0) return surface;
  Rows rows = detail::rows_of(surface, direction);
  for (int i = 0; i < by; ++i) detail::elevate_once(rows);
  return detail::surface_of(std::move(rows), direction, surface);
}

std::pair<NurbsSurface, NurbsSurface> split(const NurbsSurface& surface, Direction direction, double at) {
  const Interval domain = surface.domain(direction);
  assert(at > domain.lo && at < domain.hi);
  Rows rows = detail::rows_of(surface, direction);
  const std::vector<double> values(index(rows.degree), at);
  detail::insert(rows, values);
  return {detail::surface_of(detail::part(rows, {domain.lo, at}), direction, surface),
          detail::surface_of(detail::part(rows, {at, domain.hi}), direction, surface)};
}

NurbsSurface sub_surface(const NurbsSurface& surface, Interval u, Interval v) {
  NurbsSurface out = surface;
  if (!(u == surface.domain(Direction::u)))
    out = detail::surface_of(detail::part(detail::rows_of(out, Direction::u), u), Direction::u, out);
  if (!(v == surface.domain(Direction::v)))
    out = detail::surface_of(detail::part(detail::rows_of(out, Direction::v), v), Direction::v, out);
  return out;
}

NurbsCurve sub_curve(const NurbsCurve& curve, Interval t) {
  return detail::curve_of(detail::part(detail::rows_of(curve), t));
}

NurbsCurve reversed(const NurbsCurve& curve) {
  Rows rows = detail::rows_of(curve);
  detail::reverse(rows);
  return detail::curve_of(std::move(rows));
}

NurbsSurface reversed(const NurbsSurface& surface, Direction direction) {
  Rows rows = detail::rows_of(surface, direction);
  detail::reverse(rows);
  return detail::surface_of(std::move(rows), direction, surface);
}

NurbsSurface swapped(const NurbsSurface& surface) {
  Rows rows = detail::rows_of(surface, Direction::u);
  return {surface.degree_v, surface.degree_u, surface.count_v,       surface.count_u,
          surface.knots_v,  surface.knots_u,  std::move(rows.points)};
}

NurbsCurve with_domain(const NurbsCurve& curve, Interval to) {
  Rows rows = detail::rows_of(curve);
  detail::map_domain(rows, to);
  return detail::curve_of(std::move(rows));
}

NurbsSurface with_domain(const NurbsSurface& surface, Direction direction, Interval to) {
  NurbsSurface out = surface;
  Rows knots{surface.degree(direction), 0, surface.knots(direction), {}};
  detail::map_domain(knots, to);
  (direction == Direction::u ? out.knots_u : out.knots_v) = std::move(knots.knots);
  return out;
}

NurbsSurface with_weights_scaled(const NurbsSurface& surface, double factor) {
  assert(factor > 0);
  NurbsSurface out = surface;
  for (HPoint& h : out.points) h = factor * h;
  return out;
}

NurbsSurface translated(const NurbsSurface& surface, Vec3 by) {
  NurbsSurface out = surface;
  for (HPoint& h : out.points) h = {h.x + by.x * h.w, h.y + by.y * h.w, h.z + by.z * h.w, h.w};
  return out;
}

NurbsCurve iso_curve(const NurbsSurface& surface, Direction along, double at) {
  const Rows rows = detail::rows_of(surface, other(along));
  return {surface.degree(along), surface.knots(along), detail::row_at(rows, at)};
}

std::vector<BezierPatch> bezier_patches(const NurbsSurface& surface) {
  Rows along_u = detail::rows_of(surface, Direction::u);
  to_bezier(along_u);
  NurbsSurface all = detail::surface_of(std::move(along_u), Direction::u, surface);
  Rows along_v = detail::rows_of(all, Direction::v);
  to_bezier(along_v);
  all = detail::surface_of(std::move(along_v), Direction::v, all);

  const std::vector<Interval> us = spans(all.knots_u), vs = spans(all.knots_v);
  const int p = all.degree_u, q = all.degree_v;
  std::vector<BezierPatch> out;
  out.reserve(us.size() * vs.size());
  for (std::size_t b = 0; b < vs.size(); ++b) {
    for (std::size_t a = 0; a < us.size(); ++a) {
      BezierPatch patch{
          us[a], vs[b], {p, q, p + 1, q + 1, bezier_knots(us[a], p), bezier_knots(vs[b], q), {}}};
      patch.surface.points.reserve(index((p + 1) * (q + 1)));
      for (int j = 0; j <= q; ++j)
        for (int i = 0; i <= p; ++i)
          patch.surface.points.push_back(all.at(static_cast<int>(a) * p + i, static_cast<int>(b) * q + j));
      out.push_back(std::move(patch));
    }
  }
  return out;
}

}  // namespace burin::geom
