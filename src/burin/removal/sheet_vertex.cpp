// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/sheet_vertex.h"

namespace burin::removal {
namespace {

using geom::component;
using geom::Point3;
using geom::Vec3;
using Matrix = std::array<std::array<double, 3>, 3>;

// A direction whose share of the planes is below this is that of an edge or a face: the place stays at the
// mean of the crossings there. Two faces that meet at 20 degrees still make an edge.
constexpr double kLeastShare = 0.03;
// Of the cell: places of neighbouring cells stay apart.
constexpr double kMargin = 1e-3;

/// Jacobi: a becomes diagonal, columns of v its eigenvectors.
void diagonalise(Matrix& a, Matrix& v) {
  v = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  constexpr int kSweeps = 12;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t p = 0; p < 2; ++p) {
      for (std::size_t q = p + 1; q < 3; ++q) {
        constexpr double kZero = 1e-14;
        if (std::abs(a[p][q]) < kZero) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (std::size_t k = 0; k < 3; ++k) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
        }
        for (auto& row : v) {
          const double x = row[p], y = row[q];
          row[p] = c * x - s * y, row[q] = s * x + c * y;
        }
      }
    }
  }
}

}  // namespace

void SheetVertex::add(const Crossing& c) {
  const std::array<double, 3> n{c.n.x, c.n.y, c.n.z};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) planes_[i][j] += n[i] * n[j];
  const Vec3 p = c.p - Point3{};
  pull_ = pull_ + dot(c.n, p) * c.n;
  sum_ = sum_ + p;
  ++count_;
}

Point3 SheetVertex::place(const geom::Box3& cell) const {
  const Vec3 mean = sum_ / count_;
  Matrix a = planes_, v;
  diagonalise(a, v);
  const auto times = [&](Vec3 x) {
    return Vec3{planes_[0][0] * x.x + planes_[0][1] * x.y + planes_[0][2] * x.z,
                planes_[1][0] * x.x + planes_[1][1] * x.y + planes_[1][2] * x.z,
                planes_[2][0] * x.x + planes_[2][1] * x.y + planes_[2][2] * x.z};
  };
  const Vec3 rest = pull_ - times(mean);
  const double most = std::max({a[0][0], a[1][1], a[2][2]});
  Vec3 move;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(a[i][i] > kLeastShare * most)) continue;
    const Vec3 e{v[0][i], v[1][i], v[2][i]};
    move = move + (dot(e, rest) / a[i][i]) * e;
  }
  Point3 p = Point3{} + mean + move;
  for (std::size_t i = 0; i < 3; ++i) {
    const double lo = component(cell.lo, i), hi = component(cell.hi, i), margin = kMargin * (hi - lo);
    geom::set_component(p, i, std::clamp(component(p, i), lo + margin, hi - margin));
  }
  return p;
}

}  // namespace burin::removal
