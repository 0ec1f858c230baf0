// SPDX-License-Identifier: Apache-2.0
// How many columns and rows each span of the knots gets.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "burin/geom/surface/second_bounds.h"
#include "burin/geom/surface/tessellate.h"

namespace burin::geom {
namespace {

/// The share of the deflection that the curvature along u may take: candidates, the cheapest wins.
constexpr double kShares[] = {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95};
/// Twisted pieces can be cut into long slivers or into squares at nearly the same price: squares may cost
/// this much more.
constexpr double kForShape = 1.25;
/// Steps of the deflection when there would be too many triangles.
constexpr double kCoarser = 1.1;
/// Of all pieces together: surfaces of many pieces have few cells in each, whose bounds matter less.
constexpr double kHalvings = 100'000;
constexpr std::size_t kMostPoints = 16'000'000;  ///< of all pieces: half a gigabyte

struct Spans {
  std::vector<Interval> u, v;
  std::vector<detail::SecondBounds> bounds;  ///< [i + j * u.size()]
  const detail::SecondBounds& at(std::size_t i, std::size_t j) const { return bounds[i + j * u.size()]; }
};

/// Pieces, and points of all of them, as they would be: knots may be many times as many as points.
struct Size {
  std::size_t pieces = 0, points = 0;
};
Size size_of(const NurbsSurface& surface) {
  const std::size_t u = inner_knots(surface.knots_u, surface.degree_u).size() + 1;
  const std::size_t v = inner_knots(surface.knots_v, surface.degree_v).size() + 1;
  return {u * v, u * v * static_cast<std::size_t>((surface.degree_u + 1) * (surface.degree_v + 1))};
}

Spans spans_of(const NurbsSurface& surface) {
  Spans spans;
  const std::vector<BezierPatch> patches = bezier_patches(surface);
  const int halvings =
      std::min(detail::kMostHalvings, static_cast<int>(kHalvings / static_cast<double>(patches.size())));
  for (const BezierPatch& patch : patches) {
    if (patch.v == patches.front().v) spans.u.push_back(patch.u);
    if (patch.u == patches.front().u) spans.v.push_back(patch.v);
    spans.bounds.push_back(detail::second_bounds(patch, halvings));
  }
  return spans;
}

struct Counts {
  std::vector<double> u, v;  ///< whole numbers, as doubles: they may be huge before they are refused
  double total = std::numeric_limits<double>::infinity();
};

double sum(const std::vector<double>& n) {
  double s = 0;
  for (const double x : n) s += x;
  return s;
}

/// The largest b with a^2 uu + 2 a b uv + b^2 vv <= eight_d.
double widest(double a, const detail::SecondBounds& m, double eight_d) {
  const double left = eight_d - a * a * m.uu;
  if (!(left > 0)) return 0;
  const double x = a * m.uv, denominator = x + std::sqrt(x * x + m.vv * left);
  return denominator > 0 ? left / denominator : std::numeric_limits<double>::infinity();
}

class Chooser {
 public:
  Chooser(const Spans& spans, double max_edge) : spans_(&spans), max_edge_(max_edge) {}

  Counts choose(double deflection) const {
    Counts best, square;
    for (const double share : kShares) {
      consider(share, deflection, false, best);
      consider(share, deflection, true, square);
    }
    return square.total <= kForShape * best.total ? square : best;
  }

  double deflection(const Counts& n) const {
    double most = 0;
    for (std::size_t j = 0; j < spans_->v.size(); ++j) {
      for (std::size_t i = 0; i < spans_->u.size(); ++i) {
        const auto& m = spans_->at(i, j);
        const double a = spans_->u[i].length() / n.u[i], b = spans_->v[j].length() / n.v[j];
        most = std::max(most, (a * a * m.uu + 2 * a * b * m.uv + b * b * m.vv) / 8);
      }
    }
    return most;
  }

 private:
  /// No edge longer than max_edge: the diagonal is at most the sum of the two sides.
  double for_edges(double speed, double length) const {
    return max_edge_ > 0 ? std::ceil(2 * speed * length / max_edge_) : 1;
  }

  void consider(double share, double deflection, bool square, Counts& best) const {
    const double eight_d = 8 * deflection;
    Counts n;
    n.u.assign(spans_->u.size(), 1.0);
    n.v.assign(spans_->v.size(), 1.0);
    for (std::size_t j = 0; j < spans_->v.size(); ++j) {
      for (std::size_t i = 0; i < spans_->u.size(); ++i) {
        const auto& m = spans_->at(i, j);
        const double length = spans_->u[i].length();
        double wanted =
            std::max(std::ceil(length * std::sqrt(m.uu / (share * eight_d))), for_edges(m.u, length));
        if (square && m.v > 0)
          wanted = std::max(wanted, std::ceil(length * std::sqrt(m.uv * (m.u / m.v) / (0.5 * eight_d))));
        n.u[i] = std::max(n.u[i], wanted);
      }
    }
    for (std::size_t j = 0; j < spans_->v.size(); ++j) {
      for (std::size_t i = 0; i < spans_->u.size(); ++i) {
        const auto& m = spans_->at(i, j);
        const double length = spans_->v[j].length(), b = widest(spans_->u[i].length() / n.u[i], m, eight_d);
        n.v[j] = std::max({n.v[j], std::ceil(length / b), for_edges(m.v, length)});
      }
    }
    n.total = 2 * sum(n.u) * sum(n.v);
    if (n.total < best.total) best = std::move(n);
  }

  const Spans* spans_;
  double max_edge_;
};

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
  if (!(options.deflection_mm > 0) || !(options.max_edge_mm >= 0))
    return Error{ErrorCode::range, "the deflection or the longest edge of triangles is not positive", {}};
  if (auto ok = validate(surface); !ok) return ok.error();
  const auto most = static_cast<double>(options.max_triangles);
  const Size size = size_of(surface);
  if (2 * static_cast<double>(size.pieces) > most || size.points > kMostPoints)
    return Error{ErrorCode::range,
                 "a surface of " + std::to_string(size.pieces) + " pieces (at most " +
                     std::to_string(options.max_triangles / 2) + " for " +
                     std::to_string(options.max_triangles) + " triangles)",
                 {}};
  const Spans spans = spans_of(surface);
  Chooser chooser(spans, options.max_edge_mm);
  double deflection = options.deflection_mm;
  Counts counts = chooser.choose(deflection);
  if (counts.total > most) {
    // Without a bound on the edges the count falls to one cell a piece in the end.
    chooser = Chooser(spans, 0);
    counts = chooser.choose(deflection);
    while (counts.total > most) {
      const double far = counts.total / most;
      deflection *= far > 4 * kCoarser ? far / 4 : kCoarser;
      counts = chooser.choose(deflection);
      if (!std::isfinite(deflection))
        return Error{ErrorCode::range, "a surface too large to be cut in triangles", {}};
    }
  }
  return GridLines{lines(spans.u, counts.u), lines(spans.v, counts.v), chooser.deflection(counts)};
}

}  // namespace burin::geom
