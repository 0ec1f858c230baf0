// SPDX-License-Identifier: Apache-2.0
// The paper's procedure Find_Optimum_Solution (Park & Lee 2001, 3.2): along the contour of the radius through
// a boundary point to the other boundary points, from the middle of each allowed stretch up the gradient to
// the boundary, again. Superlevel sets shrink, so each stretch is looked through within its own yaws only.
#include <algorithm>
#include <cmath>
#include <optional>

#include "burin/plan/orient/initial.h"

namespace burin::orient {
namespace {

// rad: step along a contour; allowed stretches narrower than that may be missed.
constexpr double kContourStep = 3 * geom::kPi / 180;
constexpr int kLeastSteps = 8;
// rad: step up the gradient.
constexpr double kMarchStep = 0.25 * geom::kPi / 180;
// rad: places on the boundary.
constexpr double kBoundary = 1e-6;
// Share of the radius below which a step is no gain: the paper's stop tolerance.
constexpr double kStop = 1e-4;
// Contours followed at one contact point: far beyond what gains of kStop need on any part.
constexpr int kMostContours = 400;

class ContourSearch {
 public:
  ContourSearch(const Setting& setting, const CcPoint& at, const Relaxation& known, Scene::Memory& memory)
      : setting_(setting), at_(at), known_(known), memory_(memory), mill_(setting.scene->mill()) {}

  void run(Optimum& best) {
    std::vector<Contour> open{{best.angles, setting_.range.beta_lo, setting_.range.beta_hi}};
    for (int followed = 0; !open.empty() && followed < kMostContours; ++followed) {
      const Contour contour = open.back();
      open.pop_back();
      const double rho = effective_radius(contour.through, mill_);
      for (const auto& [lo, hi] : stretches(contour, rho)) {
        const auto middle = on_contour(rho, (lo + hi) / 2);
        if (!middle || !allowed(*middle)) continue;
        const Angles up = march(*middle);
        const double gained = effective_radius(up, mill_);
        if (gained > best.value) {
          best.value = gained;
          best.angles = up;
        }
        if (gained > rho * (1 + kStop)) open.push_back({up, lo, hi});
      }
    }
  }

 private:
  struct Contour {
    Angles through;
    double lo = 0, hi = 0;  ///< yaws
  };
  struct Stretch {
    double lo = 0, hi = 0;
  };

  bool allowed(const Angles& angles) {
    return !known_.blocked(angles) && cause_at(setting_, at_, angles, memory_) == Cause::none;
  }

  std::optional<Angles> on_contour(double rho, double beta) const {
    const auto alpha = contour_tilt(rho, beta, mill_);
    if (!alpha) return std::nullopt;
    // The contour through a point at the end of the tilts has that point, whatever rounding says.
    constexpr double kRounding = 1e-12;
    if (*alpha < setting_.range.alpha_lo - kRounding || *alpha > setting_.range.alpha_hi + kRounding)
      return std::nullopt;
    return Angles{std::clamp(*alpha, setting_.range.alpha_lo, setting_.range.alpha_hi), beta};
  }
  bool allowed_on(double rho, double beta) {
    const auto angles = on_contour(rho, beta);
    return angles && allowed(*angles);
  }

  /// Where between an allowed and a forbidden yaw the boundary is, on the allowed side.
  double boundary(double rho, double inside, double outside) {
    while (std::abs(outside - inside) > kBoundary) {
      const double middle = (inside + outside) / 2;
      (allowed_on(rho, middle) ? inside : outside) = middle;
    }
    return inside;
  }

  std::vector<Stretch> stretches(const Contour& contour, double rho) {
    const int steps =
        std::max(kLeastSteps, static_cast<int>(std::ceil((contour.hi - contour.lo) / kContourStep)));
    std::vector<double> yaws{contour.through.beta};
    for (int k = 0; k <= steps; ++k) yaws.push_back(contour.lo + k * (contour.hi - contour.lo) / steps);
    std::sort(yaws.begin(), yaws.end());
    std::vector<Stretch> found;
    bool inside = false;
    for (std::size_t k = 0; k < yaws.size(); ++k) {
      const bool now = yaws[k] == contour.through.beta || allowed_on(rho, yaws[k]);
      if (now && !inside) found.push_back({k > 0 ? boundary(rho, yaws[k], yaws[k - 1]) : yaws[k], yaws[k]});
      if (now) found.back().hi = yaws[k];
      if (!now && inside) found.back().hi = boundary(rho, yaws[k - 1], yaws[k]);
      inside = now;
    }
    return found;
  }

  /// Up the gradient from an allowed place to the last one before the boundary or the end of the ranges.
  Angles march(Angles from) {
    const AngleRange& range = setting_.range;
    for (;;) {
      const geom::Vec2 slope = radius_gradient(from, mill_);
      const double steepness = norm(slope);
      if (!(steepness > 0) || !std::isfinite(steepness)) return from;
      double step = kMarchStep;
      const geom::Vec2 up = slope / steepness;
      // Not beyond the ranges: the step ends there.
      if (up.x < 0) step = std::min(step, (range.alpha_lo - from.alpha) / up.x);
      if (up.y < 0) step = std::min(step, (range.beta_lo - from.beta) / up.y);
      if (up.y > 0) step = std::min(step, (range.beta_hi - from.beta) / up.y);
      if (!(step > kBoundary)) return from;
      const auto along = [&](double s) {
        return Angles{std::max(from.alpha + s * up.x, range.alpha_lo),
                      std::clamp(from.beta + s * up.y, range.beta_lo, range.beta_hi)};
      };
      if (!allowed(along(step))) {
        double in = 0, out = step;
        while (out - in > kBoundary) {
          const double middle = (in + out) / 2;
          (allowed(along(middle)) ? in : out) = middle;
        }
        return along(in);
      }
      from = along(step);
    }
  }

  const Setting& setting_;
  const CcPoint& at_;
  const Relaxation& known_;
  Scene::Memory& memory_;
  const model::Mill& mill_;
};

}  // namespace

Optimum find_by_contour(const Setting& setting, const CcPoint& at, Scene::Memory& memory) {
  const std::uint64_t before = memory.tests;
  const model::Mill& mill = setting.scene->mill();
  Relaxation known(*setting.scene, at);
  const Initial initial = initial_solution(setting, at, known, memory);
  Optimum best;
  best.found = best.initial_found = initial.found;
  best.cause = initial.cause;
  if (initial.found) {
    best.angles = best.initial = initial.angles;
    best.value = best.initial_value = effective_radius(initial.angles, mill);
    if (!initial.at_corner && mill.radius > 0) {
      ContourSearch(setting, at, known, memory).run(best);
      best.cause = cause_beyond(setting, at, best.angles, known, memory);
    }
  }
  best.tests = static_cast<std::uint32_t>(memory.tests - before);
  return best;
}

}  // namespace burin::orient
