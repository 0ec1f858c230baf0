// SPDX-License-Identifier: Apache-2.0
// For tests: a face-milling plan made up without the planner. Paths over a wavy face beside a wall, angles,
// radii and maps from formulas.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "burin/view/orient_html.h"

namespace burin::view::sample {

inline constexpr double kDegree = geom::kPi / 180;

struct WavyFace {
  static constexpr double kX = 240, kY = 140, kRadius = 25;
  orient::Part part;
  orient::OrientPlan plan;
  model::Mill mill;
  orient::OrientOptions options;
  Diagnostics diagnostics;
  std::vector<OrientPicture::PointMap> maps;

  static double height(double x, double y) { return 9 * std::cos(x / 38) * std::cos(y / 45) + 0.06 * x; }

  /// Triangles: 2 * cells^2 of the face, 12 of the wall. A map at every `map_every`-th point.
  explicit WavyFace(int cells = 30, std::size_t paths = 7, std::size_t points = 60,
                    std::size_t map_every = 10, int map_nodes = 33) {
    mill.radius = kRadius, mill.length = 40, mill.holder = {{18, 50}, {32, 30}};
    part.name = "wavy <face>";
    add_face(cells);
    add_wall();
    for (std::size_t k = 0; k < paths; ++k) add_path(k, paths, points, map_every, map_nodes);
    finish();
    diagnostics.info("note", "a </script> \xff message");
    diagnostics.add({Severity::left_out, "unreachable", "not reached", {}, std::array{30.0, 40.0, 5.0}});
  }

  OrientPicture picture() const {
    OrientPicture p;
    p.title = "wavy <&> \"@DATA@\" \xff";
    p.command_line = "burin orient wavy.toml </script><script>alert(1)";
    p.part = &part, p.plan = &plan, p.mill = &mill, p.options = &options, p.diagnostics = &diagnostics;
    p.maps = maps;
    p.figures = {{"Counts", "contact_points", std::to_string(plan.contact_points)},
                 {"Quality", "axis_step_max_deg", "2.25"}};
    p.nc_text = "%\n(</script>)\nG43.4 H1\n";
    return p;
  }

  static orient::Cause cause_at(const orient::Angles& a, double x, double y) {
    const double alpha = a.alpha / kDegree, beta = a.beta / kDegree;
    if (alpha < 3 + 3 * (1 + std::sin(x / 30)) + std::pow((beta - 20 * std::sin(y / 25)) / 12, 2))
      return orient::Cause::gouge;
    if (beta < -70 + 0.4 * y + 1.5 * alpha) return orient::Cause::collision;
    return beta > 80 ? orient::Cause::limit : orient::Cause::none;
  }

