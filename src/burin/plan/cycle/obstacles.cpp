// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::cycle {
namespace {

using geom::Box3;
using geom::Direction;
using geom::Interval;
using geom::Point2;
using geom::Point3;
using geom::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Cells in all, about 200 MB. When more would be needed the cells are made coarser.
constexpr std::size_t kMostCells = 1'200'000;
constexpr int kMaxDepth = 24;
constexpr std::size_t kCellsPerLeaf = 4;
// The plane and the extent are taken from 3 x 3 points: exact for surfaces of second degree, this much is
// added for others.
constexpr double kSampled = 1.25;

double square(double x) {
  return x * x;
}

// Horizontal distance of p from a box, squared.
double across2(const Box3& box, Point2 p) {
  const double dx = std::max({box.lo.x - p.x, p.x - box.hi.x, 0.0});
  const double dy = std::max({box.lo.y - p.y, p.y - box.hi.y, 0.0});
  return dx * dx + dy * dy;
}

struct Samples {
  Point3 p[3][3];  // [v][u]
};

double bend_u(const Samples& s) {
  double most = 0;
  for (const auto& row : s.p) most = std::max(most, norm(row[1] - lerp(row[0], row[2], 0.5)));
  return most;
}

double bend_v(const Samples& s) {
  double most = 0;
  for (int i = 0; i < 3; ++i) most = std::max(most, norm(s.p[1][i] - lerp(s.p[0][i], s.p[2][i], 0.5)));
  return most;
}

double length_u(const Samples& s) {
  double most = 0;
  for (const auto& row : s.p) most = std::max(most, distance(row[0], row[1]) + distance(row[1], row[2]));
  return most;
}

double length_v(const Samples& s) {
  double most = 0;
  for (int i = 0; i < 3; ++i)
    most = std::max(most, distance(s.p[0][i], s.p[1][i]) + distance(s.p[1][i], s.p[2][i]));
  return most;
}

std::vector<double> cuts_of(const geom::NurbsSurface& s, Direction d) {
  std::vector<double> cuts{s.domain(d).lo};
  for (const geom::Knot& k : geom::inner_knots(s.knots(d), s.degree(d))) cuts.push_back(k.value);
  cuts.push_back(s.domain(d).hi);
  return cuts;
}

// Height of the centre of a ball of radius `reach` over p that touches q; -infinity when it passes by.
double touch(Point3 q, Point2 p, double reach) {
  const double h = reach * reach - square(q.x - p.x) - square(q.y - p.y);
  return h >= 0 ? q.z + std::sqrt(h) : -kInfinity;
}

}  // namespace

Obstacles::Obstacles(const geom::Composite& composite, const std::vector<Region>& regions, double radius,
                     double stock, double fine_mm)
    : radius_(radius), stock_(stock) {
  for (const geom::JoinedSurface& s : composite.surfaces) evaluators_.emplace_back(s.surface);
  for (;; fine_mm *= 4) {
    bool over = false;
    cells_.clear();
    for (std::size_t i = 0; i < composite.surfaces.size() && !over; ++i)
      add_surface(composite.surfaces[i], regions[i], static_cast<std::uint32_t>(i), fine_mm, kMostCells,
                  over);
    if (!over || fine_mm > 1e6) break;
  }
  build_tree();
}

void Obstacles::add_surface(const geom::JoinedSurface& surface, const Region& region, std::uint32_t index,
                            double fine_mm, std::size_t budget, bool& over) {
  const std::vector<double> u = cuts_of(surface.surface, Direction::u),
                            v = cuts_of(surface.surface, Direction::v);
  for (std::size_t j = 0; j + 1 < v.size() && !over; ++j)
    for (std::size_t i = 0; i + 1 < u.size() && !over; ++i)
      add_rectangle(region, index, {u[i], u[i + 1]}, {v[j], v[j + 1]}, fine_mm, 0, budget, over);
}

