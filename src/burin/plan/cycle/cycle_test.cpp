// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/cycle.h"

#include <gtest/gtest.h>

#include <chrono>

#include "burin/plan/cycle/cycle_cases.h"

namespace burin::cycle {
namespace {

using namespace cases;

PlanOptions options(Method method, double diameter, double scallop, Along along = Along::u) {
  PlanOptions o;
  o.method = method;
  o.along = along;
  o.tool_diameter = diameter;
  o.scallop = scallop;
  o.safety_z = 60;
  return o;
}

SurfacePlan planned(const geom::Composite& c, const PlanOptions& o, const std::vector<Trim>& trims = {}) {
  Diagnostics diagnostics;
  Result<SurfacePlan> p = plan(c, trims, {0, 0, 50}, o, diagnostics);
  EXPECT_TRUE(p.ok()) << (p.ok() ? "" : p.error().message);
  return p.ok() ? std::move(*p) : SurfacePlan{};
}

void expect_connected(const SurfacePlan& p, double safety) {
  for (std::size_t i = 0; i < p.motions.size(); ++i) {
    const Motion& m = p.motions[i];
    ASSERT_GE(m.path.nodes.size(), 2u);
    for (std::size_t k = 0; k + 1 < m.path.nodes.size(); ++k)
      ASSERT_LT(m.path.nodes[k].t, m.path.nodes[k + 1].t) << "motion " << i;
    if (i > 0) {
      EXPECT_LE(distance(p.motions[i - 1].path.end(), m.path.start()), 1e-9) << "motion " << i;
    }
    if (!m.uv.nodes.empty()) {
      ASSERT_EQ(m.uv.nodes.size(), m.path.nodes.size());
      for (std::size_t k = 0; k < m.uv.nodes.size(); ++k) ASSERT_EQ(m.uv.nodes[k].t, m.path.nodes[k].t);
    }
    if (m.kind == MotionKind::rapid) {
      EXPECT_GE(m.path.end().z, safety - 1e-9);
      const bool up = m.path.start().x == m.path.end().x && m.path.start().y == m.path.end().y;
      EXPECT_TRUE(up || m.path.start().z >= safety - 1e-9);
    }
  }
}

/// Largest height left over a surface, and the ridges between neighbouring passes seen on lines across.
struct Ridges {
  double lowest = 1e300, highest = 0;  ///< over inner pairs of passes
  double most = 0;                     ///< of everything
  int line = 0, top = 0, of = 0;       ///< where the lowest is
};
Ridges ridges(const NurbsSurface& s, const SurfacePlan& p, double radius, double sign, Along along, int lines,
              int samples) {
  const Remains remains(centres(p, radius, 0.02, cuts), radius);
  const auto u = s.domain(geom::Direction::u), v = s.domain(geom::Direction::v);
  Ridges r;
  for (int i = 1; i < lines; ++i) {
    std::vector<double> h;
    for (int k = 0; k <= samples; ++k) {
      double a = static_cast<double>(i) / lines, b = static_cast<double>(k) / samples;
      if (along == Along::v) std::swap(a, b);
      const double uu = u.lo + a * u.length(), vv = v.lo + b * v.length();
      const Vec3 n = sign * geom::normal(s, uu, vv);
      h.push_back(remains.height(geom::point(s, uu, vv), n));
    }
    std::vector<double> tops;
    for (std::size_t k = 1; k + 1 < h.size(); ++k) {
      r.most = std::max(r.most, h[k]);
      if (h[k] > h[k - 1] && h[k] >= h[k + 1] && h[k] > 1e-5) {
        // The top between the samples, where its flanks meet.
        double top = h[k];
        if (k >= 2 && k + 2 < h.size()) {
          const double left = h[k - 1] - h[k - 2], right = h[k + 1] - h[k + 2];
          // h[k - 1] + left x = h[k + 1] + right (2 - x)
          const double x = (h[k + 1] + 2 * right - h[k - 1]) / (left + right);
          top = std::max(top, h[k - 1] + left * x);
        }
        tops.push_back(top);
      }
    }
    // Without the last pair.
    for (std::size_t k = 0; k + 1 < tops.size(); ++k) {
      if (tops[k] < r.lowest) r.line = i, r.top = static_cast<int>(k), r.of = static_cast<int>(tops.size());
      r.lowest = std::min(r.lowest, tops[k]);
      r.highest = std::max(r.highest, tops[k]);
    }
  }
  return r;
}

TEST(Plane, StepOfAFlatSurfaceFollowsTheClosedForm) {
  const auto c = composite({plane({0, 0, 0}, {20, 0, 0}, {0, 10, 0})});
  const double radius = 3, s = 0.01;
  const double d = 2 * std::sqrt(radius * radius - (radius - s) * (radius - s));
  for (const Method method : {Method::iso_parametric, Method::iso_scallop}) {
    const SurfacePlan p = planned(c, options(method, 2 * radius, s));
    expect_connected(p, 60);
    EXPECT_EQ(p.paths, static_cast<std::size_t>(std::ceil(10 / (d * 0.9965))) + 1);
    EXPECT_EQ(p.lifted, 0u);
    for (const PassFigures& f : p.figures) {
      EXPECT_LE(f.scallop_max, s);
      if (!f.last) {
        EXPECT_GE(f.scallop_min, 0.97 * s);
      }
      EXPECT_LE(f.side_step_max, d);
    }
    EXPECT_NEAR(p.cut_mm, 20.0 * static_cast<double>(p.paths), 1e-6);
    EXPECT_NEAR(p.motions[3].path.start().z, 0, 1e-9);
  }
}

TEST(Plane, TiltedTipIsOffsetAlongTheNormal) {
  const double a = 0.5;  // rad, about y
  const auto c = composite({plane({0, 0, 0}, {20 * std::cos(a), 0, 20 * std::sin(a)}, {0, 10, 0})});
  PlanOptions o = options(Method::iso_parametric, 6, 0.01);
  o.stock = 0.3;
  const SurfacePlan p = planned(c, o);
  const Vec3 n{-std::sin(a), 0, std::cos(a)};
  for (const Motion& m : p.motions) {
    if (!cuts(m)) continue;
    for (const auto& node : m.path.nodes) {
      const Point3 centre{node.p.x, node.p.y, node.p.z + 3};
      EXPECT_NEAR(dot(centre - Point3{}, n), 3.3, 1e-9);
    }
  }
}

TEST(Cylinder, StepAlongAndAcross) {
  // Convex, radius 20: cut across (paths along y, step along the arc) the step angle follows from the circle
  // of the centres; along the arc the ruling is straight and the step that of a plane.
  const double big = 20, radius = 3, s = 0.01;
  const NurbsSurface cyl = cylinder({0, 0, 0}, big, geom::radians(60), geom::radians(120), 10);
  const auto c = composite({cyl});
  const SurfacePlan across = planned(c, options(Method::iso_scallop, 6, s, Along::v));
  const double centre = big + radius;
  // Cusp at big + s from the axis: triangle with sides centre, radius, big + s.
  const auto half_angle = [&](double h) {
    const double x = big + h;
    return std::acos((centre * centre + x * x - radius * radius) / (2 * centre * x));
  };
  for (const PassFigures& f : across.figures) {
    EXPECT_LE(f.scallop_max, s);
    if (f.last) continue;
    EXPECT_GE(f.scallop_min, 0.98 * s);
    EXPECT_NEAR(f.side_step_max, 2 * big * half_angle(f.scallop_max), 2e-5);
  }
  const SurfacePlan along = planned(c, options(Method::iso_parametric, 6, s, Along::u));
  for (const PassFigures& f : along.figures) EXPECT_LE(f.scallop_max, s);
}

TEST(Path, IsTheExactToolPathWithinPathMm) {
  const NurbsSurface s = hills(40, 30, 4, 6);
  PlanOptions o = options(Method::iso_parametric, 5, 0.02);
  const SurfacePlan p = planned(composite({s}), o);
  EXPECT_EQ(p.lifted, 0u);
  for (const Motion& m : p.motions) {
    if (!cuts(m)) continue;
    for (std::size_t i = 0; i + 1 < m.path.nodes.size(); ++i)
      for (const double x : {0.0, 0.1, 0.3, 0.5, 0.62, 0.9}) {
        const Point3 uv = evaluate_piece(m.uv, i, x).p;
        const Point3 q = geom::point(s, uv.x, uv.y);
        const Vec3 n = geom::normal(s, uv.x, uv.y);
        const Point3 tip{q.x + 2.5 * n.x, q.y + 2.5 * n.y, q.z + 2.5 * n.z - 2.5};
        EXPECT_LE(distance(evaluate_piece(m.path, i, x).p, tip), 2e-6);
      }
  }
}

TEST(Scallop, OfI1NeverAboveAndOfI2WithinTwoPercent) {
  const NurbsSurface s = hills(24, 18, 3, 6);
  const double radius = 2.5, scallop = 0.02;
  for (const Along along : {Along::u, Along::v}) {
    const SurfacePlan one = planned(composite({s}), options(Method::iso_parametric, 5, scallop, along));
    const Ridges r1 = ridges(s, one, radius, 1, along, 5, 5000);
    EXPECT_LE(r1.most, scallop * 1.0005);
    EXPECT_GE(r1.highest, scallop * 0.9);
    const SurfacePlan two = planned(composite({s}), options(Method::iso_scallop, 5, scallop, along));
    const Ridges r2 = ridges(s, two, radius, 1, along, 5, 5000);
    EXPECT_LE(r2.most, scallop * 1.002);
    EXPECT_GE(r2.lowest, scallop * 0.98) << r2.line << ": " << r2.top << " of " << r2.of;
    EXPECT_LE(two.cut_mm, one.cut_mm * 1.001);
  }
}

TEST(Concave, CylinderSharperThanTheBallIsLiftedToTheDropCutterHeight) {
  // A valley of radius 2 along y and a ball of radius 3: it rests on the two upper edges.
  const double valley = 2, radius = 3;
  const NurbsSurface s = cylinder({0, 0, 0}, valley, geom::radians(-150), geom::radians(-30), 10);
  PlanOptions o = options(Method::iso_parametric, 6, 0.02, Along::v);
  o.side_step = 0.3;
  const SurfacePlan p = planned(composite({s}), o);
  EXPECT_GT(p.lifted, 0u);
  const double edge_x = valley * std::cos(geom::radians(30)), edge_z = -valley * std::sin(geom::radians(30));
  for (const Motion& m : p.motions) {
    if (!cuts(m)) continue;
    for (const auto& node : m.path.nodes) {
      const double away = std::abs(node.p.x) + edge_x;  // to the farther edge; the nearer one counts
      const double near = edge_x - std::abs(node.p.x);
      const double z = edge_z + std::sqrt(radius * radius - near * near) - radius;
      EXPECT_GE(node.p.z, z - 0.01) << away;
      if (node.p.y > 1 && node.p.y < 9) {
        EXPECT_NEAR(node.p.z, z, 0.01);
      }
    }
  }
  EXPECT_LE(deepest(s, centres(p, radius, 0.3, cuts), radius, 60), 0.011);
}

TEST(Concave, PathsAcrossAValleySharperThanTheBallDoNotRunBackwards) {
  const NurbsSurface s = cylinder({0, 0, 0}, 2, geom::radians(-150), geom::radians(-30), 10);
  for (const Method method : {Method::iso_parametric, Method::iso_scallop}) {
    PlanOptions o = options(method, 6, 0.02, Along::u);
    o.side_step = 0.5;
    const SurfacePlan p = planned(composite({s}), o);
    expect_connected(p, 60);
    EXPECT_LE(p.paths, 30u);
    EXPECT_EQ(p.lifted, p.paths);
    EXPECT_LE(deepest(s, centres(p, 3, 0.3, cuts), 3, 60), 0.011);
    // The ball fits between the edges only near the middle: no path is longer than the valley is wide.
    EXPECT_LE(p.cut_mm, 4.0 * static_cast<double>(p.paths));
  }
}

TEST(Gouge, StepBetweenTwoSurfaces) {
  // A floor and a block's top 2 mm above it: near the edge the ball is lifted off the floor.
  const NurbsSurface floor = plane({0, 0, 0}, {10, 0, 0}, {0, 6, 0});
  const NurbsSurface top = plane({10, 0, 2}, {10, 0, 0}, {0, 6, 0});
  const SurfacePlan p = planned(composite({floor, top}), options(Method::iso_parametric, 6, 0.05, Along::u));
  expect_connected(p, 60);
  EXPECT_GT(p.lifted, 0u);
  const auto balls = centres(p, 3, 0.02, [](const Motion& m) { return m.surface >= 0; });
  double most = 0;
  for (const Point3 c : balls) {
    const double across = std::max(0.0, 10 - c.x);
    if (across < 3) most = std::max(most, 2 - (c.z - std::sqrt(9 - across * across)));
    EXPECT_GE(c.z, 3 - 0.0101);
  }
  EXPECT_LE(most, 0.03);
}

TEST(Trim, RegionIsCoveredAndNotLeft) {
  const NurbsSurface s = plane({0, 0, 0}, {20, 0, 0}, {0, 20, 0});
  std::vector<Trim> trims(2);
  for (int i = 0; i < 64; ++i) {
    const double a = 2 * geom::kPi * i / 64;
    trims[0].points.push_back({0.5 + 0.45 * std::cos(a), 0.5 + 0.45 * std::sin(a)});
    trims[1].points.push_back({0.5 + 0.15 * std::cos(a), 0.5 + 0.15 * std::sin(a)});
  }
  PlanOptions o = options(Method::iso_scallop, 2, 0.02);
  const SurfacePlan p = planned(composite({s}), o, trims);
  expect_connected(p, 60);
  const auto balls = centres(p, 1, 0.05, cuts);
  for (const Point3 c : balls) {
    const double r = std::hypot(c.x - 10, c.y - 10);
    EXPECT_LE(r, 9 + 1e-6);
    EXPECT_GE(r, 3 * std::cos(geom::kPi / 64) - 1e-6);
  }
  const Remains remains(balls, 1);
  double most = 0;
  for (int i = 0; i <= 100; ++i)
    for (int j = 0; j <= 100; ++j) {
      const double x = 0.2 * i, y = 0.2 * j, r = std::hypot(x - 10, y - 10);
      if (r > 8.9 || r < 3.05) continue;
      most = std::max(most, remains.height({x, y, 0}, {0, 0, 1}));
    }
  EXPECT_LE(most, 4.2 * 0.02);
  // Few retracts: the ring falls into four cells at most.
  std::size_t plunges = 0;
  for (const Motion& m : p.motions) plunges += m.kind == MotionKind::plunge;
  EXPECT_LE(plunges, 4u);
}

TEST(Pole, BallTopIsCutWithoutSingularities) {
  const NurbsSurface s = ball_part({0, 0, 0}, 10, geom::radians(30), geom::radians(90));
  for (const Along along : {Along::u, Along::v})
    for (const Method method : {Method::iso_parametric, Method::iso_scallop}) {
      const SurfacePlan p = planned(composite({s}), options(method, 4, 0.02, along));
      expect_connected(p, 60);
      for (const Motion& m : p.motions) {
        if (!cuts(m)) continue;
        for (const auto& n : m.path.nodes) {
          ASSERT_TRUE(std::isfinite(n.d1.x + n.d2.y + n.p.z));
          EXPECT_NEAR(norm(Point3{n.p.x, n.p.y, n.p.z + 2} - Point3{}), 12, 1e-5);
        }
      }
      const Remains remains(centres(p, 2, 0.02, cuts), 2);
      double most = 0;
      for (int i = 0; i <= 60; ++i)
        for (int j = 0; j <= 60; ++j) {
          const Vec3 n = geom::normal(s, i / 60.0, j / 60.0);
          most = std::max(most, remains.height(geom::point(s, i / 60.0, j / 60.0), n));
        }
      EXPECT_LE(most, 0.02 * 1.01) << "along " << (along == Along::u ? "u" : "v");
    }
}

TEST(Approach, NeverBelowTheSafetyHeightButOverThePlace) {
  const Point3 to{40, 5, 20};
  for (const Point3 from : {Point3{0, 0, -3}, Point3{0, 0, 20}, Point3{0, 0, 50}, Point3{40, 5, 7}, to}) {
    const std::vector<Motion> way = approach(from, to, 20);
    Point3 at = from;
    for (const Motion& m : way) {
      EXPECT_EQ(m.kind, MotionKind::rapid);
      EXPECT_EQ(m.path.start(), at);
      EXPECT_NE(m.path.end(), at);
      const bool across = m.path.end().x != at.x || m.path.end().y != at.y;
      if (across) {
        EXPECT_EQ(at.z, std::max(from.z, 20.0));
      }
      at = m.path.end();
    }
    EXPECT_EQ(at, to);
  }
}

TEST(Plan, IsDeterministic) {
  const auto c = composite({hills(20, 20, 3, 7)});
  const PlanOptions o = options(Method::iso_scallop, 4, 0.02, Along::automatic);
  const SurfacePlan a = planned(c, o), b = planned(c, o);
  ASSERT_EQ(a.motions.size(), b.motions.size());
  for (std::size_t i = 0; i < a.motions.size(); ++i)
    EXPECT_EQ(a.motions[i].path.nodes, b.motions[i].path.nodes);
}

// Balls sharper than the hills: long lifted stretches, so that the work is split.
TEST(Plan, DoesNotDependOnTheNumberOfThreads) {
  const auto c = composite({hills(20, 20, 6, 7), plane({0, 0, -2}, {30, 0, 0}, {0, 30, 0})});
  for (const Method method : {Method::iso_parametric, Method::iso_scallop}) {
    PlanOptions o = options(method, 8, 0.05, Along::automatic);
    const SurfacePlan one = planned(c, o);
    EXPECT_GT(one.lifted, 0u);
    for (const unsigned threads : {2U, 5U}) {
      o.threads = threads;
      const SurfacePlan more = planned(c, o);
      EXPECT_EQ(one.gouge_max_mm, more.gouge_max_mm);
      ASSERT_EQ(one.motions.size(), more.motions.size());
      for (std::size_t i = 0; i < one.motions.size(); ++i)
        EXPECT_EQ(one.motions[i].path.nodes, more.motions[i].path.nodes);
    }
  }
}

// A fan: rays that crowd at the inner edge are a poor way to run along, and are not even planned; the way
// that is taken is the shorter of the two all the same.
TEST(Plan, AutomaticDirectionIsTheShorterOne) {
  for (const geom::Composite& c : {composite({cylinder({0, 0, 0}, 10, 0.3, 2.8, 40)}),
                                   composite({hills(40, 15, 2, 7)}), composite({hills(15, 40, 2, 7)})}) {
    const auto total = [&](Along along) {
      const SurfacePlan p = planned(c, options(Method::iso_parametric, 6, 0.02, along));
      double plunges = 0;
      for (const Motion& m : p.motions)
        if (m.kind == MotionKind::plunge) plunges += geom::length(m.path);
      return p.cut_mm + p.link_mm - plunges;
    };
    EXPECT_NEAR(total(Along::automatic), std::min(total(Along::u), total(Along::v)), 1e-9);
  }
}

// Half a million paths are not planned before they are refused.
TEST(Plan, TooMuchIsRefusedAtOnce) {
  const auto c = composite({hills(100, 100, 5, 7)});
  Diagnostics d;
  for (const Method method : {Method::iso_parametric, Method::iso_scallop}) {
    const auto begin = std::chrono::steady_clock::now();
    const auto r = plan(c, {}, {0, 0, 50}, options(method, 6, 1e-9, Along::automatic), d);
    ASSERT_FALSE(r.ok());
    EXPECT_EQ(r.error().code, ErrorCode::range);
    EXPECT_NE(r.error().message.find("paths"), std::string::npos) << r.error().message;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  }
}

TEST(Plan, RefusesWhatCannotBe) {
  const auto c = composite({plane({0, 0, 0}, {10, 0, 0}, {0, 10, 0})});
  Diagnostics d;
  const auto message = [&](const PlanOptions& o, const geom::Composite& what) {
    const auto r = plan(what, {}, {0, 0, 50}, o, d);
    return r.ok() ? std::string() : r.error().message;
  };
  PlanOptions good = options(Method::iso_parametric, 6, 0.01);
  EXPECT_EQ(message(good, c), "");
  PlanOptions o = good;
  o.tool_diameter = 0;
  EXPECT_NE(message(o, c).find("diameter"), std::string::npos);
  o = good;
  o.scallop = -1;
  EXPECT_NE(message(o, c).find("scallop"), std::string::npos);
  o = good;
  o.scallop = 3;
  EXPECT_NE(message(o, c).find("scallop"), std::string::npos);
  o = good;
  o.safety_z = -1;
  EXPECT_NE(message(o, c).find("safety height"), std::string::npos);
  o = good;
  o.side_step = 1e-9;
  EXPECT_NE(message(o, c).find("paths"), std::string::npos);
  EXPECT_NE(message(good, composite({plane({0, 0, 0}, {10, 0, 0}, {0, 0, 10})})).find("up"),
            std::string::npos);
  EXPECT_NE(message(good, {}).find("no surface"), std::string::npos);
}

}  // namespace
}  // namespace burin::cycle
