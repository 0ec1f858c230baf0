// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/tessellate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <unordered_map>

#include "burin/geom/point_tools.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/mesh_cells.h"
#include "burin/geom/surface/modify.h"
#include "burin/geom/surface/patch_grids.h"
#include "burin/geom/surface/trim_cells.h"

namespace burin::geom {
namespace {

/// Cells and triangles in the parameter plane first, then all points at once.
class Trimmed {
 public:
  Trimmed(const NurbsSurface& surface, const GridLines& lines, const detail::TrimCells& cells)
      : surface_(surface), lines_(lines), cells_(cells) {}

  Mesh build(bool reversed) {
    const auto& pieces = cells_.pieces();
    auto piece = pieces.begin();
    for (std::size_t j = 0; j < cells_.rows(); ++j) {
      const std::vector<char> inside = cells_.inside(j);
      for (std::size_t i = 0; i < cells_.columns(); ++i) {
        const std::uint64_t number = i + j * cells_.columns();
        const auto first = piece;
        while (piece != pieces.end() && piece->cell == number) ++piece;
        if (first != piece) {
          cut_cell(i, j, {first, piece}, inside[i] != 0);
        } else if (inside[i]) {
          quads_.push_back(corners(i, j));
        }
      }
    }
    Mesh mesh;
    mesh.vertices.resize(places_.size());
    SurfaceEvaluator(surface_).points(places_, mesh.vertices);
    for (const auto& q : quads_) detail::add_cell(mesh, q, reversed);
    for (const auto& t : triangles_) detail::add_triangle(mesh, t[0], t[1], t[2], reversed);
    return mesh;
  }

 private:
  struct Hash {
    std::size_t operator()(const detail::LatticePoint& p) const {
      return static_cast<std::size_t>(p.x) * 0x9e3779b97f4a7c15ULL ^ static_cast<std::size_t>(p.y);
    }
  };

  std::uint32_t vertex(detail::LatticePoint p) {
    const auto [at, fresh] = index_.try_emplace(p, static_cast<std::uint32_t>(places_.size()));
    if (fresh) places_.push_back(cells_.place(p));
    return at->second;
  }

  static std::array<detail::LatticePoint, 4> lattice_corners(std::size_t i, std::size_t j) {
    const std::int64_t x = static_cast<std::int64_t>(i) * detail::kCell,
                       y = static_cast<std::int64_t>(j) * detail::kCell, n = detail::kCell;
    return {{{x, y}, {x + n, y}, {x + n, y + n}, {x, y + n}}};
  }

  std::array<std::uint32_t, 4> corners(std::size_t i, std::size_t j) {
    const auto c = lattice_corners(i, j);
    return {vertex(c[0]), vertex(c[1]), vertex(c[2]), vertex(c[3])};
  }

  /// Of the cell's real sides.
  double width_share(std::size_t i, std::size_t j) {
    const double u = 0.5 * (lines_.u[i] + lines_.u[i + 1]), v = 0.5 * (lines_.v[j] + lines_.v[j + 1]);
    const auto d = derivatives(surface_, u, v);
    const double width = norm(d.du) * (lines_.u[i + 1] - lines_.u[i]);
    const double height = norm(d.dv) * (lines_.v[j + 1] - lines_.v[j]);
    constexpr double kMost = 1e3;  // beyond, shapes are lost anyway
    return width > 0 && height > 0 ? std::clamp(width / height, 1 / kMost, kMost) : 1;
  }

  void cut_cell(std::size_t i, std::size_t j, std::span<const detail::TrimPiece> pieces, bool left_inside) {
    const auto c = lattice_corners(i, j);
    std::vector<detail::CellPoint> points;
    std::vector<detail::CellSegment> segments;
    std::map<std::pair<std::int64_t, std::int64_t>, std::uint32_t> known;
    const auto point = [&](detail::LatticePoint p) {
      const detail::CellPoint local{p.x - c[0].x, p.y - c[0].y};
      const auto [at, fresh] =
          known.try_emplace({local.x, local.y}, static_cast<std::uint32_t>(points.size()));
      if (fresh) points.push_back(local);
      return at->second;
    };
    for (const auto& corner : c) point(corner);
    for (const auto& piece : pieces) {
      const std::uint32_t from = point(piece.from), to = point(piece.to);
      if (from != to) segments.push_back({from, to});
    }
    const auto cut = detail::triangulate_cell(std::move(points), segments, left_inside, width_share(i, j));
    for (const auto& t : cut.inside) {
      std::array<std::uint32_t, 3> out{};
      for (std::size_t k = 0; k < 3; ++k)
        out[k] = vertex({cut.points[t[k]].x + c[0].x, cut.points[t[k]].y + c[0].y});
      triangles_.push_back(out);
    }
  }

