// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/tessellate.h"

#include <cmath>

#include "burin/geom/point_tools.h"
#include "burin/geom/surface/evaluate.h"

namespace burin::geom {
namespace {

class Builder {
 public:
  Builder(const NurbsSurface& surface, const GridLines& lines, bool reversed)
      : evaluator_(surface), lines_(lines), reversed_(reversed) {}

  Mesh build() {
    const std::size_t columns = lines_.u.size();
    mesh_.vertices.resize(columns * lines_.v.size());
    for (std::size_t j = 0; j < lines_.v.size(); ++j)
      evaluator_.iso_points(Direction::u, lines_.v[j], lines_.u,
                            std::span(mesh_.vertices).subspan(j * columns, columns));
    mesh_.triangles.reserve(2 * (columns - 1) * (lines_.v.size() - 1));
    for (std::size_t j = 0; j + 1 < lines_.v.size(); ++j)
      for (std::size_t i = 0; i + 1 < columns; ++i) cell(i, j);
    return std::move(mesh_);
  }

 private:
  void cell(std::size_t i, std::size_t j) {
    const auto a = static_cast<std::uint32_t>(i + j * lines_.u.size()), b = a + 1;
    const auto d = static_cast<std::uint32_t>(a + lines_.u.size()), c = d + 1;
    const auto& p = mesh_.vertices;
    if (distance(p[a], p[c]) <= distance(p[b], p[d])) {
      add(a, b, c), add(a, c, d);
    } else {
      add(a, b, d), add(b, c, d);
    }
  }

  /// Corners at one place (poles) make no triangle.
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto& p = mesh_.vertices;
    if (p[a] == p[b] || p[b] == p[c] || p[c] == p[a]) return;
    if (reversed_) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }

  SurfaceEvaluator evaluator_;
  const GridLines& lines_;
  bool reversed_;
  Mesh mesh_;
};

}  // namespace

Result<Tessellation> tessellate(const NurbsSurface& surface, bool reversed,
                                const std::vector<std::vector<Point2>>& trims,
                                const TessellateOptions& options) {
  auto lines = grid_lines(surface, options);
  if (!lines) return lines.error();
  (void)trims;
  Tessellation out;
  out.mesh = Builder(surface, *lines, reversed).build();
  out.deflection_mm = lines->deflection_mm;
  return out;
}

}  // namespace burin::geom
