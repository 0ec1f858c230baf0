// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/collisions.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "burin/base/parallel.h"
#include "burin/verify/mill_walk.h"

namespace burin::verify {
namespace {

// Blocks between two reports of progress, and between two times that the list is brought down to what is
// kept.
constexpr std::size_t kWave = 256;
// What touches is first found, its depth to this share of it; those that are listed are measured after that.
constexpr double kFirstLook = 0.1;
// A place that many others equal nearly costs many evaluations to prove. After these the resolution of that
// move is doubled (and the bound says so): for one that may be clear, and for all together that are measured,
// of which each gets a part that is not less than the least.
constexpr std::uint64_t kBudget = 50'000, kBudgetOfAll = 20'000'000, kLeastBudget = 1000;
// Collisions that one task measures.
constexpr std::size_t kMeasured = 16;

struct Counterpart {
  const TriangleTree* tree = nullptr;
  Against against = Against::part;
};

/// What one body of a tool does to one counterpart on one move: its pieces [begin, end).
struct Hit {
  Collision collision;
  std::size_t tool = 0, begin = 0, end = 0;
};
struct Found {
  std::vector<Hit> hits;
  double resolution = 0;  ///< the coarsest with which a move was found to be clear
};

Body body_of(ToolPart part) {
  return part == ToolPart::cutter ? Body::cutter : part == ToolPart::shank ? Body::shank : Body::holder;
}

/// One piece of the tool against one counterpart on a run of steps: which moves collide, and about how deep.
class Walk {
 public:
  Walk(const Counterpart& counterpart, const ToolPiece& piece, std::size_t tool,
       const CollisionOptions& options, Found& out)
      : search_(*counterpart.tree, piece.body, options.resolution_mm, kBudget),
        floor_(options.tolerance_mm),
        hit_{{0, body_of(piece.part), counterpart.against, 0, {}}, tool, 0, 0},
        out_(out) {}

  void run(const std::vector<Step>& steps) {
    if (steps.empty()) return;
    begin(steps.front());
    walk_.run(steps, search_, [this](const Step& s, const MillSearch::Front& front) { step(s, front); });
    finish();
  }

 private:
  void step(const Step& s, const MillSearch::Front& front) {
    if (s.move != hit_.collision.move) {
      finish();
      begin(s);
    }
    if (seed_.mm > 0) search_.seed(s.stretch, s.move, seed_.at, seed_.triangle);
    search_.stretch(s.stretch, s.move, front);
    seed_ = search_.hit() ? search_.deepest() : MillFinding{};
    hit_.end = s.piece + 1;
  }
  void begin(const Step& first) {
    search_.reset(floor_, kFirstLook);
    hit_.collision.move = first.move;
    hit_.begin = first.piece;
    hit_.end = first.piece + 1;
  }
  /// Of the move so far.
  void finish() {
    if (!search_.hit()) {
      out_.resolution = std::max(out_.resolution, search_.resolution());
      return;
    }
    hit_.collision.depth_mm = search_.deepest().mm;
    hit_.collision.at = search_.deepest().at;
    out_.hits.push_back(hit_);
  }

