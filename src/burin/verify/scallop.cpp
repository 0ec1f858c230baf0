// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/scallop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/geom/point_tools.h"
#include "burin/geom/surface/closest.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/verify/sweep.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// Places on the line between two passes at which the height is taken before the ridge is narrowed down.
constexpr int kAcross = 24;
// Golden sections around the highest of them: the place of the ridge to 5e-8 of the side step. It is an edge,
// not a smooth top: its height is as wrong as its place times the slope there, side step / (2 R).
constexpr int kNarrow = 30;

// An end of a stretch counts as abreast when the way to it is square to the path within this (cosine).
constexpr double kSquare = 0.02;

struct Station {
  Point3 center;
  Vec3 along;  ///< unit
  geom::SurfacePoint foot;
};

/// Every chord of a pass.
template <class Each>
void for_chords(const TipPass& pass, const Each& each) {
  for (const std::vector<Point3>& tips : pass.stretches)
    for (std::size_t i = 0; i + 1 < tips.size(); ++i) each(tips[i], tips[i + 1]);
}

class Measure {
 public:
  Measure(const geom::NurbsSurface& surface, const std::vector<TipPass>& passes,
          const ScallopOptions& options)
      : passes_(passes),
        options_(options),
        evaluator_(surface),
        surface_(surface),
        finder_(surface),
        sweep_(segments(passes, options.radius_mm), options.radius_mm) {}

  ScallopReport run() {
    const double spacing = station_spacing();
    for (std::size_t i = 0; i < passes_.size(); ++i) {
      const std::vector<Station> from = stations(passes_[i], spacing);
      for (const Station& s : from) height(s.foot.u, s.foot.v);
      if (i + 1 < passes_.size()) report_.ridges.push_back(ridge(from, passes_[i + 1]));
    }
    whole_surface(spacing);
    bool any = false;
    for (std::size_t i = 0; i + 1 < report_.ridges.size(); ++i) {
      const ScallopReport::Ridge& r = report_.ridges[i];
      report_.scallop_min_mm = any ? std::min(report_.scallop_min_mm, r.min_mm) : r.min_mm;
      report_.scallop_max_mm = std::max(report_.scallop_max_mm, r.max_mm);
      any = true;
    }
    return std::move(report_);
  }

 private:
  static Point3 center_of(Point3 tip, double radius) { return {tip.x, tip.y, tip.z + radius}; }

  static std::vector<Sweep::Segment> segments(const std::vector<TipPass>& passes, double radius) {
    std::vector<Sweep::Segment> all;
    for (const TipPass& pass : passes)
      for_chords(pass, [&](Point3 a, Point3 b) {
        all.push_back({center_of(a, radius), center_of(b, radius)});
      });
    return all;
  }

  double station_spacing() const {
    double length = 0;
    for (const TipPass& pass : passes_)
      for_chords(pass, [&](Point3 a, Point3 b) { length += distance(a, b); });
    const double wanted = options_.spacing_mm > 0 ? options_.spacing_mm : 0.25 * options_.radius_mm;
    // Half of the samples for the ridges.
    const double least = 2 * length * (kAcross + kNarrow) / std::max<double>(1, double(options_.max_samples));
    return std::max(wanted, least);
  }

  /// Longest of a few polylines along one direction.
  double extent(geom::Direction along) {
    constexpr int kLines = 9, kPieces = 64;
    const geom::Interval u = surface_.domain(geom::Direction::u), v = surface_.domain(geom::Direction::v);
    double longest = 0;
    for (int i = 0; i < kLines; ++i) {
      double length = 0;
      Point3 last;
      for (int k = 0; k <= kPieces; ++k) {
        double s = double(k) / kPieces, t = double(i) / (kLines - 1);
        if (along == geom::Direction::v) std::swap(s, t);
        const Point3 p = evaluator_.point(u.lo + s * u.length(), v.lo + t * v.length());
        if (k > 0) length += distance(p, last);
        last = p;
      }
      longest = std::max(longest, length);
    }
    return longest;
  }

  /// Cuts below the surface anywhere: what only the ridges and contacts looked at could miss them.
  void whole_surface(double spacing) {
    const double size_u = extent(geom::Direction::u), size_v = extent(geom::Direction::v);
    const double most = std::max<double>(4, double(options_.max_samples) / 2);
    const double step = std::max(spacing, std::sqrt(size_u * size_v / most));
    const auto pieces = [&](double size) { return static_cast<int>(std::clamp(size / step, 8.0, most / 8)); };
    const int nu = pieces(size_u), nv = pieces(size_v);
    const geom::Interval u = surface_.domain(geom::Direction::u), v = surface_.domain(geom::Direction::v);
    for (int j = 0; j <= nv; ++j)
      for (int i = 0; i <= nu; ++i) height(u.lo + u.length() * i / nu, v.lo + v.length() * j / nv);
  }

  Station station(Point3 tip, Vec3 along) const {
    const Point3 center = center_of(tip, options_.radius_mm);
    return {center, unit(along), finder_.find(center, 1e-6)};
  }

