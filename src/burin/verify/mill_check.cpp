// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/mill_check.h"

#include <algorithm>
#include <cmath>

#include "burin/base/parallel.h"
#include "burin/verify/mill_motion.h"
#include "burin/verify/mill_search.h"

namespace burin::verify {
namespace {

// Moves that are looked at after each other, each starting from the deepest gouge found among them: what is
// found does not depend on the number of threads.
constexpr std::size_t kChunk = 32;

struct Deepest {
  std::vector<MillFinding> of_piece;
  std::uint64_t evaluations = 0;
};

MillFinding& finding(MillCheckReport& report, ToolPart part) {
  return part == ToolPart::cutter ? report.cutter : part == ToolPart::shank ? report.shank : report.holder;
}

}  // namespace

double MillCheckReport::gouge_max_mm() const {
  return std::max({cutter.mm, shank.mm, holder.mm});
}

Result<MillCheckReport> check_mill(const geom::Mesh& mesh, const CheckedMill& tool, const MillMotion& motion,
                                   const MillCheckOptions& options) {
  if (auto ok = validate(tool); !ok) return ok.error();
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (!positive(options.resolution_mm) || !positive(options.motion_mm))
    return Error{ErrorCode::range, "resolution and motion tolerance must be positive", {}};
  if (auto ok = validate_triangles(mesh); !ok) return ok.error();
  const std::vector<ToolPiece> pieces = pieces_of(tool);
  double span = 0;
  for (const ToolPiece& p : pieces) span = std::max(span, p.body.span());
  const StretchedMotion moves(mesh, motion, span, options.motion_mm);
  if (auto ok = moves.validate(); !ok) return ok.error();

  MillCheckReport report;
  report.bound_mm = options.resolution_mm + (moves.exact() ? 0 : options.motion_mm);
  const TriangleTree tree(mesh);
  if (tree.nodes().empty() || moves.count() < 2) return report;

  std::vector<Deepest> chunks((moves.count() - 1 + kChunk - 1) / kChunk);
  parallel_for(chunks.size(), thread_count(options.threads), [&](std::size_t chunk, std::size_t) {
    std::vector<MillSearch> searches;
    for (const ToolPiece& p : pieces) searches.emplace_back(tree, p.body, options.resolution_mm);
    const std::size_t end = std::min(moves.count(), 1 + (chunk + 1) * kChunk);
    for (std::size_t m = 1 + chunk * kChunk; m < end; ++m)
      moves.for_each_stretch(m, [&](const Stretch& stretch) {
        for (MillSearch& s : searches) s.stretch(stretch, m, s.root());
      });
    for (const MillSearch& s : searches) {
      chunks[chunk].of_piece.push_back(s.deepest());
      chunks[chunk].evaluations += s.evaluations();
    }
  });
  for (const Deepest& chunk : chunks) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      MillFinding& worst = finding(report, pieces[i].part);
      if (chunk.of_piece[i].mm > worst.mm) worst = chunk.of_piece[i];
    }
    report.evaluations += chunk.evaluations;
  }
  return report;
}

}  // namespace burin::verify
