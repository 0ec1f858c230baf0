// SPDX-License-Identifier: Apache-2.0
#include "burin/view/surface_mesh.h"

#include <algorithm>
#include <cmath>

#include "burin/geom/point_tools.h"

namespace burin::view {
namespace {

using geom::Direction;
using geom::NurbsSurface;
using geom::Side;

/// Bilinear pieces bend little: a few samples show their twist.
constexpr int kLinearSamples = 4;
/// Lines drawn in one direction: about this many, knots first.
constexpr std::size_t kIsoLines = 12;

struct Line {
  double at = 0;
  Side side = Side::right;
  bool knot = false;
};

std::vector<geom::Knot> breaks(const NurbsSurface& s, Direction d) {
  std::vector<geom::Knot> all{{s.domain(d).lo, s.degree(d) + 1}};
  for (const geom::Knot& k : geom::inner_knots(s.knots(d), s.degree(d))) all.push_back(k);
  all.push_back({s.domain(d).hi, s.degree(d) + 1});
  return all;
}

/// `samples` pieces a span; 0: at most `most` knots only.
std::vector<Line> lines_of(const NurbsSurface& s, Direction d, int samples, std::size_t most) {
  const std::vector<geom::Knot> knots = breaks(s, d);
  std::vector<Line> lines;
  if (samples == 0) {
    const std::size_t last = knots.size() - 1, step = last / std::max<std::size_t>(1, most - 1) + 1;
    for (std::size_t i = 0; i < last; i += step) lines.push_back({knots[i].value, Side::right, true});
    lines.push_back({knots[last].value, Side::left, true});
    return lines;
  }
  if (s.degree(d) == 1) samples = std::min(samples, kLinearSamples);
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double lo = knots[i].value, hi = knots[i + 1].value;
    lines.push_back({lo, Side::right, true});
    for (int k = 1; k < samples; ++k) lines.push_back({lo + (hi - lo) * k / samples, Side::right, false});
    const bool crease = knots[i + 1].multiplicity >= s.degree(d);
    if (crease) lines.push_back({hi, Side::left, true});
  }
  return lines;
}

std::size_t count_lines(const NurbsSurface& s, Direction d, int samples) {
  if (s.degree(d) == 1) samples = std::min(samples, kLinearSamples);
  const std::vector<geom::Knot> knots = breaks(s, d);
  std::size_t n = (knots.size() - 1) * static_cast<std::size_t>(samples);
  for (std::size_t i = 1; i < knots.size(); ++i) n += knots[i].multiplicity >= s.degree(d) ? 1 : 0;
  return n;
}

std::size_t count_points(const NurbsSurface& s, int samples) {
  return count_lines(s, Direction::u, samples) * count_lines(s, Direction::v, samples);
}

/// Ends and knots; where these are few also lines between them, where they are many some of them.
std::vector<int> iso_lines(const std::vector<Line>& lines) {
  std::vector<int> knots, chosen;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool twin = i > 0 && lines[i].at == lines[i - 1].at;
    if (lines[i].knot && !twin) knots.push_back(static_cast<int>(i));
  }
  if (knots.size() > kIsoLines) {
    const std::size_t step = (knots.size() - 1) / kIsoLines + 1;
    for (std::size_t i = 0; i + 1 < knots.size(); i += step) chosen.push_back(knots[i]);
    chosen.push_back(knots.back());
    return chosen;
  }
  const int per_span =
      std::max(1, static_cast<int>(kIsoLines / std::max<std::size_t>(1, knots.size() - 1)) / 2);
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    int before = -1;
    for (int k = 0; k < per_span; ++k) {
      const int line = knots[i] + (knots[i + 1] - knots[i]) * k / per_span;
      if (line != before) chosen.push_back(line);
      before = line;
    }
  }
  chosen.push_back(knots.back());
  return chosen;
}

geom::Vec3 finite_or_zero(geom::Vec3 n) {
  return is_finite(n) ? n : geom::Vec3{};
}

SurfaceMesh sample(const NurbsSurface& s, int samples, std::size_t share) {
  // Without samples inside the spans the share is split between the directions as the spans are.
  const double spans_u = static_cast<double>(breaks(s, Direction::u).size()),
               spans_v = static_cast<double>(breaks(s, Direction::v).size());
  const double root = std::sqrt(static_cast<double>(share) * spans_u / spans_v);
  const auto most_u =
      static_cast<std::size_t>(std::clamp(root, 2.0, std::max(2.0, static_cast<double>(share) / 2)));
  const std::vector<Line> us = lines_of(s, Direction::u, samples, most_u),
                          vs = lines_of(s, Direction::v, samples, std::max<std::size_t>(2, share / most_u));
  SurfaceMesh mesh;
  for (const Line& l : us) mesh.u.push_back(l.at);
  for (const Line& l : vs) mesh.v.push_back(l.at);
  mesh.iso_u = iso_lines(us);
  mesh.iso_v = iso_lines(vs);
  mesh.points.reserve(us.size() * vs.size());
  mesh.normals.reserve(us.size() * vs.size());
  geom::SurfaceEvaluator evaluator(s);
  for (const Line& v : vs) {
    for (const Line& u : us) {
      const geom::SurfaceDerivatives d = evaluator.derivatives(u.at, v.at, u.side, v.side);
      geom::Vec3 n = geom::normal(d);
      if (geom::dot(n, n) == 0)  // a pole or a collapsed edge
        n = geom::normal(s, u.at, v.at);
      mesh.points.push_back(d.p);
      mesh.normals.push_back(finite_or_zero(n));
      mesh.box.add(d.p);
    }
  }
  return mesh;
}

}  // namespace

std::vector<SurfaceMesh> sample_surfaces(const std::vector<const NurbsSurface*>& surfaces,
                                         std::size_t most_points) {
  const auto total = [&](int samples) {
    std::size_t n = 0;
    for (const NurbsSurface* s : surfaces) n += count_points(*s, samples);
    return n;
  };
  int samples = kMaxSamplesPerSpan;
  while (samples > 0 && total(samples) > most_points) --samples;
  const std::size_t share = most_points / std::max<std::size_t>(1, surfaces.size());
  std::vector<SurfaceMesh> meshes;
  meshes.reserve(surfaces.size());
  for (const NurbsSurface* s : surfaces) meshes.push_back(sample(*s, samples, share));
  return meshes;
}

int nearest_line(const std::vector<double>& parameters, double at) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < parameters.size(); ++i) {
    if (std::abs(parameters[i] - at) < std::abs(parameters[best] - at)) best = i;
  }
  return static_cast<int>(best);
}

}  // namespace burin::view
