// SPDX-License-Identifier: Apache-2.0
// For tests: a machined cover made up without the planner. 3 x 3 bicubic patches, joined by hand to one
// surface, a zigzag of a ball over it, and the same again beside it, with setpoints of which it is known what
// each is.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "burin/view/cycle_html.h"
#include "burin/view/cycle_track.h"

namespace burin::view::sample {

inline constexpr double kPatch = 30, kSize = 3 * kPatch, kRadius = 3, kSafety = 40, kPeriod = 0.001;
inline constexpr double kFeed = 1200, kRapid = 6000, kAccel = 3000;  // mm/min, mm/min, mm/s2
inline constexpr double kBump = 0.4;                                 // how far some paths are lifted, mm

inline double height(double x, double y) {
  return 14 + 6 * std::cos((x - 45) / 30) * std::cos((y - 40) / 36) + 0.02 * x;
}

/// Control values of the cubic through f at 0, 1/3, 2/3, 1.
inline void to_bezier(double* f, std::size_t stride) {
  const double a = f[0], b = f[stride], c = f[2 * stride], d = f[3 * stride];
  f[stride] = (-5 * a + 18 * b - 9 * c + 2 * d) / 6;
  f[2 * stride] = (2 * a - 9 * b + 18 * c - 5 * d) / 6;
}

inline geom::NurbsSurface patch(int column, int row) {
  double z[16];
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t i = 0; i < 4; ++i)
      z[i + 4 * j] =
          height(kPatch * (column + static_cast<double>(i) / 3), kPatch * (row + static_cast<double>(j) / 3));
  }
  for (std::size_t j = 0; j < 4; ++j) to_bezier(z + 4 * j, 1);
  for (std::size_t i = 0; i < 4; ++i) to_bezier(z + i, 4);
  geom::NurbsSurface s{3, 3, 4, 4, {0, 0, 0, 0, 1, 1, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}, {}};
  for (std::size_t k = 0; k < 16; ++k) {
    s.points.push_back(geom::homogeneous({kPatch * (column + static_cast<double>(k % 4) / 3),
                                          kPatch * (row + static_cast<double>(k / 4) / 3), z[k]},
                                         1));
  }
  return s;
}

inline geom::Composite join_by_hand(const std::vector<geom::NurbsSurface>& patches) {
  geom::JoinedSurface joined;
  geom::NurbsSurface& s = joined.surface;
  s.degree_u = s.degree_v = 3;
  s.count_u = s.count_v = 10;
  s.knots_u = s.knots_v = {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3};
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 10; ++i) {
      const int pu = std::min(i / 3, 2), pv = std::min(j / 3, 2);
      s.points.push_back(patches[static_cast<std::size_t>(pu + 3 * pv)].at(i - 3 * pu, j - 3 * pv));
    }
  }
  for (std::size_t k = 0; k < 9; ++k) {
    const double u = static_cast<double>(k % 3), v = static_cast<double>(k / 3);
    joined.members.push_back({k, {u, u + 1}, {v, v + 1}, {-u, 1, 0}, {-v, 0, 1}});
  }
  joined.joints = {{geom::Direction::u, 1, 2e-5, geom::Continuity::g1},
                   {geom::Direction::u, 2, 0, geom::Continuity::g2},
                   {geom::Direction::v, 1, 0, geom::Continuity::g0},
                   {geom::Direction::v, 2, 1e-6, geom::Continuity::g1}};
  joined.deviation_mm = 1e-5;
  geom::Composite composite;
  composite.surfaces.push_back(std::move(joined));
  composite.report.gap_max_mm = 2e-5;
  composite.report.unjoined.push_back({0, 4, "only a corner is shared", 0});
  return composite;
}

inline geom::Point3 tip(double x, double y) {
  const double h = 1e-5;
  const geom::Vec3 n = geom::unit(geom::Vec3{-(height(x + h, y) - height(x - h, y)) / (2 * h),
                                             -(height(x, y + h) - height(x, y - h)) / (2 * h), 1});
  return geom::Point3{x, y, height(x, y)} + kRadius * n - kRadius * geom::Vec3{0, 0, 1};
}

inline Where at(const char* block) {
  Where where;
  where.entity = block;
  return where;
}

struct Cover {
  std::vector<geom::NurbsSurface> patches;
  geom::Composite composite;
  cycle::SurfacePlan plan, repeat;
  std::vector<servo::Setpoint> setpoints;
  std::vector<TrackKind> truth;  ///< of every setpoint
  Diagnostics diagnostics;
  int passes = 0;

