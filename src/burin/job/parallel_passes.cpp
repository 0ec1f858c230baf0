// SPDX-License-Identifier: Apache-2.0
#include "burin/job/parallel_passes.h"

#include <algorithm>
#include <cmath>

#include "burin/geom/surface/evaluate.h"

namespace burin::job {
namespace {

using geom::Direction;
using geom::Vec3;

// Samples of a surface each way: the comparison is good to about a per cent.
constexpr int kSamples = 96;
// Passes this much closer than on a plane are no alternative any more.
constexpr double kSteepest = 1e-3;

struct Sum {
  double area = 0;      ///< integral of sqrt(1 - n.a^2), a the direction across the passes
  double distance = 0;  ///< of the planes, so that nowhere more than the scallop is left
};

/// The step on the surface that leaves `scallop` where the normal section across the passes has the curvature
/// k (positive towards the tool): d^2 = 8 S R / (1 - R k), Koo & Jee's usual formula.
double local_step(double radius, double scallop, double k) {
  return std::sqrt(8 * scallop * radius / std::max(1 - radius * k, 0.05));
}

void add(const geom::NurbsSurface& surface, Vec3 across, double radius, double scallop,
         std::optional<double> side_step, Sum& sum) {
  geom::SurfaceEvaluator evaluator(surface);
  const geom::Interval u = surface.domain(Direction::u), v = surface.domain(Direction::v);
  const double cell = u.length() * v.length() / (kSamples * kSamples);
  for (int j = 0; j < kSamples; ++j) {
    for (int i = 0; i < kSamples; ++i) {
      const geom::SurfaceDerivatives d = evaluator.derivatives(u.lo + (i + 0.5) / kSamples * u.length(),
                                                               v.lo + (j + 0.5) / kSamples * v.length());
      const Vec3 up = geom::normal(d).z < 0 ? -geom::normal(d) : geom::normal(d);
      const Vec3 along_surface = across - dot(across, up) * up;  // |.| = sqrt(1 - (n.a)^2)
      const double grade = norm(along_surface);
      sum.area += grade * norm(cross(d.du, d.dv)) * cell;
      // Curvature of the section across, seen from the tool: least squares of the direction in du, dv.
      const double e = dot(d.du, d.du), f = dot(d.du, d.dv), g = dot(d.dv, d.dv), det = e * g - f * f;
      if (!(det > 0)) continue;
      const double a = dot(along_surface, d.du), b = dot(along_surface, d.dv);
      double k = geom::normal_curvature(d, (a * g - b * f) / det, (b * e - a * f) / det);
      if (geom::normal(d).z < 0) k = -k;
      double step = local_step(radius, scallop, std::isfinite(k) ? k : 0);
      if (side_step) step = std::min(step, *side_step);
      sum.distance = std::min(sum.distance, step * grade);
    }
  }
}

}  // namespace

std::optional<double> parallel_length(const geom::Composite& composite, double radius, double scallop,
                                      std::optional<double> side_step) {
  const double flat = local_step(radius, scallop, 0);
  std::optional<double> best;
  for (const Vec3 across : {Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
    Sum sum;
    sum.distance = 1e3 * flat;
    for (const geom::JoinedSurface& s : composite.surfaces)
      add(s.surface, across, radius, scallop, side_step, sum);
    if (sum.distance < kSteepest * flat) continue;
    const double length = sum.area / sum.distance;
    if (!best || length < *best) best = length;
  }
  return best;
}

}  // namespace burin::job
