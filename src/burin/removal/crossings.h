// SPDX-License-Identifier: Apache-2.0
// Nodes where lines of all directions meet, and where the surface crosses the edges between them. Internal to
// removal. mm.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burin/removal/dexels.h"

namespace burin::removal {

/// A place of the surface, relative to the corner of the grid, and its normal.
struct Crossing {
  geom::Point3 p;
  geom::Vec3 n;
  bool known = false;  ///< from a dexel; else the middle of the edge
};

/// Nodes are numbered from 1: 0 and count + 1 are a border of empty ones.
class Crossings {
 public:
  /// Three fields along X, Y, Z, or one along Z.
  Crossings(const Grid& grid, const std::vector<DexelField>& fields) : grid_(grid), fields_(fields) {}

  double node(std::size_t axis, std::uint32_t i) const { return (i - 0.5) * grid_.step[axis]; }
  /// Calls each(i, j) for the nodes of layer k (1 to count) that are material.
  template <class Each>
  void for_nodes(std::uint32_t k, Each&& each) const;
  /// On the edge from `node` to its next along `axis`; `leaves`: the node is material, the next is not, else
  /// the other way round.
  Crossing at(std::array<std::uint32_t, 3> node, std::size_t axis, bool leaves) const;

 private:
  Crossing on_line(const DexelField& field, std::array<std::uint32_t, 3> node, bool leaves) const;
  Crossing beside(std::array<std::uint32_t, 3> node, std::size_t axis, bool leaves) const;

  const Grid& grid_;
  const std::vector<DexelField>& fields_;
};

template <class Each>
void Crossings::for_nodes(std::uint32_t k, Each&& each) const {
  const DexelField& f = fields_[0];
  for (std::uint32_t j = 1; j <= grid_.count[1]; ++j) {
    if (f.axis() == 0) {
      for (const Span* s = f.begin(j - 1, k - 1); s != f.end(j - 1, k - 1); ++s) {
        const auto [from, to] = grid_.nodes_in(0, s->lo, s->hi);
        for (std::uint32_t i = from; i < to; ++i) each(i + 1, j);
      }
      continue;
    }
    for (std::uint32_t i = 1; i <= grid_.count[0]; ++i)
      for (const Span* s = f.begin(i - 1, j - 1); s != f.end(i - 1, j - 1); ++s) {
        const auto [from, to] = grid_.nodes_in(2, s->lo, s->hi);
        if (from < k && k <= to) each(i, j);
      }
  }
}

}  // namespace burin::removal