void Obstacles::add_rectangle(const Region& region, std::uint32_t index, Interval u, Interval v,
                              double fine_mm, int depth, std::size_t budget, bool& over) {
  if (over) return;
  const bool edge = region.on_edge(u, v);
  if (!edge && !region.inside(0.5 * (u.lo + u.hi), 0.5 * (v.lo + v.hi))) return;
  Samples s;
  geom::SurfaceEvaluator& evaluator = evaluators_[index];
  // Just inside, so that knots at the ends do not matter.
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      s.p[j][i] = evaluator.point(u.lo + 0.5 * i * u.length(), v.lo + 0.5 * j * v.length());
  const double reach = radius_ + stock_;
  // Cells on a trimming loop reach beyond it by their size.
  const double largest = edge ? 0.02 * reach : 0.5 * reach;
  const double bu = bend_u(s), bv = bend_v(s), lu = length_u(s), lv = length_v(s);
  // Twist is seen by neither row nor column.
  const double twist = 0.25 * norm((s.p[0][0] - s.p[0][2]) + (s.p[2][2] - s.p[2][0]));
  const bool flat = std::max({bu, bv, 0.25 * twist}) <= fine_mm && std::max(lu, lv) <= largest;
  const bool may_split = depth < kMaxDepth && std::max(lu, lv) > 1e-3;
  if (!flat && may_split) {
    const double cu = std::max(bu / fine_mm, lu / largest), cv = std::max(bv / fine_mm, lv / largest);
    const double mu = 0.5 * (u.lo + u.hi), mv = 0.5 * (v.lo + v.hi);
    // Only twist is left: halve the longer side.
    const bool in_u = std::max(cu, cv) > 1 ? cu >= cv : lu >= lv;
    if (in_u) {
      add_rectangle(region, index, {u.lo, mu}, v, fine_mm, depth + 1, budget, over);
      add_rectangle(region, index, {mu, u.hi}, v, fine_mm, depth + 1, budget, over);
    } else {
      add_rectangle(region, index, u, {v.lo, mv}, fine_mm, depth + 1, budget, over);
      add_rectangle(region, index, u, {mv, v.hi}, fine_mm, depth + 1, budget, over);
    }
    return;
  }
  if (cells_.size() >= budget) {
    over = true;
    return;
  }
  Cell c;
  c.surface = index;
  c.u = u;
  c.v = v;
  c.middle = s.p[1][1];
  c.normal = unit(cross(s.p[2][2] - s.p[0][0], s.p[2][0] - s.p[0][2]));
  c.half_u = 0.5 * (s.p[1][2] - s.p[1][0]);
  c.half_v = 0.5 * (s.p[2][1] - s.p[0][1]);
  const Vec3 longer = norm(c.half_u) >= norm(c.half_v) ? c.half_u : c.half_v;
  c.side = unit(longer - dot(longer, c.normal) * c.normal);
  const Vec3 across = cross(c.normal, c.side);
  for (const auto& row : s.p)
    for (const Point3 q : row) {
      const Vec3 e = q - c.middle;
      c.box.add(q);
      c.extent_side = std::max(c.extent_side, std::abs(dot(e, c.side)));
      c.extent_across = std::max(c.extent_across, std::abs(dot(e, across)));
      c.thickness = std::max(c.thickness, std::abs(dot(e, c.normal)));
    }
  const double bulge = std::max({bu, bv, twist}) * kSampled;
  c.plane = flat && norm(c.normal) > 0;
  // Of a cell without area the axes vanish that it has no extent along: nothing is ruled out by them.
  c.thickness = kSampled * c.thickness;
  c.extent_side += bulge;
  c.extent_across += bulge;
  c.box = c.box.grown(bulge);
  cells_.push_back(c);
}

void Obstacles::build_tree() {
  std::vector<std::uint32_t> order(cells_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  top_ = -kInfinity;
  for (const Cell& c : cells_) top_ = std::max(top_, c.middle.z + stock_);
  if (order.empty()) return;
  nodes_.reserve(2 * order.size() / kCellsPerLeaf + 4);
  build_node(order, 0, order.size());
  std::vector<Cell> sorted;
  sorted.reserve(cells_.size());
  for (const std::uint32_t i : order) sorted.push_back(cells_[i]);
  cells_ = std::move(sorted);
}

std::uint32_t Obstacles::build_node(std::vector<std::uint32_t>& order, std::size_t first, std::size_t last) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  Box3 box, middles;
  for (std::size_t i = first; i < last; ++i) {
    box.add(cells_[order[i]].box);
    middles.add(cells_[order[i]].middle);
  }
  nodes_[index].box = box;
  if (last - first <= kCellsPerLeaf) {
    nodes_[index].first = static_cast<std::uint32_t>(first);
    nodes_[index].count = static_cast<std::uint32_t>(last - first);
    return static_cast<std::uint32_t>(index);
  }
  const Vec3 size = middles.hi - middles.lo;
  const auto key = [&](std::uint32_t i) {
    const Point3 m = cells_[i].middle;
    if (size.x >= size.y && size.x >= size.z) return m.x;
    return size.y >= size.z ? m.y : m.z;
  };
  const std::size_t mid = (first + last) / 2;
  const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(mid), at(last), [&](std::uint32_t a, std::uint32_t b) {
    const double ka = key(a), kb = key(b);
    return ka < kb || (ka == kb && a < b);
  });
  build_node(order, first, mid);
  const std::uint32_t right = build_node(order, mid, last);
  nodes_[index].right = right;
  return static_cast<std::uint32_t>(index);
}

