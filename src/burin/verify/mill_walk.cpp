// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/mill_walk.h"

#include <algorithm>

namespace burin::verify {
namespace {

constexpr std::size_t kBlock = 512;
// Great circles stay within a cap that holds their ends when it is less than half of the sphere: below a
// chord of sqrt(2).
constexpr double kCap = 1.4;

}  // namespace

Step step_of(const ToolPath& path, std::size_t piece) {
  const cl::Pose& from = piece == 0 ? path.from : path.pieces[piece - 1].to;
  return {Stretch::between(from, path.pieces[piece].to), path.pieces[piece].move, piece};
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

Around around(const Step* begin, const Step* end, double span) {
  geom::Box3 tips;
  geom::Vec3 sum;
  const auto each_end = [&](auto&& use) {
    for (const Step* s = begin; s != end; ++s) use(s->stretch.at(0)), use(s->stretch.at(1));
  };
  each_end([&](const Placed& p) { tips.add(p.tip), sum = sum + p.axis; });
  Around out;
  out.mean = {lerp(tips.lo, tips.hi, 0.5), norm(sum) > 0 ? unit(sum) : begin->stretch.middle.axis};
  double way = 0, chord = 0;
  each_end([&](const Placed& p) {
    way = std::max(way, distance(p.tip, out.mean.tip));
    chord = std::max(chord, norm(p.axis - out.mean.axis));
  });
  out.slack = way + (chord < kCap ? chord : 2) * span;
  return out;
}

}  // namespace burin::verify
