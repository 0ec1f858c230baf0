// SPDX-License-Identifier: Apache-2.0
// Internal to joining: contacts of patches, the cuts they ask for, and the cells between the cuts with their
// neighbours. After this step two cells share a whole side or nothing.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "burin/geom/surface/join.h"
#include "burin/geom/surface/join_edges.h"

namespace burin::geom::detail {

/// 0: u = lo, 1: u = hi (both run along v), 2: v = lo, 3: v = hi (both run along u).
using SideIndex = int;
constexpr Direction across(SideIndex side) {
  return side < 2 ? Direction::u : Direction::v;
}
constexpr Direction along(SideIndex side) {
  return other(across(side));
}
constexpr bool at_high_end(SideIndex side) {
  return side % 2 == 1;
}

/// A patch, or a piece of one that a forced join bent. Patch parameters are map[0] + map[1] * parameter.
struct Source {
  NurbsSurface surface;
  std::size_t patch = 0;
  std::array<double, 2> map_u{0, 1}, map_v{0, 1};
  std::array<EdgeCurve, 4> edges;
  std::array<bool, 4> collapsed{};
  double length_u = 0, length_v = 0;  ///< of the longer edge in that direction
  bool bent = false;                  ///< a part that a forced join made
  double deviation_mm = 0;            ///< then: of all parts from the patch

  double length(Direction d) const { return d == Direction::u ? length_u : length_v; }
};
Source source_of(NurbsSurface surface, std::size_t patch, double tolerance_mm);

struct Contact {
  int a = 0, b = 0;  ///< sources, a <= b
  SideIndex side_a = 0, side_b = 0;
  Match match;
  bool partial = false;  ///< does not cover both sides of the patches
  bool inner = false;    ///< of parts of the same bent patch
  bool smooth = false;   ///< the tangent planes agree along the contact
};

/// All contacts of edges, the best first where several compete for one side; refused ones go to the report.
std::vector<Contact> find_contacts(const std::vector<Source>& sources, const JoinOptions& options,
                                   JoinReport& report, Diagnostics& diagnostics);

/// How a cell lies in a grid: grid x is the cell's u (v when swapped), against it when flipped.
struct Orientation {
  bool swap = false, flip_x = false, flip_y = false;
  bool operator==(const Orientation&) const = default;
};

struct Link {
  int cell = -1;  ///< none
  SideIndex side = 0;
  bool reversed = false;
  double alpha = 1;  ///< along this cell's own edge, see Match
  double gap_mm = 0;
  bool exact = true;
  bool partial = false;     ///< a contact that the rules want joined
  bool artificial = false;  ///< the cells are neighbours in the same source
  bool inner = false;       ///< in the same patch: artificial, or both are parts of a bent one
  bool barrier = false;     ///< inner, and crossing it would leave a partial contact open
};

/// One cell of the grid that the cuts make of a source. Intervals in the source's parameters.
struct Cell {
  int source = 0;
  Interval u, v;
  double area = 0;
  std::array<Link, 4> links;
};

struct CellGraph {
  std::vector<Cell> cells;  ///< by source, u fastest
};
/// Both ways; `link` is that of `a`, without its cell and side.
void connect(CellGraph& graph, int a, SideIndex side_a, int b, SideIndex side_b, Link link);
CellGraph make_cells(const std::vector<Source>& sources, const std::vector<Contact>& contacts,
                     const JoinOptions& options, JoinReport& report);

/// A direction of the grid: +x, -x, +y, -y.
enum class Step { east, west, north, south };
struct Placed {
  int cell = -1;
  Orientation orientation;
  bool operator==(const Placed&) const = default;
};
SideIndex side_facing(const Orientation& o, Step step);
/// How the cell behind `link` lies when `from` has orientation `o` and the link leaves it towards `step`.
Orientation behind(const Orientation& o, Step step, const Link& link);
inline const Link& link_towards(const CellGraph& graph, const Placed& from, Step step) {
  return graph.cells[static_cast<std::size_t>(from.cell)]
      .links[static_cast<std::size_t>(side_facing(from.orientation, step))];
}

void report_unjoined(JoinReport& report, std::size_t a, std::size_t b, std::string reason,
                     double deviation_mm = 0);

}  // namespace burin::geom::detail
