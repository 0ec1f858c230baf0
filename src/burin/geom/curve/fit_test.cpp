// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "burin/geom/curve/fit_internal.h"
#include "burin/geom/curve/letter_k.h"

namespace burin::geom {
namespace {

#ifdef NDEBUG
constexpr int kManySamples = 100'000;
#else
constexpr int kManySamples = 2'000;  // unoptimized code is some thirty times slower
#endif

Nurbs2 bezier(std::vector<Point2> points, std::vector<double> weights = {}) {
  const auto count = points.size();
  Nurbs2 curve{static_cast<int>(count) - 1, std::vector<double>(count, 0.0), std::move(points),
               std::move(weights)};
  curve.knots.insert(curve.knots.end(), count, 1.0);
  if (curve.weights.empty()) curve.weights.assign(count, 1.0);
  return curve;
}

Nurbs2 scaled(Nurbs2 curve, double factor) {
  for (Point2& p : curve.points) p = {factor * p.x, factor * p.y};
  return curve;
}

/// A cubic that bends one way or changes its mind, without hairpins: what drawings are made of.
Nurbs2 ordinary_cubic(std::mt19937& random) {
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  return bezier({{0, 0},
                 {uniform(2, 5), uniform(-4, 4)},
                 {uniform(6, 9), uniform(-4, 4)},
                 {uniform(10, 12), uniform(-3, 3)}});
}

/// Any control points: hairpins, loops, near cusps.
Nurbs2 wild_bezier(std::mt19937& random, int degree, bool rational) {
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  std::vector<Point2> points;
  std::vector<double> weights;
  for (int i = 0; i <= degree; ++i) {
    points.push_back({uniform(-10, 10), uniform(-10, 10)});
    weights.push_back(rational ? std::exp(uniform(-1.5, 1.5)) : 1.0);
  }
  return bezier(points, weights);
}

/// The concentric arcs; those that vanish come out on the other side of their centre, as the certificate has
/// them.
std::vector<Segment> concentric(const std::vector<Segment>& segments, double d) {
  std::vector<Segment> result;
  for (Segment s : segments) {
    if (s.is_line()) {
      const Vec2 shift = d * right(unit(s.b - s.a));
      result.push_back(make_line(s.a + shift, s.b + shift));
      continue;
    }
    const double ratio = (s.radius + d) / s.radius;
    if (ratio == 0) continue;
    s.a = s.center + ratio * (s.a - s.center);
    s.b = s.center + ratio * (s.b - s.center);
    s.radius *= std::abs(ratio);
    result.push_back(s);
  }
  return result;
}

/// Distance to a chain for points that come in order: looks around the last hit first, everywhere if that is
/// far.
class ChainDistance {
 public:
  explicit ChainDistance(const std::vector<Segment>& segments) : segments_(segments) {}
  double operator()(Point2 p, double expected) {
    const std::size_t from = last_ > 1 ? last_ - 1 : 0;
    double best = scan(p, from, std::min(segments_.size(), last_ + 2));
    if (best > 0.5 * expected) best = std::min(best, scan(p, 0, segments_.size()));
    return best;
  }

