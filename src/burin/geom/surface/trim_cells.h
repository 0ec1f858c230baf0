// SPDX-License-Identifier: Apache-2.0
// Trim polygons over the cells of a grid of parameter lines: which cells lie inside, and the pieces of the
// polygons in those that are cut. Internal to geom/surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "burin/geom/surface/cell_triangles.h"
#include "burin/geom/surface/tessellate.h"

namespace burin::geom::detail {

/// A place on the lattice that has kCell steps in every cell: what two cells share is the same to both.
struct LatticePoint {
  std::int64_t x = 0, y = 0;
  bool operator==(const LatticePoint&) const = default;
};

/// A piece of a trim within one (closed) cell; from == to: a place that a neighbour's pieces have on a side
/// of this cell.
struct TrimPiece {
  std::uint64_t cell = 0;  ///< column + row * columns
  LatticePoint from, to;
};

class TrimCells {
 public:
  /// Nothing when the polygons would be cut in more than `most` pieces.
  static std::optional<TrimCells> make(const GridLines& lines, const std::vector<std::vector<Point2>>& trims,
                                       std::size_t most);

  std::size_t columns() const { return lines_->u.size() - 1; }
  std::size_t rows() const { return lines_->v.size() - 1; }
  /// In the order of the cells.
  const std::vector<TrimPiece>& pieces() const { return pieces_; }
  /// For each cell of the row: just right of its left side at half its height is inside.
  std::vector<char> inside(std::size_t row) const;
  Point2 place(LatticePoint p) const;

 private:
  explicit TrimCells(const GridLines& lines) : lines_(&lines) {}
  LatticePoint snapped(Point2 p) const;
  bool add_edge(LatticePoint a, LatticePoint b, std::size_t most);
  bool add_piece(LatticePoint a, LatticePoint b, std::size_t most);
  void add_places_on_sides(LatticePoint p);

  const GridLines* lines_;
  std::vector<TrimPiece> pieces_;
  struct Crossing {
    std::int64_t row, column;  ///< counts for all cells right of the column
    bool operator<(const Crossing& o) const { return row != o.row ? row < o.row : column < o.column; }
  };
  std::vector<Crossing> crossings_;  ///< of the middle lines of the rows
};

}  // namespace burin::geom::detail
