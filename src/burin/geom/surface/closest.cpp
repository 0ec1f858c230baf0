// SPDX-License-Identifier: Apache-2.0
// Branch and bound: a tree of boxes over the Bezier pieces, then pieces cut in halves. See docs/surfaces.md.
#include "burin/geom/surface/closest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "burin/geom/surface/axis.h"
#include "burin/geom/surface/basis.h"
#include "burin/geom/surface/closest_cell.h"
#include "burin/geom/surface/closest_newton.h"

namespace burin::geom {
namespace {

using detail::Axis;
using detail::Cell;

/// More leaves are not made: they then hold blocks of pieces.
constexpr std::int64_t kMaxLeaves = 1 << 16;
/// Work is bounded: after this many steps the best place found so far is returned, without proof. (A surface
/// of equal distance everywhere that is no exact sphere, say.)
constexpr int kMaxSteps = 200'000;

struct Block {
  int u_begin = 0, u_end = 0, v_begin = 0, v_end = 0;
  std::int64_t pieces() const { return std::int64_t{u_end - u_begin} * (v_end - v_begin); }
};

struct Node {
  Box3 box;
  Block block;
  std::int32_t left = -1, right = -1;  // -1: a leaf
};

double distance_to(const Box3& box, Point3 p) {
  const auto gap = [](double lo, double hi, double x) { return std::max({lo - x, x - hi, 0.0}); };
  return norm({gap(box.lo.x, box.hi.x, p.x), gap(box.lo.y, box.hi.y, p.y), gap(box.lo.z, box.hi.z, p.z)});
}

/// Waits for being looked at: a node of the tree, a piece, or a part of one.
struct Item {
  double bound = 0;  // no point of it is nearer
  std::int64_t order = 0;
  std::int32_t node = -1;
  int iu = -1, iv = -1;
  std::unique_ptr<Cell> cell;
};
bool later(const Item& a, const Item& b) {
  return a.bound != b.bound ? a.bound > b.bound : a.order > b.order;
}

}  // namespace

struct ClosestPointFinder::State {
  NurbsSurface surface;
  Axis u, v;
  detail::Newton newton;
  std::int64_t leaf_pieces = 1;
  double reach = 0;  // largest coordinate
  std::vector<Node> nodes;

