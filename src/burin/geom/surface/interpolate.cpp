// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/interpolate.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "burin/geom/point_tools.h"
#include "burin/geom/surface/basis.h"

namespace burin::geom {
namespace {

constexpr int kDegree = 3;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

Error bad(std::string message) {
  return {ErrorCode::geometry, std::move(message), {}};
}

/// A grid seen along one direction: `lines` sequences of `count` points.
struct Lines {
  const std::vector<Point3>* points = nullptr;
  int count = 0, lines = 0;
  std::size_t step = 0, line_step = 0;
  const Point3& at(int line, int i) const { return (*points)[index(line) * line_step + index(i) * step]; }
};

/// Centripetal parameters in [0, 1] of one line; empty when it has no length.
std::vector<double> centripetal(const Lines& lines, int line) {
  std::vector<double> t(index(lines.count), 0.0);
  for (int i = 1; i < lines.count; ++i)
    t[index(i)] = t[index(i - 1)] + std::sqrt(distance(lines.at(line, i), lines.at(line, i - 1)));
  const double total = t.back();
  if (!(total > 0)) return {};
  for (double& x : t) x /= total;
  t.back() = 1;
  return t;
}

Result<std::vector<double>> averaged_parameters(const Lines& lines, const std::string& name) {
  std::vector<double> mean(index(lines.count), 0.0);
  int used = 0;
  for (int line = 0; line < lines.lines; ++line) {
    const std::vector<double> t = centripetal(lines, line);
    if (t.empty()) {
      const bool end = line == 0 || line + 1 == lines.lines;
      if (end && lines.lines - used > 1 && used == line) continue;
      return bad(name + " " + std::to_string(line + 1) +
                 " of the points has no length (only one at an end may be a single place)");
    }
    for (int i = 0; i < lines.count; ++i) mean[index(i)] += t[index(i)];
    ++used;
  }
  for (double& x : mean) x /= used;
  for (int i = 1; i < lines.count; ++i) {
    if (mean[index(i)] > mean[index(i - 1)]) continue;
    return bad("points " + std::to_string(i) + " and " + std::to_string(i + 1) + " of every " + name +
               " are the same (places that differ)");
  }
  mean.front() = 0, mean.back() = 1;
  return mean;
}

/// The NURBS Book, eq. 9.8.
std::vector<double> averaged_knots(const std::vector<double>& t, int degree) {
  const int n = static_cast<int>(t.size());
  std::vector<double> knots(index(degree + 1), t.front());
  for (int j = 1; j < n - degree; ++j) {
    double sum = 0;
    for (int i = j; i < j + degree; ++i) sum += t[index(i)];
    knots.push_back(sum / degree);
  }
  knots.insert(knots.end(), index(degree + 1), t.back());
  return knots;
}

/// Control points from points on one line. The matrix is banded and totally positive: elimination without
/// pivoting is stable (de Boor & Pinkus 1977).
class LineSolver {
 public:
  LineSolver(const std::vector<double>& t, const std::vector<double>& knots, int degree)
      : n_(static_cast<int>(t.size())), p_(degree), band_(index(n_) * index(2 * degree + 1), 0.0) {
    detail::Basis basis;
    for (int k = 0; k < n_; ++k) {
      const int span = find_span(knots, degree, n_, t[index(k)]);
      detail::basis_derivatives(knots, degree, span, t[index(k)], 0, basis);
      for (int j = 0; j <= degree; ++j) {
        const int column = span - degree + j;
        if (std::abs(column - k) <= p_) entry(k, column) = basis.value[0][index(j)];
      }
    }
    for (int k = 0; k < n_; ++k) {
      for (int i = k + 1; i <= std::min(k + p_, n_ - 1); ++i) {
        const double factor = entry(i, k) /= entry(k, k);
        for (int j = k + 1; j <= std::min(k + p_, n_ - 1); ++j) entry(i, j) -= factor * entry(k, j);
      }
    }
  }

  void solve(std::vector<Vec3>& x) const {
    for (int i = 0; i < n_; ++i)
      for (int k = std::max(0, i - p_); k < i; ++k) x[index(i)] = x[index(i)] - entry(i, k) * x[index(k)];
    for (int i = n_ - 1; i >= 0; --i) {
      for (int k = i + 1; k <= std::min(i + p_, n_ - 1); ++k)
        x[index(i)] = x[index(i)] - entry(i, k) * x[index(k)];
      x[index(i)] = x[index(i)] / entry(i, i);
    }
  }