  const NurbsSurface& surface_;
  const GridLines& lines_;
  const detail::TrimCells& cells_;
  std::unordered_map<detail::LatticePoint, std::uint32_t, Hash> index_;  ///< asked, never run through
  std::vector<Point2> places_;
  std::vector<std::array<std::uint32_t, 4>> quads_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

Error too_long(std::size_t most) {
  return {ErrorCode::range,
          "the trims of a face are too long for its triangles (at most " + std::to_string(most) + " pieces)",
          {}};
}

/// Fewer cells when the trims fall into too many pieces, as long as that makes fewer cells.
Result<Tessellation> trimmed(const NurbsSurface& surface, const detail::Spans& spans, bool reversed,
                             const std::vector<std::vector<Point2>>& trims,
                             const TessellateOptions& options) {
  auto lines = detail::grid_lines(spans, options);
  if (!lines) return lines.error();
  TessellateOptions coarser = options;
  for (;;) {
    const auto cells = detail::TrimCells::make(*lines, trims, options.max_triangles);
    if (cells) return Tessellation{Trimmed(surface, *lines, *cells).build(reversed), lines->deflection_mm};
    const std::size_t before = (lines->u.size() - 1) * (lines->v.size() - 1);
    coarser.max_triangles = before;  // half as many cells
    lines = detail::grid_lines(spans, coarser);
    if (!lines || (lines->u.size() - 1) * (lines->v.size() - 1) >= before)
      return too_long(options.max_triangles);
  }
}

/// Steps of the deflection when there would be too many triangles.
constexpr double kCoarser = 1.1;

/// Long pieces are halved as long as that saves triangles: bounds are better and numbers of lines nearer to
/// what each place needs. Judged at a deflection of this share of the surface's size.
constexpr double kFine = 1e-5, kSaves = 0.9;
constexpr double kManyTriangles = 64;  ///< a piece
constexpr int kMostRounds = 4;

NurbsSurface halved_spans(const NurbsSurface& surface, const detail::Spans& spans) {
  const auto middles = [](const std::vector<Interval>& list) {
    std::vector<double> out;
    for (const Interval& span : list) out.push_back(0.5 * (span.lo + span.hi));
    return out;
  };
  // A knot in a direction of degree 1 would count as a crease.
  NurbsSurface out = surface;
  if (surface.degree_u > 1) out = insert_knots(out, Direction::u, middles(spans.u));
  if (surface.degree_v > 1) out = insert_knots(out, Direction::v, middles(spans.v));
  return out;
}

/// The same surface over the same parameters, in more pieces; none when that does not help.
detail::Spans finer(const NurbsSurface& surface, detail::Spans spans) {
  NurbsSurface now = surface;
  const double deflection = kFine * bounds(surface).diagonal();
  if (!(deflection > 0)) return {};
  bool helped = false;
  double total = detail::patch_counts(spans, deflection, 0).total;
  for (int round = 0; round < kMostRounds; ++round) {
    if (total < kManyTriangles * double(spans.bounds.size())) break;
    now = halved_spans(now, spans);
    auto next = detail::spans_of(now, false);
    if (!next) break;
    const double fewer = detail::patch_counts(*next, deflection, 0).total;
    if (!(fewer < kSaves * total)) break;
    spans = *std::move(next), total = fewer, helped = true;
  }
  if (!helped) return {};
  return spans;
}

}  // namespace

struct Tessellator::State {
  const NurbsSurface* surface = nullptr;
  const std::vector<std::vector<Point2>>* trims = nullptr;
  detail::Spans spans, fine;  ///< as the knots are; in more pieces

  struct Choice {
    const detail::Spans* spans = nullptr;
    detail::PatchCounts counts;
  };
  Choice cheaper(double deflection, double max_edge) const {
    Choice plain{&spans, detail::patch_counts(spans, deflection, max_edge)};
    if (fine.bounds.empty()) return plain;
    Choice many{&fine, detail::patch_counts(fine, deflection, max_edge)};
    return many.counts.total < plain.counts.total ? many : plain;
  }
};

Result<Tessellator> Tessellator::make(const NurbsSurface& surface,
                                      const std::vector<std::vector<Point2>>& trims) {
  for (const auto& loop : trims)
    for (const Point2 p : loop)
      if (!is_finite(p)) return Error{ErrorCode::geometry, "a trim has a place that is not finite", {}};
  auto spans = detail::spans_of(surface, !trims.empty());
  if (!spans) return spans.error();
  detail::Spans fine;
  if (trims.empty()) fine = finer(surface, *spans);
  Tessellator out;
  out.state_ = std::make_shared<const State>(State{&surface, &trims, *std::move(spans), std::move(fine)});
  return out;
}

double Tessellator::triangles(double deflection_mm, double max_edge_mm) const {
  return state_->cheaper(deflection_mm, max_edge_mm).counts.total;
}

Result<Tessellation> Tessellator::build(bool reversed, const TessellateOptions& options) const {
  const detail::Spans& spans = state_->spans;
  if (auto ok = detail::check_budget(spans, options); !ok) return ok.error();
  if (!state_->trims->empty()) return trimmed(*state_->surface, spans, reversed, *state_->trims, options);
  const auto most = static_cast<double>(options.max_triangles);
  double deflection = options.deflection_mm;
  State::Choice chosen = state_->cheaper(deflection, options.max_edge_mm);
  // Without a bound on the edges the count falls to one cell a piece in the end.
  while (chosen.counts.total > most) {
    chosen = state_->cheaper(deflection, 0);
    if (chosen.counts.total <= most) break;
    deflection *= std::max(kCoarser, 0.5 * chosen.counts.total / most);
    if (!std::isfinite(deflection))
      return Error{ErrorCode::range, "a surface too large to be cut in triangles", {}};
  }
  return Tessellation{detail::patch_mesh(*state_->surface, *chosen.spans, chosen.counts, reversed),
                      chosen.counts.deflection_mm};
}

Result<Tessellation> tessellate(const NurbsSurface& surface, bool reversed,
                                const std::vector<std::vector<Point2>>& trims,
                                const TessellateOptions& options) {
  const auto tessellator = Tessellator::make(surface, trims);
  if (!tessellator) return tessellator.error();
  return tessellator->build(reversed, options);
}

}  // namespace burin::geom
