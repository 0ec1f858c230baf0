// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/strip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace burin::orient {
namespace {

using geom::Point3;
using geom::Vec3;

constexpr double kDegree = geom::kPi / 180;

/// How far a place is outside the cutting body, a convex function: the cylinder of R - r grown by r (a flat
/// end: no growing).
double outside(const model::Mill& mill, const cl::Pose& pose, Point3 q) {
  const Vec3 to = q - pose.tip;
  const double h = dot(to, pose.axis), across = norm(to - h * pose.axis), r = mill.corner_radius;
  const double a = across - (mill.radius - r), b = std::max(r - h, h - mill.length);
  return std::min(std::max(a, b), 0.0) + std::hypot(std::max(a, 0.0), std::max(b, 0.0)) - r;
}

/// The places that pass over one place of the surface while the tool moves on: as a curve in the tool's
/// frame.
using Passing = std::function<Point3(double way)>;

/// Least of outside() along the curve, by a scan and golden section.
double least(const model::Mill& mill, const cl::Pose& pose, const Passing& q, double reach) {
  constexpr int kScan = 60;
  double best = 1e300, at = 0;
  for (int i = 0; i <= kScan; ++i) {
    const double way = reach * (2.0 * i / kScan - 1), d = outside(mill, pose, q(way));
    if (d < best) best = d, at = way;
  }
  double lo = at - 2 * reach / kScan, hi = at + 2 * reach / kScan;
  for (int i = 0; i < 60; ++i) {
    const double a = lo + 0.382 * (hi - lo), b = hi - 0.382 * (hi - lo);
    if (outside(mill, pose, q(a)) < outside(mill, pose, q(b)))
      hi = b;
    else
      lo = a;
  }
  return std::min(best, outside(mill, pose, q(0.5 * (lo + hi))));
}

/// A surface that the feed moves along itself: revolution about an axis along t (k_ff), a profile circle
/// k_tt. c in the origin, f = x, t = y, n = z.
struct Bent {
  double k_tt = 0, k_ff = 0;
  Passing over(double along_t, double height) const {
    const double a = k_tt * along_t, s = k_tt == 0 ? along_t : std::sin(a) / k_tt;
    const double rise = k_tt == 0 ? 0 : 2 * std::pow(std::sin(0.5 * a), 2) / k_tt;
    const double y = s - height * std::sin(a), z = rise + height * std::cos(a);
    const double k = k_ff;
    return [=](double way) {
      if (k == 0) return Point3{way, y, z};
      const double radius = 1 / k - z;  // signed
      return Point3{radius * std::sin(k * way), y, 1 / k - radius * std::cos(k * way)};
    };
  }
};

/// The strip on one side by its definition: how far out something of the tool passes within the scallop over
/// the surface.
double by_sampling(const model::Mill& mill, const Angles& angles, const Bent& bent, double scallop, int side,
                   double guess) {
  const CcPoint at{{}, {0, 0, 1}, {1, 0, 0}};
  const cl::Pose pose = orient::pose(at, angles, mill);
  const auto cut = [&](double way) {
    for (const double share : {1.0, 0.7, 0.3, 0.02}) {
      if (least(mill, pose, bent.over(side * way, share * scallop), 2.5 * mill.radius) <= 1e-9) return true;
    }
    return false;
  };
  const double step = std::max(guess, 1e-3 * mill.radius) / 12;
  double lo = 0;
  while (cut(lo + step)) lo += step;
  double hi = lo + step;
  for (int i = 0; i < 34; ++i) (cut(0.5 * (lo + hi)) ? lo : hi) = 0.5 * (lo + hi);
  return lo;
}

struct Random {
  std::mt19937_64 engine{7};
  double operator()(double a, double b) { return a + (b - a) * (double(engine() >> 11) * 0x1p-53); }
};

model::Mill a_mill(Random& random, bool bull) {
  const double radius = random(10, 125);
  return {bull ? model::MillKind::bull : model::MillKind::flat,
          radius,
          bull ? random(0.02, 1) * radius : 0,
          2 * radius,
          {}};
}

CcPoint point_of(const Bent& bent) {
  CcPoint at{{}, {0, 0, 1}, {1, 0, 0}};
  at.k_ff = bent.k_ff, at.k_tt = bent.k_tt;
  return at;
}

TEST(Strip, StraightFeedAsTheSweptToolHasIt) {
  Random random;
  for (int i = 0; i < 120; ++i) {
    const model::Mill mill = a_mill(random, i % 2 == 1);
    const Angles angles{random(0.5, 30) * kDegree, random(-89, 89) * kDegree};
    Bent bent;
    // As concave as the silhouette allows, or convex.
    const double rho = effective_radius(angles, mill);
    if (i % 3 != 0) bent.k_tt = i % 3 == 1 ? random(0, 0.7) / rho : -random(0, 1) / mill.radius;
    const double scallop = std::pow(10, random(-3, 0));
    const Strip strip = strip_at(point_of(bent), angles, mill, scallop);
    // On a concave profile a turned ellipse may touch again beyond the strip; only its contact point's own
    // stretch counts, and the two agree where they mean the same.
    EXPECT_NEAR(by_sampling(mill, angles, bent, scallop, 1, strip.left), strip.left, 1e-5 * mill.radius)
        << i << " " << mill.radius << " " << mill.corner_radius << " " << angles.alpha / kDegree << " "
        << angles.beta / kDegree << " " << bent.k_tt * mill.radius << " " << scallop;
    EXPECT_NEAR(by_sampling(mill, angles, bent, scallop, -1, strip.right), strip.right, 1e-5 * mill.radius)
        << i << " " << mill.radius << " " << mill.corner_radius << " " << angles.alpha / kDegree << " "
        << angles.beta / kDegree << " " << bent.k_tt * mill.radius << " " << scallop;
  }
}

TEST(Strip, CurvedFeedAsTheToolThatTurnsWithTheSurface) {
  Random random;
  for (int i = 0; i < 80; ++i) {
    const model::Mill mill = a_mill(random, i % 2 == 1);
    const Angles angles{random(1.5, 20) * kDegree, random(-60, 60) * kDegree};
    const Bent bent{-random(0, 0.3) / mill.radius, -random(0, 0.3) / mill.radius};
    const double scallop = std::pow(10, random(-3, -1));
    const Strip strip = strip_at(point_of(bent), angles, mill, scallop);
    for (const int side : {1, -1}) {
      const double mine = side == 1 ? strip.left : strip.right;
      const double true_one = by_sampling(mill, angles, bent, scallop, side, mine);
      std::printf("%d %d %.4f %.4f %.4f  R %.1f r %.1f a %.1f b %.1f kt %.3f kf %.3f h %.4f\n", i, side, mine,
                  true_one, mine / true_one - 1, mill.radius, mill.corner_radius, angles.alpha / kDegree,
                  angles.beta / kDegree, bent.k_tt * mill.radius, bent.k_ff * mill.radius, scallop);
    }
  }
}

}  // namespace
}  // namespace burin::orient