 private:
  double& entry(int row, int column) {
    return band_[index(row) * index(2 * p_ + 1) + index(column - row + p_)];
  }
  double entry(int row, int column) const {
    return band_[index(row) * index(2 * p_ + 1) + index(column - row + p_)];
  }

  int n_, p_;
  std::vector<double> band_;
};

void solve_lines(std::vector<Point3>& points, int count, int lines, std::size_t step, std::size_t line_step,
                 const LineSolver& solver) {
  std::vector<Vec3> x(index(count));
  for (int line = 0; line < lines; ++line) {
    for (int i = 0; i < count; ++i)
      x[index(i)] = points[index(line) * line_step + index(i) * step] - Point3{};
    solver.solve(x);
    for (int i = 0; i < count; ++i)
      points[index(line) * line_step + index(i) * step] = Point3{} + x[index(i)];
  }
}

Result<void> check(const PointGrid& grid) {
  const std::int64_t total = std::int64_t{grid.count_u} * grid.count_v;
  if (grid.count_u < 2 || grid.count_v < 2 || total > kMaxControlPoints)
    return bad("a grid of " + std::to_string(grid.count_u) + " x " + std::to_string(grid.count_v) +
               " points (at least 2 x 2, at most " + std::to_string(kMaxControlPoints) + " together)");
  if (grid.points.size() != static_cast<std::size_t>(total))
    return bad(std::to_string(grid.points.size()) + " points (" + std::to_string(total) + " for a grid of " +
               std::to_string(grid.count_u) + " x " + std::to_string(grid.count_v) + ")");
  for (std::size_t i = 0; i < grid.points.size(); ++i)
    if (!is_finite(grid.points[i])) return bad("point " + std::to_string(i + 1) + " is not finite");
  return {};
}

Result<void> check_parameters(const std::vector<double>& t, int count, const std::string& name) {
  bool fine = t.size() == index(count);
  for (std::size_t i = 0; fine && i < t.size(); ++i)
    fine = std::isfinite(t[i]) && (i == 0 || t[i] > t[i - 1]);
  if (fine) return {};
  return bad("the parameters in " + name + " do not fit (" + std::to_string(count) + " ascending numbers)");
}

}  // namespace

Result<NurbsSurface> interpolate(const PointGrid& grid, const std::vector<double>& u,
                                 const std::vector<double>& v) {
  if (auto ok = check(grid); !ok) return ok.error();
  if (auto ok = check_parameters(u, grid.count_u, "u"); !ok) return ok.error();
  if (auto ok = check_parameters(v, grid.count_v, "v"); !ok) return ok.error();
  NurbsSurface s;
  s.count_u = grid.count_u, s.count_v = grid.count_v;
  s.degree_u = std::min(kDegree, s.count_u - 1), s.degree_v = std::min(kDegree, s.count_v - 1);
  s.knots_u = averaged_knots(u, s.degree_u);
  s.knots_v = averaged_knots(v, s.degree_v);
  std::vector<Point3> points = grid.points;
  const std::size_t row = index(grid.count_u);
  solve_lines(points, s.count_u, s.count_v, 1, row, LineSolver(u, s.knots_u, s.degree_u));
  solve_lines(points, s.count_v, s.count_u, row, 1, LineSolver(v, s.knots_v, s.degree_v));
  s.points.reserve(points.size());
  for (const Point3& p : points) s.points.push_back(homogeneous(p, 1));
  if (auto ok = validate(s); !ok) return ok.error();
  return s;
}

Result<NurbsSurface> interpolate(const PointGrid& grid) {
  if (auto ok = check(grid); !ok) return ok.error();
  const std::size_t row = index(grid.count_u);
  auto u = averaged_parameters({&grid.points, grid.count_u, grid.count_v, 1, row}, "row");
  if (!u) return u.error();
  auto v = averaged_parameters({&grid.points, grid.count_v, grid.count_u, row, 1}, "column");
  if (!v) return v.error();
  return interpolate(grid, *u, *v);
}

}  // namespace burin::geom