 private:
  void add_face(int cells) {
    const auto n = static_cast<std::uint32_t>(cells + 1);
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) {
        const double x = kX * i / cells, y = kY * j / cells;
        part.mesh.vertices.push_back({x, y, height(x, y)});
      }
    for (std::uint32_t j = 0; j + 1 < n; ++j)
      for (std::uint32_t i = 0; i + 1 < n; ++i) {
        const std::uint32_t a = i + j * n;
        part.mesh.triangles.push_back({a, a + 1, a + n + 1});
        part.mesh.triangles.push_back({a, a + n + 1, a + n});
      }
    part.design_triangles = part.mesh.triangles.size();
  }
  void add_wall() {
    const auto base = static_cast<std::uint32_t>(part.mesh.vertices.size());
    for (std::uint32_t k = 0; k < 8; ++k)
      part.mesh.vertices.push_back({k & 1u ? kX : 0, kY + (k & 2u ? 26.0 : 14.0), k & 4u ? 55.0 : -10.0});
    const std::uint32_t quads[6][4]{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& q : quads) {
      part.mesh.triangles.push_back({base + q[0], base + q[1], base + q[2]});
      part.mesh.triangles.push_back({base + q[0], base + q[2], base + q[3]});
    }
    for (const geom::Point3 p : part.mesh.vertices) part.bounds.add(p);
  }
  orient::OrientedPoint point(double x, double y, std::size_t number) const {
    const double h = 1e-4, dx = (height(x + h, y) - height(x - h, y)) / (2 * h),
                 dy = (height(x, y + h) - height(x, y - h)) / (2 * h);
    orient::OrientedPoint p;
    p.cc.c = {x, y, height(x, y)};
    p.cc.n = unit(geom::Vec3{-dx, -dy, 1}), p.cc.f = unit(geom::Vec3{1, 0, dx});
    p.reachable = number % 23 != 22;
    p.initial_found = number % 17 != 16;
    const double lean = 20 * std::sin(y / 25) * kDegree;
    // At the border of what cause_at() calls a gouge: yaw 0 first, then its least tilt.
    p.initial = {(6.05 + 3 * std::sin(x / 30) + std::pow(lean / kDegree / 12, 2)) * kDegree, 0};
    p.angles = {(6.05 + 3 * std::sin(x / 30) + std::pow(0.2 * lean / kDegree / 12, 2)) * kDegree, 0.8 * lean};
    p.rho = effective_radius(p.angles, mill), p.rho_initial = effective_radius(p.initial, mill);
    p.strip = {1.2 + 0.4 * std::sin(x / 50), 1.5};
    p.tests = static_cast<std::uint32_t>(18 + number % 9);
    p.cause = number % 5 ? orient::Cause::gouge : orient::Cause::collision;
    return p;
  }
  void add_path(std::size_t k, std::size_t paths, std::size_t points, std::size_t map_every, int nodes) {
    orient::OrientedPath path;
    path.number = static_cast<int>(k), path.face = 0;
    path.at = paths > 1 ? static_cast<double>(k) / static_cast<double>(paths - 1) : 0;
    for (std::size_t i = 0; i < points; ++i) {
      const double x =
          kX * static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(1, points - 1));
      path.points.push_back(point(x, kY * path.at, i));
      if (map_every > 0 && i % map_every == map_every / 2) add_map(k, i, path.points.back().cc.c, nodes);
    }
    plan.paths.push_back(path);
  }
  void add_map(std::size_t path, std::size_t number, geom::Point3 c, int nodes) {
    orient::CSpaceMap map{options.range, nodes, nodes, {}};
    const orient::AngleRange& r = map.range;
    for (int j = 0; j < nodes; ++j)
      for (int i = 0; i < nodes; ++i)
        map.cells.push_back(cause_at({r.alpha_lo + (r.alpha_hi - r.alpha_lo) * i / (nodes - 1),
                                      r.beta_lo + (r.beta_hi - r.beta_lo) * j / (nodes - 1)},
                                     c.x, c.y));
    maps.push_back({path, number, map});
  }
  void finish() {
    double sum = 0;
    std::size_t both = 0;
    for (const orient::OrientedPath& path : plan.paths) {
      double own = 0;
      std::size_t n = 0;
      for (const orient::OrientedPoint& p : path.points) {
        ++plan.contact_points, plan.tests += p.tests;
        if (!p.reachable) ++plan.unreachable;
        if (p.reachable && p.initial_found) own += p.rho / p.rho_initial - 1, ++n;
      }
      plan.gain_per_path.push_back(n ? own / static_cast<double>(n) : 0);
      sum += own, both += n;
      plan.cut_mm += kX;
    }
    plan.gain_mean = both ? sum / static_cast<double>(both) : 0;
    plan.axis_step_max = 2.25 * kDegree;
    orient::Comparison sturz, ball;
    sturz.name = "sturz", sturz.possible = true, sturz.tilt = 9.4 * kDegree, sturz.paths = 11,
    sturz.cut_mm = 2640, sturz.minutes = 2.64;
    ball.name = "ball", ball.possible = true, ball.radius_mm = 12, ball.paths = 46, ball.cut_mm = 11040,
    ball.minutes = 11.04;
    plan.comparisons = {sturz, ball};
  }
};

}  // namespace burin::view::sample
