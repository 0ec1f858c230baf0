// SPDX-License-Identifier: Apache-2.0
// How many columns and rows each span of the knots gets when they go all through the surface.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "burin/geom/surface/patch_grids.h"

namespace burin::geom {
namespace {

using detail::Spans;

/// Steps of the deflection when there would be too many triangles.
constexpr double kCoarser = 1.1;

struct Counts {
  std::vector<double> u, v;  ///< whole numbers, as doubles: they may be huge before they are refused
  double total = std::numeric_limits<double>::infinity();
};

double sum(const std::vector<double>& n) {
  double s = 0;
  for (const double x : n) s += x;
  return s;
}

void consider(const Spans& spans, double share, double deflection, double max_edge, bool square,
              Counts& best) {
  Counts n;
  n.u.assign(spans.u.size(), 1.0);
  n.v.assign(spans.v.size(), 1.0);
  for (std::size_t j = 0; j < spans.v.size(); ++j)
    for (std::size_t i = 0; i < spans.u.size(); ++i)
      n.u[i] = std::max(n.u[i], detail::columns_for(spans.at(i, j), spans.u[i].length(), share, deflection,
                                                    max_edge, square));
  for (std::size_t j = 0; j < spans.v.size(); ++j)
    for (std::size_t i = 0; i < spans.u.size(); ++i)
      n.v[j] = std::max(n.v[j], detail::rows_for(spans.at(i, j), spans.u[i].length() / n.u[i],
                                                 spans.v[j].length(), deflection, max_edge));
  n.total = 2 * sum(n.u) * sum(n.v);
  if (n.total < best.total) best = std::move(n);
}

Counts choose(const Spans& spans, double deflection, double max_edge) {
  Counts best, square;
  for (const double share : detail::kShares) {
    consider(spans, share, deflection, max_edge, false, best);
    consider(spans, share, deflection, max_edge, true, square);
  }
  return square.total <= detail::kForShape * best.total ? square : best;
}

double proven(const Spans& spans, const Counts& n) {
  double most = 0;
  for (std::size_t j = 0; j < spans.v.size(); ++j)
    for (std::size_t i = 0; i < spans.u.size(); ++i)
      most = std::max(most, detail::deviation8(spans.at(i, j), spans.u[i].length() / n.u[i],
                                               spans.v[j].length() / n.v[j]));
  return most / 8;
}

std::vector<double> lines(const std::vector<Interval>& spans, const std::vector<double>& counts) {
  std::vector<double> out;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const auto n = static_cast<std::size_t>(counts[i]);
    for (std::size_t k = 0; k < n; ++k)
      out.push_back(spans[i].lo + spans[i].length() * (double(k) / double(n)));
  }
  out.push_back(spans.back().hi);
  // Spans of a few rounding units cannot be cut as often as others ask for.
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

Result<GridLines> grid_lines(const NurbsSurface& surface, const TessellateOptions& options) {
  const auto spans = detail::spans_of(surface, false);
  if (!spans) return spans.error();
  return detail::grid_lines(*spans, options);
}

Result<GridLines> detail::grid_lines(const Spans& spans, const TessellateOptions& options) {
  if (auto ok = check_budget(spans, options); !ok) return ok.error();
  const auto most = static_cast<double>(options.max_triangles);
  double deflection = options.deflection_mm;
  Counts counts = choose(spans, deflection, options.max_edge_mm);
  // Without a bound on the edges the count falls to one cell a piece in the end.
  if (counts.total > most) counts = choose(spans, deflection, 0);
  while (counts.total > most) {
    const double far = counts.total / most;
    deflection *= far > 4 * kCoarser ? far / 4 : kCoarser;
    counts = choose(spans, deflection, 0);
    if (!std::isfinite(deflection))
      return Error{ErrorCode::range, "a surface too large to be cut in triangles", {}};
  }
  return GridLines{lines(spans.u, counts.u), lines(spans.v, counts.v), proven(spans, counts)};
}

}  // namespace burin::geom
