// SPDX-License-Identifier: Apache-2.0
// See docs/reachable-angles.md.
#include "burin/plan/rotary/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/geom/point_tools.h"
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

Corners corners_of(const LeafBlock& leaf, int lane, geom::Point3 center) {
  Corners c;
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = geom::Point3{leaf.x[i][lane], leaf.y[i][lane], leaf.z[i][lane]} - center;
  return c;
}

/// From a to b counter-clockwise, halved until no piece's half width has a cosine below `least_cos`. `wide`:
/// more than half the circle.
void cut_gap(geom::Vec2 a, geom::Vec2 b, bool wide, double least_cos, std::vector<ReachGap>& out) {
  const geom::Vec2 sum = a + b;
  // Opposite, or nearly: the sum has no direction.
  geom::Vec2 middle = norm2(sum) < 1e-8 ? geom::left(a) : wide ? -unit(sum) : unit(sum);
  const double cos_half = dot(a, middle);
  if (wide || cos_half < least_cos) {
    cut_gap(a, middle, false, least_cos, out);
    cut_gap(middle, b, false, least_cos, out);
  } else {
    // Rounded up: the lower line stands no higher than it must.
    out.push_back({{a.x, a.y}, {b.x, b.y}, {middle.x, middle.y}, cos_half, std::abs(cross(a, middle))});
  }
}

/// One piece of the tool against the part. What reaches deepest into the gaps that are left is opened first:
/// little is opened that does not reach into the gaps that remain in the end.
class Walk {
 public:
  Walk(const ReachTree& tree, const ReachKernels& kernels, geom::Point3 center, Arcs& arcs)
      : tree_(tree), kernels_(kernels), center_(center), arcs_(arcs) {
    const double size = tree.size + std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
    rounding_mm_ = 2e-15 * size;
    waiting_.reserve(256);
    gaps_.reserve(8);
  }

  /// Stops early when less than `enough` (radians) is left.
  void run(const Piece& piece, double enough = 0) {
    if (tree_.nodes.empty() || arcs_.all()) return;
    piece_ = &piece;
    enough_ = enough;
    query_ = {center_.x, center_.y, center_.z, piece.h0, piece.h1, piece.radius, nullptr, 0};
    changed();
    if (arcs_.none()) dive();
    waiting_.clear();
    open(0);
    while (!waiting_.empty() && !arcs_.all() && enough_left_) {
      std::pop_heap(waiting_.begin(), waiting_.end(), less);
      const Waiting w = waiting_.back();
      waiting_.pop_back();
      const NodeBlock& node = tree_.nodes[w.box / 4];
      if (w.state != state_) {  // the gaps have become smaller since
        kernels_.boxes(node, query_, found_);
        if (!matters(static_cast<int>(w.box % 4))) continue;
      }
      const std::uint32_t child = node.child[w.box % 4];
      if (child >= kLeaf) {
        look(tree_.leaves[child - kLeaf]);
      } else {
        open(child);
      }
    }
  }

 private:
  struct Waiting {
    double key;
    std::uint32_t box;    ///< four times the node, and the lane
    std::uint32_t state;  ///< of the gaps when it was looked at
  };
  static bool less(const Waiting& a, const Waiting& b) {
    return a.key < b.key || (a.key == b.key && a.box > b.box);
  }

  bool matters(int lane) const { return (found_.meets >> lane & 1) && found_.depth[lane] > rounding_mm_; }

  /// The arcs have grown.
  void changed() {
    ++state_;
    if (arcs_.none()) return;
    gaps_.clear();
    arcs_.for_gaps([this](geom::Vec2 a, geom::Vec2 b, bool wide) {
      cut_gap(a, b, wide, piece_->h0 > 0 ? kNarrow : kWide, gaps_);
    });
    if (enough_ > 0) enough_left_ = total(arcs_.gaps()) >= enough_;
    query_.gaps = gaps_.data();
    query_.gap_count = static_cast<int>(gaps_.size());
  }

  /// What is to be opened first: about the angle by which the lane reaches into a gap.
  double key(int lane) const {
    // As long as nothing is forbidden: the nearest first.
    if (query_.gap_count == 0) return 1e100 / (1 + found_.near2[lane]);
    const double r = query_.radius, depth = found_.depth[lane],
                 k2 = std::max(0.0, found_.near2[lane] - r * r);
    return depth / (std::sqrt(k2 + 2 * r * depth) + std::sqrt(k2));
  }

