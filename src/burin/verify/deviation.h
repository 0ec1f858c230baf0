// SPDX-License-Identifier: Apache-2.0
// Signed deviation of a machined surface: what all tools together leave on (positive) or take out of
// (negative) the design, measured along the normal. Uses nothing of plan/. mm. docs/verify.md
//
// On the line p + h n of a sample every tool at every moment covers an interval of h. Material is gone there.
//   gouge:  the lowest h < 0 of the intervals that reach up to the surface (h >= 0): a cutter on the far side
//           of a thin wall is no gouge of the near side;
//   excess: the lowest h >= 0 that is covered, when nothing is cut below the surface;
//   unmachined: nothing is covered within `reach_mm`.
// Both as values of one function: deviation = -gouge, or excess, or NaN.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/verify/path.h"

namespace burin::verify {

/// Where the deviation is measured. `machined` false: must not be cut, but need not be reached.
struct SurfaceSample {
  geom::Point3 p;
  geom::Vec3 n;        ///< unit, outwards
  float area_mm2 = 0;  ///< of the surface it stands for
  bool machined = true;
};
/// The part of a triangle that a sample stands for (in the middle of it): what halving the longest side again
/// and again gives. `path`: a 1, then for each halving which half.
struct SurfaceCell {
  std::uint32_t triangle = 0;
  std::uint64_t path = 1;
};
struct SampledSurface {
  std::vector<SurfaceSample> samples;
  double spacing_mm = 0;  ///< no place of a triangle is farther than spacing / sqrt(2) from a sample of it
  std::vector<SurfaceCell> cells;   ///< of the samples
  std::vector<geom::Vec3> normals;  ///< a vertex of the mesh; empty: of the triangles
};

struct SampleOptions {
  std::optional<double> spacing_mm;     ///< nothing: from `count`, else from the tool and the bound asked for
  std::optional<std::size_t> count;     ///< about so many
  double least_radius_mm = 3;           ///< of the tools: sets the spacing when nothing else does
  std::size_t max_samples = 5'000'000;  ///< more are an error that says what spacing would do
};
/// What sets the spacing when nothing else does.
double usual_spacing(double least_radius_mm);
/// Samples on the triangles. `machined[t]` says it for triangle t; empty: all. `normals` (one a vertex,
/// empty: of the triangles) are blended over each triangle. Errors: a mesh without area, indices that do not
/// exist, numbers not finite (geometry); more samples than allowed (range), before anything is allocated.
Result<SampledSurface> sample_surface(const geom::Mesh& mesh, const std::vector<bool>& machined,
                                      const std::vector<geom::Vec3>& normals, const SampleOptions& options);

struct DeviationOptions {
  double reach_mm = 5;  ///< nothing cut within it: unmachined. Gouges deeper than it are reported as it.
  double tolerance_mm = 0.01;     ///< what the areas count above
  double resolution_mm = 0.0005;  ///< of each deviation
  unsigned threads = 1;           ///< 0: as many as there are; the result is the same for any number
};

struct WorstDeviation {
  double mm = 0;  ///< 0: none
  geom::Point3 at;
  geom::Vec3 n;
  std::uint32_t move = 0;  ///< GOTO that cuts there
};
struct DeviationReport {
  std::vector<float> deviation_mm;  ///< a sample; NaN: unmachined
  WorstDeviation gouge, excess;
  double gouge_area_mm2 = 0, excess_area_mm2 = 0;  ///< beyond the tolerance
  double excess_mean_mm = 0;                       ///< over the machined area that was reached, by area
  double unmachined_area_mm2 = 0, area_mm2 = 0;
  /// How far the true worst values of the triangles can lie from the reported ones: spacing, resolution and
  /// motion. The deflection of the triangles comes on top.
  double bound_mm = 0;
};

/// The worst places are searched for between the samples as well, until the bound holds. Errors: tools or
/// numbers that are impossible (range), motion not finite (geometry).
Result<DeviationReport> measure_deviation(const geom::Mesh& mesh, const SampledSurface& surface,
                                          const CheckedPath& path, const DeviationOptions& options,
                                          ProgressSink* progress = nullptr);

/// Area by deviation: equal steps of `step_mm`, as far to both sides of 0 as nearly all samples go; the rest
/// is in the outermost bins.
struct Histogram {
  double step_mm = 0;
  double from_mm = 0;  ///< lower end of the first bin
  std::vector<double> area_mm2;
};
Histogram histogram(const SampledSurface& surface, const DeviationReport& report, std::size_t bins);

}  // namespace burin::verify
