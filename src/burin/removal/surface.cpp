// SPDX-License-Identifier: Apache-2.0
// Dual contouring over the nodes where dexels of all directions cross. docs/removal.md
//
//   Ju, Losasso, Schaefer & Warren, Dual contouring of Hermite data (SIGGRAPH 2002);
//   Nielson, Dual marching cubes (2004): one vertex for every sheet of the surface in a cell, which keeps the
//   mesh a manifold.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "burin/removal/cell_sheets.h"
#include "burin/removal/crossings.h"
#include "burin/removal/field.h"
#include "burin/removal/sheet_vertex.h"

namespace burin::removal {
namespace {

using geom::Point3;

/// Nodes of one layer, a border of empty ones around: bit i % 64 of word i / 64 of row j.
class Layer {
 public:
  Layer(std::uint32_t nx, std::uint32_t ny) : words_((nx + 63) / 64), bits_(words_ * ny, 0) {}
  std::size_t words() const { return words_; }
  const std::uint64_t* row(std::uint32_t j) const { return bits_.data() + j * words_; }
  bool at(std::uint32_t i, std::uint32_t j) const { return (row(j)[i / 64] >> (i % 64) & 1) != 0; }
  void set(std::uint32_t i, std::uint32_t j) { bits_[j * words_ + i / 64] |= 1ULL << (i % 64); }

 private:
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

class Surface {
 public:
  Surface(const Grid& grid, const std::vector<DexelField>& fields)
      : grid_(grid),
        crossings_(grid, fields),
        nx_(grid.count[0] + 2),
        ny_(grid.count[1] + 2),
        nz_(grid.count[2] + 2) {}

  geom::Mesh make() {
    for (int k = -1; k < 3; ++k) layers_.push_back(layer(k));
    for (std::uint32_t k = 0; k + 1 < nz_; ++k) {
      cells(k);
      quads(k);
      before_ = std::move(now_);
      layers_.erase(layers_.begin());
      layers_.push_back(layer(static_cast<int>(k) + 3));
    }
    for (Point3& p : mesh_.vertices) p = grid_.origin + (p - Point3{});
    return std::move(mesh_);
  }

 private:
  static constexpr std::uint32_t kNoCell = 0xffffffffu;
  struct Cell {
    CellSheets sheets;
    std::uint32_t first = 0;  ///< vertex of sheet 0
  };
  struct Cells {
    std::vector<std::uint32_t> number;  ///< of the cell whose lowest node is (i, j), kNoCell
    std::vector<Cell> cells;
  };

  Layer layer(int k) const {
    Layer out(nx_, ny_);
    if (k < 1 || k > static_cast<int>(grid_.count[2])) return out;
    crossings_.for_nodes(static_cast<std::uint32_t>(k),
                         [&](std::uint32_t i, std::uint32_t j) { out.set(i, j); });
    return out;
  }
  /// Layer k + up of nodes, while the cells of layer k are at work.
  const Layer& nodes(int up) const { return layers_[static_cast<std::size_t>(up + 1)]; }

  unsigned corners(std::uint32_t i, std::uint32_t j, int up) const {
    unsigned c = 0;
    for (unsigned n = 0; n < 8; ++n)
      c |= unsigned{nodes(up + static_cast<int>(n >> 2)).at(i + (n & 1), j + (n >> 1 & 1))} << n;
    return c;
  }
  /// Faces of the cell that must be joined (cell_sheets.h).
  unsigned joined(std::uint32_t i, std::uint32_t j, unsigned here) const {
    unsigned out = 0;
    for (unsigned face = 0; face < 6; ++face) {
      if (!meets_itself(here, face)) continue;
      // Such faces have material in them: there is a cell on their other side.
      const unsigned axis = face / 2;
      const int step = (face & 1) != 0 ? 1 : -1;
      const unsigned there =
          corners(i + (axis == 0 ? static_cast<std::uint32_t>(step) : 0),
                  j + (axis == 1 ? static_cast<std::uint32_t>(step) : 0), axis == 2 ? step : 0);
      if (meets_itself(there, face ^ 1)) out |= 1U << face;
    }
    return out;
  }

  void cells(std::uint32_t k) {
    now_.number.assign(static_cast<std::size_t>(nx_) * ny_, kNoCell);
    now_.cells.clear();
    const std::size_t words = nodes(0).words();
    for (std::uint32_t j = 0; j + 1 < ny_; ++j) {
      const std::array<const std::uint64_t*, 4> rows{nodes(0).row(j), nodes(0).row(j + 1), nodes(1).row(j),
                                                     nodes(1).row(j + 1)};
      const auto any = [&](std::size_t w) {
        return w < words ? rows[0][w] | rows[1][w] | rows[2][w] | rows[3][w] : 0;
      };
      const auto all = [&](std::size_t w) {
        return w < words ? rows[0][w] & rows[1][w] & rows[2][w] & rows[3][w] : 0;
      };
      for (std::size_t w = 0; w < words; ++w) {
        std::uint64_t mixed =
            (any(w) | any(w) >> 1 | any(w + 1) << 63) & ~(all(w) & (all(w) >> 1 | all(w + 1) << 63));
        for (; mixed != 0; mixed &= mixed - 1) {
          const auto i =
              static_cast<std::uint32_t>(64 * w) + static_cast<std::uint32_t>(__builtin_ctzll(mixed));
          if (i + 1 < nx_) cell(i, j, k);
        }
      }
    }
  }

