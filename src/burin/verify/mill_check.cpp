// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/mill_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "burin/base/parallel.h"
#include "burin/geom/point_tools.h"
#include "burin/verify/mill_bound.h"
#include "burin/verify/triangle_tree.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// Moves that are looked at after each other, each starting from the deepest gouge found among them: what is
// found does not depend on the number of threads.
constexpr std::size_t kChunk = 32;
// Triangles and times are halved at most so often; by then both are far below any resolution.
constexpr int kMostHalvings = 200;

/// The deepest gouge of one piece of the tool on a stretch of motion: branch and bound over boxes, triangles
/// and times.
class Search {
 public:
  Search(const TriangleTree& tree, const MillBody& body, double resolution)
      : tree_(tree), body_(body), resolution_(resolution) {}

  void stretch(const Stretch& stretch, std::size_t move) {
    stretch_ = &stretch;
    move_ = move;
    const Span whole = Span::whole(stretch);
    const Upper upper = of_node(tree_.nodes()[0], whole);
    box(0, whole, upper);
  }
  const MillFinding& deepest() const { return found_; }
  std::uint64_t evaluations() const { return evaluations_; }

 private:
  using Corners = std::array<Point3, 3>;

  bool settled(double value) const { return value <= found_.mm + resolution_; }

  template <class Extent>
  Upper bound(const Extent& extent, const Span& span) {
    ++evaluations_;
    return upper_bound(body_, *stretch_, span, extent, found_.mm + resolution_);
  }
  Upper of_node(const TriangleTree::Node& node, const Span& span) {
    const Vec3 h = node.half;
    return bound(BoxExtent{node.center,
                           norm(h),
                           {node.normal, node.most, node.least},
                           {Vec3{h.x, 0, 0}, Vec3{0, h.y, 0}, Vec3{0, 0, h.z}}},
                 span);
  }
  Upper of_triangle(const Corners& c, Vec3 normal, const Span& span) {
    return bound(TriangleExtent(c, normal), span);
  }

  /// Both parts, the one that is nearer or deeper in its middle first.
  template <class First, class Second>
  void both(const Upper& a, const Upper& b, First&& first, Second&& second) {
    if (a.f >= b.f) {
      first();
      second();
    } else {
      second();
      first();
    }
  }

  void box(std::uint32_t index, const Span& span, const Upper& upper) {
    if (settled(upper.value)) return;
    const TriangleTree::Node& node = tree_.nodes()[index];
    // Below the resolution time is halved for triangles only, where what is found settles the rest.
    if (upper.time > std::max(upper.space, resolution_)) {
      const std::array<Span, 2> parts = span.halves(*stretch_);
      const Upper a = of_node(node, parts[0]), b = of_node(node, parts[1]);
      both(
          a, b, [&] { box(index, parts[0], a); }, [&] { box(index, parts[1], b); });
      return;
    }
    if (node.count == 0) {
      const Upper a = of_node(tree_.nodes()[node.first], span),
                  b = of_node(tree_.nodes()[node.first + 1], span);
      both(
          a, b, [&] { box(node.first, span, a); }, [&] { box(node.first + 1, span, b); });
      return;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const TriangleTree::Triangle& t = tree_.triangles()[i];
      const Vec3 normal = unit(cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]));
      triangle(t.corners, t.index, normal, span, of_triangle(t.corners, normal, span), 0);
    }
  }

  void triangle(const Corners& c, std::uint32_t index, Vec3 normal, const Span& span, const Upper& upper,
                int depth) {
    if (settled(upper.value)) return;
    take(c, index, span, upper);
    if (settled(upper.value) || depth >= kMostHalvings) return;
    if (upper.time > upper.space) {
      const std::array<Span, 2> parts = span.halves(*stretch_);
      const Upper a = of_triangle(c, normal, parts[0]), b = of_triangle(c, normal, parts[1]);
      both(
          a, b, [&] { triangle(c, index, normal, parts[0], a, depth + 1); },
          [&] { triangle(c, index, normal, parts[1], b, depth + 1); });
      return;
    }
    std::size_t at = 0;  // of the longest side
    for (std::size_t i = 1; i < 3; ++i)
      if (distance(c[i], c[(i + 1) % 3]) > distance(c[at], c[(at + 1) % 3])) at = i;
    const Point3 p = c[at], q = c[(at + 1) % 3], r = c[(at + 2) % 3], m = lerp(p, q, 0.5);
    const Corners one{p, m, r}, two{m, q, r};
    const Upper a = of_triangle(one, normal, span), b = of_triangle(two, normal, span);
    both(
        a, b, [&] { triangle(one, index, normal, span, a, depth + 1); },
        [&] { triangle(two, index, normal, span, b, depth + 1); });
  }

  /// What is surely there: in the middle, and at the corner and the end of the time towards which it grows.
  void take(const Corners& c, std::uint32_t index, const Span& span, const Upper& upper) {
    take(upper.f, lerp(lerp(c[0], c[1], 0.5), c[2], 1.0 / 3), index);
    std::size_t best = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (dot(upper.gradient, c[i] - c[best]) > 0) best = i;
    const Placed end = stretch_->at(span.middle + (upper.along_time > 0 ? span.half : -span.half));
    ++evaluations_;
    take(body_at(body_, end.tip, end.axis, c[best]).f, c[best], index);
  }
  void take(double depth, Point3 at, std::uint32_t index) {
    if (depth > found_.mm) found_ = {depth, at, move_, index};
  }

  const TriangleTree& tree_;
  MillBody body_;
  double resolution_;
  const Stretch* stretch_ = nullptr;
  std::size_t move_ = 0;
  MillFinding found_;
  std::uint64_t evaluations_ = 0;
};

