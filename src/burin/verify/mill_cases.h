// SPDX-License-Identifier: Apache-2.0
// Triangles and paths that tests of mills are made of.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/verify/path.h"

namespace burin::verify::cases {

/// f(u, v) on a grid over [0, 1]^2.
template <class F>
geom::Mesh grid(int nu, int nv, F&& f) {
  geom::Mesh m;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) m.vertices.push_back(f(double(i) / nu, double(j) / nv));
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (nu + 1) + i), b = a + static_cast<std::uint32_t>(nu) + 1;
      m.triangles.push_back({a, a + 1, b + 1});
      m.triangles.push_back({a, b + 1, b});
    }
  return m;
}

inline geom::Mesh box(geom::Point3 lo, geom::Point3 hi) {
  geom::Mesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

/// The motion begins in the first pose; each after it is a move of its own, numbered like it. `rapid` says
/// which are rapids (those it does not reach are not).
inline CheckedPath path_of(const CheckedMill& tool, const std::vector<cl::Pose>& poses,
                           const std::vector<bool>& rapid = {}) {
  CheckedPath path;
  path.tools.push_back({tool, 1, poses.empty() ? cl::Pose{} : poses.front(), {}});
  path.moves.resize(poses.size());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    path.moves[i].rapid = i < rapid.size() && rapid[i];
    path.tools[0].pieces.push_back({poses[i], static_cast<std::uint32_t>(i), path.moves[i].rapid});
  }
  return path;
}

}  // namespace burin::verify::cases
