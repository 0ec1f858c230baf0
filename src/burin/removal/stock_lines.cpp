// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/stock_lines.h"

#include <atomic>
#include <string>
#include <utility>

#include "burin/base/parallel.h"
#include "burin/removal/line_sweep.h"

namespace burin::removal {
namespace {

using geom::component;
using geom::Point3;
using geom::Vec3;

// Crossings of one row of tiles: 64 million of 20 bytes.
constexpr std::size_t kMostCrossings = 64'000'000;

/// each(line u, line v, place in the tile) for the lines of tile t.
template <class Each>
void for_lines(const DexelField& field, std::size_t t, Each&& each) {
  const auto tu = static_cast<std::uint32_t>(t % field.tiles_u()),
             tv = static_cast<std::uint32_t>(t / field.tiles_u());
  const std::uint32_t nu = field.grid().count[field.u_axis()], nv = field.grid().count[field.v_axis()];
  for (std::uint32_t v = tv * Tile::kSide; v < std::min(nv, (tv + 1) * Tile::kSide); ++v)
    for (std::uint32_t u = tu * Tile::kSide; u < std::min(nu, (tu + 1) * Tile::kSide); ++u)
      each(u, v, DexelField::in_tile(u, v));
}

Vec3 unit_along(std::size_t axis) {
  return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
}

Result<void> fill(DexelField& field, const BlockStock& block, unsigned threads) {
  const Grid& grid = field.grid();
  const Vec3 e = unit_along(field.axis()), lo = block.lo - grid.origin, hi = block.hi - grid.origin;
  const Span whole{static_cast<float>(component(lo, field.axis())),
                   static_cast<float>(component(hi, field.axis())), pack(-e), pack(e)};
  const auto inside = [&](std::uint32_t i, std::size_t axis) {
    const double at = (i + 0.5) * grid.step[axis];
    return component(lo, axis) <= at && at < component(hi, axis);
  };
  parallel_for(field.tile_count(), threads, [&](std::size_t t, std::size_t) {
    for_lines(field, t, [&](std::uint32_t u, std::uint32_t v, std::uint32_t l) {
      if (inside(u, field.u_axis()) && inside(v, field.v_axis())) field.tile(t).add(l, whole);
    });
  });
  return {};
}

/// A tool that stands still.
Result<void> fill(DexelField& field, const CylinderStock& cylinder, unsigned threads) {
  const Grid& grid = field.grid();
  Motion still;
  still.tip = Point3{} + (cylinder.base - grid.origin);
  still.axis = unit(cylinder.axis);
  parallel_for(field.tile_count(), threads, [&](std::size_t t, std::size_t) {
    LineSweep sweep({cylinder.radius, 0, cylinder.length, 0}, still, field.axis(), 0, 0);
    for_lines(field, t, [&](std::uint32_t u, std::uint32_t v, std::uint32_t l) {
      const Covered c =
          sweep.line((u + 0.5) * grid.step[field.u_axis()], (v + 0.5) * grid.step[field.v_axis()]);
      const Span s{static_cast<float>(c.a), static_cast<float>(c.b)};
      if (c.empty() || !(s.lo < s.hi)) return;
      field.tile(t).add(l, {s.lo, s.hi, pack(sweep.normal_a(c)), pack(sweep.normal_b(c))});
    });
  });
  return {};
}

/// Lines and corners are put on a grid of 2^30 steps over the stock, in u and v, where the side of an edge on
/// which a line lies is known exactly: a closed mesh is entered as often as it is left.
class MeshLines {
 public:
  MeshLines(DexelField& field, const geom::Mesh& mesh) : field_(field), mesh_(mesh) {
    const Grid& g = field.grid();
    const double size = std::max(g.length(field.u_axis()), g.length(field.v_axis()));
    scale_ = static_cast<double>(1 << 30) / size;
    for (const Point3& p : mesh.vertices) {
      const Vec3 d = p - g.origin;
      u_.push_back(whole(component(d, field.u_axis())));
      v_.push_back(whole(component(d, field.v_axis())));
    }
    for (std::uint32_t i = 0; i < g.count[field.u_axis()]; ++i)
      line_u_.push_back(whole((i + 0.5) * g.step[field.u_axis()]));
    for (std::uint32_t i = 0; i < g.count[field.v_axis()]; ++i)
      line_v_.push_back(whole((i + 0.5) * g.step[field.v_axis()]));
    rows_.resize(field.tiles_v());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [from, to] = range(line_v_, v_, t);
      if (from < to)
        for (std::size_t r = from / Tile::kSide; r <= (to - 1) / Tile::kSide; ++r) rows_[r].push_back(t);
    }
  }

