// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/reach.h"

#include <algorithm>
#include <cmath>

#include "burin/plan/rotary/reach_exact.h"

namespace burin::rotary {

namespace {

using geom::Vec3;
using namespace detail;

/// Where a point stands as far away as the piece is wide, rounding of squares (1e-16) becomes 1e-8 in the
/// angle (the arc sine has no slope left). A gap of less than that is none.
constexpr double kRounding = 2e-8;

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

}  // namespace

struct ReachIndex::State {
  std::vector<std::array<geom::Point3, 3>> triangles;
  model::BallTool tool;
};

ReachIndex::ReachIndex(const geom::Mesh& mesh, const model::BallTool& tool, double /*accuracy_rad*/)
    : state_(std::make_unique<State>()) {
  state_->tool = tool;
  for (const auto& t : mesh.triangles) {
    std::array<geom::Point3, 3> corners;
    bool good = true;
    for (std::size_t i = 0; i < 3; ++i) {
      good = good && t[i] < mesh.vertices.size() && finite(mesh.vertices[t[i]]);
      if (good) corners[i] = mesh.vertices[t[i]];
    }
    if (good) state_->triangles.push_back(corners);
  }
}
ReachIndex::~ReachIndex() = default;
ReachIndex::ReachIndex(ReachIndex&&) noexcept = default;
ReachIndex& ReachIndex::operator=(ReachIndex&&) noexcept = default;

AngleSet ReachIndex::reachable(geom::Point3 center, const ReachOptions& options) const {
  if (!finite(center) || !std::isfinite(options.grow_mm)) return {};
  Arcs arcs;
  for (const Piece& piece : pieces_of(state_->tool, options)) {
    for (const auto& t : state_->triangles) {
      const Corners c{t[0] - center, t[1] - center, t[2] - center};
      if (std::min({c[0].x, c[1].x, c[2].x}) >= piece.radius) continue;
      if (std::max({c[0].x, c[1].x, c[2].x}) <= -piece.radius) continue;
      const auto rho = [](const Vec3& v) { return std::hypot(v.y, v.z); };
      if (std::max({rho(c[0]), rho(c[1]), rho(c[2])}) <= piece.h0) continue;
      forbid_exactly(c, piece, arcs);
      if (arcs.all()) return {};
    }
  }
  return arcs.gaps(kRounding);
}

}  // namespace burin::rotary