  /// Evenly along every stretch, both ends among them.
  std::vector<Station> stations(const TipPass& pass, double spacing) const {
    std::vector<Station> out;
    for (const std::vector<Point3>& tips : pass.stretches) {
      double left = 0;
      for (std::size_t i = 0; i + 1 < tips.size(); ++i) {
        const Vec3 way = tips[i + 1] - tips[i];
        const double length = norm(way);
        double at = left;
        for (; at < length; at += spacing) out.push_back(station(tips[i] + (at / length) * way, way));
        left = at - length;
      }
      if (tips.size() > 1) out.push_back(station(tips.back(), tips.back() - tips[tips.size() - 2]));
    }
    return out;
  }

  struct Abreast {
    Point3 center;
    bool square = false;  ///< the way there is square to the path
  };
  Abreast nearest_on(const TipPass& pass, const Station& from) const {
    Abreast best;
    double least = std::numeric_limits<double>::infinity();
    for_chords(pass, [&](Point3 tip_a, Point3 tip_b) {
      const Point3 p = nearest_on_segment(from.center, center_of(tip_a, options_.radius_mm),
                                          center_of(tip_b, options_.radius_mm));
      const double far = distance(p, from.center);
      if (far < least) {
        least = far;
        best = {p, std::abs(dot(p - from.center, from.along)) <= kSquare * far};
      }
    });
    return best;
  }

  /// Height of what is left over the surface at (u, v): negative where it was cut too deep, which is noted.
  double height(double u, double v) {
    ++report_.samples;
    const double side = options_.normal_reversed ? -1 : 1;
    const geom::SurfaceDerivatives d = evaluator_.derivatives(u, v);
    Vec3 n = geom::normal(d);
    if (n == Vec3{}) n = geom::normal(surface_, u, v);  // a pole
    if (!(norm(n) > 0.5)) return 0;                     // no area around: nothing stands there
    n = side * n;
    const Point3 q = d.p + options_.stock_mm * n;
    const double reach = 2 * options_.radius_mm;
    const double h = sweep_.entry(q, n, -reach, reach, 0).value_or(reach);
    if (-h > report_.gouge_max_mm) {
      report_.gouge_max_mm = -h;
      report_.gouge_at = d.p;
    }
    return h;
  }

  ScallopReport::Ridge ridge(const std::vector<Station>& from, const TipPass& to) {
    ScallopReport::Ridge ridge{std::numeric_limits<double>::infinity(), 0};
    const bool any = std::any_of(to.stretches.begin(), to.stretches.end(),
                                 [](const std::vector<Point3>& tips) { return tips.size() > 1; });
    if (!any) return ridge;
    for (const Station& a : from) {
      const Abreast next = nearest_on(to, a);
      const double h = highest(a.foot, finder_.find(next.center, 1e-6));
      if (next.square) ridge.min_mm = std::min(ridge.min_mm, h);
      ridge.max_mm = std::max(ridge.max_mm, h);
    }
    return ridge;
  }

  /// The highest place on the line between two feet (straight in the parameters).
  double highest(const geom::SurfacePoint& a, const geom::SurfacePoint& b) {
    const auto at = [&](double x) { return height(a.u + x * (b.u - a.u), a.v + x * (b.v - a.v)); };
    int best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (int k = 0; k <= kAcross; ++k) {
      const double h = at(double(k) / kAcross);
      if (h > most) most = h, best = k;
    }
    double lo = std::max(0, best - 1) / double(kAcross), hi = std::min(kAcross, best + 1) / double(kAcross);
    constexpr double kGolden = 0.6180339887498949;
    double x1 = hi - kGolden * (hi - lo), x2 = lo + kGolden * (hi - lo);
    double h1 = at(x1), h2 = at(x2);
    for (int k = 0; k < kNarrow; ++k) {
      if (h1 > h2) {
        hi = x2, x2 = x1, h2 = h1;
        h1 = at(x1 = hi - kGolden * (hi - lo));
      } else {
        lo = x1, x1 = x2, h1 = h2;
        h2 = at(x2 = lo + kGolden * (hi - lo));
      }
    }
    return std::max({most, h1, h2});
  }

  const std::vector<TipPass>& passes_;
  const ScallopOptions& options_;
  geom::SurfaceEvaluator evaluator_;
  const geom::NurbsSurface& surface_;
  geom::ClosestPointFinder finder_;
  Sweep sweep_;
  ScallopReport report_;
};

}  // namespace

ScallopReport measure_scallop(const geom::NurbsSurface& surface, const std::vector<TipPass>& passes,
                              const ScallopOptions& options) {
  bool usable = geom::validate(surface).ok() && options.radius_mm > 0 && std::isfinite(options.radius_mm) &&
                std::isfinite(options.stock_mm) && std::isfinite(options.spacing_mm) && !passes.empty();
  for (const TipPass& pass : passes)
    for_chords(pass, [&](Point3 a, Point3 b) { usable = usable && is_finite(a) && is_finite(b); });
  if (!usable) return {};
  return Measure(surface, passes, options).run();
}

}  // namespace burin::verify