  void cell(std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const unsigned here = corners(i, j, 0);
    Cell c{cell_sheets(here, joined(i, j, here)), static_cast<std::uint32_t>(mesh_.vertices.size())};
    std::array<SheetVertex, 4> vertices;
    for (unsigned e = 0; e < 12; ++e) {
      if (c.sheets.of_edge[e] == CellSheets::kNone) continue;
      const unsigned lower = corner_of_edge(e), axis = e / 4;
      vertices[c.sheets.of_edge[e]].add(crossings_.at(
          {i + (lower & 1), j + (lower >> 1 & 1), k + (lower >> 2)}, axis, (here >> lower & 1) != 0));
    }
    const Point3 lo{crossings_.node(0, i), crossings_.node(1, j), crossings_.node(2, k)};
    const geom::Box3 box{lo, lo + geom::Vec3{grid_.step[0], grid_.step[1], grid_.step[2]}};
    for (unsigned s = 0; s < c.sheets.count; ++s) mesh_.vertices.push_back(vertices[s].place(box));
    now_.number[static_cast<std::size_t>(j) * nx_ + i] = static_cast<std::uint32_t>(now_.cells.size());
    now_.cells.push_back(c);
  }

  /// Four triangles' corners around every crossed edge: those in layer k, and those from it upwards.
  void quads(std::uint32_t k) {
    const Layer &here = nodes(0), &above = nodes(1);
    for (std::uint32_t j = 0; j + 1 < ny_; ++j) {
      for (std::size_t w = 0; w < here.words(); ++w) {
        const std::uint64_t bits = here.row(j)[w], next = w + 1 < here.words() ? here.row(j)[w + 1] : 0;
        const std::array<std::uint64_t, 3> changed{bits ^ (bits >> 1 | next << 63), bits ^ here.row(j + 1)[w],
                                                   bits ^ above.row(j)[w]};
        for (unsigned axis = 0; axis < 3; ++axis)
          for (std::uint64_t m = changed[axis]; m != 0; m &= m - 1) {
            const auto i =
                static_cast<std::uint32_t>(64 * w) + static_cast<std::uint32_t>(__builtin_ctzll(m));
            if (i < nx_) quad(i, j, k, axis, here.at(i, j));
          }
      }
    }
  }

  void quad(std::uint32_t i, std::uint32_t j, std::uint32_t k, unsigned axis, bool leaves) {
    std::array<std::uint32_t, 4> v{};
    // Around the edge in the sense from the next axis to the one after it: cells that see it as their edge
    // (p, q).
    constexpr std::array<std::array<unsigned, 2>, 4> kAround{{{1, 1}, {0, 1}, {0, 0}, {1, 0}}};
    for (unsigned n = 0; n < 4; ++n) {
      std::array<std::uint32_t, 3> at{i, j, k};
      at[(axis + 1) % 3] -= kAround[n][0], at[(axis + 2) % 3] -= kAround[n][1];
      const Cells& cells = at[2] == k ? now_ : before_;
      const Cell& c = cells.cells[cells.number[static_cast<std::size_t>(at[1]) * nx_ + at[0]]];
      v[n] = c.first + c.sheets.of_edge[4 * axis + kAround[n][0] + 2 * kAround[n][1]];
    }
    if (!leaves) std::swap(v[1], v[3]);
    const auto far = [&](unsigned a, unsigned b) {
      return distance(mesh_.vertices[v[a]], mesh_.vertices[v[b]]);
    };
    if (far(0, 2) <= far(1, 3)) {
      mesh_.triangles.push_back({v[0], v[1], v[2]});
      mesh_.triangles.push_back({v[0], v[2], v[3]});
    } else {
      mesh_.triangles.push_back({v[0], v[1], v[3]});
      mesh_.triangles.push_back({v[1], v[2], v[3]});
    }
  }

  const Grid& grid_;
  Crossings crossings_;
  std::uint32_t nx_, ny_, nz_;  ///< nodes, those of the border included
  std::vector<Layer> layers_;   ///< k - 1 to k + 2
  Cells before_, now_;          ///< of layer k - 1 and k
  geom::Mesh mesh_;
};

}  // namespace

geom::Mesh surface(const Grid& grid, const std::vector<DexelField>& fields) {
  return Surface(grid, fields).make();
}

}  // namespace burin::removal
