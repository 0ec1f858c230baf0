// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <string>

#include "burin/base/text.h"
#include "burin/geom/point_tools.h"
#include "burin/verify/deviation.h"
#include "burin/verify/surface_cell.h"

namespace burin::verify {
namespace {

// A cell of radius r (from its middle to the farthest corner) has at most 3 sqrt(3) / 4 r^2, r = spacing /
// sqrt(2); halved triangles have about half a square of the spacing.
constexpr double kMostArea = 0.6495190528383290;
constexpr double kUsualArea = 0.4;
// What gouges between samples of a ball may add when nothing else sets the spacing: spacing^2 / (4 r).
constexpr double kBetweenMm = 0.002;
// Samples that are enough for pictures and areas when nobody asked for a number.
constexpr std::size_t kUsualSamples = 1'000'000;
constexpr int kMostHalvings = 62;  // what a path holds
constexpr double kWider = 1.25;    // when there are too many
constexpr int kMostTries = 200;

/// Calls each(patch, path) for the cells of a patch; it returns false to stop.
template <class Each>
bool cells_of(const Patch& patch, std::uint64_t path, double radius, int depth, Each& each) {
  if (depth >= kMostHalvings || patch.radius() <= radius) return each(patch, path);
  const std::array<Patch, 2> halves = patch.halves();
  return cells_of(halves[0], path << 1, radius, depth + 1, each) &&
         cells_of(halves[1], path << 1 | 1, radius, depth + 1, each);
}

class Sampler {
 public:
  Sampler(const geom::Mesh& mesh, const std::vector<geom::Vec3>& normals) : mesh_(mesh), normals_(normals) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const double area = patch_of(mesh, {}, t).area();
      area_ += area;
      if (area > 0) triangles_.push_back(static_cast<std::uint32_t>(t));
    }
  }
  double area() const { return area_; }
  std::size_t triangles() const { return triangles_.size(); }

  /// Stops when there are more than `most`.
  std::size_t count(double spacing, std::size_t most) const {
    if (area_ / (kMostArea * spacing * spacing) > static_cast<double>(most)) return most + 1;
    std::size_t n = 0;
    const auto one = [&](const Patch&, std::uint64_t) { return ++n <= most; };
    for (const std::uint32_t t : triangles_)
      if (!cells_of(patch_of(mesh_, {}, t), 1, spacing / std::sqrt(2.0), 0, one)) break;
    return n;
  }
  SampledSurface sample(double spacing, std::size_t count, const std::vector<bool>& machined) const {
    SampledSurface out;
    out.spacing_mm = spacing;
    out.normals = normals_;
    out.samples.reserve(count);
    out.cells.reserve(count);
    for (const std::uint32_t t : triangles_) {
      const bool wanted = machined.empty() || machined[t];
      const auto one = [&](const Patch& patch, std::uint64_t path) {
        out.samples.push_back({patch.middle(), patch.normal(), static_cast<float>(patch.area()), wanted});
        out.cells.push_back({t, path});
        return true;
      };
      cells_of(patch_of(mesh_, normals_, t), 1, spacing / std::sqrt(2.0), 0, one);
    }
    return out;
  }
  double spacing_for(std::size_t count) const {
    return std::sqrt(area_ / (kUsualArea * static_cast<double>(std::max<std::size_t>(1, count))));
  }

 private:
  const geom::Mesh& mesh_;
  const std::vector<geom::Vec3>& normals_;
  std::vector<std::uint32_t> triangles_;  // that have an area
  double area_ = 0;
};

Error geometry(const std::string& what) {
  return {ErrorCode::geometry, what, {}};
}
Error range(const std::string& what) {
  return {ErrorCode::range, what, {}};
}

Result<void> validate(const geom::Mesh& mesh, const std::vector<bool>& machined,
                      const std::vector<geom::Vec3>& normals, const SampleOptions& options) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.vertices.size() || !is_finite(mesh.vertices[v]))
        return geometry("triangle " + std::to_string(t) + " has a corner that is not finite or not there");
  if (!machined.empty() && machined.size() != mesh.triangles.size())
    return geometry("not as many marks of machined triangles as triangles");
  if (!normals.empty() && normals.size() != mesh.vertices.size())
    return geometry("not as many normals as vertices");
  for (const geom::Vec3& n : normals)
    if (!is_finite(n)) return geometry("a normal is not finite");
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (options.spacing_mm && !positive(*options.spacing_mm))
    return range("the spacing of the samples must be positive");
  if (options.count && *options.count == 0) return range("no samples are asked for (at least 1)");
  if (!positive(options.least_radius_mm)) return range("the least radius of the tools must be positive");
  if (options.max_samples == 0) return range("no samples are allowed (at least 1)");
  return {};
}

/// Wider until there are at most `most`.
double widened(const Sampler& sampler, double spacing, std::size_t most) {
  for (int i = 0; i < kMostTries && sampler.count(spacing, most) > most; ++i) spacing *= kWider;
  return spacing;
}

double chosen_spacing(const Sampler& sampler, const SampleOptions& options) {
  if (options.spacing_mm) return *options.spacing_mm;
  if (options.count) {
    // Once corrected by what comes out.
    const double spacing = sampler.spacing_for(*options.count);
    const std::size_t got = sampler.count(spacing, 4 * *options.count);
    const double better = spacing * std::sqrt(static_cast<double>(got) / static_cast<double>(*options.count));
    return widened(sampler, better, std::max(options.max_samples, sampler.triangles()));
  }
  const std::size_t most = std::min(options.max_samples, std::max(kUsualSamples, 2 * sampler.triangles()));
  const double wanted = usual_spacing(options.least_radius_mm);
  return widened(sampler, std::max(wanted, 0.8 * sampler.spacing_for(most)), most);
}

}  // namespace

double usual_spacing(double least_radius_mm) {
  return std::sqrt(4 * least_radius_mm * kBetweenMm);
}

Result<SampledSurface> sample_surface(const geom::Mesh& mesh, const std::vector<bool>& machined,
                                      const std::vector<geom::Vec3>& normals, const SampleOptions& options) {
  if (auto ok = validate(mesh, machined, normals, options); !ok) return ok.error();
  const Sampler sampler(mesh, normals);
  if (!std::isfinite(sampler.area())) return geometry("the area of the mesh is not finite");
  if (!(sampler.area() > 0)) return geometry("the mesh has no area");
  const std::size_t most = options.max_samples;
  const auto too_many = [&](const std::string& what) {
    return range(what + ", more than the " + std::to_string(most) + " allowed (a spacing of about " +
                 format_fixed(sampler.spacing_for(most / 2 + 1), 4) + " mm would do)");
  };
  if (sampler.triangles() > most)
    return range("the mesh has " + std::to_string(sampler.triangles()) +
                 " triangles, each of which needs a sample: more than the " + std::to_string(most) +
                 " allowed (a coarser mesh would do)");
  if (options.count && *options.count > most)
    return too_many(std::to_string(*options.count) + " samples are asked for");
  const double spacing = chosen_spacing(sampler, options);
  const std::size_t count = sampler.count(spacing, most);
  if (count > most) return too_many("the spacing asked for makes too many samples");
  return sampler.sample(spacing, count, machined);
}

}  // namespace burin::verify