namespace {

struct Place {
  double u = 0, v = 0;
};

/// The step from a place of a cell towards the one nearest to c: Newton, or Gauss-Newton where the distance
/// bends the wrong way; clamped to the cell.
enum class Step { none, newton, gauss_newton };
Step step_to_nearest(const geom::SurfaceDerivatives& d, Vec3 e, Interval u, Interval v, Place at,
                     Place& step) {
  double uu = dot(d.du, d.du) - dot(e, d.duu), vv = dot(d.dv, d.dv) - dot(e, d.dvv);
  double uv = dot(d.du, d.dv) - dot(e, d.duv);
  Step kind = Step::newton;
  if (!(uu > 0 && vv > 0 && uu * vv - uv * uv > 1e-9 * uu * vv)) {
    uu = dot(d.du, d.du), vv = dot(d.dv, d.dv), uv = dot(d.du, d.dv);
    if (!(uu * vv - uv * uv > 1e-12 * uu * vv)) return Step::none;
    kind = Step::gauss_newton;
  }
  const double ru = dot(e, d.du), rv = dot(e, d.dv), det = uu * vv - uv * uv;
  step = {(ru * vv - rv * uv) / det, (rv * uu - ru * uv) / det};
  if (at.u + step.u < u.lo || at.u + step.u > u.hi) {
    step.u = std::clamp(at.u + step.u, u.lo, u.hi) - at.u;
    step.v = (rv - step.u * uv) / vv;
  }
  if (at.v + step.v < v.lo || at.v + step.v > v.hi) {
    step.v = std::clamp(at.v + step.v, v.lo, v.hi) - at.v;
    step.u = std::clamp(at.u + (ru - step.v * uv) / uu, u.lo, u.hi) - at.u;
  }
  return kind;
}

/// Of a parallelogram middle + s a + t b, |s|, |t| <= 1: the (s, t) nearest to e from the middle, nearly (the
/// clamping of one is not seen by the other).
Place on_parallelogram(Vec3 a, Vec3 b, Vec3 e) {
  const double aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), det = aa * bb - ab * ab;
  if (!(det > 1e-12 * aa * bb)) return {};
  const double ra = dot(e, a), rb = dot(e, b);
  return {std::clamp((ra * bb - rb * ab) / det, -1.0, 1.0), std::clamp((rb * aa - ra * ab) / det, -1.0, 1.0)};
}

}  // namespace

Obstacles::Probe::Probe(const Obstacles& obstacles)
    : obstacles_(&obstacles), evaluators_(obstacles.evaluators_.size()) {}

geom::SurfaceEvaluator& Obstacles::Probe::evaluator(std::uint32_t surface) {
  std::optional<geom::SurfaceEvaluator>& e = evaluators_[surface];
  if (!e) e.emplace(obstacles_->evaluators_[surface]);
  return *e;
}

double Obstacles::Probe::visit(std::uint32_t index, Point2 p, double reach, double floor) {
  const Cell& cell = obstacles_->cells_[index];
  geom::SurfaceEvaluator& surface = evaluator(cell.surface);
  Place at{0.5 * (cell.u.lo + cell.u.hi), 0.5 * (cell.v.lo + cell.v.hi)};
  double best = -kInfinity;
  double height = floor;
  if (cell.plane && floor >= cell.box.hi.z) {
    // Below the centre: the nearest place is about that of the cell's plane.
    const Place on = on_parallelogram(cell.half_u, cell.half_v, Point3{p.x, p.y, floor} - cell.middle);
    at.u = std::clamp(at.u + 0.5 * on.u * cell.u.length(), cell.u.lo, cell.u.hi);
    at.v = std::clamp(at.v + 0.5 * on.v * cell.v.length(), cell.v.lo, cell.v.hi);
  } else {
    // The shank may touch it anywhere: the highest of five points to start from.
    best = touch(cell.middle, p, reach);
    for (const double cu : {cell.u.lo, cell.u.hi})
      for (const double cv : {cell.v.lo, cell.v.hi}) {
        const double z = touch(surface.point(cu, cv), p, reach);
        if (z > best) best = z, at = {cu, cv};
      }
    height = std::max(floor, best);
    if (!(height > -kInfinity)) height = cell.middle.z + reach;
  }
  // The nearest point of the cell to the centre; when the ball overlaps it the centre rises until it
  // touches; as the touching height is largest at the nearest point, this converges quadratically.
  constexpr int kIterations = 16;
  double last_gain = kInfinity;
  for (int i = 0; i < kIterations; ++i) {
    const geom::SurfaceDerivatives d = surface.derivatives(at.u, at.v);
    best = std::max(best, touch(d.p, p, reach));
    if (best > height) {
      last_gain = best - height;
      height = best;
    }
    const Vec3 e = Point3{p.x, p.y, height} - d.p;
    Place step;
    const Step kind = step_to_nearest(d, e, cell.u, cell.v, at, step);
    if (kind == Step::none) break;
    const double moved = norm(step.u * d.du + step.v * d.dv);
    // Out of reach by more than there is left to go.
    if (height == floor && kind == Step::newton && norm(e) - reach > 2 * moved) break;
    at = {at.u + step.u, at.v + step.v};
    // The height is second-order in the place: 1e-6 mm off is nothing.
    if (moved < 1e-6 && last_gain < 1e-10) break;
    if (moved < 1e-6) last_gain = 0;
  }
  if (best > floor) last_ = index;
  return std::max(best, floor);
}