struct Piece {
  MillBody body;
  MillFinding MillCheckReport::*finding = nullptr;
};
std::vector<Piece> pieces_of(const CheckedMill& tool) {
  std::vector<Piece> out;
  for (const MillBody& body : bodies_of(tool)) {
    const ToolCylinder* c = out.empty() ? nullptr : &tool.cylinders[out.size() - 1];
    out.push_back({body, !c          ? &MillCheckReport::cutter
                         : c->holder ? &MillCheckReport::holder
                                     : &MillCheckReport::shank});
  }
  return out;
}

Error out_of_range(const std::string& what) {
  return {ErrorCode::range, what, {}};
}

Result<void> validate(const CheckedMill& tool, const MillCheckOptions& options) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (!positive(tool.radius) || !positive(tool.length))
    return out_of_range("radius and length of the cutter must be positive");
  if (!(tool.corner_radius >= 0 && tool.corner_radius <= std::min(tool.radius, tool.length)))
    return out_of_range("the corner radius does not fit the cutter (0 to radius and length)");
  for (const ToolCylinder& c : tool.cylinders)
    if (!positive(c.radius) || !std::isfinite(c.from) || !std::isfinite(c.to) || !(c.from < c.to))
      return out_of_range("a cylinder of the tool has no volume (radius > 0, from < to)");
  if (!positive(options.resolution_mm) || !positive(options.motion_mm))
    return out_of_range("resolution and motion tolerance must be positive");
  return {};
}

Result<void> validate(const geom::Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.vertices.size() || !is_finite(mesh.vertices[v]))
        return Error{ErrorCode::geometry,
                     "triangle " + std::to_string(t) + " has a corner that is not finite or not there",
                     {}};
  return {};
}

struct Deepest {
  std::vector<MillFinding> of_piece;
  std::uint64_t evaluations = 0;
};

}  // namespace

double MillCheckReport::gouge_max_mm() const {
  return std::max({cutter.mm, shank.mm, holder.mm});
}

Result<MillCheckReport> check_mill(const geom::Mesh& mesh, const CheckedMill& tool, const MillMotion& motion,
                                   const MillCheckOptions& options) {
  if (auto ok = validate(tool, options); !ok) return ok.error();
  if (auto ok = validate(mesh); !ok) return ok.error();
  const std::vector<Piece> pieces = pieces_of(tool);
  double span = 0;
  for (const Piece& p : pieces)
    span = std::max({span, std::abs(p.body.high) + p.body.radius, std::abs(p.body.low) + p.body.radius});
  const StretchedMotion moves(mesh, motion, span, options.motion_mm);
  if (auto ok = moves.validate(); !ok) return ok.error();

  MillCheckReport report;
  report.bound_mm = options.resolution_mm + (moves.exact() ? 0 : options.motion_mm);
  const TriangleTree tree(mesh);
  if (tree.nodes().empty() || moves.count() < 2) return report;

  std::vector<Deepest> chunks((moves.count() - 1 + kChunk - 1) / kChunk);
  parallel_for(chunks.size(), thread_count(options.threads), [&](std::size_t chunk, std::size_t) {
    std::vector<Search> searches;
    for (const Piece& p : pieces) searches.emplace_back(tree, p.body, options.resolution_mm);
    const std::size_t end = std::min(moves.count(), 1 + (chunk + 1) * kChunk);
    for (std::size_t m = 1 + chunk * kChunk; m < end; ++m)
      moves.for_each_stretch(m, [&](const Stretch& stretch) {
        for (Search& s : searches) s.stretch(stretch, m);
      });
    for (const Search& s : searches) {
      chunks[chunk].of_piece.push_back(s.deepest());
      chunks[chunk].evaluations += s.evaluations();
    }
  });
  for (const Deepest& chunk : chunks) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      MillFinding& worst = report.*pieces[i].finding;
      if (chunk.of_piece[i].mm > worst.mm) worst = chunk.of_piece[i];
    }
    report.evaluations += chunk.evaluations;
  }
  return report;
}

}  // namespace burin::verify