 private:
  double scan(Point2 p, std::size_t from, std::size_t to) {
    double best = 1e300;
    for (std::size_t i = from; i < to; ++i) {
      const double d = nearest_on(segments_[i], p).distance;
      if (d < best) {
        best = d;
        last_ = i;
      }
    }
    return best;
  }
  const std::vector<Segment>& segments_;
  std::size_t last_ = 0;
};

/// Largest distance of the curve from the arcs, and of its regular offset from the offset arcs, at dense
/// samples.
double sampled_deviation(const Curve2& curve, const FitResult& fit, double d, int samples) {
  const std::vector<Segment> offset = concentric(fit.segments, d);
  ChainDistance to_fit(fit.segments), to_offset(offset);
  double worst = 0;
  for (int i = 0; i <= samples; ++i) {
    const Derivatives2 c = derivatives_at(curve, static_cast<double>(i) / samples);
    worst = std::max(worst, to_fit(c.point, fit.max_deviation_mm));
    const double speed = norm(c.d1);
    if (d == 0 || speed < 1e-6) continue;
    const double kappa = cross(c.d1, c.d2) / (speed * speed * speed);
    if (1 + d * kappa <= 1e-3) continue;
    worst = std::max(worst, to_offset(c.point + d * right(c.d1 / speed), fit.max_deviation_mm));
  }
  return worst;
}

void expect_well_formed(const Curve2& curve, const FitResult& fit, const FitOptions& options) {
  ASSERT_FALSE(fit.segments.empty());
  EXPECT_EQ(fit.segments.front().a, start_point(curve));
  EXPECT_EQ(fit.segments.back().b, end_point(curve));
  EXPECT_LE(fit.max_deviation_mm, options.tolerance_mm);
  ASSERT_FALSE(fit.piece_starts.empty());
  EXPECT_EQ(fit.piece_starts.front(), 0u);
  std::size_t piece = 1;
  for (std::size_t i = 0; i < fit.segments.size(); ++i) {
    const Segment& s = fit.segments[i];
    if (!s.is_line()) {
      const double allowed = kArcConsistency * (std::abs(s.radius) + 1);
      EXPECT_NEAR(distance(s.a, s.center), std::abs(s.radius), allowed);
      EXPECT_NEAR(distance(s.b, s.center), std::abs(s.radius), allowed);
    }
    if (i == 0) continue;
    EXPECT_EQ(fit.segments[i - 1].b, s.a);
    if (piece < fit.piece_starts.size() && fit.piece_starts[piece] == i) {
      ++piece;
      continue;
    }
    const Vec2 before = end_tangent(fit.segments[i - 1]), after = start_tangent(s);
    // Ends are rounded to about 1e-15 of the coordinates, which turns the shortest arcs.
    const double shortest = std::min(length_of(s), length_of(fit.segments[i - 1]));
    const double allowed = 1e-6 + 1e-14 * (1 + norm(s.a - Point2{})) / shortest;
    EXPECT_LT(std::abs(std::atan2(cross(before, after), dot(before, after))), allowed)
        << "joint " << i << ", shortest " << shortest;
  }
  EXPECT_EQ(piece, fit.piece_starts.size());
}

std::size_t segments_of_k(FitMethod method, double tolerance, bool corners_free) {
  const std::vector<Nurbs2> k = letter_k();
  const auto turn = [&](std::size_t at) {
    const Vec2 a = tangent_at(Curve2(k[(at + k.size() - 1) % k.size()]), 1),
               b = tangent_at(Curve2(k[at % k.size()]), 0);
    return std::abs(std::atan2(cross(a, b), dot(a, b)));
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < k.size(); ++i) {
    FitOptions options{method, tolerance, 0.28, 1e-3};
    if (corners_free) {
      options.start_freedom_rad = corner_freedom(turn(i));
      options.end_freedom_rad = corner_freedom(turn(i + 1));
    }
    const auto fit = fit_arc_spline(k[i], options);
    EXPECT_TRUE(fit.ok());
    if (!fit.ok()) continue;
    expect_well_formed(k[i], *fit, options);
    count += fit->segments.size();
  }
  return count;
}

TEST(FitLetterK, NeedsFewArcs) {
  EXPECT_LE(segments_of_k(FitMethod::minimal, 0.1, false), 48u);
  EXPECT_LE(segments_of_k(FitMethod::minimal, 0.01, false), 76u);
  EXPECT_LE(segments_of_k(FitMethod::minimal, 0.001, false), 160u);
}

TEST(FitLetterK, FreeDirectionsAtCornersSaveArcs) {
  EXPECT_LE(segments_of_k(FitMethod::minimal, 0.1, true), 40u);
  EXPECT_LE(segments_of_k(FitMethod::minimal, 0.01, true), 70u);
  EXPECT_LE(segments_of_k(FitMethod::minimal, 0.001, true), 150u);
}

TEST(FitLetterK, MinimalBeatsBisection) {
  for (const double tolerance : {0.1, 0.01, 0.001}) {
    EXPECT_LT(3 * segments_of_k(FitMethod::minimal, tolerance, false),
              2.2 * static_cast<double>(segments_of_k(FitMethod::bisect, tolerance, false)))
        << tolerance;
  }
}

TEST(FitLetterK, BoundHoldsAndIsTightAgainstDenseSampling) {
  for (const FitMethod method : {FitMethod::minimal, FitMethod::bisect}) {
    for (const Nurbs2& curve : letter_k()) {
      const FitOptions options{method, 0.01, 0.28, 1e-3, 0.05, 0.05};
      const auto fit = fit_arc_spline(curve, options);
      ASSERT_TRUE(fit.ok());
      const double sampled = sampled_deviation(curve, *fit, options.offset_mm, kManySamples);
      EXPECT_LE(sampled, fit->max_deviation_mm + 1e-12);
      EXPECT_LE(fit->max_deviation_mm, 1.1 * sampled + 1e-9);
    }
  }
}

TEST(FitLetterK, DrawingAndHeaderAgree) {
  std::ifstream file(std::string(BURIN_SOURCE_DIR) + "/examples/k/k.dxf");
  ASSERT_TRUE(file.good());
  std::vector<Nurbs2> drawn;
  std::string code, value;
  while (std::getline(file, code) && std::getline(file, value)) {
    const int number = std::stoi(code);
    if (number == 0 && value == "SPLINE") drawn.push_back({});
    if (drawn.empty()) continue;
    if (number == 71) drawn.back().degree = std::stoi(value);
    if (number == 40) drawn.back().knots.push_back(std::stod(value));
    if (number == 10) drawn.back().points.push_back({std::stod(value), 0});
    if (number == 20) drawn.back().points.back().y = std::stod(value);
  }
  for (Nurbs2& curve : drawn) curve.weights.assign(curve.points.size(), 1.0);
  EXPECT_EQ(drawn, letter_k());
  EXPECT_EQ(drawn.size(), 13u);
  Box2 box;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    box.add(bounds(drawn[i]));
    EXPECT_EQ(drawn[i].points.back(), drawn[(i + 1) % drawn.size()].points.front());
  }
  EXPECT_LE(box.width(), 41);
  EXPECT_LE(box.height(), 42);
}

TEST(Fit, BoundHoldsAgainstDenseSamplingOnRandomCurves) {
  std::mt19937 random(11);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (int i = 0; i < 40; ++i) {
    const Curve2 curve = i % 2 == 0 ? ordinary_cubic(random) : wild_bezier(random, 2 + i % 5, i % 4 == 1);
    const FitMethod method = i % 3 == 0 ? FitMethod::bisect : FitMethod::minimal;
    const FitOptions options{method, std::pow(10, uniform(-4, 0)), i % 5 == 0 ? 0 : uniform(-0.6, 0.6), 1e-3};
    const auto fit = fit_arc_spline(curve, options);
    ASSERT_TRUE(fit.ok()) << i;
    expect_well_formed(curve, *fit, options);
    const int samples = i == 0 ? 100'000 : kManySamples;
    EXPECT_LE(sampled_deviation(curve, *fit, options.offset_mm, samples), fit->max_deviation_mm + 1e-11)
        << i << " tolerance " << options.tolerance_mm << " offset " << options.offset_mm;
  }
}

TEST(Fit, ArcsStayNearTheCurveToo) {
  std::mt19937 random(12);
  for (int i = 0; i < 10; ++i) {
    const Nurbs2 curve = ordinary_cubic(random);
    const FitOptions options{FitMethod::minimal, 0.01, 0.3, 1e-3};
    const auto fit = fit_arc_spline(curve, options);
    ASSERT_TRUE(fit.ok());
    std::vector<Segment> polyline;
    constexpr int kSides = 2000;  // 0.006 mm each: a chord's height is far below the tolerance
    for (int k = 0; k < kSides; ++k) {
      polyline.push_back(make_line(point_at(curve, k / 2000.0), point_at(curve, (k + 1) / 2000.0)));
    }
    ChainDistance to_curve(polyline);
    for (const Segment& s : fit->segments) {
      for (int k = 0; k <= 50; ++k) {
        EXPECT_LE(to_curve(point_on(s, k / 50.0), options.tolerance_mm), fit->max_deviation_mm + 1e-5);
      }
    }
  }
}

TEST(Fit, OrdinaryCubicsNeedClearlyFewerArcsThanBisection) {
  std::mt19937 random(13);
  std::size_t minimal = 0, bisect = 0;
  for (int i = 0; i < 25; ++i) {
    const Nurbs2 curve = ordinary_cubic(random);
    const auto few = fit_arc_spline(curve, {FitMethod::minimal, 0.001, 0.2, 1e-3});
    const auto many = fit_arc_spline(curve, {FitMethod::bisect, 0.001, 0.2, 1e-3});
    ASSERT_TRUE(few.ok() && many.ok());
    EXPECT_LE(few->segments.size(), many->segments.size());
    minimal += few->segments.size();
    bisect += many->segments.size();
  }
  EXPECT_LT(1.7 * static_cast<double>(minimal), static_cast<double>(bisect));
}

TEST(Fit, IsTheSameEveryTimeAndInEveryScale) {
  std::mt19937 random(14);
  for (int i = 0; i < 10; ++i) {
    const Nurbs2 curve = ordinary_cubic(random);
    const auto once = fit_arc_spline(curve, {FitMethod::minimal, 0.01, 0.25, 1e-3});
    const auto again = fit_arc_spline(curve, {FitMethod::minimal, 0.01, 0.25, 1e-3});
    const auto large = fit_arc_spline(scaled(curve, 1024), {FitMethod::minimal, 10.24, 256, 1e-3});
    ASSERT_TRUE(once.ok() && again.ok() && large.ok());
    EXPECT_EQ(once->segments, again->segments);
    EXPECT_EQ(once->segments.size(), large->segments.size());
  }
}

TEST(Fit, LinesAndArcsComeBackUnchanged) {
  const auto line = fit_arc_spline(Line2{{1, 2}, {4, 6}}, {});
  ASSERT_TRUE(line.ok());
  ASSERT_EQ(line->segments.size(), 1u);
  EXPECT_EQ(line->segments[0], make_line({1, 2}, {4, 6}));
  EXPECT_EQ(line->max_deviation_mm, 0);

  const auto arc = fit_arc_spline(Arc2{{1, 1}, 2, 0.5, -1.5}, {});
  ASSERT_TRUE(arc.ok());
  ASSERT_EQ(arc->segments.size(), 1u);
  EXPECT_EQ(arc->segments[0].center, (Point2{1, 1}));
  EXPECT_NEAR(arc->segments[0].radius, -2, 1e-12);
  EXPECT_NEAR(sweep_of(arc->segments[0]), -1.5, 1e-12);

  const auto circle = fit_arc_spline(Arc2{{1, 1}, 2, 0.5, 2 * kPi}, {});
  ASSERT_TRUE(circle.ok());
  ASSERT_EQ(circle->segments.size(), 2u);
  EXPECT_EQ(circle->segments[0].a, circle->segments[1].b);
  EXPECT_NEAR(sweep_of(circle->segments[0]) + sweep_of(circle->segments[1]), 2 * kPi, 1e-9);
}

TEST(Fit, StraightSplineIsOneLine) {
  const auto fit =
      fit_arc_spline(bezier({{0, 0}, {1, 2}, {2, 4}, {5, 10}}), {FitMethod::minimal, 1e-6, 0.3, 1e-3});
  ASSERT_TRUE(fit.ok());
  ASSERT_EQ(fit->segments.size(), 1u);
  EXPECT_TRUE(fit->segments[0].is_line());
  EXPECT_LT(fit->max_deviation_mm, 1e-12);
}

TEST(Fit, RationalCircleIsOneArc) {
  const double w = std::sqrt(0.5);
  const auto fit =
      fit_arc_spline(bezier({{3, 0}, {3, 3}, {0, 3}}, {1, w, 1}), {FitMethod::minimal, 1e-6, 0.3, 1e-3});
  ASSERT_TRUE(fit.ok());
  ASSERT_EQ(fit->segments.size(), 1u);
  EXPECT_NEAR(fit->segments[0].radius, 3, 1e-9);
  EXPECT_LT(fit->max_deviation_mm, 1e-9);
}

TEST(Fit, EllipseWithinTolerance) {
  for (const double sweep : {1.0, -2.5, 2 * kPi}) {
    const EllipseArc2 ellipse{{1, 2}, {8, 0}, {0, 3}, 0.3, sweep};
    const FitOptions options{FitMethod::minimal, 0.002, 0.5, 1e-3};
    const auto fit = fit_arc_spline(ellipse, options);
    ASSERT_TRUE(fit.ok());
    expect_well_formed(ellipse, *fit, options);
    EXPECT_LE(sampled_deviation(ellipse, *fit, 0.5, 5000), fit->max_deviation_mm + 1e-11);
    EXPECT_LE(fit->segments.size(), 24u);
  }
}

TEST(Fit, CornersInsideTheCurveStayWhereTheyAre) {
  // Two quadratic arches with a full-multiplicity knot between them.
  const Nurbs2 curve{2, {0, 0, 0, 1, 1, 2, 2, 2}, {{0, 0}, {2, 3}, {4, 0}, {6, 3}, {8, 0}}, {1, 1, 1, 1, 1}};
  const FitOptions options{FitMethod::minimal, 0.01, 0, 1e-3};
  const auto fit = fit_arc_spline(curve, options);
  ASSERT_TRUE(fit.ok());
  expect_well_formed(curve, *fit, options);
  ASSERT_EQ(fit->piece_starts.size(), 2u);
  EXPECT_NEAR(distance(fit->segments[fit->piece_starts[1]].a, {4, 0}), 0, 1e-12);
}

TEST(Fit, OffsetBeyondTheRadiusOfCurvature) {
  // A parabola's tip of radius 0.25 and an inner offset of 0.6: the offset curve has a swallow tail there.
  const Nurbs2 curve = bezier({{-2, 8}, {0, -8}, {2, 8}});
  for (const double d : {-0.6, 0.6}) {
    for (const double tolerance : {0.1, 0.01, 0.001}) {
      const FitOptions options{FitMethod::minimal, tolerance, d, 1e-3};
      const auto fit = fit_arc_spline(curve, options);
      ASSERT_TRUE(fit.ok());
      expect_well_formed(curve, *fit, options);
      EXPECT_LE(sampled_deviation(curve, *fit, d, kManySamples), fit->max_deviation_mm + 1e-11)
          << d << " " << tolerance;
    }
  }
}

TEST(Fit, DegenerateCurvesAreFittedOrRefused) {
  const std::vector<Nurbs2> curves{
      bezier({{0, 0}, {0, 0}, {3, 1}, {4, 5}}),                      // no derivative at the start
      bezier({{0, 0}, {0, 0}, {0, 0}, {4, 5}}),                      // nor a second one
      bezier({{0, 0}, {3, 1}, {4, 5}, {4, 5}}),                      // at the end
      bezier({{0, 0}, {4, 4}, {0, 4}, {4, 0}}),                      // a loop, nearly a cusp
      bezier({{0, 0}, {10, 10}, {0, 10}, {10, 0}}),                  //
      bezier({{0, 0}, {1, 1}, {0, 1}, {1, 0}}),                      // a cusp
      bezier({{0, 0}, {5, 5}, {5, -5}, {0, 0}}),                     // closed
      bezier({{0, 0}, {10, 0}, {-5, 0}, {4, 0}}),                    // runs back on itself
      bezier({{0, 0}, {1, 4}, {3, -2}, {5, 1}}, {1, 1e4, 1e-4, 1}),  // extreme weights
      bezier({{0, 0}, {1, 3}, {2, -3}, {3, 3}, {4, -3}, {5, 3}, {6, -3}, {7, 3}, {8, -3}, {9, 3}, {10, 0}}),
  };
  for (std::size_t i = 0; i < curves.size(); ++i) {
    for (const double d : {0.0, 0.2, -0.2}) {
      for (const FitMethod method : {FitMethod::minimal, FitMethod::bisect}) {
        const FitOptions options{method, 0.01, d, 1e-3};
        const auto fit = fit_arc_spline(curves[i], options);
        ASSERT_TRUE(fit.ok()) << i << " " << d << ": " << fit.error().message;
        expect_well_formed(curves[i], *fit, options);
        EXPECT_LE(sampled_deviation(curves[i], *fit, 0, 5000), fit->max_deviation_mm + 1e-11)
            << i << " " << d;
        EXPECT_LE(fit->segments.size(), 200u) << i << " " << d;
      }
    }
  }
}

TEST(Fit, TinyAndHugeCurvesAndTolerances) {
  const Nurbs2 curve = bezier({{0, 0}, {0.3, 0.8}, {0.8, -0.5}, {1, 0.2}});
  for (const double size : {1e-6, 1e-2, 1.0, 1e5}) {
    for (const double tolerance : {1e-6, 1e-3, 10.0}) {
      const FitOptions options{FitMethod::minimal, tolerance, 0.28, 1e-3};
      const auto fit = fit_arc_spline(scaled(curve, size), options);
      ASSERT_TRUE(fit.ok()) << size << " " << tolerance;
      expect_well_formed(scaled(curve, size), *fit, options);
    }
  }
}

TEST(Fit, RefusesWhatCannotBeFitted) {
  const auto code = [](const Curve2& curve, const FitOptions& options) {
    const auto fit = fit_arc_spline(curve, options);
    return fit.ok() ? ErrorCode::internal : fit.error().code;
  };
  EXPECT_EQ(code(Line2{{1, 1}, {1, 1}}, {}), ErrorCode::geometry);
  EXPECT_EQ(code(bezier({{1, 1}, {1, 1}, {1, 1}}), {}), ErrorCode::geometry);
  EXPECT_EQ(code(Line2{{1, 1}, {2, 1}}, {FitMethod::minimal, 0}), ErrorCode::geometry);
  EXPECT_EQ(code(Line2{{1, 1}, {2, 1}}, {FitMethod::minimal, -1}), ErrorCode::geometry);
  EXPECT_EQ(code(Line2{{1, 1}, {2, 1}}, {FitMethod::minimal, std::nan("")}), ErrorCode::geometry);
  EXPECT_EQ(code(Line2{{1, 1}, {2, 1}}, {FitMethod::minimal, 0.1, std::nan("")}), ErrorCode::geometry);
}

TEST(Fit, CornerFreedomIsNoneAtSmoothJointsAndSmallAtTips) {
  EXPECT_EQ(corner_freedom(0), 0);
  EXPECT_EQ(corner_freedom(1e-3), 0);
  EXPECT_NEAR(corner_freedom(0.2), 0.05, 1e-12);
  EXPECT_NEAR(corner_freedom(kPi / 2), 0.1, 1e-12);
  EXPECT_NEAR(corner_freedom(kPi - 0.02), 0.005, 1e-12);
  EXPECT_NEAR(corner_freedom(kPi), 0, 1e-12);
}

TEST(Certificate, KnowsClosedForms) {
  // y = 4 h x (1 - x) over its chord: height h, and its offset d has the same height over the offset chord's
  // line.
  const Curve2 parabola = bezier({{0, 0}, {0.5, 0.02}, {1, 0}});
  const auto path = fit::path_of(parabola);
  ASSERT_TRUE(path.ok());
  const fit::Run line{{{0, 0}, {1, 0}, 0, {1, 0}, {1, 0}}, 0, 1};
  fit::Target target;
  target.path = &path->path;
  target.tolerance = 0.1;
  const fit::Deviation plain = fit::certify(target, {line});
  EXPECT_NEAR(plain.hi, 0.01, 1e-4 * 0.01 + 1e-12);
  EXPECT_GE(plain.hi, 0.01);
  target.tolerance = 0.0099;
  EXPECT_FALSE(std::isfinite(fit::certify(target, {line}).bound()));

  // A circle of radius 3 against a concentric arc of radius 3.05: 0.05 everywhere, for the offset as well.
  const double w = std::sqrt(0.5);
  const auto circle = fit::path_of(bezier({{3, 0}, {3, 3}, {0, 3}}, {1, w, 1}));
  ASSERT_TRUE(circle.ok());
  const fit::Run arc{{{3.05, 0}, {0, 1}, 1 / 3.05, {0, 3.05}, {-1, 0}}, 0, 1};
  fit::Target offset;
  offset.path = &circle->path;
  offset.tolerance = 0.1;
  offset.d = 0.7;
  const fit::Deviation both = fit::certify(offset, {arc});
  EXPECT_NEAR(both.hi, 0.05, 1e-9);
  EXPECT_NEAR(both.lo, 0, 0.05);
}

}  // namespace
}  // namespace burin::geom