  explicit Cover(int number_of_passes = 24, double nodes_every = 3) : passes(number_of_passes) {
    for (int k = 0; k < 9; ++k) patches.push_back(patch(k % 3, k / 3));
    composite = join_by_hand(patches);
    make_plan(nodes_every);
    repeat = plan;
    for (cycle::Motion& m : repeat.motions) {
      for (geom::QuinticNode& node : m.path.nodes) node.p = node.p + geom::Vec3{110, 0, 0};
    }
    geom::Point3 here{-10, -10, 60};
    here = move(here, {0, 0, 60}, kRapid, TrackKind::program);
    here = group(here, plan);
    here = move(here, {110, 0, 60}, kRapid, TrackKind::program);
    here = group(here, repeat);
    move(here, {-10, -10, 60}, kRapid, TrackKind::program);
    diagnostics.info("modal_g91", "N50 G91 is modal: N70 moves by 40 (G90 would move to 40)", at("N50"));
    diagnostics.add({Severity::left_out, "lifted", "path 8 </script><b>is lifted by 0.4 mm", at("N10"),
                     std::array{45.0, kSize * 8 / (passes - 1), height(45, kSize * 8 / (passes - 1))}});
  }

  CyclePicture picture() const {
    CyclePicture p;
    p.title = "cover <&> \"@DATA@\" \xff damaged";
    p.command_line = "burin cycle cover.nc --html cover.html </script><script>alert(1)</script>";
    for (int g = 0; g < 2; ++g) {
      CycleGroup group;
      group.patches = patches;
      for (int k = 0; k < 9; ++k) group.patch_names.push_back("N" + std::to_string(10 * (k + 1)));
      group.composite = &composite;
      group.plan = g ? &repeat : &plan;
      group.displacement = {110.0 * g, 0, 0};
      group.title = g ? "repeat, moved by X110" : "G106.2 I2 E1, N10 to N90";
      group.tool_diameter_mm = 2 * kRadius;
      p.groups.push_back(group);
    }
    p.setpoints = &setpoints;
    p.period_s = kPeriod;
    p.commanded_feed_mm_min = kFeed;
    p.scallop_mm = 0.01;
    p.accel_limit_mm_s2 = kAccel;
    p.diagnostics = &diagnostics;
    p.figures = {{"Program", "blocks", "9"}, {"Quality", "greatest scallop", "0.0098 mm"}};
    p.nc_text = "%\nO1 (</script>)\n";
    for (int k = 1; k <= 9; ++k)
      p.nc_text += "N" + std::to_string(10 * k) + " G06.23 U4 V4 D6. L0. F1200. S0.01\n";
    return p;
  }

 private:
  bool lifted(int pass) const { return pass >= passes / 3 && pass < passes / 3 + 3; }
  geom::Point3 cl(double x, int pass, bool lift) const {
    geom::Point3 p = tip(x, kSize * pass / (passes - 1));
    const double d = (x - 45) / 10;
    if (lift && std::abs(d) < 1) p.z += kBump * std::pow(1 - d * d, 3);
    return p;
  }

  void make_plan(double nodes_every) {
    const auto line = [&](cycle::MotionKind kind, geom::Point3 a, geom::Point3 b) {
      cycle::Motion m;
      m.kind = kind;
      m.path = geom::straight(a, b);
      plan.motions.push_back(m);
    };
    const geom::Point3 start{0, 0, 60}, first = cl(0, 0, false);
    line(cycle::MotionKind::rapid, start, {first.x, first.y, kSafety});
    line(cycle::MotionKind::plunge, {first.x, first.y, kSafety}, first);
    for (int pass = 0; pass < passes; ++pass) {
      plan.motions.push_back(cut(pass, nodes_every));
      const double s = static_cast<double>(pass) / passes;
      if (pass > 0) {
        plan.figures.push_back({0, pass, 0.0078 + 0.001 * s, 0.0092 + 0.0011 * s + (pass == 5 ? 0.002 : 0),
                                kSize / (passes - 1), pass + 1 == passes, false});
      }
      if (pass + 1 < passes) {
        const geom::Point3 a = plan.motions.back().path.end(), b = cl(pass % 2 ? 0 : kSize, pass + 1, false);
        line(cycle::MotionKind::link, a, b);
      }
    }
    const geom::Point3 end = plan.motions.back().path.end();
    line(cycle::MotionKind::rapid, end, {end.x, end.y, kSafety});
    line(cycle::MotionKind::rapid, {end.x, end.y, kSafety}, start);
    plan.paths = static_cast<std::size_t>(passes);
    plan.lifted = 3;
    plan.lift_max_mm = kBump;
    plan.cut_mm = 95.0 * passes;
    plan.link_mm = 90;
    plan.rapid_mm = 150;
  }

