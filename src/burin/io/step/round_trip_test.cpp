// SPDX-License-Identifier: Apache-2.0
// write_step and back.
#include <gtest/gtest.h>

#include "burin/io/step/read_step.h"
#include "burin/io/step/step_test_util.h"

namespace burin::io {
namespace {

using geom::NurbsSurface;
using step::test::evaluate;
using step::test::random_surface;

double largest_difference(const NurbsSurface& a, const NurbsSurface& b) {
  double worst = 0;
  constexpr int kGrid = 12;
  for (int j = 0; j <= kGrid; ++j) {
    for (int i = 0; i <= kGrid; ++i) {
      const double u = double(i) / kGrid, v = double(j) / kGrid;
      worst = std::max(worst, distance(evaluate(a, u, v), evaluate(b, u, v)));
    }
  }
  return worst;
}

TEST(RoundTrip, RandomRationalSurfacesComeBack) {
  std::mt19937 random(11);
  for (int round = 0; round < 12; ++round) {
    std::vector<NurbsSurface> surfaces;
    for (int k = 0; k < 3; ++k) {
      const int p = 1 + static_cast<int>(random() % 5), q = 1 + static_cast<int>(random() % 5);
      surfaces.push_back(random_surface(random, p, q, p + 1 + static_cast<int>(random() % 5),
                                        q + 1 + static_cast<int>(random() % 5)));
    }
    const auto text = write_step(surfaces, "three patches");
    ASSERT_TRUE(text) << text.error().to_string();
    Diagnostics diagnostics;
    const auto model = read_cad(*text, {}, diagnostics);
    ASSERT_TRUE(model) << model.error().to_string();
    EXPECT_TRUE(diagnostics.empty());
    EXPECT_EQ(model->unit, "mm");
    EXPECT_EQ(model->name, "three patches");
    ASSERT_EQ(model->faces.size(), surfaces.size());
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      const CadFace& face = model->faces[k];
      EXPECT_EQ(face.number, static_cast<int>(k) + 1);
      EXPECT_FALSE(face.trimmed);
      EXPECT_TRUE(face.loops.empty());
      EXPECT_FALSE(face.of_solid);
      EXPECT_EQ(face.surface.count_u, surfaces[k].count_u);
      EXPECT_EQ(face.surface.degree_v, surfaces[k].degree_v);
      EXPECT_LT(largest_difference(face.surface, surfaces[k]), 1e-9);
    }
  }
}

TEST(RoundTrip, BoxHoldsTheSurfaceClosely) {
  std::mt19937 random(12);
  for (int round = 0; round < 10; ++round) {
    const NurbsSurface s = random_surface(random, 3, 3, 6, 7);
    Diagnostics diagnostics;
    const auto model = read_cad(*write_step({s}, "box"), {}, diagnostics);
    ASSERT_TRUE(model);
    geom::Box3 sampled;
    for (int j = 0; j <= 40; ++j) {
      for (int i = 0; i <= 40; ++i) sampled.add(evaluate(s, i / 40.0, j / 40.0));
    }
    const geom::Box3 box = model->faces[0].box;
    EXPECT_TRUE(box.grown(1e-9).contains(sampled.lo));
    EXPECT_TRUE(box.grown(1e-9).contains(sampled.hi));
    EXPECT_LT(box.hi.z - sampled.hi.z, 0.2);
    EXPECT_LT(sampled.lo.z - box.lo.z, 0.2);
    EXPECT_EQ(model->bounds.hi, box.hi);
  }
}

TEST(RoundTrip, SameBytesEachTime) {
  std::mt19937 random(13);
  const NurbsSurface a = random_surface(random, 3, 2, 5, 4), b = random_surface(random, 2, 2, 3, 3);
  const auto first = write_step({a, b}, "part"), second = write_step({a, b}, "part");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, *second);
}

TEST(RoundTrip, ChosenFacesKeepTheirNumbers) {
  std::mt19937 random(14);
  std::vector<NurbsSurface> surfaces;
  for (int k = 0; k < 5; ++k) surfaces.push_back(random_surface(random, 2, 2, 3 + k, 3));
  const auto text = write_step(surfaces, "five");
  ReadCadOptions options;
  options.file_name = "five.step";
  options.faces = {4, 2, 4};
  Diagnostics diagnostics;
  const auto model = read_cad(*text, options, diagnostics);
  ASSERT_TRUE(model);
  ASSERT_EQ(model->faces.size(), 2u);
  EXPECT_EQ(model->faces[0].number, 2);
  EXPECT_EQ(model->faces[1].number, 4);
  EXPECT_EQ(model->faces[1].surface.count_u, 6);
  for (const int missing : {0, 6, -1}) {
    options.faces = {1, missing};
    const auto none = read_cad(*text, options, diagnostics);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::usage);
    EXPECT_NE(none.error().message.find("faces 1 to 5"), std::string::npos);
    EXPECT_FALSE(mesh_cad(*text, options, 0.1, 0.3, diagnostics));
  }
}

TEST(RoundTrip, RefusesWhatIsNoSurface) {
  EXPECT_FALSE(write_step({}, "nothing"));
  std::mt19937 random(15);
  NurbsSurface s = random_surface(random, 2, 2, 4, 4);
  s.points[5].w = -1;
  EXPECT_EQ(write_step({s}, "weight").error().code, ErrorCode::geometry);
  s = random_surface(random, 2, 2, 4, 4);
  s.knots_u.pop_back();
  EXPECT_FALSE(write_step({s}, "knots"));
  s = random_surface(random, 2, 2, 4, 4);
  for (auto& p : s.points) p = {1, 2, 3, 1};
  EXPECT_FALSE(write_step({s}, "point"));
}

TEST(RoundTrip, OddNamesAreMadePlain) {
  std::mt19937 random(16);
  const NurbsSurface s = random_surface(random, 1, 1, 2, 2);
  Diagnostics diagnostics;
  for (const char* name : {"", "it's (a) \"part\";", "r\xc3\xa4tsel\n", "END-ISO-10303-21;"}) {
    const auto text = write_step({s}, name);
    ASSERT_TRUE(text);
    EXPECT_TRUE(read_cad(*text, {}, diagnostics)) << name;
  }
}

}  // namespace
}  // namespace burin::io
