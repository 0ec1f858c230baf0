// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/removal.h"

#include <gtest/gtest.h>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/mesh_cases.h"

namespace burin::removal {
namespace {

using geom::kPi;
using geom::Point3;
using geom::Vec3;

struct Step {
  Point3 tip;
  Vec3 axis{0, 0, 1};
  bool rapid = false;
};
verify::CheckedPath path_of(const verify::CheckedMill& tool, const std::vector<Step>& steps) {
  verify::CheckedPath path;
  verify::ToolPath t;
  t.tool = tool;
  t.from = {steps[0].tip, steps[0].axis};
  for (std::size_t i = 1; i < steps.size(); ++i) {
    t.pieces.push_back({{steps[i].tip, steps[i].axis}, static_cast<std::uint32_t>(i - 1), steps[i].rapid});
    path.moves.push_back({static_cast<std::uint32_t>(i), 0, steps[i].rapid});
  }
  path.tools.push_back(t);
  return path;
}
verify::CheckedMill mill(double radius, double corner, double length = 30) {
  return {radius, corner, length, {}};
}
RemovalOptions at(double resolution, Directions directions = Directions::automatic) {
  RemovalOptions o;
  o.resolution_mm = resolution;
  o.directions = directions;
  return o;
}
const BlockStock kBlock{{0, 0, 0}, {40, 20, 10}};
const BlockStock kOff{{-40, -40, -20}, {40, 40, 10}};

double removed(const Stock& stock, const verify::CheckedPath& path, const RemovalOptions& options) {
  auto r = remove_material(stock, path, options);
  EXPECT_TRUE(r) << r.error().to_string();
  return r ? r->removed_mm3() : -1;
}

// A slot along X through the whole block, z of the tip at 6: 4 deep.
TEST(Removal, SlotsOfAllEndsHaveTheirVolume) {
  const double r = 3, depth = 4, length = 40;
  for (const double c : {0.0, 1.0, 3.0}) {
    // Below the height of the corner: 2 (r - c) c + half a disc of radius c.
    const double section = 2 * r * (depth - c) + 2 * (r - c) * c + 0.5 * kPi * c * c;
    for (const Directions d : {Directions::one, Directions::three}) {
      const double v = removed(kBlock, path_of(mill(r, c), {{{-10, 10, 6}}, {{50, 10, 6}}}), at(0.1, d));
      EXPECT_NEAR(v, section * length, 0.003 * section * length) << "corner " << c;
    }
  }
}

}  // namespace
}  // namespace burin::removal
