// SPDX-License-Identifier: Apache-2.0
// A path as a list of cuts: one piece of a tool on one short piece of motion, in the order in which a place
// of the stock meets them. Internal to removal. mm.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "burin/base/result.h"
#include "burin/removal/dexels.h"
#include "burin/removal/line_sweep.h"
#include "burin/verify/collisions.h"
#include "burin/verify/path.h"

namespace burin::removal {

/// Relative to the corner of the grid, single precision rounded outwards.
struct CutBox {
  std::array<float, 3> lo{}, hi{};
  void add(const CutBox& b) {
    for (std::size_t i = 0; i < 3; ++i) lo[i] = std::min(lo[i], b.lo[i]), hi[i] = std::max(hi[i], b.hi[i]);
  }
};

struct Cut {
  Motion motion;  ///< relative to the corner of the grid
  CutBox box;
  verify::MillBody body;
  verify::Body kind = verify::Body::cutter;
  bool contact = false;  ///< must not take anything
  std::uint32_t move = 0;
  double reach = 0;  ///< no place of the piece inside the stock is farther from the tip
};

/// Do all tools stand along +Z all the time?
bool is_upright(const verify::CheckedPath& path);

/// Goes through a path once and gives its cuts in portions of bounded size; those that do not reach the stock
/// are left out.
class CutSource {
 public:
  CutSource(const verify::CheckedPath& path, const Grid& grid, double tolerance);
  /// The next portion, about `most`; empty at the end.
  std::vector<Cut> next(std::size_t most);
  double done() const;  ///< share of the pieces

 private:
  struct Piece {
    verify::MillBody body;
    verify::Body kind = verify::Body::cutter;
  };
  void start_tool();
  void add(std::vector<Cut>& out, const Motion& motion, const verify::PathPiece& piece) const;

  const verify::CheckedPath* path_;
  Grid grid_;
  double tolerance_;
  std::size_t tool_ = 0, piece_ = 0, gone_ = 0, total_ = 0;
  std::vector<Piece> pieces_;  ///< from the tip upwards
  double span_ = 0;
};

/// Boxes of the cuts in a tree over their order, so that a tile finds its own without a list.
class CutTree {
 public:
  explicit CutTree(const std::vector<Cut>& cuts);
  /// Calls each(cut number) in order for all whose box may interest: `wanted(box)`.
  template <class Wanted, class Each>
  void walk(Wanted&& wanted, Each&& each) const {
    if (!levels_.empty()) walk(levels_.size() - 1, 0, wanted, each);
  }

 private:
  static constexpr std::size_t kFan = 8;
  template <class Wanted, class Each>
  void walk(std::size_t level, std::size_t node, Wanted& wanted, Each& each) const {
    if (!wanted(levels_[level][node])) return;
    if (level == 0) return each(node);
    const std::size_t end = std::min((node + 1) * kFan, levels_[level - 1].size());
    for (std::size_t child = node * kFan; child < end; ++child) walk(level - 1, child, wanted, each);
  }
  std::vector<std::vector<CutBox>> levels_;  ///< [0]: of the cuts
};

}  // namespace burin::removal