double Obstacles::Probe::highest(Point2 p, double reach, double floor, double stop_above) {
  const std::vector<Node>& nodes = obstacles_->nodes_;
  if (nodes.empty()) return floor;
  const double reach2 = reach * reach;
  const std::uint32_t first = last_;
  if (first != kNone) {
    floor = visit(first, p, reach, floor);
    if (floor > stop_above) return floor;
  }
  // The ball at the floor, and the shank above it, reach the box.
  const auto may_raise = [&](const Box3& box, double away2) {
    const double below = std::max(0.0, floor - box.hi.z);
    return away2 + below * below < reach2;
  };
  struct Waiting {
    std::uint32_t node = 0;
    double away2 = 0;
  };
  Waiting stack[128];
  int size = 0;
  stack[size++] = {0, across2(nodes[0].box, p)};
  while (size > 0) {
    const Waiting next = stack[--size];
    const Node& node = nodes[next.node];
    if (!may_raise(node.box, next.away2)) continue;
    if (node.count == 0) {
      Waiting left{next.node + 1, across2(nodes[next.node + 1].box, p)};
      Waiting right{node.right, across2(nodes[node.right].box, p)};
      const bool go_left = may_raise(nodes[left.node].box, left.away2);
      const bool go_right = may_raise(nodes[right.node].box, right.away2);
      // The one that may touch higher first: it raises the floor for the other.
      if (go_left && go_right &&
          nodes[left.node].box.hi.z + std::sqrt(reach2 - left.away2) <
              nodes[right.node].box.hi.z + std::sqrt(reach2 - right.away2))
        std::swap(left, right);
      if (go_right) stack[size++] = right;
      if (go_left) stack[size++] = left;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (i == first) continue;
      const Cell& cell = obstacles_->cells_[i];
      if (!may_raise(cell.box, across2(cell.box, p))) continue;
      if (cell.box.hi.z <= floor && out_of_reach(cell, {p.x, p.y, floor}, reach2)) continue;
      floor = visit(i, p, reach, floor);
      if (floor > stop_above) return floor;
    }
  }
  return floor;
}

// All of the cell is below the centre: it is free when its box along its own axes is out of reach.
bool Obstacles::out_of_reach(const Cell& cell, Point3 centre, double reach2) {
  const Vec3 e = centre - cell.middle;
  const double up = std::max(0.0, std::abs(dot(e, cell.normal)) - cell.thickness);
  const double side = std::max(0.0, std::abs(dot(e, cell.side)) - cell.extent_side);
  const double across = std::max(0.0, std::abs(dot(e, cross(cell.normal, cell.side))) - cell.extent_across);
  return up * up + side * side + across * across >= reach2;
}

bool Obstacles::Probe::clear(Point3 centre, double depth) {
  const double reach = obstacles_->radius_ + obstacles_->stock_ - depth;
  if (!(reach > 0)) return true;
  // Heights are found to 1e-10; a hair above is not above.
  constexpr double kHair = 1e-9;
  return highest(xy(centre), reach, centre.z, centre.z + kHair) <= centre.z + kHair;
}

double Obstacles::Probe::lowest_tip(Point2 p) {
  return lowest_tip(p, -kInfinity);
}

double Obstacles::Probe::lowest_tip(Point2 p, double floor) {
  const double radius = obstacles_->radius_;
  return highest(p, radius + obstacles_->stock_, floor + radius, kInfinity) - radius;
}

double Obstacles::Probe::depth(Point3 centre, double most) {
  constexpr double kFine = 1e-6;
  if (clear(centre, kFine)) return 0;
  double lo = kFine, hi = most;
  if (!clear(centre, most)) return most;
  while (hi - lo > std::max(kFine, 0.01 * lo)) {
    const double mid = 0.5 * (lo + hi);
    (clear(centre, mid) ? hi : lo) = mid;
  }
  return hi;
}

}  // namespace burin::cycle
