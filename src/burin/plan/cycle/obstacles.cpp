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
  for (const auto& row : s.p)
    for (const Point3 q : row) {
      c.box.add(q);
      c.extent = std::max(c.extent, distance(q, c.middle));
      c.thickness = std::max(c.thickness, std::abs(dot(q - c.middle, c.normal)));
    }
  // A cell without area has no plane: it is a ball of its extent.
  if (norm(c.normal) == 0) c.thickness = c.extent;
  const double bulge = std::max({bu, bv, twist}) * kSampled;
  c.thickness = kSampled * c.thickness;
  c.extent += bulge;
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

double Obstacles::climb(const Cell& cell, Point2 p, double reach, double floor) const {
  geom::SurfaceEvaluator& evaluator = evaluators_[cell.surface];
  // The highest of five points to start from.
  double u = 0.5 * (cell.u.lo + cell.u.hi), v = 0.5 * (cell.v.lo + cell.v.hi);
  double best = touch(cell.middle, p, reach);
  for (const double cu : {cell.u.lo, cell.u.hi})
    for (const double cv : {cell.v.lo, cell.v.hi}) {
      const double z = touch(evaluator.point(cu, cv), p, reach);
      if (z > best) best = z, u = cu, v = cv;
    }
  double height = std::max(floor, best);
  if (!(height > -kInfinity)) height = cell.middle.z + reach;
  // The nearest point of the cell to the centre; when the ball overlaps it the centre rises until it
  // touches; as the touching height is largest at the nearest point, this converges quadratically.
  constexpr int kIterations = 16;
  double last_gain = kInfinity;
  for (int i = 0; i < kIterations; ++i) {
    const Point3 c{p.x, p.y, height};
    const geom::SurfaceDerivatives d = evaluator.derivatives(u, v);
    const double z = touch(d.p, p, reach);
    if (z > best) best = z;
    if (best > height) {
      last_gain = best - height;
      height = best;
    }
    const Vec3 e = c - d.p;
    double uu = dot(d.du, d.du) - dot(e, d.duu), vv = dot(d.dv, d.dv) - dot(e, d.dvv);
    double uv = dot(d.du, d.dv) - dot(e, d.duv);
    if (!(uu > 0 && vv > 0 && uu * vv - uv * uv > 1e-9 * uu * vv)) {
      uu = dot(d.du, d.du), vv = dot(d.dv, d.dv), uv = dot(d.du, d.dv);
      if (!(uu * vv - uv * uv > 1e-12 * uu * vv)) break;
    }
    const double ru = dot(e, d.du), rv = dot(e, d.dv), det = uu * vv - uv * uv;
    double du = (ru * vv - rv * uv) / det, dv = (rv * uu - ru * uv) / det;
    if (u + du < cell.u.lo || u + du > cell.u.hi) {
      du = std::clamp(u + du, cell.u.lo, cell.u.hi) - u;
      dv = (rv - du * uv) / vv;
    }
    if (v + dv < cell.v.lo || v + dv > cell.v.hi) {
      dv = std::clamp(v + dv, cell.v.lo, cell.v.hi) - v;
      du = std::clamp(u + (ru - dv * uv) / uu, cell.u.lo, cell.u.hi) - u;
    }
    const double moved = norm(du * d.du + dv * d.dv);
    u += du;
    v += dv;
    // The height is second-order in the place: 1e-6 mm off is nothing.
    if (moved < 1e-6 && last_gain < 1e-10) break;
    if (moved < 1e-6) last_gain = 0;
  }
  return std::max(best, floor);
}

double Obstacles::highest(Point2 p, double reach, double floor, double stop_above) const {
  if (nodes_.empty()) return floor;
  const double reach2 = reach * reach;
  std::uint32_t stack[128];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    const double away2 = across2(node.box, p);
    if (away2 >= reach2) continue;
    if (node.box.hi.z + std::sqrt(reach2 - away2) <= floor) continue;
    if (node.count == 0) {
      const std::uint32_t left = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
      // The higher one first: it raises the floor for the other.
      const bool left_first = nodes_[left].box.hi.z >= nodes_[node.right].box.hi.z;
      stack[size++] = left_first ? node.right : left;
      stack[size++] = left_first ? left : node.right;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Cell& cell = cells_[i];
      const double off2 = across2(cell.box, p);
      if (off2 >= reach2 || cell.box.hi.z + std::sqrt(reach2 - off2) <= floor) continue;
      if (floor > -kInfinity && cell.box.hi.z <= floor) {
        // All of it is below the centre: it is free when the disc that holds it is out of reach.
        const Vec3 e = Point3{p.x, p.y, floor} - cell.middle;
        const double h = dot(e, cell.normal), all2 = dot(e, e);
        const double up = std::max(0.0, std::abs(h) - cell.thickness);
        const double side = std::max(0.0, std::sqrt(std::max(0.0, all2 - h * h)) - cell.extent);
        if (up * up + side * side >= reach2) continue;
      }
      floor = std::max(floor, climb(cell, p, reach, floor));
      if (floor > stop_above) return floor;
    }
  }
  return floor;
}

bool Obstacles::clear(Point3 centre, double depth) const {
  const double reach = radius_ + stock_ - depth;
  if (!(reach > 0)) return true;
  // Heights are found to 1e-10; a hair above is not above.
  constexpr double kHair = 1e-9;
  return highest(xy(centre), reach, centre.z, centre.z + kHair) <= centre.z + kHair;
}

double Obstacles::lowest_tip(Point2 p) const {
  return lowest_tip(p, -kInfinity);
}

double Obstacles::lowest_tip(Point2 p, double floor) const {
  return highest(p, radius_ + stock_, floor + radius_, kInfinity) - radius_;
}

double Obstacles::depth(Point3 centre, double most) const {
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
