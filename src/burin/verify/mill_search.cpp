// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/mill_search.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "burin/geom/point_tools.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// Triangles and times are halved at most so often; by then both are far below any resolution.
constexpr int kMostHalvings = 200;
// A front of more nodes than this costs more in every move than it spares.
constexpr std::size_t kMostFront = 64;

/// Both parts, the one that is nearer or deeper in its middle first.
template <class Bound, class First, class Second>
void both(const Bound& a, const Bound& b, First&& first, Second&& second) {
  if (a.f >= b.f) {
    first();
    second();
  } else {
    second();
    first();
  }
}

Error out_of_range(const std::string& what) {
  return {ErrorCode::range, what, {}};
}

}  // namespace

std::vector<ToolPiece> pieces_of(const CheckedMill& tool) {
  std::vector<ToolPiece> out;
  for (const MillBody& body : bodies_of(tool)) {
    const ToolCylinder* c = out.empty() ? nullptr : &tool.cylinders[out.size() - 1];
    out.push_back({body, !c ? ToolPart::cutter : c->holder ? ToolPart::holder : ToolPart::shank});
  }
  return out;
}
double span(const CheckedMill& tool) {
  double span = 0;
  for (const MillBody& body : bodies_of(tool)) span = std::max(span, body.span());
  return span;
}

Result<void> validate(const CheckedMill& tool) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (!positive(tool.radius) || !positive(tool.length))
    return out_of_range("radius and length of the cutter must be positive");
  if (!(tool.corner_radius >= 0 && tool.corner_radius <= std::min(tool.radius, tool.length)))
    return out_of_range("the corner radius does not fit the cutter (0 to radius and length)");
  for (const ToolCylinder& c : tool.cylinders)
    if (!positive(c.radius) || !std::isfinite(c.from) || !std::isfinite(c.to) || !(c.from < c.to))
      return out_of_range("a cylinder of the tool has no volume (radius > 0, from < to)");
  return {};
}

Result<void> validate_triangles(const geom::Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.vertices.size() || !is_finite(mesh.vertices[v]))
        return Error{ErrorCode::geometry,
                     "triangle " + std::to_string(t) + " has a corner that is not finite or not there",
                     {}};
  return {};
}

MillSearch::MillSearch(const TriangleTree& tree, const MillBody& body, double resolution,
                       std::uint64_t budget)
    : tree_(tree), body_(body), resolution_asked_(resolution), resolution_(resolution), budget_(budget) {
  reset(0);
}

void MillSearch::reset(double floor, double share) {
  floor_ = floor;
  share_ = share;
  found_ = {};
  found_.mm = floor;
  resolution_ = resolution_asked_;
  allowed_ = evaluations_ + budget_;
  update();
}

void MillSearch::know(const MillFinding& found) {
  found_ = found;
  update();
}

void MillSearch::update() {
  enough_ = found_.mm + (hit() ? std::max(resolution_, share_ * found_.mm) : resolution_);
}

void MillSearch::spend() {
  if (budget_ == 0 || evaluations_ <= allowed_) return;
  resolution_ *= 2;
  allowed_ += budget_;
  update();
}

void MillSearch::set(const Stretch& stretch, std::size_t move) {
  stretch_ = &stretch;
  move_ = move;
}

void MillSearch::seed(const Stretch& stretch, std::size_t move, Point3 at, std::uint32_t triangle) {
  set(stretch, move);
  for (const double t : {0.0, 0.5, 1.0}) {
    const Placed placed = stretch.at(t);
    ++evaluations_;
    take(body_at(body_, placed.tip, placed.axis, at).f, at, triangle);
  }
}

void MillSearch::stretch(const Stretch& stretch, std::size_t move, const Front& front) {
  set(stretch, move);
  const Span whole = Span::whole(stretch);
  for (const std::uint32_t index : front) box(index, whole, of_node(tree_.nodes()[index], whole));
}

MillSearch::Front MillSearch::root() const {
  return tree_.nodes().empty() ? Front{} : Front{0};
}

void MillSearch::narrow(const Placed& mean, double slack, const Front& front, Front& out) {
  const Stretch still{mean, {}, {}, {}, 0};
  set(still, move_);
  // The bound holds for the distance to the surface of the piece, outside of it, too, and that changes by no
  // more than the places move. What the move before has found or spent is not for the others.
  const double kept = enough_;
  enough_ = floor_ + resolution_asked_ - slack;
  out.clear();
  for (const std::uint32_t index : front) narrow_node(index, {0, 0, mean}, slack, out);
  enough_ = kept;
  stretch_ = nullptr;
}

void MillSearch::narrow_node(std::uint32_t index, const Span& still, double smallest, Front& out) {
  const TriangleTree::Node& node = tree_.nodes()[index];
  if (settled(of_node(node, still).value)) return;
  if (node.count > 0 || norm(node.half) <= smallest || out.size() >= kMostFront) {
    out.push_back(index);
    return;
  }
  narrow_node(node.first, still, smallest, out);
  narrow_node(node.first + 1, still, smallest, out);
}

template <class Extent>
Upper MillSearch::bound(const Extent& extent, const Span& span) {
  ++evaluations_;
  Upper upper = upper_bound(body_, *stretch_, span, extent, enough_);
  upper.value = std::min(upper.value, body_.inside());
  return upper;
}
Upper MillSearch::of_node(const TriangleTree::Node& node, const Span& span) {
  const Vec3 h = node.half;
  return bound(BoxExtent{node.center,
                         norm(h),
                         {node.normal, node.most, node.least},
                         {Vec3{h.x, 0, 0}, Vec3{0, h.y, 0}, Vec3{0, 0, h.z}}},
               span);
}
Upper MillSearch::of_triangle(const Corners& c, Vec3 normal, const Span& span) {
  return bound(TriangleExtent(c, normal), span);
}

void MillSearch::box(std::uint32_t index, const Span& span, const Upper& upper) {
  spend();
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

void MillSearch::triangle(const Corners& c, std::uint32_t index, Vec3 normal, const Span& span,
                          const Upper& upper, int depth) {
  spend();
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
void MillSearch::take(const Corners& c, std::uint32_t index, const Span& span, const Upper& upper) {
  take(upper.f, lerp(lerp(c[0], c[1], 0.5), c[2], 1.0 / 3), index);
  std::size_t best = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (dot(upper.gradient, c[i] - c[best]) > 0) best = i;
  const Placed end = stretch_->at(span.middle + (upper.along_time > 0 ? span.half : -span.half));
  ++evaluations_;
  take(body_at(body_, end.tip, end.axis, c[best]).f, c[best], index);
}
void MillSearch::take(double depth, Point3 at, std::uint32_t index) {
  if (depth <= found_.mm) return;
  found_ = {depth, at, move_, index};
  update();
}

}  // namespace burin::verify
