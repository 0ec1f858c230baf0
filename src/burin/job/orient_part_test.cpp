// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/mesh_cases.h"
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