  /// Straight down to the nearest triangles, so that there are gaps to begin with.
  void dive() {
    std::uint32_t at = 0;
    while (at < kLeaf) {
      kernels_.boxes(tree_.nodes[at], query_, found_);
      int best = -1;
      double most = 0;
      for (int i = 0; i < 4; ++i) {
        if (matters(i) && key(i) > most) {
          best = i;
          most = key(i);
        }
      }
      if (best < 0) return;
      at = tree_.nodes[at].child[best];
    }
    look(tree_.leaves[at - kLeaf]);
  }

  /// Asks for the memory of what is likely opened soon.
  void fetch(std::uint32_t child) const {
    const char* at = child >= kLeaf ? reinterpret_cast<const char*>(&tree_.leaves[child - kLeaf])
                                    : reinterpret_cast<const char*>(&tree_.nodes[child]);
    constexpr std::size_t kLine = 64;
    for (std::size_t i = 0; i < sizeof(LeafBlock); i += kLine) __builtin_prefetch(at + i);
  }

  void open(std::uint32_t at) {
    kernels_.boxes(tree_.nodes[at], query_, found_);
    for (int i = 0; i < 4; ++i) {
      if (!matters(i)) continue;
      fetch(tree_.nodes[at].child[i]);
      waiting_.push_back({key(i), 4 * at + static_cast<std::uint32_t>(i), state_});
      std::push_heap(waiting_.begin(), waiting_.end(), less);
    }
  }

  void look(const LeafBlock& leaf) {
    kernels_.triangles(leaf, query_, found_);
    int wanted = 0;
    for (int i = 0; i < 4; ++i) wanted |= matters(i) ? 1 << i : 0;
    if (wanted == 0) return;
    kernels_.exact(leaf, query_, found_);
    bool grown = false;
    for (int i = 0; i < 4; ++i) {
      if (!(wanted & found_.meets & 1 << i)) continue;
      if (found_.unsure >> i & 1) {
        forbid_exactly(corners_of(leaf, i, center_), *piece_, arcs_);
      } else if (!arcs_.covers(found_.lo[i], found_.hi[i])) {
        arcs_.add(found_.lo[i], found_.hi[i]);
      } else {
        continue;
      }
      grown = true;
    }
    if (grown) changed();
  }

  // A gap that is cut into narrower pieces is described better (its middle line stands nearer to the lower
  // ends of the cylinder), which matters for cylinders that begin far from the centre.
  static constexpr double kWide = 0.5, kNarrow = 0.92;  // cosines of half the width

  const ReachTree& tree_;
  const ReachKernels& kernels_;
  geom::Point3 center_;
  Arcs& arcs_;
  const Piece* piece_ = nullptr;
  double rounding_mm_ = 0, enough_ = 0;
  bool enough_left_ = true;
  ReachQuery query_;
  ReachFound found_;
  std::vector<Waiting> waiting_;
  std::vector<ReachGap> gaps_;
  std::uint32_t state_ = 0;
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

ReachIndex::ReachIndex(const geom::Mesh& mesh, const model::BallTool& tool)
    : state_(std::make_unique<State>()) {
  state_->tree = make_reach_tree(mesh);
  state_->tool = tool;
  state_->kernels = &reach_kernels_avx2();
}
ReachIndex::~ReachIndex() = default;
ReachIndex::ReachIndex(ReachIndex&&) noexcept = default;
ReachIndex& ReachIndex::operator=(ReachIndex&&) noexcept = default;

AngleSet ReachIndex::reachable(geom::Point3 center, const ReachOptions& options) const {
  if (!is_finite(center) || !std::isfinite(options.grow_mm)) return {};
  Arcs arcs;
  Walk walk(state_->tree, *state_->kernels, center, arcs);
  for (const Piece& piece : pieces_of(state_->tool, options)) {
    if (arcs.all()) break;
    if (piece.h0 >= 0) {
      walk.run(piece);
    } else {
      without_tree(state_->tree, center, piece, arcs);
    }
  }
  return arcs.gaps();
}

}  // namespace burin::rotary
