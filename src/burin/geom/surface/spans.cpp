// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/spans.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace burin::geom::detail {
namespace {

/// Of all pieces together: surfaces of many pieces have few cells in each, whose bounds matter less.
constexpr double kHalvings = 100'000;
/// Of all pieces: half a gigabyte.
constexpr std::size_t kMostPoints = 16'000'000;

/// No edge longer than max_edge: the diagonal is at most the sum of the two sides.
double for_edges(double speed, double length, double max_edge) {
  return max_edge > 0 ? std::ceil(2 * speed * length / max_edge) : 1;
}

/// The largest b with a^2 uu + 2 a b uv + b^2 vv <= eight_d.
double widest(double a, const SecondBounds& m, double eight_d) {
  const double left = eight_d - a * a * m.uu;
  if (!(left > 0)) return 0;
  const double x = a * m.uv, denominator = x + std::sqrt(x * x + m.vv * left);
  return denominator > 0 ? left / denominator : std::numeric_limits<double>::infinity();
}

/// Knots where the surface may have a crease or an end.
std::vector<char> creases(const std::vector<double>& knots, int degree) {
  std::vector<char> out{1};
  for (const Knot& knot : inner_knots(knots, degree)) out.push_back(knot.multiplicity >= degree ? 1 : 0);
  out.push_back(1);
  return out;
}

/// A chord of an end of the surface may stand out of it by all that the end is curved, in any direction.
void regard_ends(SecondBounds& m, const SecondBounds& all, bool end_in_u, bool end_in_v) {
  if (end_in_u) m.vv += all.vv;
  if (end_in_v) m.uu += all.uu;
}

}  // namespace

Result<Spans> spans_of(const NurbsSurface& surface, bool along) {
  if (auto ok = validate(surface); !ok) return ok.error();
  // Before the pieces are made: a high degree makes many points of each.
  const std::size_t columns = inner_knots(surface.knots_u, surface.degree_u).size() + 1;
  const std::size_t rows = inner_knots(surface.knots_v, surface.degree_v).size() + 1;
  const auto each = static_cast<std::size_t>((surface.degree_u + 1) * (surface.degree_v + 1));
  if (columns * rows * each > kMostPoints)
    return Error{ErrorCode::range,
                 "a surface of " + std::to_string(columns) + " x " + std::to_string(rows) +
                     " pieces of degree " + std::to_string(surface.degree_u) + " x " +
                     std::to_string(surface.degree_v) + " (at most " + std::to_string(kMostPoints / each) +
                     " pieces of this degree)",
                 {}};
  Spans spans;
  const std::vector<BezierPatch> patches = bezier_patches(surface);
  const int halvings =
      std::min(kMostHalvings, static_cast<int>(kHalvings / static_cast<double>(patches.size())));
  spans.bounds.reserve(patches.size());
  for (const BezierPatch& patch : patches) {
    if (patch.v == patches.front().v) spans.u.push_back(patch.u);
    if (patch.u == patches.front().u) spans.v.push_back(patch.v);
    spans.bounds.push_back(second_bounds(patch, halvings));
  }
  if (along) return spans;
  const std::vector<char> cu = creases(surface.knots_u, surface.degree_u);
  const std::vector<char> cv = creases(surface.knots_v, surface.degree_v);
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      const BezierPatch& patch = patches[i + j * columns];
      SecondBounds& all = spans.bounds[i + j * columns];
      SecondBounds m = normal_bounds(patch, all);
      regard_ends(m, all, cu[i] || cu[i + 1], cv[j] || cv[j + 1]);
      const double du = patch.u.length(), dv = patch.v.length();
      if (deviation8(m, du, dv) < deviation8(all, du, dv)) all = m;
    }
  }
  return spans;
}

Result<void> check_budget(const Spans& spans, const TessellateOptions& options) {
  if (!(options.deflection_mm > 0) || !(options.max_edge_mm >= 0))
    return Error{ErrorCode::range, "the deflection or the longest edge of triangles is not positive", {}};
  if (2 * static_cast<double>(spans.bounds.size()) > static_cast<double>(options.max_triangles))
    return Error{ErrorCode::range,
                 "a surface of " + std::to_string(spans.bounds.size()) + " pieces (at most " +
                     std::to_string(options.max_triangles / 2) + " for " +
                     std::to_string(options.max_triangles) + " triangles)",
                 {}};
  return {};
}

double columns_for(const SecondBounds& m, double length, double share, double deflection, double max_edge,
                   bool square) {
  double n = std::max({1.0, std::ceil(length * std::sqrt(m.uu / (share * 8 * deflection))),
                       for_edges(m.u, length, max_edge)});
  if (square && m.v > 0)
    n = std::max(n, std::ceil(length * std::sqrt(m.uv * (m.u / m.v) / (4 * deflection))));
  return n;
}

double rows_for(const SecondBounds& m, double a, double length, double deflection, double max_edge) {
  return std::max({1.0, std::ceil(length / widest(a, m, 8 * deflection)), for_edges(m.v, length, max_edge)});
}

}  // namespace burin::geom::detail
