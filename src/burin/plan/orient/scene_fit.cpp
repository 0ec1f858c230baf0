// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/scene_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace burin::orient::detail {

using geom::Point3;
using geom::Vec3;

namespace {

struct Symmetric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  void add(const Vec3& v) {
    xx += v.x * v.x, xy += v.x * v.y, xz += v.x * v.z, yy += v.y * v.y, yz += v.y * v.z, zz += v.z * v.z;
  }
};

/// The direction of least spread, by turning pairs of axes (Jacobi).
Vec3 least_spread(const Symmetric& s) {
  double m[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
  double e[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  constexpr int kSweeps = 6;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int i = 0; i < 2; ++i) {
      for (int j = i + 1; j < 3; ++j) {
        if (m[i][j] == 0) continue;
        const double turn = 0.5 * (m[j][j] - m[i][i]) / m[i][j];
        const double t = std::copysign(1.0, turn) / (std::abs(turn) + std::sqrt(turn * turn + 1));
        const double c = 1 / std::sqrt(t * t + 1), sn = t * c;
        for (auto& row : m) {
          const double a = row[i], b = row[j];
          row[i] = c * a - sn * b;
          row[j] = sn * a + c * b;
        }
        for (int k = 0; k < 3; ++k) {
          const double a = m[i][k], b = m[j][k];
          m[i][k] = c * a - sn * b;
          m[j][k] = sn * a + c * b;
        }
        for (auto& row : e) {
          const double a = row[i], b = row[j];
          row[i] = c * a - sn * b;
          row[j] = sn * a + c * b;
        }
      }
    }
  }
  int least = 0;
  for (int i = 1; i < 3; ++i)
    if (m[i][i] < m[least][least]) least = i;
  return geom::unit({e[0][least], e[1][least], e[2][least]});
}

struct Extent {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  void add(double x) {
    lo = std::min(lo, x);
    hi = std::max(hi, x);
  }
  double width() const { return hi - lo; }
};

Vec3 across(const Vec3& n) {
  const Vec3 side = std::abs(n.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return geom::unit(cross(n, side));
}

/// Of both candidates the one along which the corners spread less; of directions in its plane the one with
/// the least area.
std::array<Vec3, 3> directions(const std::vector<Vec3>& corners, const Vec3& normal) {
  Vec3 mean;
  for (const Vec3& v : corners) mean = mean + v;
  mean = mean / static_cast<double>(corners.size());
  Symmetric spread;
  for (const Vec3& v : corners) spread.add(v - mean);
  Vec3 n = least_spread(spread);
  if (!(norm(n) > 0.5)) n = {0, 0, 1};
  const auto width = [&](const Vec3& d) {
    Extent e;
    for (const Vec3& v : corners) e.add(dot(v, d));
    return e.width();
  };
  if (norm(normal) > 0.5 && width(normal) < width(n)) n = normal;
  const Vec3 p = across(n), q = cross(n, p);
  constexpr int kTurns = 4;
  Vec3 best_a = p, best_b = q;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTurns; ++i) {
    const double angle = 0.5 * geom::kPi * i / kTurns, c = std::cos(angle), s = std::sin(angle);
    const Vec3 a = c * p + s * q, b = c * q - s * p;
    const double wa = width(a), wb = width(b), area = wa * wb + 1e-3 * (wa + wb) * (wa + wb);
    if (area < least) {
      least = area;
      best_a = wa >= wb ? a : b;
      best_b = wa >= wb ? b : a;
    }
  }
  return {best_a, best_b, n};
}

}  // namespace

FittedBox fit_box(const geom::Mesh& mesh, std::span<const std::uint32_t> triangles, std::size_t sample) {
  const auto corner = [&](std::uint32_t triangle, std::size_t i) -> const Point3& {
    return mesh.vertices[mesh.triangles[triangle][i]];
  };
  const Point3 ref = corner(triangles[0], 0);
  std::vector<Vec3> corners;
  const std::size_t step = (triangles.size() + sample - 1) / sample;
  corners.reserve(3 * (triangles.size() / step + 1));
  Vec3 normal;
  for (std::size_t i = 0; i < triangles.size(); i += step) {
    const Point3 &p = corner(triangles[i], 0), &q = corner(triangles[i], 1), &r = corner(triangles[i], 2);
    for (const Point3& at : {p, q, r}) corners.push_back(at - ref);
    normal = normal + cross(q - p, r - p);
  }
  FittedBox box;
  box.axis = directions(corners, geom::unit(normal));
  std::array<Extent, 3> extent;
  const auto add = [&](const Vec3& v) {
    for (std::size_t k = 0; k < 3; ++k) extent[k].add(dot(v, box.axis[k]));
  };
  if (step == 1) {
    for (const Vec3& v : corners) add(v);
  } else {
    for (const std::uint32_t t : triangles)
      for (std::size_t i = 0; i < 3; ++i) add(corner(t, i) - ref);
  }
  box.middle = ref;
  for (std::size_t k = 0; k < 3; ++k) {
    box.middle = box.middle + 0.5 * (extent[k].lo + extent[k].hi) * box.axis[k];
    box.half[k] = 0.5 * extent[k].width();
  }
  return box;
}

void put_box(const FittedBox& box, const Point3& origin, int lane, SceneNode& node) {
  const Vec3 c = box.middle - origin;
  const double size = box.half[0] + box.half[1] + box.half[2];
  // Rounding to single precision: of the middle, half a unit of each coordinate; of the axes, the same share
  // of the extents. Doubled, and what double precision loses at the place of the part.
  constexpr double kUnit = 1.0 / 16777216, kDouble = 1e-15;
  const double far = std::abs(box.middle.x) + std::abs(box.middle.y) + std::abs(box.middle.z) + size;
  const double grow = 4 * kUnit * (norm(c) + size) + kDouble * far;
  const auto put = [&](float(&to)[3][8], const Vec3& v) {
    to[0][lane] = static_cast<float>(v.x);
    to[1][lane] = static_cast<float>(v.y);
    to[2][lane] = static_cast<float>(v.z);
  };
  put(node.c, c);
  put(node.a, (box.half[0] + grow) * box.axis[0]);
  put(node.b, (box.half[1] + grow) * box.axis[1]);
  put(node.n, box.axis[2]);
  node.t[lane] = static_cast<float>(box.half[2] + grow);
  node.reach = std::max(node.reach, static_cast<float>((norm(c) + size + 4 * grow) * (1 + 2 * kUnit)));
  node.used |= 1 << lane;
}

}  // namespace burin::orient::detail
