// SPDX-License-Identifier: Apache-2.0
// What reachable angles are measured on: a cutter with six hooked flutes, 50 mm long, turned by 180 degrees,
// as a mesh of about `triangles`, and places of the ball that touch it without gouging, ring by ring.
#pragma once

#include <map>

#include "burin/model/tool.h"
#include "burin/plan/rotary/reach_cases.h"

namespace burin::rotary::bench {

/// Ball and shank of 2 mm, a holder that begins 60 mm above the ball.
inline model::BallTool tool() {
  model::BallTool t;
  t.radius = t.shank_radius = 2;
  t.shank_length = 60;
  t.holder = {{20, 50}};
  return t;
}
/// A short shank: the holder is among the teeth and beside the part.
inline model::BallTool short_tool() {
  model::BallTool t = tool();
  t.shank_length = 14;
  t.holder = {{5, 30}, {20, 50}};
  return t;
}

struct Case {
  geom::Mesh mesh;
  std::vector<geom::Point3> centers;
};

inline Case make_case(int triangles) {
  const int around = static_cast<int>(std::sqrt(triangles * 0.5 * 3)), along = triangles / 2 / around;
  auto section = cases::star(around, [](double a) { return 21 - 4 * std::cos(6 * a); });
  for (geom::Point2& p : section) {
    const double rho = std::hypot(p.x, p.y), a = std::atan2(p.y, p.x) - 0.06 * (rho - 17);
    p = {rho * std::cos(a), rho * std::sin(a)};
  }
  Case out;
  out.mesh = cases::swept(section, 50, geom::kPi, along);
  const auto& m = out.mesh;
  constexpr int kRings = 8, kPerRing = 64;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int k = 0; k < kPerRing; ++k) {
      const int row = along * (2 * ring + 1) / (2 * kRings), column = around * k / kPerRing;
      const auto& t = m.triangles[static_cast<std::size_t>(row * around + column) * 2];
      const geom::Point3 a = m.vertices[t[0]], b = m.vertices[t[1]], c = m.vertices[t[2]];
      const double r = tool().radius;
      const geom::Point3 center = a + ((b - a) + (c - a)) / 3.0 + r * unit(cross(b - a, c - a));
      bool free = true;
      for (std::size_t i = 0; i < m.triangles.size() && free; ++i) {
        const auto& q = m.triangles[i];
        if (std::abs(m.vertices[q[0]].x - center.x) > 2 * r) continue;
        if (std::abs(m.vertices[q[0]].y - center.y) > 2 * r) continue;
        free = cases::distance_to_triangle(center, m.vertices[q[0]], m.vertices[q[1]], m.vertices[q[2]]) >
               r - 1e-9;
      }
      if (free) out.centers.push_back(center);
    }
  }
  return out;
}
inline const Case& the_case(int triangles) {
  static std::map<int, Case> made;
  const auto found = made.find(triangles);
  return found != made.end() ? found->second : made.emplace(triangles, make_case(triangles)).first->second;
}

}  // namespace burin::rotary::bench