  MillSearch search_;
  double floor_;
  Hit hit_;  ///< of the move so far
  Found& out_;
  MillFinding seed_;  ///< of the step before
  MillWalk walk_;
};

auto place(const Hit& h) {
  return std::tuple(h.collision.move, h.collision.body, h.collision.against);
}
bool in_order(const Hit& a, const Hit& b) {
  return place(a) < place(b);
}

void keep_deepest(std::vector<Hit>& list, std::size_t most) {
  if (list.size() <= most) return;
  std::nth_element(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(most), list.end(),
                   [](const Hit& a, const Hit& b) {
                     return a.collision.depth_mm != b.collision.depth_mm
                                ? a.collision.depth_mm > b.collision.depth_mm
                                : in_order(a, b);
                   });
  list.resize(most);
}

/// A body of several cylinders is one body.
void merge(std::vector<Hit>& list) {
  std::stable_sort(list.begin(), list.end(), in_order);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (kept == 0 || place(list[kept - 1]) != place(list[i])) {
      list[kept++] = list[i];
      continue;
    }
    Hit& one = list[kept - 1];
    if (list[i].collision.depth_mm > one.collision.depth_mm) one.collision = list[i].collision;
    one.begin = std::min(one.begin, list[i].begin);
    one.end = std::max(one.end, list[i].end);
  }
  list.resize(kept);
}

Found look(const ToolPath& path, const Block& block, const std::vector<Counterpart>& counterparts,
           const CollisionOptions& options) {
  std::vector<Step> all, rapid;
  all.reserve(block.end - block.begin);
  for (std::size_t i = block.begin; i < block.end; ++i) {
    all.push_back(step_of(path, i));
    if (path.pieces[i].rapid) rapid.push_back(all.back());
  }
  Found found{{}, options.resolution_mm};
  for (const ToolPiece& piece : pieces_of(path.tool))
    for (const Counterpart& c : counterparts)
      Walk(c, piece, block.tool, options, found)
          .run(piece.part == ToolPart::cutter && c.against == Against::part ? rapid : all);
  merge(found.hits);
  return found;
}

/// How deep it really is; the resolution it took.
double measure(Hit& hit, const ToolPath& path, const std::vector<Counterpart>& counterparts,
               const CollisionOptions& options, std::uint64_t budget) {
  double resolution = options.resolution_mm;
  for (const ToolPiece& piece : pieces_of(path.tool))
    for (const Counterpart& c : counterparts) {
      if (body_of(piece.part) != hit.collision.body || c.against != hit.collision.against) continue;
      MillSearch search(*c.tree, piece.body, options.resolution_mm, budget);
      search.reset(options.tolerance_mm);
      search.know({hit.collision.depth_mm, hit.collision.at, hit.collision.move, 0});
      for (std::size_t i = hit.begin; i < hit.end; ++i)
        search.stretch(step_of(path, i).stretch, hit.collision.move, search.root());
      hit.collision.depth_mm = search.deepest().mm;
      hit.collision.at = search.deepest().at;
      resolution = std::max(resolution, search.resolution());
    }
  return resolution;
}

Result<void> validate(const CollisionOptions& options) {
  if (!(std::isfinite(options.tolerance_mm) && options.tolerance_mm >= 0))
    return Error{ErrorCode::range, "the tolerance of collisions is no depth (0 mm or more)", {}};
  if (!(std::isfinite(options.resolution_mm) && options.resolution_mm > 0))
    return Error{ErrorCode::range, "the resolution of collisions must be positive", {}};
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
  if (auto ok = validate(options); !ok) return ok.error();
  if (auto ok = validate(path); !ok) return ok.error();
  for (const geom::Mesh* mesh : {&part, &obstacles})
    if (auto ok = validate_triangles(*mesh); !ok) return ok.error();
  const TriangleTree part_tree(part), obstacle_tree(obstacles);
  std::vector<Counterpart> counterparts;
  if (!part_tree.nodes().empty()) counterparts.push_back({&part_tree, Against::part});
  if (!obstacle_tree.nodes().empty()) counterparts.push_back({&obstacle_tree, Against::obstacle});

  const unsigned threads = thread_count(options.threads);
  const auto go_on = [&](std::size_t done, std::size_t of, const char* stage) {
    return !progress || progress->progress(stage, double(done) / double(of));
  };
  const Error stopped{ErrorCode::usage, "stopped", {}};

  CollisionReport report;
  std::vector<Hit> hits;
  double resolution = options.resolution_mm;
  const std::vector<Block> blocks = blocks_of(path);
  std::vector<Found> found(std::min(kWave, blocks.size()));
  for (std::size_t first = 0; first < blocks.size(); first += kWave) {
    if (!go_on(first, blocks.size(), "collisions")) return stopped;
    const std::size_t count = std::min(kWave, blocks.size() - first);
    parallel_for(count, threads, [&](std::size_t i, std::size_t) {
      const Block& block = blocks[first + i];
      found[i] = look(path.tools[block.tool], block, counterparts, options);
    });
    for (std::size_t i = 0; i < count; ++i) {
      report.count += found[i].hits.size();
      resolution = std::max(resolution, found[i].resolution);
      hits.insert(hits.end(), found[i].hits.begin(), found[i].hits.end());
    }
    keep_deepest(hits, options.max_listed);
  }
  std::sort(hits.begin(), hits.end(), in_order);

  const std::uint64_t budget =
      hits.empty() ? kBudget : std::clamp(kBudgetOfAll / hits.size(), kLeastBudget, kBudget);
  std::vector<double> resolutions(hits.size());
  for (std::size_t first = 0; first < hits.size(); first += kWave * kMeasured) {
    if (!go_on(first, hits.size(), "depths")) return stopped;
    const std::size_t end = std::min(hits.size(), first + kWave * kMeasured);
    parallel_for((end - first + kMeasured - 1) / kMeasured, threads, [&](std::size_t task, std::size_t) {
      const std::size_t from = first + task * kMeasured;
      for (std::size_t i = from; i < std::min(end, from + kMeasured); ++i)
        resolutions[i] = measure(hits[i], path.tools[hits[i].tool], counterparts, options, budget);
    });
  }
  for (const double r : resolutions) resolution = std::max(resolution, r);
  for (const Hit& hit : hits) report.collisions.push_back(hit.collision);
  report.bound_mm = resolution + path.motion_mm;
  return report;
}

}  // namespace burin::verify
