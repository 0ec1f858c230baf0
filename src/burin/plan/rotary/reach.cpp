// SPDX-License-Identifier: Apache-2.0
// See docs/reachable-angles.md.
#include "burin/plan/rotary/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/plan/rotary/reach_exact.h"
#include "burin/plan/rotary/reach_kernels.h"
#include "burin/plan/rotary/reach_tree.h"

namespace burin::rotary {

namespace {

using namespace detail;

/// Shank and holder as upright cylinders. A piece reaches up through wider ones above it: then its top is
/// inside of them and need not be looked at.
std::vector<Piece> pieces_of(const model::BallTool& tool, const ReachOptions& options) {
  std::vector<Piece> out;
  const double grow = options.grow_mm;
  if (options.shank && tool.shank_radius + grow > 0)
    out.push_back({0, std::numeric_limits<double>::infinity(), tool.shank_radius + grow});
  if (!options.holder) return out;
  double at = tool.shank_length;
  for (std::size_t i = 0; i < tool.holder.size(); ++i) {
    double top = at;
    for (std::size_t j = i; j < tool.holder.size() && tool.holder[j].radius >= tool.holder[i].radius; ++j)
      top += tool.holder[j].height;
    if (tool.holder[i].radius + grow > 0 && top + grow > at - grow)
      out.push_back({at - grow, top + grow, tool.holder[i].radius + grow});
    at += tool.holder[i].height;
  }
  return out;
}

bool finite(geom::Point3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

Corners corners_of(const LeafBlock& leaf, int lane, geom::Point3 center) {
  Corners c;
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = geom::Point3{leaf.x[i][lane], leaf.y[i][lane], leaf.z[i][lane]} - center;
  return c;
}

/// One piece of the tool against the part, near things first: what they forbid saves opening others.
class Walk {
 public:
  Walk(const ReachTree& tree, const ReachKernels& kernels, geom::Point3 center, const Piece& piece,
       Arcs& arcs)
      : tree_(tree), kernels_(kernels), center_(center), piece_(piece), arcs_(arcs) {
    query_ = {center.x, center.y, center.z, piece.h0, piece.h1, piece.radius};
  }

  void run() {
    if (tree_.nodes.empty()) return;
    open(0);
    while (top_ > 0 && !arcs_.all()) {
      const Waiting w = stack_[--top_];
      if (!w.unsure && arcs_.covers(w.lo, w.hi)) continue;
      if (w.child >= kLeaf) {
        look(tree_.leaves[w.child - kLeaf]);
      } else {
        open(w.child);
      }
    }
  }

 private:
  struct Waiting {
    double near2, lo, hi;
    std::uint32_t child;
    bool unsure;
  };

  void open(std::uint32_t at) {
    const NodeBlock& node = tree_.nodes[at];
    kernels_.boxes(node, query_, found_);
    const int bottom = top_;
    for (int i = 0; i < 4; ++i) {
      const bool unsure = found_.unsure >> i & 1;
      if (!(found_.meets >> i & 1) || (!unsure && arcs_.covers(found_.lo[i], found_.hi[i]))) continue;
      int at_most = top_++;  // the nearest comes to lie on top
      for (; at_most > bottom && stack_[at_most - 1].near2 < found_.near2[i]; --at_most)
        stack_[at_most] = stack_[at_most - 1];
      stack_[at_most] = {found_.near2[i], found_.lo[i], found_.hi[i], node.child[i], unsure};
    }
  }

  void look(const LeafBlock& leaf) {
    kernels_.triangles(leaf, query_, found_);
    int wanted = 0;
    for (int i = 0; i < 4; ++i) {
      if (!(found_.meets >> i & 1)) continue;
      if (found_.unsure >> i & 1 || !arcs_.covers(found_.lo[i], found_.hi[i])) wanted |= 1 << i;
    }
    if (wanted == 0) return;
    kernels_.exact(leaf, query_, found_);
    for (int i = 0; i < 4; ++i) {
      if (!(wanted & found_.meets & 1 << i)) continue;
      if (found_.unsure >> i & 1) {
        forbid_exactly(corners_of(leaf, i, center_), piece_, arcs_);
      } else if (!arcs_.covers(found_.lo[i], found_.hi[i])) {
        arcs_.add(found_.lo[i], found_.hi[i]);
      }
    }
  }

  const ReachTree& tree_;
  const ReachKernels& kernels_;
  geom::Point3 center_;
  const Piece& piece_;
  Arcs& arcs_;
  ReachQuery query_;
  ReachArcs found_;
  Waiting stack_[ReachTree::kStack];
  int top_ = 0;
};

/// A holder that reaches down past the ball's centre: no arcs as the kernels have them.
void without_tree(const ReachTree& tree, geom::Point3 center, const Piece& piece, Arcs& arcs) {
  for (const LeafBlock& leaf : tree.leaves) {
    for (int i = 0; i < 4 && !arcs.all(); ++i) forbid_exactly(corners_of(leaf, i, center), piece, arcs);
  }
}

}  // namespace

struct ReachIndex::State {
  ReachTree tree;
  model::BallTool tool;
  const ReachKernels* kernels = nullptr;
};

ReachIndex::ReachIndex(const geom::Mesh& mesh, const model::BallTool& tool, double /*accuracy_rad*/)
    : state_(std::make_unique<State>()) {
  state_->tree = make_reach_tree(mesh);
  state_->tool = tool;
  state_->kernels = &reach_kernels_avx2();
}
ReachIndex::~ReachIndex() = default;
ReachIndex::ReachIndex(ReachIndex&&) noexcept = default;
ReachIndex& ReachIndex::operator=(ReachIndex&&) noexcept = default;

AngleSet ReachIndex::reachable(geom::Point3 center, const ReachOptions& options) const {
  if (!finite(center) || !std::isfinite(options.grow_mm)) return {};
  Arcs arcs;
  for (const Piece& piece : pieces_of(state_->tool, options)) {
    if (arcs.all()) break;
    if (piece.h0 >= 0) {
      Walk(state_->tree, *state_->kernels, center, piece, arcs).run();
    } else {
      without_tree(state_->tree, center, piece, arcs);
    }
  }
  return arcs.gaps();
}

bool ReachIndex::clear(geom::Point3 center, double lo, double hi, const ReachOptions& options) const {
  if (!finite(center) || !std::isfinite(options.grow_mm) || !(hi - lo < 2 * geom::kPi))
    return total(reachable(center, options)) >= 2 * geom::kPi;
  // A range narrower than what angles may be off would close by itself.
  constexpr double kNarrow = 100 * kSlack;
  if (hi - lo < kNarrow) {
    const double middle = 0.5 * (lo + hi);
    lo = middle - 0.5 * kNarrow;
    hi = middle + 0.5 * kNarrow;
  }
  Arcs arcs;
  arcs.add(turn_of(std::cos(hi), std::sin(hi)), turn_of(std::cos(lo), std::sin(lo)));
  const double free = total(arcs.gaps());
  for (const Piece& piece : pieces_of(state_->tool, options)) {
    if (piece.h0 >= 0) {
      Walk(state_->tree, *state_->kernels, center, piece, arcs).run();
    } else {
      without_tree(state_->tree, center, piece, arcs);
    }
    if (arcs.all() || total(arcs.gaps()) < free - 10 * kSlack) return false;
  }
  return true;
}

}  // namespace burin::rotary
