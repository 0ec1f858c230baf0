// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/edges.h"
#include "burin/geom/mesh/mesh_index.h"

namespace burin::geom {

namespace {

/// Triangles that hang together.
struct Shell {
  std::vector<std::uint32_t> triangles;
  Box3 box;
  double volume = 0;
};

void turn(std::array<std::uint32_t, 3>& t) {
  std::swap(t[1], t[2]);
}

/// Makes neighbours agree, shell by shell, with the sense that most triangles of it have. Nothing when some
/// cannot.
std::optional<std::vector<Shell>> agreed_shells(Mesh& mesh, const Edges& edges) {
  enum : unsigned char { kOpen, kKept, kTurned };
  std::vector<unsigned char> state(mesh.triangles.size(), kOpen);
  std::vector<Shell> shells;
  for (std::uint32_t first = 0; first < state.size(); ++first) {
    if (state[first] != kOpen || !is_triangle(mesh, first)) continue;
    Shell shell;
    shell.triangles.push_back(first);
    state[first] = kKept;
    std::size_t turned = 0;
    for (std::size_t i = 0; i < shell.triangles.size(); ++i) {
      const std::uint32_t t = shell.triangles[i];
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        const HalfEdge other = edges.twin[h];
        if (!is_pair(other)) continue;
        const bool same_way = from(mesh, h) == from(mesh, other);
        const unsigned char wanted = same_way == (state[t] == kKept) ? kTurned : kKept;
        unsigned char& found = state[other / 3];
        if (found == kOpen) {
          found = wanted;
          turned += wanted == kTurned;
          shell.triangles.push_back(other / 3);
        } else if (found != wanted) {
          return std::nullopt;
        }
      }
    }
    const unsigned char to_turn = 2 * turned > shell.triangles.size() ? kKept : kTurned;
    for (const std::uint32_t t : shell.triangles) {
      if (state[t] == to_turn)
        state[t] = kTurned;
      else
        state[t] = kKept;
    }
    shells.push_back(std::move(shell));
  }
  for (std::size_t t = 0; t < state.size(); ++t) {
    if (state[t] == kTurned) turn(mesh.triangles[t]);
  }
  return shells;
}

void measure(const Mesh& mesh, Shell& shell) {
  for (const std::uint32_t t : shell.triangles) {
    for (const std::uint32_t i : mesh.triangles[t]) shell.box.add(mesh.vertices[i]);
  }
  const Point3 o = lerp(shell.box.lo, shell.box.hi, 0.5);
  for (const std::uint32_t t : shell.triangles) {
    const auto& c = mesh.triangles[t];
    shell.volume += dot(mesh.vertices[c[0]] - o, cross(mesh.vertices[c[1]] - o, mesh.vertices[c[2]] - o)) / 6;
  }
}

bool holds(const Box3& outer, const Box3& inner) {
  return outer.contains(inner.lo) && outer.contains(inner.hi);
}

/// For each shell the outermost one that it lies in, or itself.
std::vector<std::size_t> outermost(const Mesh& mesh, const std::vector<Shell>& shells) {
  /// More are taken one by one: comparing them all would take its time.
  constexpr std::size_t kMostNested = 4096;
  std::vector<std::size_t> out(shells.size()), order(shells.size()), outer;
  std::iota(out.begin(), out.end(), std::size_t{0});
  if (shells.size() < 2 || shells.size() > kMostNested) return out;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(shells[a].volume) > std::abs(shells[b].volume);
  });
  std::vector<std::optional<MeshIndex>> index(shells.size());
  for (const std::size_t i : order) {
    const Point3 somewhere = mesh.vertices[mesh.triangles[shells[i].triangles.front()][0]];
    for (const std::size_t k : outer) {
      if (!holds(shells[k].box, shells[i].box)) continue;
      if (!index[k]) {
        Mesh part{mesh.vertices, {}};
        for (const std::uint32_t t : shells[k].triangles) part.triangles.push_back(mesh.triangles[t]);
        index[k].emplace(part);
      }
      if (index[k]->inside(somewhere)) {
        out[i] = k;
        break;
      }
    }
    if (out[i] == i) outer.push_back(i);
  }
  return out;
}

}  // namespace

bool orient(Mesh& mesh) {
  const Edges edges = find_edges(mesh);
  if (edges.shared_by_many > 0) return false;
  auto shells = agreed_shells(mesh, edges);
  if (!shells) return false;
  for (Shell& shell : *shells) measure(mesh, shell);
  // What lies in a shell keeps its sense against it: a hollow stays one, and a body in a body.
  const std::vector<std::size_t> around = outermost(mesh, *shells);
  for (std::size_t i = 0; i < shells->size(); ++i) {
    if ((*shells)[around[i]].volume >= 0) continue;
    for (const std::uint32_t t : (*shells)[i].triangles) turn(mesh.triangles[t]);
  }
  return true;
}

}  // namespace burin::geom