  explicit State(const NurbsSurface& s);
  std::int32_t build(Block block);
  Box3 hull(int iu, int iv) const;
  Cell piece(int iu, int iv, Point3 p) const;
};

ClosestPointFinder::State::State(const NurbsSurface& s)
    : surface(s), u(s.knots_u, s.degree_u), v(s.knots_v, s.degree_v), newton(surface) {
  const Block all{0, u.pieces(), 0, v.pieces()};
  leaf_pieces = (all.pieces() + kMaxLeaves - 1) / kMaxLeaves;
  build(all);
  const Box3 box = nodes.front().box;
  for (const Point3 p : {box.lo, box.hi})
    reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

std::int32_t ClosestPointFinder::State::build(Block b) {
  const auto at = static_cast<std::int32_t>(nodes.size());
  nodes.push_back({{}, b, -1, -1});
  Box3 box;
  if (b.pieces() <= leaf_pieces) {
    for (int j = b.v_begin; j < b.v_end; ++j) {
      for (int i = b.u_begin; i < b.u_end; ++i) box.add(hull(i, j));
    }
  } else {
    Block l = b, r = b;
    if (b.u_end - b.u_begin >= b.v_end - b.v_begin) {
      l.u_end = r.u_begin = b.u_begin + (b.u_end - b.u_begin) / 2;
    } else {
      l.v_end = r.v_begin = b.v_begin + (b.v_end - b.v_begin) / 2;
    }
    const std::int32_t left = build(l), right = build(r);
    Node& node = nodes[static_cast<std::size_t>(at)];
    node.left = left, node.right = right;
    box.add(nodes[static_cast<std::size_t>(left)].box);
    box.add(nodes[static_cast<std::size_t>(right)].box);
  }
  nodes[static_cast<std::size_t>(at)].box = box;
  return at;
}

/// Of the control points that act on the piece.
Box3 ClosestPointFinder::State::hull(int iu, int iv) const {
  Box3 box;
  const int i0 = u.first_point(iu), j0 = v.first_point(iv);
  for (int j = 0; j <= surface.degree_v; ++j) {
    for (int i = 0; i <= surface.degree_u; ++i) box.add(project(surface.at(i0 + i, j0 + j)));
  }
  return box;
}

Cell ClosestPointFinder::State::piece(int iu, int iv, Point3 p) const {
  std::vector<double> space_u, space_v;
  const double *const mu = u.bezier(iu, space_u), *const mv = v.bezier(iv, space_v);
  const int nu = surface.degree_u + 1, nv = surface.degree_v + 1;
  const int i0 = u.first_point(iu), j0 = v.first_point(iv);
  Cell cell;
  cell.p = surface.degree_u, cell.q = surface.degree_v;
  cell.u = {u.lo(iu), u.hi(iu)}, cell.v = {v.lo(iv), v.hi(iv)};
  std::vector<HPoint> half(static_cast<std::size_t>(nu * nv), HPoint{0, 0, 0, 0});
  cell.net = half;
  const auto at = [nu](int i, int j) { return static_cast<std::size_t>(i + j * nu); };
  for (int j = 0; j < nv; ++j) {
    for (int k = 0; k < nu; ++k) {
      const HPoint h = surface.at(i0 + k, j0 + j);
      const HPoint relative{h.x - h.w * p.x, h.y - h.w * p.y, h.z - h.w * p.z, h.w};
      for (int i = 0; i < nu; ++i) half[at(i, j)] = half[at(i, j)] + mu[i * nu + k] * relative;
    }
  }
  for (int j = 0; j < nv; ++j) {
    for (int k = 0; k < nv; ++k) {
      for (int i = 0; i < nu; ++i) cell.net[at(i, j)] = cell.net[at(i, j)] + mv[j * nv + k] * half[at(i, k)];
    }
  }
  return cell;
}

namespace {

/// One search. Kept out of State, which is shared by all searches.
class Search {
 public:
  Search(const ClosestPointFinder& finder, Point3 p) : finder_(finder), p_(p) {}
  SurfacePoint best;

  void offer(double u, double v) {
    const SurfacePoint s = finder_.refine(p_, u, v);
    if (!(s.distance >= best.distance)) best = s;
  }
  void push(Item item) {
    item.order = order_++;
    heap_.push_back(std::move(item));
    std::push_heap(heap_.begin(), heap_.end(), later);
  }
  bool empty() const { return heap_.empty(); }
  Item pop() {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    Item item = std::move(heap_.back());
    heap_.pop_back();
    return item;
  }

 private:
  const ClosestPointFinder& finder_;
  Point3 p_;
  std::int64_t order_ = 0;
  std::vector<Item> heap_;
};

}  // namespace

ClosestPointFinder::ClosestPointFinder(const NurbsSurface& surface)
    : state_(std::make_unique<State>(surface)) {}
ClosestPointFinder::~ClosestPointFinder() = default;
ClosestPointFinder::ClosestPointFinder(ClosestPointFinder&&) noexcept = default;
ClosestPointFinder& ClosestPointFinder::operator=(ClosestPointFinder&&) noexcept = default;

SurfacePoint ClosestPointFinder::refine(Point3 p, double u, double v) const {
  return state_->newton.refine(state_->surface, p, u, v);
}

SurfacePoint ClosestPointFinder::find(Point3 p, double tolerance_mm) const {
  const State& s = *state_;
  Search search(*this, p);
  const Interval du = s.surface.domain(Direction::u), dv = s.surface.domain(Direction::v);
  search.best = refine(p, 0.5 * (du.lo + du.hi), 0.5 * (dv.lo + dv.hi));
  if (!std::isfinite(search.best.distance)) return search.best;
  // Rounding of coordinates relative to p; bounds cannot be better than that.
  const double far = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), s.reach});
  const double rounding = detail::kCellRounding * far;
  const double tolerance = std::max(tolerance_mm, 2 * rounding);

  search.push({distance_to(s.nodes.front().box, p), 0, 0, -1, -1, nullptr});
  const auto worth = [&](double bound) { return bound < search.best.distance - tolerance; };
  const auto visit_cell = [&](Cell cell, double bound) {
    const Cell::Bounds b = cell.bounds();
    if (b.corner < search.best.distance) search.offer(b.corner_u, b.corner_v);
    bound = std::max(bound, b.lower - rounding);
    if (worth(bound)) search.push({bound, 0, -1, -1, -1, std::make_unique<Cell>(std::move(cell))});
  };
  for (int step = 0; step < kMaxSteps && !search.empty(); ++step) {
    const Item item = search.pop();
    if (!worth(item.bound)) break;  // all that is left is as far
    if (item.cell) {
      if (!item.cell->can_be_split()) continue;
      auto [a, b] = item.cell->split();
      visit_cell(std::move(a), item.bound);
      visit_cell(std::move(b), item.bound);
    } else if (item.node < 0) {
      Cell cell = s.piece(item.iu, item.iv, p);
      search.offer(0.5 * (cell.u.lo + cell.u.hi), 0.5 * (cell.v.lo + cell.v.hi));
      visit_cell(std::move(cell), item.bound);
    } else if (const Node& n = s.nodes[static_cast<std::size_t>(item.node)]; n.left < 0) {
      for (int j = n.block.v_begin; j < n.block.v_end; ++j) {
        for (int i = n.block.u_begin; i < n.block.u_end; ++i) {
          const double bound = distance_to(s.hull(i, j), p) - rounding;
          if (worth(bound)) search.push({bound, 0, -1, i, j, nullptr});
        }
      }
    } else {
      for (const std::int32_t child : {n.left, n.right}) {
        const double bound = distance_to(s.nodes[static_cast<std::size_t>(child)].box, p) - rounding;
        if (worth(bound)) search.push({bound, 0, child, -1, -1, nullptr});
      }
    }
  }
  return search.best;
}

}  // namespace burin::geom
