// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/tool_angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace burin::orient {
namespace {

using geom::Vec3;

CcPoint frame(std::mt19937& random) {
  std::normal_distribution<double> g;
  CcPoint at;
  at.c = {10 * g(random), 10 * g(random), 10 * g(random)};
  at.n = geom::unit({g(random), g(random), g(random)});
  at.f = geom::unit(cross(at.n, Vec3{g(random), g(random), g(random)}));
  return at;
}

/// The points of the cutting edge, or of the corner's torus, whose tangent plane holds the view direction f:
/// the silhouette. Its radius of curvature at the contact point, by three points of it.
double silhouette_radius(const Angles& angles, const model::Mill& mill) {
  const CcPoint at{{}, {0, 0, 1}, {1, 0, 0}};
  const cl::Pose pose = orient::pose(at, angles, mill);
  const double r = mill.corner_radius, ring = mill.radius - r;
  const Vec3 e1 = geom::unit(cross(pose.axis, at.f)), e2 = cross(pose.axis, e1);
  // The contact point's place around the ring.
  const Vec3 to = at.c + r * at.n - (pose.tip + r * pose.axis);
  const double here = std::atan2(dot(to, e2), dot(to, e1));
  const auto place = [&](double phi) {
    const Vec3 out = std::cos(phi) * e1 + std::sin(phi) * e2;
    const Vec3 along = cross(pose.axis, out);
    // Normal of the torus in the plane of out and axis, perpendicular to f.
    Vec3 normal = dot(out, at.f) * pose.axis - dot(pose.axis, at.f) * out;
    if (dot(normal, at.n) > 0) normal = -normal;
    static_cast<void>(along);
    const geom::Point3 q = pose.tip + r * pose.axis + ring * out + r * geom::unit(normal);
    return geom::Point2{dot(q - at.c, at.t()), dot(q - at.c, at.n)};
  };
  constexpr double kStep = 1e-3;
  const geom::Point2 a = place(here - kStep), b = place(here), c = place(here + kStep);
  const double twice_area = std::abs(cross(b - a, c - a));
  return distance(a, b) * distance(b, c) * distance(c, a) / (2 * twice_area);
}

TEST(ToolAngles, RadiusIsThatOfTheSilhouette) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> tilt(0.1, 1.2), yaw(-1.2, 1.2), share(0, 0.6);
  for (int i = 0; i < 2000; ++i) {
    model::Mill mill{model::MillKind::bull, 20, 20 * share(random), 30, {}};
    if (i % 2 == 0) mill = {model::MillKind::flat, 20, 0, 30, {}};
    const Angles angles{tilt(random), yaw(random)};
    const double rho = effective_radius(angles, mill);
    EXPECT_NEAR(silhouette_radius(angles, mill) / rho, 1, 1e-3) << i;
  }
}

TEST(ToolAngles, ContactStaysOnTheTool) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> tilt(1e-3, 1.5), yaw(-1.57, 1.57);
  for (int i = 0; i < 2000; ++i) {
    const CcPoint at = frame(random);
    const model::Mill mill = i % 2 == 0 ? model::Mill{model::MillKind::flat, 20, 0, 30, {}}
                                        : model::Mill{model::MillKind::bull, 20, 3, 30, {}};
    const Angles angles{tilt(random), yaw(random)};
    const cl::Pose p = pose(at, angles, mill);
    const double r = mill.corner_radius;
    // The centre of the corner's tube lies r above the contact point along n, at height r and radius R - r.
    const Vec3 to = at.c + r * at.n - p.tip;
    EXPECT_NEAR(dot(to, p.axis), r, 1e-12 * 100);
    EXPECT_NEAR(norm(to - dot(to, p.axis) * p.axis), mill.radius - r, 1e-12 * 100);
    const Angles back = angles_of(at, p.axis);
    EXPECT_NEAR(back.alpha, angles.alpha, 1e-12);
    EXPECT_NEAR(back.beta, angles.beta, 1e-9);
  }
}

TEST(ToolAngles, GradientAndContour) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> tilt(0.02, 1.2), yaw(-1.3, 1.3);
  const model::Mill mill{model::MillKind::bull, 12, 2, 30, {}};
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 1000; ++i) {
    const Angles a{tilt(random), yaw(random)};
    const double rho = effective_radius(a, mill);
    const geom::Vec2 g = radius_gradient(a, mill);
    const double ga = (effective_radius({a.alpha + kStep, a.beta}, mill) -
                       effective_radius({a.alpha - kStep, a.beta}, mill)) /
                      (2 * kStep);
    const double gb = (effective_radius({a.alpha, a.beta + kStep}, mill) -
                       effective_radius({a.alpha, a.beta - kStep}, mill)) /
                      (2 * kStep);
    EXPECT_NEAR(g.x / ga, 1, 1e-5);
    EXPECT_NEAR(g.y, gb, 1e-5 * std::abs(g.x));
    EXPECT_NEAR(contour_tilt(rho, a.beta, mill).value(), a.alpha, 1e-12);
  }
  EXPECT_FALSE(contour_tilt(1.9, 0.3, mill));
}

/// A point of the edge a little beside the contact against a surface of known curvature.
TEST(ToolAngles, LocalBoundIsWhereTheEdgeBeginsToCut) {
  const model::Mill mill{model::MillKind::flat, 20, 0, 30, {}};
  for (const double beta : {-0.8, 0.0, 0.4}) {
    CcPoint at{{}, {0, 0, 1}, {1, 0, 0}, 0.004, 0.001, 0.006};
    const double least = least_local_tilt(at, beta, mill);
    const auto gap = [&](double alpha) {
      const cl::Pose p = pose(at, {alpha, beta}, mill);
      const Vec3 to = at.c - p.tip, side = geom::unit(cross(p.axis, to));
      constexpr double kTurn = 1e-3;
      const geom::Point3 q = p.tip + std::cos(kTurn) * to + std::sin(kTurn) * mill.radius * side;
      return q.z - 0.5 * (at.k_ff * q.x * q.x + 2 * at.k_ft * q.x * q.y + at.k_tt * q.y * q.y);
    };
    EXPECT_GT(gap(least + 1e-3), 0);
    EXPECT_LT(gap(least - 1e-3), 0);
  }
}

}  // namespace
}  // namespace burin::orient
