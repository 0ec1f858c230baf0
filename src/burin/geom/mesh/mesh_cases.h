// SPDX-License-Identifier: Apache-2.0
// Meshes with known geometry for tests and benchmarks.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include "burin/geom/mesh/mesh.h"

namespace burin::geom::cases {

/// A grid of nu x nv cells, closed in u (first column = last); quads cut in two.
inline Mesh tube(std::uint32_t nu, std::uint32_t nv, const std::function<Point3(double u, double v)>& at) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= nv; ++j) {
    for (std::uint32_t i = 0; i < nu; ++i) mesh.vertices.push_back(at(i / double(nu), j / double(nv)));
  }
  for (std::uint32_t j = 0; j < nv; ++j) {
    for (std::uint32_t i = 0; i < nu; ++i) {
      const std::uint32_t a = j * nu + i, b = j * nu + (i + 1) % nu;
      mesh.triangles.push_back({a, b, a + nu});
      mesh.triangles.push_back({b, b + nu, a + nu});
    }
  }
  return mesh;
}

/// Closes the first and the last ring of a tube with fans about their middles.
inline void cap(Mesh& mesh, std::uint32_t nu, std::uint32_t nv) {
  for (const std::uint32_t row : {0U, nv * nu}) {
    Vec3 sum;
    for (std::uint32_t i = 0; i < nu; ++i) sum = sum + (mesh.vertices[row + i] - Point3{});
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(Point3{} + sum / double(nu));
    for (std::uint32_t i = 0; i < nu; ++i) {
      const std::uint32_t a = row + i, b = row + (i + 1) % nu;
      if (row == 0) {
        mesh.triangles.push_back({middle, b, a});
      } else {
        mesh.triangles.push_back({middle, a, b});
      }
    }
  }
}

/// A closed shaft about X from 0 to `length`, its radius a function of angle (u, turns) and x: outside
/// outwards.
inline Mesh shaft(std::uint32_t nu, std::uint32_t nv, double length,
                  const std::function<double(double u, double x)>& radius) {
  Mesh mesh = tube(nu, nv, [&](double u, double v) {
    const double r = radius(u, v * length), a = 2 * kPi * u;
    return Point3{v * length, r * std::cos(a), r * std::sin(a)};
  });
  cap(mesh, nu, nv);
  return mesh;
}

/// Sphere about c: rings about X, closed at the poles.
inline Mesh sphere(std::uint32_t nu, std::uint32_t nv, Point3 c, double r) {
  // Inner rings only; fans close the poles.
  Mesh mesh = tube(nu, nv - 2, [&](double u, double v) {
    const double polar = kPi * (1 + v * (nv - 2)) / nv, a = 2 * kPi * u;
    return c + r * Vec3{-std::cos(polar), std::sin(polar) * std::cos(a), std::sin(polar) * std::sin(a)};
  });
  cap(mesh, nu, nv - 2);
  mesh.vertices[mesh.vertices.size() - 2] = c + Vec3{-r, 0, 0};
  mesh.vertices.back() = c + Vec3{r, 0, 0};
  return mesh;
}

inline Mesh box(Point3 lo, Point3 hi) {
  Mesh mesh;
  for (unsigned i = 0; i < 8; ++i)
    mesh.vertices.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline Mesh torus(std::uint32_t nu, std::uint32_t nv, double big, double small) {
  Mesh mesh = tube(nu, nv, [&](double u, double v) {
    const double a = 2 * kPi * u, b = 2 * kPi * v, r = big + small * std::cos(a);
    return Point3{-small * std::sin(a), r * std::cos(b), r * std::sin(b)};
  });
  for (auto& t : mesh.triangles) {
    for (auto& i : t) i %= nu * nv;  // the last ring is the first
  }
  mesh.vertices.resize(nu * nv);
  return mesh;
}

/// The section of a side-milling cutter with `teeth`, turned along X: deep flutes, sharp edges.
inline Mesh cutter(std::uint32_t triangles, double length, double outer, double inner, int teeth,
                   double turns) {
  const auto nu = static_cast<std::uint32_t>(std::sqrt(triangles / 2.0)), nv = triangles / 2 / nu;
  Mesh mesh = tube(nu, nv, [&](double u, double v) {
    const double tooth = u * teeth - std::floor(u * teeth);
    const double r = tooth < 0.15 ? outer : inner + (outer - inner) * std::pow((tooth - 0.15) / 0.85, 2);
    const double a = 2 * kPi * (u + turns * v);
    return Point3{v * length, r * std::cos(a), r * std::sin(a)};
  });
  cap(mesh, nu, nv);
  return mesh;
}

/// Triangles anywhere in a cube of 100 mm; `size` of them, some needles, some without area, corners shared.
inline Mesh soup(std::mt19937& random, std::size_t count, double size) {
  std::uniform_real_distribution<double> place(-50, 50), step(-size, size), unit(0, 1);
  Mesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const Point3 p{place(random), place(random), place(random)};
    const Vec3 e{step(random), step(random), step(random)}, f{step(random), step(random), step(random)};
    const double kind = unit(random);
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(p);
    mesh.vertices.push_back(p + e);
    if (kind < 0.6) {
      mesh.vertices.push_back(p + f);
    } else if (kind < 0.8) {
      mesh.vertices.push_back(p + unit(random) * e + std::pow(10, -12 * unit(random)) * f);  // needle
    } else if (kind < 0.9) {
      mesh.vertices.push_back(p + unit(random) * e);  // no area
    } else if (kind < 0.95) {
      mesh.vertices.push_back(p);  // two corners at one place
    } else {
      mesh.vertices.back() = p;  // a point
      mesh.vertices.push_back(p);
    }
    mesh.triangles.push_back({n, n + 1, n + 2});
  }
  return mesh;
}

}  // namespace burin::geom::cases
