// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/nurbs.h"

#include <gtest/gtest.h>

#include <limits>

namespace burin::geom {
namespace {

NurbsSurface plate(int nu, int nv, int p, int q) {
  NurbsSurface s;
  s.degree_u = p, s.degree_v = q, s.count_u = nu, s.count_v = nv;
  s.knots_u = clamped_uniform_knots(nu, p);
  s.knots_v = clamped_uniform_knots(nv, q);
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) s.points.push_back(homogeneous({double(i), double(j), 0}, 1));
  }
  return s;
}

TEST(Nurbs, UniformKnots) {
  EXPECT_EQ(clamped_uniform_knots(6, 3), (std::vector<double>{0, 0, 0, 0, 1 / 3., 2 / 3., 1, 1, 1, 1}));
  EXPECT_EQ(clamped_uniform_knots(4, 3), (std::vector<double>{0, 0, 0, 0, 1, 1, 1, 1}));
}

TEST(Nurbs, FindSpan) {
  const std::vector<double> k{0, 0, 0, 1, 2, 2, 5, 5, 5};
  EXPECT_EQ(find_span(k, 2, 6, 0), 2);
  EXPECT_EQ(find_span(k, 2, 6, 0.5), 2);
  EXPECT_EQ(find_span(k, 2, 6, 1), 3);
  EXPECT_EQ(find_span(k, 2, 6, 2), 5);
  EXPECT_EQ(find_span(k, 2, 6, 5), 5);
  EXPECT_EQ(find_span(k, 2, 6, -9), 2);
  EXPECT_EQ(find_span(k, 2, 6, 9), 5);
  EXPECT_EQ(find_span(k, 2, 6, std::numeric_limits<double>::quiet_NaN()), 5);
}

TEST(Nurbs, InnerKnots) {
  const auto inner = inner_knots({0, 0, 0, 1, 2, 2, 5, 5, 5}, 2);
  ASSERT_EQ(inner.size(), 2u);
  EXPECT_EQ(inner[0].value, 1);
  EXPECT_EQ(inner[0].multiplicity, 1);
  EXPECT_EQ(inner[1].value, 2);
  EXPECT_EQ(inner[1].multiplicity, 2);
}

std::string refused(const NurbsSurface& s) {
  const auto r = validate(s);
  EXPECT_FALSE(r);
  return r ? "" : r.error().message;
}
bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

TEST(Nurbs, ValidateSaysWhatIsWrong) {
  const NurbsSurface good = plate(5, 6, 3, 2);
  ASSERT_TRUE(validate(good));
  NurbsSurface s = good;
  s.degree_u = 0;
  EXPECT_TRUE(has(refused(s), "degree 0 in u (1 to 25"));
  s = good, s.degree_v = 26;
  EXPECT_TRUE(has(refused(s), "degree 26 in v"));
  s = good, s.count_u = 3;
  EXPECT_TRUE(has(refused(s), "needs at least 4"));
  s = good, s.count_v = 2'000'000'000;
  EXPECT_TRUE(has(refused(s), "at most 4000000"));
  s = good, s.count_u = 4'000'000, s.count_v = 4'000'000;
  EXPECT_TRUE(has(refused(s), "16000000000000 control points"));
  s = good, s.points.pop_back();
  EXPECT_TRUE(has(refused(s), "29 control points (5 in u by 6 in v need 30)"));
  s = good, s.knots_u.pop_back();
  EXPECT_TRUE(has(refused(s), "8 knots in u"));
  s = good, s.knots_v[4] = 0.1, s.knots_v[3] = 0.2;
  EXPECT_TRUE(has(refused(s), "knot 5, 0.1, in v is less"));
  s = good, s.knots_u[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(refused(s), "not a usable number"));
  s = good, s.knots_u[0] = -1;
  EXPECT_TRUE(has(refused(s), "not clamped"));
  s = good, s.knots_u[8] = 2;
  EXPECT_TRUE(has(refused(s), "not clamped"));
  s = good, s.knots_u[4] = 0;
  EXPECT_TRUE(has(refused(s), "more than 3 times"));
  s = good, s.knots_v = {0, 0, 0, .5, .5, .5, 1, 1, 1};
  EXPECT_TRUE(has(refused(s), "more than 2 times"));
  s = good, s.knots_v.assign(9, 0.0);
  EXPECT_TRUE(has(refused(s), "all knots in v are equal"));
  s = good, s.knots_v[3] = 1e-310;
  EXPECT_TRUE(has(refused(s), "too close"));
  s = good, s.points[7].w = 0;
  EXPECT_TRUE(has(refused(s), "control point 3 in u, 2 in v: weight 0"));
  s = good, s.points[7].w = -1;
  EXPECT_TRUE(has(refused(s), "positive"));
  s = good, s.points[7].w = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(refused(s), "positive"));
  s = good, s.points[0].y = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(has(refused(s), "control point 1 in u, 1 in v: a coordinate"));
}

TEST(Nurbs, ValidateCurve) {
  NurbsCurve c{2, clamped_uniform_knots(3, 2), {{0, 0, 0, 1}, {1, 1, 0, 1}, {2, 0, 0, 1}}};
  EXPECT_TRUE(validate(c));
  c.points.pop_back();
  EXPECT_FALSE(validate(c));
  EXPECT_FALSE(validate(NurbsCurve{}));
  EXPECT_FALSE(validate(NurbsSurface{}));
}

}  // namespace
}  // namespace burin::geom
