// SPDX-License-Identifier: Apache-2.0
// Material removal: the stock as a field of dexels (lines of material along Z, or along X, Y and Z), cut by
// everything the tools do, in the order of the program. mm, mm^3, part frame. docs/removal.md
//
//   van Hook, Real-time shaded NC milling display (SIGGRAPH 1986): dexels;
//   Benouamer & Michelucci, Bridging the gap between CSG and Brep via a triple ray representation (1997);
//   the intervals that a swept convex piece of a tool covers on a line are found from its envelope, not from
//   steps of time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/removal/stock.h"
#include "burin/verify/collisions.h"
#include "burin/verify/path.h"

namespace burin::removal {

enum class Directions {
  automatic,  ///< one when all tool axes are +Z, else three
  one,        ///< along Z: 3 axes
  three,      ///< along X, Y and Z
};

struct RemovalOptions {
  double resolution_mm = 0;  ///< distance of the dexels; 0: 1/200 of the longest side of the stock
  Directions directions = Directions::automatic;
  unsigned threads = 1;  ///< 0: as many as there are; the result is the same for any number
  std::size_t max_dexels = 20'000'000;
  /// Material that a rapid, shank or holder takes counts as a collision when it is deeper than this in the
  /// body: when the body, made smaller by it all around, still takes some.
  double contact_mm = 0.05;
  /// Keep when each place was cut (for clock()).
  bool keep_times = false;
};

/// What must not have cut, but did: the cutter on a rapid, shank or holder on any move.
struct StockContact {
  std::uint32_t move = 0;  ///< GOTO number
  verify::Body body = verify::Body::cutter;
  /// Most taken out of one dexel during the move, in the direction where that is least; exact to the
  /// resolution.
  double depth_mm = 0;
  double volume_mm3 = 0;
  geom::Point3 at;
};

/// When each node of a grid over the stock lost its material: what the viewer plays. A node is solid at time
/// t of the path when cut_at > t. Index of node (i, j, k): (k * count[1] + j) * count[0] + i.
struct StockClock {
  static constexpr std::uint32_t kNever = 0xffffffffu;  ///< still there at the end
  static constexpr std::uint32_t kEmpty = 0;            ///< was never material
  std::array<std::uint32_t, 3> count{};
  geom::Point3 origin;
  double step_mm = 0;
  /// 1 + GOTO number whose motion took the node away.
  std::vector<std::uint32_t> cut_at;
  /// Where the surface that stays for good (or was there at the start) crosses the edge from a node to its
  /// next in x, y, z: 1..255 as share of the step from the node + 1/256; 0: no crossing known. 3 a node.
  std::vector<std::uint8_t> crossing;
};

class Field;

class Removal {
 public:
  Removal(Removal&&) noexcept;
  Removal& operator=(Removal&&) noexcept;
  ~Removal();

  double stock_mm3() const;
  double removed_mm3() const;
  double resolution_mm() const;
  const std::vector<StockContact>& contacts() const;
  /// What is left, closed; sharp edges are kept where three directions are known (dual contouring or
  /// equivalent), facets lie within the resolution.
  /// Nothing in it when memory does not do.
  geom::Mesh mesh() const;
  /// At most `max_nodes` nodes (27 at least): the cuts once more on the lines through them. Nothing in it
  /// without keep_times, or when memory does not do.
  StockClock clock(std::size_t max_nodes) const;

 private:
  friend Result<Removal> remove_material(const Stock&, const verify::CheckedPath&, const RemovalOptions&,
                                         ProgressSink*);
  explicit Removal(std::unique_ptr<Field> field);
  std::unique_ptr<Field> field_;
};

/// Errors: of validate(stock); too many dexels for the memory allowed (range; says which resolution would
/// do), tilted axes with Directions::one (unsupported).
Result<Removal> remove_material(const Stock& stock, const verify::CheckedPath& path,
                                const RemovalOptions& options, ProgressSink* progress = nullptr);

}  // namespace burin::removal
