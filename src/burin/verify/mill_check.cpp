// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/mill_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "burin/base/parallel.h"
#include "burin/geom/point_tools.h"
#include "burin/verify/mill_body.h"
#include "burin/verify/mill_motion.h"
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

struct Span {
  double middle = 0, half = 0;  ///< of the time
  Placed at;                    ///< in the middle
};

/// The deepest gouge of one piece of the tool on a stretch of motion: branch and bound over boxes, triangles
/// and times.
class Search {
 public:
  Search(const TriangleTree& tree, const MillBody& body, double resolution)
      : tree_(tree), body_(body), resolution_(resolution) {}

  void stretch(const Stretch& stretch, std::size_t move) {
    stretch_ = &stretch;
    turn_rate_ = norm(stretch.turn);
    way_rate_ = norm(stretch.way);
    move_ = move;
    const Span whole{0.5, 0.5, stretch.at(0.5)};
    const Upper upper = of_node(tree_.nodes()[0], whole);
    box(0, whole, upper);
  }
  const MillFinding& deepest() const { return found_; }
  std::uint64_t evaluations() const { return evaluations_; }

 private:
  using Corners = std::array<Point3, 3>;
  /// A unit normal and how far the extent goes from its centre along it.
  struct Plane {
    Vec3 normal;
    double most = 0, least = 0;
  };
  struct Upper {
    double value = 0;  ///< no place is deeper
    double f = 0;      ///< in the middle
    // Of the side that is the least there; what it may grow by is the reason to divide.
    Vec3 gradient;
    double space = 0, time = 0;
    double along_time = 0;
  };

  bool settled(double value) const { return value <= found_.mm + resolution_; }

  /// All places within the extent over the span: the least of the bounds that the sides of the body give, and
  /// of a mean of bottom and side, whose edge is where flat ends cut deepest. `directions(g)`: what three
  /// directions that span the extent add to g's function; `most(those)`: what they add together at most.
  /// `radius`: of a ball about the centre that holds the extent.
  template <class Directions, class Most>
  Upper bound(Point3 center, double radius, const Plane& plane, const Span& span, Directions&& directions,
              Most&& most) {
    ++evaluations_;
    const BodyAt b = body_at(body_, span.at.tip, span.at.axis, center);
    // How a place of the part moves as seen from the tool, to the first order and what is left of it.
    const Vec3 from_tip = center - span.at.tip, turn = stretch_->turn;
    const Vec3 motion = -(stretch_->way + cross(turn, from_tip));
    const double far = norm(from_tip) + radius + way_rate_ * span.half;
    const double bend = 0.5 * turn_rate_ * (turn_rate_ * far + 2 * way_rate_) * span.half * span.half;
    Upper upper;
    upper.f = b.f;
    upper.value = std::numeric_limits<double>::infinity();
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
    consider(body_.reach(span.at.axis, -n) + dot(n, from_tip), n, side > 0 ? plane.most : -plane.least,
             false);
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
      consider(share * b.sides[0].f + (1 - share) * b.sides[1].f, gradient, most(directions(gradient)),
               false);
    }
    return upper;
  }

  Upper of_node(const TriangleTree::Node& node, const Span& span) {
    return bound(
        node.center, norm(node.half), {node.normal, node.most, node.least}, span,
        [&](Vec3 g) {
          return std::array{g.x * node.half.x, g.y * node.half.y, g.z * node.half.z};
        },
        [](const std::array<double, 3>& d) { return std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]); });
  }

  static Point3 middle(const Corners& c) { return lerp(lerp(c[0], c[1], 0.5), c[2], 1.0 / 3); }
  Upper of_triangle(const Corners& c, Vec3 normal, const Span& span) {
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

  std::array<Span, 2> halves(const Span& span) const {
    std::array<Span, 2> out;
    const double half = 0.5 * span.half;
    for (std::size_t i = 0; i < 2; ++i) {
      const double middle = span.middle + (i == 0 ? -half : half);
      out[i] = {middle, half, stretch_->at(middle)};
    }
    return out;
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

  void triangle(const Corners& c, std::uint32_t index, Vec3 normal, const Span& span, const Upper& upper,
                int depth) {
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
  void take(const Corners& c, std::uint32_t index, const Span& span, const Upper& upper) {
    take(upper.f, middle(c), index);
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
  double turn_rate_ = 0, way_rate_ = 0;
  std::size_t move_ = 0;
  MillFinding found_;
  std::uint64_t evaluations_ = 0;
};

struct Piece {
  MillBody body;
  MillFinding MillCheckReport::*finding = nullptr;
};
std::vector<Piece> pieces_of(const CheckedMill& tool) {
  std::vector<Piece> out{{{tool.radius, 0, tool.length, tool.corner_radius}, &MillCheckReport::cutter}};
  for (const ToolCylinder& c : tool.cylinders)
    out.push_back(
        {{c.radius, c.from, c.to, 0}, c.holder ? &MillCheckReport::holder : &MillCheckReport::shank});
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
