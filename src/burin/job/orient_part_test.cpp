// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/mesh_cases.h"
#include "burin/geom/surface/closest.h"
#include "burin/geom/surface/modify.h"
#include "burin/geom/surface/surface_cases.h"
#include "burin/io/step/read_step.h"
#include "burin/io/stl/stl.h"
#include "burin/job/orient_job.h"

namespace burin::job {
namespace {

FileSource files(std::vector<std::pair<std::string, std::string>> list) {
  return [list = std::move(list)](const std::string& path) -> Result<std::string> {
    for (const auto& [name, text] : list)
      if (name == path) return text;
    return Error{ErrorCode::io, "not there", {.file = path}};
  };
}

TEST(OrientPart, APropellerIsItsSideThenWhatStandsAround) {
  OrientJobFile job;
  model::PropellerData data;
  data.diameter = 300;
  job.part = data;
  job.options.tolerance_mm = 0.1;
  job.obstacles = {"box.stl"};
  Diagnostics diagnostics;
  const std::string box = io::write_stl(geom::cases::box({400, 0, 0}, {410, 10, 10}));
  const auto part = load_orient_part(job, "jobs", files({{"jobs/box.stl", box}}), diagnostics);
  ASSERT_TRUE(part.ok()) << part.error().to_string();
  EXPECT_EQ(part->faces.size(), 1u);
  EXPECT_GT(part->design_triangles, 100u);
  EXPECT_GT(part->mesh.triangles.size(), part->design_triangles + 12);
  EXPECT_LE(part->deflection_mm, 0.1 / 40);
  EXPECT_GT(part->deflection_mm, 0);
  EXPECT_DOUBLE_EQ(part->bounds.hi.x, 410);
  // The design's triangles look up (the very edge at the hub is steep and may hang over a little).
  for (std::size_t i = 0; i < part->design_triangles; ++i) {
    const auto& t = part->mesh.triangles[i];
    const auto& p = part->mesh.vertices;
    EXPECT_GT(unit(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])).z, -0.2);
  }
  EXPECT_TRUE(diagnostics.empty());
}

TEST(OrientPart, AMeshIsTheDesignItself) {
  OrientJobFile job;
  job.part = OrientMesh{"box.stl", true};
  Diagnostics diagnostics;
  const std::string box = io::write_stl(geom::cases::box({0, 0, 0}, {10, 10, 10}));
  const auto part = load_orient_part(job, "", files({{"box.stl", box}}), diagnostics);
  ASSERT_TRUE(part.ok()) << part.error().to_string();
  EXPECT_TRUE(part->faces.empty());
  EXPECT_EQ(part->design_triangles, 12u);
  EXPECT_EQ(part->deflection_mm, 0);
  EXPECT_LT(geom::examine(part->mesh).signed_volume, 0);  // flipped
}

TEST(OrientPart, FacesThatAreNotChosenAreObstacles) {
  geom::cases::Shape shape;
  shape.weight_lo = shape.weight_hi = 1;
  const geom::NurbsSurface chosen = geom::cases::random_surface(1, shape);
  const geom::NurbsSurface other = geom::translated(chosen, {0, 0, 100});
  const auto step = io::write_step({chosen, other}, "two");
  if (!step.ok()) GTEST_SKIP() << "built without OpenCASCADE";
  OrientJobFile job;
  job.options.tolerance_mm = 2;
  const auto load = [&](std::vector<int> faces, bool flip) {
    Diagnostics diagnostics;
    job.part = OrientSurface{"two.step", std::move(faces), flip};
    return load_orient_part(job, "", files({{"two.step", *step}}), diagnostics);
  };
  const auto part = load({1}, false);
  ASSERT_TRUE(part.ok()) << part.error().to_string();
  ASSERT_EQ(part->faces.size(), 1u);
  EXPECT_EQ(part->faces[0].number, 1);
  EXPECT_LE(part->deflection_mm, 0.05);
  const geom::ClosestPointFinder finder(part->faces[0].surface);
  const auto& p = part->mesh.vertices;
  double below = 0;
  for (std::size_t i = 0; i < part->mesh.triangles.size(); i += 37) {
    const auto& t = part->mesh.triangles[i];
    const double distance = finder.find(p[t[0]], 1e-6).distance;
    if (i < part->design_triangles) {
      EXPECT_LT(distance, 1e-6);
      below += cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]).z;
    } else {
      EXPECT_GT(distance, 20);
    }
  }
  EXPECT_LT(part->design_triangles, part->mesh.triangles.size());
  const auto flipped = load({1}, true);
  ASSERT_TRUE(flipped.ok());
  EXPECT_NE(flipped->faces[0].reversed, part->faces[0].reversed);
  const auto& t = flipped->mesh.triangles[0];
  const auto& q = flipped->mesh.vertices;
  EXPECT_LT(cross(q[t[1]] - q[t[0]], q[t[2]] - q[t[0]]).z * below, 0);
  EXPECT_EQ(load({}, false)->faces.size(), 2u);
  const auto none = load({3}, false);
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().message.find("(1 to 2)"), std::string::npos);
}

TEST(OrientPart, ErrorsNameTheFile) {
  OrientJobFile job;
  job.part = OrientMesh{"gone.stl"};
  Diagnostics diagnostics;
  const auto gone = load_orient_part(job, "", files({}), diagnostics);
  ASSERT_FALSE(gone.ok());
  EXPECT_NE(gone.error().to_string().find("gone.stl"), std::string::npos);
  job.part = OrientMesh{"box.stl"};
  job.obstacles = {"other.stl"};
  const std::string box = io::write_stl(geom::cases::box({0, 0, 0}, {10, 10, 10}));
  const auto other =
      load_orient_part(job, "", files({{"box.stl", box}, {"other.stl", "rubbish"}}), diagnostics);
  ASSERT_FALSE(other.ok());
  EXPECT_EQ(other.error().where.file, "other.stl");
}

}  // namespace
}  // namespace burin::job
