// SPDX-License-Identifier: Apache-2.0
#include "burin/view/orient_html.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "burin/view/mesh_shape.h"
#include "burin/view/orient_sample.h"
#include "burin/view/page_test_support.h"

namespace burin::view {
namespace {

using orient::Cause;
using orient::OrientedPoint;
using sample::WavyFace;
using test::data_of;
using test::numbers;

TEST(OrientHtml, IsOnePageWhoseDataParsesAndCannotEscape) {
  const WavyFace face;
  const std::string page = orient_html(face.picture());
  test::expect_closed_page(page);
  test::expect_balanced(page);
  EXPECT_NE(page.find("<title>wavy &lt;&amp;&gt; &quot;@DATA@&quot;"), std::string::npos);
  const auto data = data_of(page);
  EXPECT_EQ(data["title"].get<std::string>().substr(0, 17), "wavy <&> \"@DATA@\"");
  EXPECT_EQ(data["part"], "wavy <face>");
  EXPECT_EQ(data["warnings"].size(), 2u);
  EXPECT_EQ(data["figures"].size(), 2u);
  EXPECT_EQ(data["nc"].get<std::string>(), face.picture().nc_text);
  EXPECT_EQ(data["design"]["triangles"], face.part.design_triangles);
  EXPECT_EQ(data["obstacles"]["triangles"], 12);
  EXPECT_EQ(data["tool"]["holder"].size(), 2u);
}

TEST(OrientHtml, PointsComeBack) {
  const WavyFace face;
  const auto data = data_of(orient_html(face.picture()));
  const auto& p = data["points"];
  const auto contact = numbers<float>(p["contact"]), angles = numbers<float>(p["angles"]),
             rho = numbers<float>(p["rho"]), strip = numbers<float>(p["strip"]);
  const auto normal = numbers<std::int16_t>(p["normal"]);
  const auto flags = numbers<std::uint8_t>(p["flags"]);
  const auto tests = numbers<std::uint16_t>(p["tests"]);
  const auto index = numbers<std::uint32_t>(p["index"]);
  std::size_t i = 0;
  for (const orient::OrientedPath& path : face.plan.paths) {
    for (std::size_t k = 0; k < path.points.size(); ++k, ++i) {
      const OrientedPoint& q = path.points[k];
      ASSERT_EQ(index[i], k);
      EXPECT_NEAR(contact[3 * i + 2], q.cc.c.z, 1e-5);
      EXPECT_NEAR(normal[3 * i + 1] / 32767.0, q.cc.n.y, 2e-5);
      EXPECT_NEAR(angles[4 * i], q.angles.alpha, 1e-7);
      EXPECT_NEAR(angles[4 * i + 3], q.initial.beta, 1e-7);
      EXPECT_NEAR(rho[2 * i], q.rho, 1e-4);
      EXPECT_NEAR(rho[2 * i + 1], q.rho_initial, 1e-4);
      EXPECT_NEAR(strip[2 * i] + strip[2 * i + 1], q.strip.width(), 1e-6);
      EXPECT_EQ(flags[i] & 1, q.reachable ? 1 : 0);
      EXPECT_EQ(flags[i] & 2, q.initial_found ? 2 : 0);
      EXPECT_EQ(flags[i] >> 2, static_cast<int>(q.cause));
      EXPECT_EQ(tests[i], q.tests);
    }
  }
  EXPECT_EQ(p["n"], i);
}

TEST(OrientHtml, PathsHaveTheMeansOfAllTheirPoints) {
  const WavyFace face;
  const auto data = data_of(orient_html(face.picture()));
  const auto ids = numbers<std::int32_t>(data["paths"]["ids"]);
  const auto figures = numbers<float>(data["paths"]["figures"]);
  ASSERT_EQ(ids.size(), 6 * face.plan.paths.size());
  for (std::size_t k = 0; k < face.plan.paths.size(); ++k) {
    const auto& points = face.plan.paths[k].points;
    double first = 0, best = 0, length = 0;
    int both = 0, reached = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      reached += points[i].reachable;
      if (i) length += distance(points[i].cc.c, points[i - 1].cc.c);
      if (points[i].reachable && points[i].initial_found)
        ++both, first += points[i].rho_initial, best += points[i].rho;
    }
    EXPECT_EQ(ids[6 * k + 1], static_cast<int>(points.size()));
    EXPECT_EQ(ids[6 * k + 2], reached);
    EXPECT_EQ(ids[6 * k + 3], both);
    EXPECT_NEAR(figures[9 * k + 1], first / both, 1e-3);
    EXPECT_NEAR(figures[9 * k + 2], best / both, 1e-3);
    EXPECT_NEAR(figures[9 * k + 3], face.plan.gain_per_path[k], 1e-6);
    EXPECT_NEAR(figures[9 * k + 5], length, 1e-3);
  }
  EXPECT_EQ(data["times"].size(), 3u);
  EXPECT_EQ(data["times"][0][5], face.plan.paths.size());
  EXPECT_NEAR(data["times"][0][7].get<double>(), face.plan.cut_mm / face.options.feed_mm_min, 1e-12);
}

/// The points of the maps on the page, as indices over all points of the plan.
void expect_maps(const WavyFace& face, const nlohmann::json& data, std::size_t least, std::size_t every) {
  const auto ids = numbers<std::int32_t>(data["paths"]["ids"]);
  const auto index = numbers<std::uint32_t>(data["points"]["index"]);
  ASSERT_GE(data["maps"].size(), least);
  for (std::size_t n = 0; n < data["maps"].size(); n += every) {
    const auto& m = data["maps"][n];
    const std::size_t at = m[0];
    std::size_t path = 0, first = 0;
    while (at >= first + static_cast<std::size_t>(ids[6 * path]))
      first += static_cast<std::size_t>(ids[6 * path++]);
    ASSERT_EQ(index[at], m[1].get<std::size_t>());
    const geom::Point3 c = face.plan.paths[path].points[index[at]].cc.c;
    const auto range = numbers<float>(m[4]);
    const auto cells = numbers<std::uint8_t>(m[5]);
    const int tilts = m[2], yaws = m[3];
    for (int j = 0; j < yaws; ++j) {
      for (int i = 0; i < tilts; ++i) {
        const int k = i + j * tilts;
        const orient::AngleRange& r = face.options.range;
        const orient::Angles a{r.alpha_lo + (r.alpha_hi - r.alpha_lo) * i / (tilts - 1),
                               r.beta_lo + (r.beta_hi - r.beta_lo) * j / (yaws - 1)};
        ASSERT_EQ(cells[static_cast<std::size_t>(k / 4)] >> (2 * (k % 4)) & 3,
                  static_cast<int>(WavyFace::cause_at(a, c.x, c.y)));
      }
    }
    EXPECT_NEAR(range[3], face.options.range.beta_hi, 1e-6);
  }
}

TEST(OrientHtml, MapsComeBackNodeByNode) {
  const WavyFace face;
  const auto data = data_of(orient_html(face.picture()));
  EXPECT_EQ(data["maps"].size(), face.maps.size());
  expect_maps(face, data, 1, 1);
}

TEST(OrientHtml, StaysBelowNineMegabytes) {
  const WavyFace face(300, 100, 1000, 20, 33);
  OrientPicture picture = face.picture();
  picture.nc_text = std::string(3'000'000, '\n');
  const std::string page = orient_html(picture);
  EXPECT_LT(page.size(), 9'000'000u);
  const auto data = data_of(page);
  EXPECT_EQ(data["paths"]["of"], 100);
  EXPECT_LE(data["points"]["n"].get<int>(), 50'000);
  EXPECT_LE(data["design"]["triangles"].get<int>(), 30'000);
  EXPECT_GE(data["design"]["triangles"].get<int>(), 10'000);
  EXPECT_EQ(data["mapCount"], 5'000);
  expect_maps(face, data, 2'000, 97);
}

TEST(OrientHtml, SamePictureSameBytes) {
  const WavyFace a, b;
  EXPECT_EQ(orient_html(a.picture()), orient_html(b.picture()));
}

TEST(OrientHtml, AnythingIsAPage) {
  WavyFace face(2, 2, 3, 1, 5);
  OrientPicture picture = face.picture();
  picture.maps[0].path = 99;
  picture.maps[1].point = 99;
  picture.maps[2].map.cells.pop_back();
  picture.maps[3].map.tilts = 1;
  face.plan.paths[0].points[0].rho = std::numeric_limits<double>::infinity();
  face.plan.paths[0].points[1].cc.n = {std::nan(""), 0, 0};
  face.plan.gain_mean = std::nan("");
  face.plan.gain_per_path.clear();
  EXPECT_EQ(data_of(orient_html(picture))["maps"].size(), 2u);
  face.plan = {};
  face.part = {};
  face.mill = {};
  const auto data = data_of(orient_html(picture));
  EXPECT_EQ(data["points"]["n"], 0);
  EXPECT_EQ(data["maps"].size(), 0u);
  EXPECT_EQ(data["design"]["triangles"], 0);
}

TEST(MeshShape, ReducedMeshesStayNearAndHaveNoMoreThanAskedFor) {
  const WavyFace face(200);
  const std::size_t design = face.part.design_triangles;
  const ReducedMesh drawn = reduced(face.part.mesh, 0, design, 5'000);
  EXPECT_LE(drawn.mesh.triangles.size(), 5'000u);
  EXPECT_GE(drawn.mesh.triangles.size(), 1'500u);
  for (std::size_t i = 0; i < drawn.source.size(); ++i) {
    EXPECT_LT(drawn.source[i], design);
    for (const std::uint32_t v : drawn.mesh.triangles[i]) {
      const geom::Point3 p = drawn.mesh.vertices[v];
      EXPECT_NEAR(p.z, WavyFace::height(p.x, p.y), 1e-9);
    }
  }
  const ReducedMesh wall = reduced(face.part.mesh, design, design + 99, 100);
  EXPECT_EQ(wall.mesh.triangles.size(), 12u);
  EXPECT_TRUE(reduced({}, 0, 5, 10).source.empty());
  geom::Mesh point;  // no extent at all
  point.vertices.assign(3, {1, 2, 3});
  point.triangles.assign(50, {0, 1, 2});
  EXPECT_TRUE(reduced(point, 0, 50, 10).source.empty());
}

TEST(MeshShape, SmoothFacesAreShadedSmoothAndEdgesStaySharp) {
  const WavyFace face(60);
  const std::size_t design = face.part.design_triangles;
  const Shape smooth = shaded(face.part.mesh, reduced(face.part.mesh, 0, design, 1'000'000));
  ASSERT_EQ(smooth.points.size(), 3 * design);
  for (std::size_t i = 0; i < smooth.points.size(); i += 5) {
    const geom::Point3 p = smooth.points[i];
    if (p.x < 8 || p.x > WavyFace::kX - 8 || p.y < 8 || p.y > WavyFace::kY - 8) continue;
    const double h = 1e-4;
    const geom::Vec3 n =
        unit(geom::Vec3{-(WavyFace::height(p.x + h, p.y) - WavyFace::height(p.x - h, p.y)) / (2 * h),
                        -(WavyFace::height(p.x, p.y + h) - WavyFace::height(p.x, p.y - h)) / (2 * h), 1});
    EXPECT_GT(dot(smooth.normals[i], n), 0.999);
  }
  const Shape wall = shaded(face.part.mesh, reduced(face.part.mesh, design, design + 12, 100));
  for (const geom::Vec3 n : wall.normals)
    EXPECT_NEAR(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1, 1e-12);
}

}  // namespace
}  // namespace burin::view
