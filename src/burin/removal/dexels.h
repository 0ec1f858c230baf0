// SPDX-License-Identifier: Apache-2.0
// Dexels: lines of material in one direction, in tiles that one thread works on. Internal to removal. mm.
//
// Lines run through the middles of the cells of a grid, so that a line stands for the area of its cell and a
// block is counted exactly. Heights along a line are measured from the corner of the grid, in single
// precision: 6e-8 of the stock's length.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "burin/geom/point_tools.h"
#include "burin/geom/vec.h"

namespace burin::removal {

/// A unit vector in 32 bits, within 1e-4 (octahedron).
using PackedNormal = std::uint32_t;
PackedNormal pack(geom::Vec3 n);
geom::Vec3 unpack(PackedNormal n);

/// Material from `lo` to `hi`; normals outwards from it at both ends.
struct Span {
  float lo = 0, hi = 0;
  PackedNormal n_lo = 0, n_hi = 0;
};

/// Cells in x, y, z that all directions share.
struct Grid {
  geom::Point3 origin;  ///< lower corner
  std::array<double, 3> step{};
  std::array<std::uint32_t, 3> count{};

  double node(std::size_t axis, double i) const { return component(origin, axis) + (i + 0.5) * step[axis]; }
  double length(std::size_t axis) const { return step[axis] * count[axis]; }
  /// Nodes from first to before second that lie in [lo, hi) above the corner.
  std::array<std::uint32_t, 2> nodes_in(std::size_t axis, float lo, float hi) const {
    const auto first = [&](float h) {
      const double i = std::ceil(static_cast<double>(h) / step[axis] - 0.5);
      return static_cast<std::uint32_t>(std::clamp<double>(i, 0, count[axis]));
    };
    return {first(lo), first(hi)};
  }
};

class Tile {
 public:
  static constexpr std::uint32_t kSide = 16;
  static constexpr std::uint32_t kLines = kSide * kSide;

  Tile() : lines_(kLines) {}
  const Span* begin(std::uint32_t line) const { return pool_.data() + lines_[line].first; }
  const Span* end(std::uint32_t line) const { return begin(line) + lines_[line].count; }
  /// Appends to an empty tile: lines in any order, spans of a line upwards.
  void add(std::uint32_t line, const Span& span);
  /// Does any line of the tile have material in the parts `mask` of its length?
  bool holds(std::uint64_t mask) const { return (occupied_ & mask) != 0; }
  bool empty() const { return occupied_ == 0; }
  /// 64 parts of the length are numbered by the bits: those that [lo, hi] reaches.
  static std::uint64_t parts(float lo, float hi, float per_mm);
  void count_parts(float per_mm);
  /// Frees what is not needed once nothing more is cut.
  void shrink();
  double length() const;

  /// Takes [a, b] away. `removed(lo, hi)` is told every piece that was there; `normal_a()`, `normal_b()`
  /// give the packed normals of the material left at a and b and are asked only when some is. Pieces shorter
  /// than `sliver` do not stay. Returns whether anything was taken.
  template <class Removed, class NormalA, class NormalB>
  bool cut(std::uint32_t line, float a, float b, float sliver, Removed&& removed, NormalA&& normal_a,
           NormalB&& normal_b);

 private:
  struct Line {
    std::uint32_t first = 0;
    std::uint16_t count = 0, room = 0;
  };
  void insert(Line& line, std::uint32_t at, const Span& span);
  void erase(Line& line, std::uint32_t at);

  std::vector<Span> pool_;
  std::vector<Line> lines_;
  std::size_t lost_ = 0;  ///< places of the pool that no line uses any more
  std::uint64_t occupied_ = 0;
};

template <class Removed, class NormalA, class NormalB>
bool Tile::cut(std::uint32_t index, float a, float b, float sliver, Removed&& removed, NormalA&& normal_a,
               NormalB&& normal_b) {
  Line& line = lines_[index];
  bool any = false;
  for (std::uint32_t i = 0; i < line.count;) {
    Span& s = pool_[line.first + i];
    if (s.lo >= b) break;
    if (s.hi <= a) {
      ++i;
      continue;
    }
    const float lo = std::max(s.lo, a), hi = std::min(s.hi, b);
    any = true;
    removed(lo, hi);
    const bool below = a - s.lo > sliver, above = s.hi - b > sliver;
    if (!below && !above) {
      erase(line, i);
    } else if (!below) {
      s.lo = b, s.n_lo = normal_b();
      ++i;
    } else if (!above) {
      s.hi = a, s.n_hi = normal_a();
      ++i;
    } else {
      const Span rest{b, s.hi, normal_b(), s.n_hi};
      s.hi = a, s.n_hi = normal_a();
      insert(line, i + 1, rest);
      break;
    }
  }
  return any;
}

/// All lines of one direction: along axis `axis`; u and v are the next axes in the order x, y, z, x.
class DexelField {
 public:
  DexelField() = default;
  DexelField(const Grid& grid, std::size_t axis);

  const Grid& grid() const { return grid_; }
  std::size_t axis() const { return axis_; }
  std::size_t u_axis() const { return (axis_ + 1) % 3; }
  std::size_t v_axis() const { return (axis_ + 2) % 3; }
  std::uint32_t tiles_u() const { return tiles_u_; }
  std::uint32_t tiles_v() const { return tiles_v_; }
  std::size_t tile_count() const { return tiles_.size(); }
  Tile& tile(std::size_t t) { return tiles_[t]; }
  const Tile& tile(std::size_t t) const { return tiles_[t]; }
  float parts_per_mm() const { return static_cast<float>(64 / grid_.length(axis_)); }
  /// Place of a line in its tile.
  static std::uint32_t in_tile(std::uint32_t u, std::uint32_t v) {
    return (v % Tile::kSide) * Tile::kSide + u % Tile::kSide;
  }
  const Tile& tile_of(std::uint32_t u, std::uint32_t v) const {
    return tiles_[v / Tile::kSide * tiles_u_ + u / Tile::kSide];
  }
  const Span* begin(std::uint32_t u, std::uint32_t v) const { return tile_of(u, v).begin(in_tile(u, v)); }
  const Span* end(std::uint32_t u, std::uint32_t v) const { return tile_of(u, v).end(in_tile(u, v)); }
  double cell_area() const { return grid_.step[u_axis()] * grid_.step[v_axis()]; }
  double volume() const;

 private:
  Grid grid_;
  std::size_t axis_ = 2;
  std::uint32_t tiles_u_ = 0, tiles_v_ = 0;
  std::vector<Tile> tiles_;
};

}  // namespace burin::removal
