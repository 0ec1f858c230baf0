// SPDX-License-Identifier: Apache-2.0
// Samples that lie near each other, and where their lines enter the tools. Internal to verify. mm.
// docs/verify-deviation.md
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "burin/verify/deviation.h"
#include "burin/verify/swept_tool.h"

namespace burin::verify {

/// The tools as the index has them, and whose move a stretch is.
struct Swept {
  std::vector<SweptTool> tools;
  std::vector<std::uint32_t> path;  ///< by tool: index into CheckedPath::tools
  const CheckedPath* checked = nullptr;

  std::uint32_t move_of(const Moment& at) const {
    return checked->tools[path[at.tool]].pieces[tools[at.tool].original(at.stretch)].move;
  }
  SampleLine line(geom::Point3 p, geom::Vec3 n, const DeviationOptions& options) const {
    return {p, n, options.reach_mm, options.resolution_mm, options.reach_mm, {}};
  }
  void lower(SampleLine& line) const {
    for (const SweptTool& tool : tools) tool.lower(line);
  }
  void lower(SampleLine& line, const Moment& hint) const {
    tools[hint.tool].lower(line, tools[hint.tool].candidate(hint.stretch, hint.body));
  }
};
inline Swept swept_tools(const CheckedPath& path) {
  Swept swept;
  swept.checked = &path;
  for (std::uint32_t k = 0; k < path.tools.size(); ++k) {
    const ToolPath& tool = path.tools[k];
    if (tool.pieces.empty()) continue;
    std::vector<Stretch> stretches;
    stretches.reserve(tool.pieces.size());
    const cl::Pose* from = &tool.from;
    for (const PathPiece& piece : tool.pieces) {
      stretches.push_back(Stretch::between(*from, piece.to));
      from = &piece.to;
    }
    swept.tools.emplace_back(bodies_of(tool.tool), std::move(stretches),
                             static_cast<std::uint32_t>(swept.tools.size()));
    swept.path.push_back(k);
  }
  return swept;
}

/// A box of its own direction around places.
class Enclosure {
 public:
  Enclosure(geom::Vec3 n, geom::Point3 origin) : origin_(origin) {
    const geom::Vec3 any = std::abs(n.x) < 0.6 ? geom::Vec3{1, 0, 0} : geom::Vec3{0, 1, 0};
    axes_ = {unit(cross(n, any)), cross(n, unit(cross(n, any))), n};
  }
  void add(geom::Point3 p) {
    const geom::Vec3 d = p - origin_;
    box_.add(geom::Point3{dot(d, axes_[0]), dot(d, axes_[1]), dot(d, axes_[2])});
  }
  BoxExtent extent() const {
    const geom::Point3 m = lerp(box_.lo, box_.hi, 0.5);
    const geom::Vec3 half = 0.5 * (box_.hi - box_.lo);
    return {origin_ + (m.x * axes_[0] + m.y * axes_[1] + m.z * axes_[2]),
            norm(half),
            {axes_[2], half.z, -half.z},
            {half.x * axes_[0], half.y * axes_[1], half.z * axes_[2]}};
  }

 private:
  geom::Point3 origin_;
  std::array<geom::Vec3, 3> axes_;
  geom::Box3 box_;
};

/// Of the samples of a tile, and of its parts; fewer are not worth another look.
inline constexpr std::size_t kGroup = 4;

/// Lowest entries of the samples of a tile: the first one and those that the stretch of their neighbour says
/// nothing about walk through the index alone; what could be lower for the others is gathered once.
class Tile {
 public:
  Tile(const Swept& swept, const DeviationOptions& options) : swept_(swept), options_(options) {}

  const std::vector<SampleLine>& measure(const std::vector<SurfaceSample>& samples,
                                         const std::uint32_t* index, std::size_t count) {
    lines_.clear();
    open_.clear();
    const SampleLine* hint = nullptr;
    lines_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const SurfaceSample& s = samples[index[i]];
      lines_.push_back(swept_.line(s.p, s.n, options_));
      SampleLine& line = lines_.back();
      if (hint) swept_.lower(line, hint->at);
      if (line.found()) {
        open_.push_back(i);
      } else {
        swept_.lower(line);
      }
      if (line.found()) hint = &line;
    }
    if (!open_.empty()) finish();
    return lines_;
  }

 private:
  void finish() {
    std::vector<SweptTool::Part> all;
    for (const SweptTool& tool : swept_.tools) tool.add_all(all);
    lower(open_.data(), open_.size(), all);
  }
  /// Fewer samples each time have to do with less of the index.
  void lower(const std::size_t* which, std::size_t count, const std::vector<SweptTool::Part>& all) {
    const BoxExtent extent = around(which, count);
    const double touch = lines_.front().touch();
    std::vector<SweptTool::Part> some;
    for (const SweptTool::Part& part : all) swept_.tools[part.tool].narrow(part, extent, extent, touch, some);
    if (count <= kGroup) {
      for (std::size_t i = 0; i < count; ++i)
        for (const SweptTool::Part& part : some) swept_.tools[part.tool].lower(lines_[which[i]], part);
      return;
    }
    const std::size_t part = (count + kGroup - 1) / kGroup;
    for (std::size_t first = 0; first < count; first += part)
      lower(which + first, std::min(part, count - first), some);
  }
  BoxExtent around(const std::size_t* which, std::size_t count) const {
    Enclosure box(lines_[which[0]].n, lines_[which[0]].q);
    for (std::size_t i = 0; i < count; ++i) {
      const SampleLine& line = lines_[which[i]];
      box.add(line.q);
      box.add(line.q + std::max(0.0, line.best) * line.n);
    }
    return box.extent();
  }

  const Swept& swept_;
  const DeviationOptions& options_;
  std::vector<SampleLine> lines_;
  std::vector<std::size_t> open_;
};

}  // namespace burin::verify