  /// Fills one row of tiles. False: too many crossings.
  bool fill_row(std::size_t row) {
    std::vector<Crossing> found;
    for (const std::uint32_t t : rows_[row])
      if (!cross(t, row, found)) return false;
    std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
      if (a.line != b.line) return a.line < b.line;
      if (a.h != b.h) return a.h < b.h;
      return a.step > b.step;  // where faces touch, material goes on
    });
    for (std::size_t i = 0; i < found.size();) {
      const std::uint32_t line = found[i].line;
      int depth = 0;
      Span span;
      for (; i < found.size() && found[i].line == line; ++i) {
        const int before = depth;
        depth += found[i].step;
        if (before <= 0 && depth > 0) span.lo = found[i].h, span.n_lo = found[i].normal;
        if (before > 0 && depth <= 0 && found[i].h > span.lo) {
          span.hi = found[i].h, span.n_hi = found[i].normal;
          const std::uint32_t u = line / Tile::kSide, v = line % Tile::kSide;
          field_.tile(row * field_.tiles_u() + u / Tile::kSide).add(DexelField::in_tile(u, v), span);
        }
      }
    }
    return true;
  }

 private:
  struct Crossing {
    std::uint32_t line = 0;  ///< u * kSide + v in the row
    float h = 0;
    std::int32_t step = 0;  ///< +1: into the material
    PackedNormal normal = 0;
  };
  std::int64_t whole(double x) const { return std::llround(x * scale_); }
  /// Lines from first to before second that the triangle may cover in one direction.
  std::pair<std::size_t, std::size_t> range(const std::vector<std::int64_t>& lines,
                                            const std::vector<std::int64_t>& at, std::uint32_t t) const {
    const auto& c = mesh_.triangles[t];
    const auto [lo, hi] = std::minmax({at[c[0]], at[c[1]], at[c[2]]});
    return {std::lower_bound(lines.begin(), lines.end(), lo) - lines.begin(),
            std::upper_bound(lines.begin(), lines.end(), hi) - lines.begin()};
  }

  bool cross(std::uint32_t t, std::size_t row, std::vector<Crossing>& found) const {
    std::array<std::uint32_t, 3> c = mesh_.triangles[t];
    const auto twice = [&](std::uint32_t a, std::uint32_t b, std::int64_t u, std::int64_t v) {
      return (u_[b] - u_[a]) * (v - v_[a]) - (v_[b] - v_[a]) * (u - u_[a]);
    };
    const std::int64_t area = twice(c[0], c[1], u_[c[2]], v_[c[2]]);
    if (area == 0) return true;
    const Vec3 n = unit(geom::cross(mesh_.vertices[c[1]] - mesh_.vertices[c[0]],
                                    mesh_.vertices[c[2]] - mesh_.vertices[c[0]]));
    if (area < 0) std::swap(c[1], c[2]);
    const double size = static_cast<double>(std::abs(area));
    const std::size_t axis = field_.axis();
    const double base = component(field_.grid().origin, axis);
    const auto [from_u, to_u] = range(line_u_, u_, t);
    auto [from_v, to_v] = range(line_v_, v_, t);
    from_v = std::max(from_v, row * Tile::kSide), to_v = std::min(to_v, (row + 1) * Tile::kSide);
    for (std::size_t v = from_v; v < to_v; ++v) {
      for (std::size_t u = from_u; u < to_u; ++u) {
        std::array<std::int64_t, 3> side{};
        bool in = true;
        for (std::size_t k = 0; k < 3 && in; ++k) {
          const std::uint32_t a = c[k], b = c[(k + 1) % 3];
          side[k] = twice(a, b, line_u_[u], line_v_[v]);
          // On the edge itself: as if the line were a little to the left and up, for all triangles alike.
          const std::int64_t du = u_[b] - u_[a], dv = v_[b] - v_[a];
          in = side[k] > 0 || (side[k] == 0 && (dv > 0 || (dv == 0 && du > 0)));
        }
        if (!in) continue;
        if (found.size() == kMostCrossings) return false;
        double h = 0;
        for (std::size_t k = 0; k < 3; ++k)
          h += static_cast<double>(side[(k + 1) % 3]) / size * (component(mesh_.vertices[c[k]], axis) - base);
        // Counter-clockwise seen against the line: it leaves there.
        found.push_back({static_cast<std::uint32_t>(u * Tile::kSide + v % Tile::kSide), static_cast<float>(h),
                         area > 0 ? -1 : 1, pack(n)});
      }
    }
    return true;
  }

  DexelField& field_;
  const geom::Mesh& mesh_;
  double scale_ = 1;
  std::vector<std::int64_t> u_, v_, line_u_, line_v_;
  std::vector<std::vector<std::uint32_t>> rows_;  ///< triangles of each row of tiles
};

Result<void> fill(DexelField& field, const MeshStock& stock, unsigned threads) {
  MeshLines lines(field, stock.mesh);
  std::atomic<bool> too_many{false};
  parallel_for(field.tiles_v(), threads, [&](std::size_t row, std::size_t) {
    if (!lines.fill_row(row)) too_many = true;
  });
  if (too_many)
    return Error{ErrorCode::range,
                 "stock: the mesh lies in too many layers over each other (a coarser resolution, or a "
                 "simpler mesh)",
                 {}};
  return {};
}

}  // namespace

Result<void> fill(DexelField& field, const Stock& stock, unsigned threads) {
  if (auto ok = std::visit([&](const auto& s) { return fill(field, s, threads); }, stock); !ok)
    return ok.error();
  parallel_for(field.tile_count(), threads, [&](std::size_t t, std::size_t) {
    field.tile(t).shrink();
    field.tile(t).count_parts(field.parts_per_mm());
  });
  return {};
}

}  // namespace burin::removal
