// SPDX-License-Identifier: Apache-2.0
// Cuts on one tile of dexels, one after the other. Internal to removal. mm.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burin/removal/cuts.h"
#include "burin/removal/dexels.h"

namespace burin::removal {

/// What one move and one kind of body took out of one tile and must not have taken.
struct ContactPart {
  std::uint32_t move = 0;
  verify::Body kind = verify::Body::cutter;
  std::uint8_t axis = 0;  ///< of the dexels
  bool deep = false;      ///< more than contact_mm somewhere
  float depth = 0;        ///< most taken out of one line
  double volume = 0;
  std::array<float, 3>
      at{};  ///< in the piece taken last out of that line, relative to the corner of the grid
};

struct CutLimits {
  double tolerance = 0;  ///< of the ends of what is cut
  double contact = 0;    ///< less deep is no contact
};

/// When nodes of the grid were cut: 1 + move; marked by the lines along Z.
struct NodeTimes {
  std::uint32_t* cut_at = nullptr;
};

class TileCutter {
 public:
  TileCutter(DexelField& field, std::size_t tile, const CutLimits& limits, NodeTimes times = {});
  void run(const std::vector<Cut>& cuts, const CutTree& tree, std::vector<ContactPart>& contacts);

 private:
  struct Range {
    std::uint32_t from = 0, to = 0;  ///< lines, to excluded
  };
  /// Contact of one kind of body with the tile during one move.
  struct Open {
    ContactPart part;
    bool used = false;
    std::array<float, Tile::kLines> taken{};
    std::vector<std::uint32_t> lines;
  };

  bool wanted(const CutBox& box) const;
  void cut(const Cut& cut);
  Range lines(float lo, float hi, std::size_t axis, const Range& most) const;
  bool line(const Cut& cut, std::uint32_t u, std::uint32_t v, LineSweep& sweep, LineSweep* deep);
  void note(Open& open, std::uint32_t line, std::uint32_t u, std::uint32_t v, float lo, float hi);
  void mark(std::uint32_t u, std::uint32_t v, float lo, float hi, std::uint32_t move);
  void flush(Open& open);

  DexelField& field_;
  Tile& tile_;
  CutLimits limits_;
  NodeTimes times_;
  std::size_t u_axis_, v_axis_, axis_;
  double step_u_, step_v_;
  float per_mm_, sliver_;
  Range u_, v_;
  CutBox box_;
  std::array<Open, 3> open_;
  std::vector<ContactPart>* contacts_ = nullptr;
};

}  // namespace burin::removal
