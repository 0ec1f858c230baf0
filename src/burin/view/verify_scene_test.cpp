// SPDX-License-Identifier: Apache-2.0
#include "burin/view/verify_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "burin/geom/mesh/mesh_cases.h"
#include "burin/view/mesh_values.h"
#include "burin/view/orient_sample.h"
#include "burin/view/orient_scene.h"

namespace burin::view {
namespace {

using geom::Mesh;
using geom::Point3;

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles)
    area +=
        norm(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]])) / 2;
  return area;
}
double longest_of(const Mesh& mesh) {
  double longest = 0;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, geom::distance(mesh.vertices[t[k]], mesh.vertices[t[(k + 1) % 3]]));
  return longest;
}

TEST(MeshValues, RefinedMeshesAreTheSameSurface) {
  for (const Mesh& mesh :
       {geom::cases::box({0, 0, 0}, {30, 20, 1}), geom::cases::sphere(12, 8, {0, 0, 0}, 10)}) {
    const Mesh fine = refined(mesh, 1.5, 1'000'000);
    EXPECT_NEAR(area_of(fine), area_of(mesh), 1e-9 * area_of(mesh));
    EXPECT_LE(longest_of(fine), 1.5);
    // Still closed: every edge once each way.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : fine.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
    EXPECT_LE(refined(mesh, 1e-6, 5'000).triangles.size(), 5'000u);
    const double wanted = 20'000;
    const auto got = static_cast<double>(refined(mesh, edge_for(mesh, 20'000), 1'000'000).triangles.size());
    EXPECT_GT(got, wanted / 4);
    EXPECT_LT(got, wanted * 4);
  }
}

/// A thin plate, sampled on top and bottom with values of their own.
TEST(MeshValues, EachSideHasItsOwnValues) {
  const Mesh fine = refined(geom::cases::box({0, 0, 0}, {20, 20, 0.1}), 1, 1'000'000);
  std::vector<verify::SurfaceSample> samples;
  std::vector<float> values;
  const auto add = [&](double x, double y, bool top, float value) {
    samples.push_back({{x, y, top ? 0.1 : 0}, {0, 0, top ? 1.0 : -1.0}, 0.01f, true});
    values.push_back(value);
  };
  for (double x = 0.1; x < 20; x += 0.25) {
    for (double y = 0.1; y < 20; y += 0.25) {
      add(x, y, true, 0.01f);
      add(x, y, false, x < 10 ? -0.02f : std::numeric_limits<float>::quiet_NaN());
    }
  }
  add(5.03, 5.02, true, -0.7f);
  const std::vector<float> got = vertex_values(fine, samples, values);
  int gouged = 0;
  for (std::size_t v = 0; v < got.size(); ++v) {
    const Point3 p = fine.vertices[v];
    if (p.x < 1 || p.x > 19 || p.y < 1 || p.y > 19) continue;
    if (p.z > 0.05) {
      gouged += got[v] == -0.7f;
      if (got[v] != -0.7f) {
        EXPECT_EQ(got[v], 0.01f);
      }
    } else if (p.x < 9) {
      EXPECT_EQ(got[v], -0.02f);
    } else if (p.x > 11) {
      EXPECT_TRUE(std::isnan(got[v])) << "not machined";
    }
  }
  EXPECT_EQ(gouged, 1);
}

/// A flat end of 10 mm over a plane, one point too deep: what a verification of it says, by hand.
struct Plane {
  job::VerifyInput input;
  job::VerifyResult result;
  Plane() {
    input.operation = "orient";
    input.design = geom::cases::box({0, 0, -5}, {40, 40, 0});
    input.program_text = "a\nb\nc\n";
    input.program.add(cl::FeedRate{600}, 1);
    for (int i = 0; i < 5; ++i)
      input.program.add(cl::Feed{{{10.0 * i, 20, i == 3 ? -0.05 : 0}, {0, 0, 1}}},
                        static_cast<std::uint32_t>(i + 2));
    verify::ToolPath tool;
    tool.tool = {5, 0, 20, {{12, 20, 60, true}}};
    tool.tool_number = 7;
    input.path.tools = {tool};
    for (double x = 0.5; x < 40; ++x) {
      for (double y = 0.5; y < 40; ++y) {
        result.surface.samples.push_back({{x, y, 0}, {0, 0, 1}, 1.f, true});
        result.deviation.deviation_mm.push_back(std::hypot(x - 30, y - 20) < 5 ? -0.05f : 0.f);
      }
    }
    result.deviation.gouge = {0.05, {30, 20, 0}, {0, 0, 1}, 3};
    result.deviation.area_mm2 = 1600;
    result.collisions = {{2, verify::Body::holder, verify::Against::part, 0.4, {1, 2, 3}}};
    result.bound_mm = 0.001;
  }
};

TEST(VerifyScene, FindingsPointToTheirMoves) {
  Plane plane;
  Diagnostics diagnostics;
  diagnostics.left_out("unmachined", "something", {.file = "a.nc", .line = 3});
  VerifySceneOptions options;
  options.title = "plane";
  const auto scene = verify_scene(plane.input, &plane.result, &diagnostics, options);
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_TRUE(validate(*scene)) << validate(*scene).error().message;
  ASSERT_EQ(scene->findings.size(), 3u);
  const SceneFinding& gouge = scene->findings[0];
  EXPECT_EQ(gouge.level, SceneFinding::Level::fault);
  EXPECT_EQ(gouge.title, "deepest gouge 0.05 mm");
  EXPECT_EQ(gouge.detail, "move 3, line 5");
  ASSERT_TRUE(gouge.node);
  EXPECT_EQ(scene->path.point[*gouge.node], (Point3{30, 20, -0.05}));
  EXPECT_EQ(scene->findings[1].title, "holder in part, 0.4 mm");
  EXPECT_EQ(scene->findings[2].detail, "a.nc:3");
  EXPECT_EQ(scene->tools[0].number, 7);
  EXPECT_EQ(scene->tools[0].name, "flat 10 mm");
  EXPECT_EQ(scene->tools[0].pieces.back().kind, ToolPiece::Kind::holder);
}

TEST(VerifyScene, ColoursFollowTheDeviation) {
  Plane plane;
  const auto scene = verify_scene(plane.input, &plane.result, nullptr, {});
  ASSERT_TRUE(scene);
  const SceneMesh& design = scene->meshes[0];
  ASSERT_EQ(design.value.size(), design.mesh.vertices.size());
  EXPECT_GT(design.mesh.triangles.size(), 20'000u);
  for (std::size_t v = 0; v < design.value.size(); ++v) {
    const Point3 p = design.mesh.vertices[v];
    if (p.z < 0 || p.x < 2 || p.x > 38 || p.y < 2 || p.y > 38 || std::isnan(design.value[v])) continue;
    const double r = std::hypot(p.x - 30, p.y - 20);
    if (r < 3.5) {
      EXPECT_EQ(design.value[v], -0.05f);
    }
    if (r > 6.5) {
      EXPECT_EQ(design.value[v], 0.f);
    }
  }
  ASSERT_EQ(scene->series.size(), 1u);
  EXPECT_EQ(scene->series[0].value[1], 0.f);
  EXPECT_EQ(scene->series[0].value[3], -0.05f);
  double area = 0;
  for (const double a : scene->histograms[0].area) area += a;
  EXPECT_NEAR(area, 1600, 1e-6);
  EXPECT_NEAR(scene->histograms[0].from, -0.05, 1e-6);
}

TEST(VerifyScene, WithoutAResultOnlyWhatWasRead) {
  Plane plane;
  const auto scene = verify_scene(plane.input, nullptr, nullptr, {});
  ASSERT_TRUE(scene);
  EXPECT_TRUE(scene->meshes[0].value.empty());
  EXPECT_TRUE(scene->findings.empty());
  EXPECT_EQ(scene->path.point.size(), 5u);
}

TEST(VerifyScene, PlacesAlongOutlines) {
  job::VerifyInput input;
  input.operation = "laser";
  input.kerf_mm = 0.2;
  input.outlines = {{{geom::make_line({0, 0}, {10, 0})}, false}, {{geom::make_line({0, 5}, {10, 5})}, true}};
  input.program.add(cl::FeedRate{1000}, 1);
  input.program.add(cl::Rapid{{{0, 0, 0}, {0, 0, 1}}}, 2);
  input.program.add(cl::Beam{true, 10}, 3);
  input.program.add(cl::Feed{{{10, 0, 0}, {0, 0, 1}}}, 4);
  job::VerifyResult result;
  result.beam.emplace();
  for (std::uint32_t o = 0; o < 2; ++o)
    for (int i = 0; i < 10; ++i)
      result.beam->places.push_back({{double(i), 5.0 * o}, {0, 1}, o ? NAN : -0.01 * i, 1, o, false});
  result.beam->gouge = {0.09, {9, 0}, 1};
  const auto scene = verify_scene(input, &result, nullptr, {});
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_TRUE(validate(*scene));
  ASSERT_EQ(scene->outlines.size(), 2u);
  EXPECT_FALSE(scene->outlines[0].closed);
  EXPECT_EQ(scene->outlines[0].value[9], -0.09f);
  EXPECT_TRUE(std::isnan(scene->outlines[1].value[3]));
  EXPECT_EQ(scene->findings[0].title, "deepest gouge 0.09 mm");
  EXPECT_EQ(scene->tools[0].kerf_mm, 0.2);
}

// --- tool orientation

TEST(OrientScene, PointsAnglesAndMapsComeBack) {
  const sample::WavyFace face;
  cl::Program program;
  program.add(cl::FeedRate{800});
  std::uint32_t number = 0;
  for (const orient::OrientedPath& path : face.plan.paths) {
    program.add(cl::Rapid{{path.points[0].cc.c + geom::Vec3{0, 0, 50}, {0, 0, 1}}});
    program.add(cl::Feed{{path.points[0].cc.c + geom::Vec3{0, 0, 5}, {0, 0, 1}}});
    for (const orient::OrientedPoint& p : path.points) program.add(cl::Feed{{p.cc.c, p.cc.n}}, number++);
  }
  OrientPicture picture = face.picture();
  picture.program = &program;
  picture.nc_line_to_record = {0xffffffffu, 0, 1, 3};
  const auto scene = orient_scene(picture);
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_TRUE(validate(*scene)) << validate(*scene).error().message;
  EXPECT_EQ(scene->groups.size(), face.plan.paths.size());
  EXPECT_EQ(scene->meshes[0].mesh.triangles.size(), face.part.design_triangles);
  EXPECT_EQ(scene->meshes[1].role, MeshRole::obstacle);
  ASSERT_EQ(scene->cspaces.size(), face.maps.size());
  for (std::size_t k = 0; k < face.maps.size(); ++k) {
    const SceneCSpace& c = scene->cspaces[k];
    const auto& m = face.maps[k];
    const orient::OrientedPoint& p = face.plan.paths[m.path].points[m.point];
    EXPECT_EQ(scene->path.point[c.node], p.cc.c);
    EXPECT_EQ(scene->path.group[c.node], m.path);
    EXPECT_NEAR(scene->series[0].value[c.node], p.rho, 1e-4);
    EXPECT_NEAR(scene->series[3].value[c.node], geom::degrees(p.angles.alpha), 1e-4);
    for (std::uint32_t i = 0; i < c.tilts; i += 5) {
      for (std::uint32_t j = 0; j < c.yaws; j += 4) {
        const std::size_t at = i * c.yaws + j;
        ASSERT_EQ(c.cause[at], static_cast<int>(m.map.at(static_cast<int>(i), static_cast<int>(j))));
        const double rho = effective_radius(m.map.node(static_cast<int>(i), static_cast<int>(j)), face.mill);
        if (c.cause[at] == 0) {
          EXPECT_NEAR(c.radius_mm[at], rho, 1e-4 * rho);
        }
        if (c.cause[at] != 0) {
          EXPECT_TRUE(std::isnan(c.radius_mm[at]));
        }
      }
    }
  }
  for (std::size_t n = 1; n < scene->path.point.size(); ++n)
    EXPECT_EQ(scene->path.kind[n] == WayKind::feed, !std::isnan(scene->series[0].value[n]));
  EXPECT_EQ(scene->path.line[0], 3u) << "record 1 stands in the third line";
}

}  // namespace
}  // namespace burin::view
