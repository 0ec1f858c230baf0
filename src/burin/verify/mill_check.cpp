// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/mill_check.h"

#include <algorithm>
#include <cmath>

#include "burin/base/parallel.h"
#include "burin/verify/mill_walk.h"

namespace burin::verify {
namespace {

MillFinding& finding(MillCheckReport& report, ToolPart part) {
  return part == ToolPart::cutter ? report.cutter : part == ToolPart::shank ? report.shank : report.holder;
}

/// Each piece of the tool begins with the deepest place that was found in the block.
MillCheckReport look(const TriangleTree& tree, const ToolPath& path, const Block& block, double resolution) {
  std::vector<Step> steps;
  for (std::size_t i = block.begin; i < block.end; ++i) steps.push_back(step_of(path, i));
  MillCheckReport report;
  for (const ToolPiece& piece : pieces_of(path.tool)) {
    MillSearch search(tree, piece.body, resolution);
    MillWalk().run(steps, search, [&](const Step& step, const MillSearch::Front& front) {
      search.stretch(step.stretch, step.move, front);
    });
    MillFinding& worst = finding(report, piece.part);
    if (search.deepest().mm > worst.mm) worst = search.deepest();
    report.evaluations += search.evaluations();
  }
  return report;
}

}  // namespace

double MillCheckReport::gouge_max_mm() const {
  return std::max({cutter.mm, shank.mm, holder.mm});
}

Result<MillCheckReport> check_mill(const geom::Mesh& mesh, const CheckedPath& path,
                                   const MillCheckOptions& options) {
  if (!(std::isfinite(options.resolution_mm) && options.resolution_mm > 0))
    return Error{ErrorCode::range, "the resolution must be positive", {}};
  if (auto ok = validate(path); !ok) return ok.error();
  if (auto ok = validate_triangles(mesh); !ok) return ok.error();
  MillCheckReport report;
  report.bound_mm = options.resolution_mm + path.motion_mm;
  const TriangleTree tree(mesh);
  if (tree.nodes().empty()) return report;

  const std::vector<Block> blocks = blocks_of(path);
  std::vector<MillCheckReport> found(blocks.size());
  parallel_for(blocks.size(), thread_count(options.threads), [&](std::size_t i, std::size_t) {
    found[i] = look(tree, path.tools[blocks[i].tool], blocks[i], options.resolution_mm);
  });
  for (const MillCheckReport& block : found) {
    for (const auto worst : {&MillCheckReport::cutter, &MillCheckReport::shank, &MillCheckReport::holder})
      if ((block.*worst).mm > (report.*worst).mm) report.*worst = block.*worst;
    report.evaluations += block.evaluations;
  }
  return report;
}

}  // namespace burin::verify