  cycle::Motion cut(int pass, double every) const {
    cycle::Motion m;
    m.surface = 0;
    m.pass = pass;
    m.lift_max = lifted(pass) ? kBump : 0;
    const int n = static_cast<int>(std::lround(kSize / every));
    const double y = kSize * pass / (passes - 1), side = pass % 2 ? -1 : 1, h = 1e-3;
    for (int i = 0; i <= n; ++i) {
      const double t = kSize * i / n, x = side > 0 ? t : kSize - t;
      const auto at = [&](double d) { return cl(x + side * d, pass, lifted(pass)); };
      const geom::Point3 p = at(0);
      m.path.nodes.push_back({t, p, (at(h) - at(-h)) / (2 * h), ((at(h) - p) + (at(-h) - p)) / (h * h)});
      m.uv.nodes.push_back({t, {x / kPatch, y / kPatch, 0}, {side / kPatch, 0, 0}, {}});
    }
    return m;
  }

  /// From rest to rest with constant acceleration along a table of points.
  void travel(const std::vector<geom::Point3>& points, const std::vector<geom::Point3>& uv, double feed,
              TrackKind kind, int surface, int pass) {
    std::vector<double> s{0};
    for (std::size_t i = 1; i < points.size(); ++i)
      s.push_back(s.back() + distance(points[i - 1], points[i]));
    const double v = std::min(feed / 60, std::sqrt(s.back() * kAccel)), ramp = v / kAccel;
    const double total = s.back() / v + ramp;
    std::size_t k = 1;
    const auto ticks = static_cast<int>(std::ceil(total / kPeriod));
    for (int i = 1; i <= ticks; ++i) {
      const double t = std::min(total, i * kPeriod), end = total - t;
      const double speed = std::min({t * kAccel, v, end * kAccel});
      const double at = t < ramp     ? 0.5 * kAccel * t * t
                        : end < ramp ? s.back() - 0.5 * kAccel * end * end
                                     : v * (t - 0.5 * ramp);
      while (k + 1 < s.size() && s[k] < at) ++k;
      const double f = s[k] > s[k - 1] ? (at - s[k - 1]) / (s[k] - s[k - 1]) : 0;
      const geom::Point3 p = lerp(points[k - 1], points[k], f);
      const double none = std::nan("");
      const geom::Point3 w = uv.empty() ? geom::Point3{none, none, 0} : lerp(uv[k - 1], uv[k], f);
      setpoints.push_back({kPeriod * static_cast<double>(setpoints.size()), p.x, p.y, p.z, 60 * speed, w.x,
                           w.y, surface, pass});
      truth.push_back(kind);
    }
  }

  geom::Point3 move(geom::Point3 from, geom::Point3 to, double feed, TrackKind kind) {
    if (setpoints.empty()) {
      const double none = std::nan("");
      setpoints.push_back({0, from.x, from.y, from.z, 0, none, none, -1, -1});
      truth.push_back(kind);
    }
    travel({from, to}, {}, feed, kind, -1, -1);
    return to;
  }

  geom::Point3 group(geom::Point3 here, const cycle::SurfacePlan& of) {
    for (const cycle::Motion& m : of.motions) {
      std::vector<geom::Point3> points, uv;
      const int per = m.pass >= 0 ? 40 : 1;
      for (std::size_t i = 0; i + 1 < m.path.nodes.size(); ++i) {
        for (int k = i ? 1 : 0; k <= per; ++k) {
          const double x = static_cast<double>(k) / per;
          points.push_back(geom::evaluate_piece(m.path, i, x).p);
          if (m.pass >= 0) uv.push_back(geom::evaluate_piece(m.uv, i, x).p);
        }
      }
      const bool rapid = m.kind == cycle::MotionKind::rapid;
      const TrackKind kind = rapid                                 ? TrackKind::rapid
                             : m.kind == cycle::MotionKind::plunge ? TrackKind::plunge
                             : m.kind == cycle::MotionKind::link   ? TrackKind::link
                                                                   : TrackKind::cut;
      travel(points, uv, rapid ? kRapid : kFeed, kind, m.surface, m.pass);
      here = points.back();
    }
    return here;
  }
};

}  // namespace burin::view::sample
