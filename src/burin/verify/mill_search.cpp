// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/mill_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

Point3 middle(const std::array<Point3, 3>& c) {
  return lerp(lerp(c[0], c[1], 0.5), c[2], 1.0 / 3);
}
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
  std::vector<ToolPiece> out{{{tool.radius, 0, tool.length, tool.corner_radius}, ToolPart::cutter}};
  for (const ToolCylinder& c : tool.cylinders)
    out.push_back({{c.radius, c.from, c.to, 0}, c.holder ? ToolPart::holder : ToolPart::shank});
  return out;
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
  turn_rate_ = norm(stretch.turn);
  way_rate_ = norm(stretch.way);
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
  const Span whole{0.5, 0.5, stretch.at(0.5)};
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

/// All places within the extent over the span: the least of the bounds that the sides of the body give, and
/// of a mean of bottom and side, whose edge is where flat ends cut deepest. `directions(g)`: what three
/// directions that span the extent add to g's function; `most(those)`: what they add together at most.
/// `radius`: of a ball about the centre that holds the extent.
template <class Directions, class Most>
MillSearch::Upper MillSearch::bound(Point3 center, double radius, const Plane& plane, const Span& span,
                                    Directions&& directions, Most&& most) {
  ++evaluations_;
  const BodyAt b = body_at(body_, span.at.tip, span.at.axis, center);
  // How a place of the part moves as seen from the tool, to the first order and what is left of it.
  const Vec3 from_tip = center - span.at.tip, turn = stretch_->turn;
  const Vec3 motion = -(stretch_->way + cross(turn, from_tip));
  const double far = norm(from_tip) + radius + way_rate_ * span.half;
  const double bend = 0.5 * turn_rate_ * (turn_rate_ * far + 2 * way_rate_) * span.half * span.half;
  Upper upper;
  upper.f = b.f;
  upper.value = body_.inside();
  const auto consider = [&](double f, Vec3 gradient, double space, bool least) {
    const double along = dot(gradient, motion);
    double time = span.half * std::abs(along) + bend;
    // (gradient x turn) . (place - centre): of how differently the places move.
    if (turn_rate_ > 0)
      time += span.half *
              std::max(most(directions(cross(gradient, turn))), most(directions(cross(turn, gradient))));
    upper.value = std::min(upper.value, f + space + time);
    if (least) upper.space = space, upper.time = time, upper.gradient = gradient, upper.along_time = along;
  };
  for (std::size_t i = 0; i < b.count; ++i) {
    consider(b.sides[i].f, b.sides[i].gradient, most(directions(b.sides[i].gradient)), i == b.least);
    if (settled(upper.value)) return upper;
  }
  const double side = dot(plane.normal, upper.gradient) < 0 ? -1 : 1;
  const Vec3 n = side * plane.normal;
  consider(body_.reach(span.at.axis, -n) + dot(n, from_tip), n, side > 0 ? plane.most : -plane.least, false);
  if (settled(upper.value)) return upper;
  // The mean of bottom and side that changes least over extent and span.
  const auto one = directions(b.sides[0].gradient), two = directions(b.sides[1].gradient);
  const double time_one = span.half * dot(b.sides[0].gradient, motion);
  const double time_two = span.half * dot(b.sides[1].gradient, motion);
  double over = time_two * (time_two - time_one), under = (time_two - time_one) * (time_two - time_one);
  for (std::size_t i = 0; i < 3; ++i) {
    over += two[i] * (two[i] - one[i]);
    under += (two[i] - one[i]) * (two[i] - one[i]);
  }
  if (under > 0 && over > 0 && over < under) {
    const double share = over / under;
    const Vec3 gradient = share * b.sides[0].gradient + (1 - share) * b.sides[1].gradient;
    consider(share * b.sides[0].f + (1 - share) * b.sides[1].f, gradient, most(directions(gradient)), false);
  }
  return upper;
}

MillSearch::Upper MillSearch::of_node(const TriangleTree::Node& node, const Span& span) {
  return bound(
      node.center, norm(node.half), {node.normal, node.most, node.least}, span,
      [&](Vec3 g) {
        return std::array{g.x * node.half.x, g.y * node.half.y, g.z * node.half.z};
      },
      [](const std::array<double, 3>& d) { return std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]); });
}

MillSearch::Upper MillSearch::of_triangle(const Corners& c, Vec3 normal, const Span& span) {
  const Point3 m = middle(c);
  const double radius = std::max({distance(m, c[0]), distance(m, c[1]), distance(m, c[2])});
  return bound(
      m, radius, {normal, 0, 0}, span,
      [&](Vec3 g) {
        return std::array{dot(g, c[0] - m), dot(g, c[1] - m), dot(g, c[2] - m)};
      },
      [](const std::array<double, 3>& d) {
        return std::max({d[0], d[1], d[2]});
      });
}

std::array<MillSearch::Span, 2> MillSearch::halves(const Span& span) const {
  std::array<Span, 2> out;
  const double half = 0.5 * span.half;
  for (std::size_t i = 0; i < 2; ++i) {
    const double middle = span.middle + (i == 0 ? -half : half);
    out[i] = {middle, half, stretch_->at(middle)};
  }
  return out;
}

void MillSearch::box(std::uint32_t index, const Span& span, const Upper& upper) {
  spend();
  if (settled(upper.value)) return;
  const TriangleTree::Node& node = tree_.nodes()[index];
  // Below the resolution time is halved for triangles only, where what is found settles the rest.
  if (upper.time > std::max(upper.space, resolution_)) {
    const std::array<Span, 2> parts = halves(span);
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
    const std::array<Span, 2> parts = halves(span);
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
  take(upper.f, middle(c), index);
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
