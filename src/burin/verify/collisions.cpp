// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/collisions.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "burin/base/parallel.h"
#include "burin/verify/mill_motion.h"
#include "burin/verify/mill_search.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// Pieces that are looked at together. A move is never divided between two of these, so that what is found
// does not depend on the number of threads.
constexpr std::size_t kBlock = 512;
// Blocks between two reports of progress, and between two times that the list is brought down to what is
// kept.
constexpr std::size_t kWave = 256;
// A move that stands deep in the part owns that to many places nearly alike; after so many evaluations for
// one depth it is told apart less finely.
constexpr std::uint64_t kBudget = 20'000;

/// One straight piece of a tool's way.
struct Step {
  Stretch stretch;
  std::uint32_t move = 0;
};

/// Pieces of one tool that are looked at together.
struct Block {
  std::size_t tool = 0, begin = 0, end = 0;
};

struct Counterpart {
  const TriangleTree* tree = nullptr;
  Against against = Against::part;
};

struct Found {
  std::vector<Collision> collisions;  ///< one a move, body and counterpart
  double resolution = 0;              ///< the coarsest of all searches
};

Body body_of(ToolPart part) {
  return part == ToolPart::cutter ? Body::cutter : part == ToolPart::shank ? Body::shank : Body::holder;
}

/// One piece of the tool against one counterpart on a run of steps.
class Walk {
 public:
  Walk(const Counterpart& counterpart, const ToolPiece& piece, const CollisionOptions& options, Found& out)
      : search_(*counterpart.tree, piece.body, options.resolution_mm, kBudget),
        span_(piece.body.span()),
        floor_(options.tolerance_mm),
        prototype_{0, body_of(piece.part), counterpart.against, 0, {}},
        out_(out) {}

  void run(const std::vector<Step>& steps) {
    search_.reset(floor_);
    move_ = steps.empty() ? 0 : steps.front().move;
    if (!steps.empty()) range(steps.data(), steps.data() + steps.size(), search_.root(), 0);
    finish();
  }

 private:
  /// Halves the steps until none of the tree is near enough to matter, or one step is left.
  void range(const Step* begin, const Step* end, const MillSearch::Front& front, std::size_t level) {
    if (front.empty()) return;
    if (end - begin == 1) return step(*begin, front);
    if (fronts_.size() <= level) fronts_.resize(level + 1);
    const auto [mean, slack] = around(begin, end);
    MillSearch::Front narrowed = std::move(fronts_[level]);
    search_.narrow(mean, slack, front, narrowed);
    const Step* middle = begin + (end - begin) / 2;
    range(begin, middle, narrowed, level + 1);
    range(middle, end, narrowed, level + 1);
    fronts_[level] = std::move(narrowed);
  }

  void step(const Step& s, const MillSearch::Front& front) {
    if (s.move != move_) {
      finish();
      search_.reset(floor_);
      move_ = s.move;
    }
    if (seed_.mm > 0) search_.seed(s.stretch, s.move, seed_.at, seed_.triangle);
    search_.stretch(s.stretch, s.move, front);
    seed_ = search_.hit() ? search_.deepest() : MillFinding{};
  }

  /// Of the move so far.
  void finish() {
    out_.resolution = std::max(out_.resolution, search_.resolution());
    if (!search_.hit()) return;
    Collision c = prototype_;
    c.move = move_;
    c.depth_mm = search_.deepest().mm;
    c.at = search_.deepest().at;
    out_.collisions.push_back(c);
  }

  struct Around {
    Placed mean;
    double slack = 0;  ///< no place of the piece of the tool is farther from where it is in `mean`
  };
  Around around(const Step* begin, const Step* end) const {
    geom::Box3 tips;
    Vec3 sum;
    const auto each_end = [&](auto&& use) {
      for (const Step* s = begin; s != end; ++s) use(s->stretch.from), use(s->stretch.at(1));
    };
    each_end([&](const Placed& p) { tips.add(p.tip), sum = sum + p.axis; });
    Around out;
    out.mean = {lerp(tips.lo, tips.hi, 0.5), norm(sum) > 0 ? unit(sum) : begin->stretch.from.axis};
    double way = 0, chord = 0;
    each_end([&](const Placed& p) {
      way = std::max(way, distance(p.tip, out.mean.tip));
      chord = std::max(chord, norm(p.axis - out.mean.axis));
    });
    // Great circles stay within a cap that holds their ends if it is less than half of the sphere.
    constexpr double kCap = 1.4;
    out.slack = way + (chord < kCap ? chord : 2) * span_;
    return out;
  }

  MillSearch search_;
  double span_, floor_;
  Collision prototype_;
  Found& out_;
  std::uint32_t move_ = 0;
  MillFinding seed_;  ///< of the step before
  std::vector<MillSearch::Front> fronts_;
};

/// The deeper one first; where as deep, by move, body and counterpart.
bool before(const Collision& a, const Collision& b) {
  return std::tuple(-a.depth_mm, a.move, a.body, a.against) <
         std::tuple(-b.depth_mm, b.move, b.body, b.against);
}
auto place(const Collision& c) {
  return std::tuple(c.move, c.body, c.against);
}

void keep_deepest(std::vector<Collision>& list, std::size_t most) {
  if (list.size() <= most) return;
  std::nth_element(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(most), list.end(), before);
  list.resize(most);
}

/// A body of several cylinders is one body.
void merge(std::vector<Collision>& list) {
  std::sort(list.begin(), list.end(), [](const Collision& a, const Collision& b) {
    return place(a) != place(b) ? place(a) < place(b) : a.depth_mm > b.depth_mm;
  });
  list.erase(std::unique(list.begin(), list.end(),
                         [](const Collision& a, const Collision& b) { return place(a) == place(b); }),
             list.end());
}

Found look(const ToolPath& path, const Block& block, const std::vector<Counterpart>& counterparts,
           const CollisionOptions& options) {
  std::vector<Step> all, rapid;
  all.reserve(block.end - block.begin);
  for (std::size_t i = block.begin; i < block.end; ++i) {
    const PathPiece& piece = path.pieces[i];
    all.push_back({Stretch::between(i == 0 ? path.from : path.pieces[i - 1].to, piece.to), piece.move});
    if (piece.rapid) rapid.push_back(all.back());
  }
  Found found{{}, options.resolution_mm};
  for (const ToolPiece& piece : pieces_of(path.tool))
    for (const Counterpart& c : counterparts)
      Walk(c, piece, options, found)
          .run(piece.part == ToolPart::cutter && c.against == Against::part ? rapid : all);
  merge(found.collisions);
  return found;
}

std::vector<Block> blocks_of(const CheckedPath& path) {
  std::vector<Block> blocks;
  for (std::size_t t = 0; t < path.tools.size(); ++t) {
    const std::vector<PathPiece>& pieces = path.tools[t].pieces;
    for (std::size_t begin = 0; begin < pieces.size();) {
      std::size_t end = std::min(begin + kBlock, pieces.size());
      while (end < pieces.size() && pieces[end].move == pieces[end - 1].move) ++end;
      blocks.push_back({t, begin, end});
      begin = end;
    }
  }
  return blocks;
}

Result<void> validate(const CheckedPath& path, const CollisionOptions& options) {
  if (!(std::isfinite(options.tolerance_mm) && options.tolerance_mm >= 0))
    return Error{ErrorCode::range, "the tolerance of collisions must not be negative", {}};
  if (!(std::isfinite(options.resolution_mm) && options.resolution_mm > 0))
    return Error{ErrorCode::range, "the resolution of collisions must be positive", {}};
  if (!(std::isfinite(path.motion_mm) && path.motion_mm >= 0))
    return Error{ErrorCode::range, "the motion tolerance of the path must not be negative", {}};
  for (const ToolPath& tool : path.tools) {
    if (auto ok = validate(tool.tool); !ok) return ok.error();
    const cl::Pose* from = &tool.from;
    if (auto ok = validate_pose(*from, tool.pieces.empty() ? 0 : tool.pieces.front().move); !ok)
      return ok.error();
    for (const PathPiece& piece : tool.pieces) {
      if (auto ok = validate_pose(piece.to, piece.move); !ok) return ok.error();
      if (auto ok = validate_turn(*from, piece.to, piece.move); !ok) return ok.error();
      from = &piece.to;
    }
  }
  return {};
}

}  // namespace

std::string_view name(Body body) {
  return body == Body::cutter ? "cutter" : body == Body::shank ? "shank" : "holder";
}
std::string_view name(Against against) {
  return against == Against::part ? "part" : against == Against::stock ? "stock" : "obstacle";
}

Result<CollisionReport> find_collisions(const geom::Mesh& part, const geom::Mesh& obstacles,
                                        const CheckedPath& path, const CollisionOptions& options,
                                        ProgressSink* progress) {
  if (auto ok = validate(path, options); !ok) return ok.error();
  for (const geom::Mesh* mesh : {&part, &obstacles})
    if (auto ok = validate_triangles(*mesh); !ok) return ok.error();
  const TriangleTree part_tree(part), obstacle_tree(obstacles);
  std::vector<Counterpart> counterparts;
  if (!part_tree.nodes().empty()) counterparts.push_back({&part_tree, Against::part});
  if (!obstacle_tree.nodes().empty()) counterparts.push_back({&obstacle_tree, Against::obstacle});

  CollisionReport report;
  double resolution = options.resolution_mm;
  const std::vector<Block> blocks = blocks_of(path);
  std::vector<Found> found(std::min(kWave, blocks.size()));
  for (std::size_t first = 0; first < blocks.size(); first += kWave) {
    if (progress && !progress->progress("collisions", double(first) / double(blocks.size())))
      return Error{ErrorCode::usage, "stopped", {}};
    const std::size_t count = std::min(kWave, blocks.size() - first);
    parallel_for(count, thread_count(options.threads), [&](std::size_t i, std::size_t) {
      const Block& block = blocks[first + i];
      found[i] = look(path.tools[block.tool], block, counterparts, options);
    });
    for (std::size_t i = 0; i < count; ++i) {
      report.count += found[i].collisions.size();
      resolution = std::max(resolution, found[i].resolution);
      report.collisions.insert(report.collisions.end(), found[i].collisions.begin(),
                               found[i].collisions.end());
    }
    keep_deepest(report.collisions, options.max_listed);
  }
  std::sort(report.collisions.begin(), report.collisions.end(),
            [](const Collision& a, const Collision& b) { return place(a) < place(b); });
  report.bound_mm = resolution + path.motion_mm;
  return report;
}

}  // namespace burin::verify
