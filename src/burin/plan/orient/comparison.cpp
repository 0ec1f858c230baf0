// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/comparison.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

namespace burin::orient {

namespace {

/// Tilts that are tried when none suits all points.
constexpr int kTilts = 64;
/// A ball of the whole radius of curvature would touch all over: this share of it is taken.
constexpr double kBallShare = 0.9;

std::string bytes_of(double value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
double double_of(const std::string& bytes) {
  double value = 0;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

/// Smallest tilt from `from` on that suits all points of a path; alpha_hi and more when none does.
double suits_path(const Setting& setting, const OrientedPath& path, double from) {
  Scene::Memory memory;
  double tilt = from;
  bool moved = true;
  while (moved && tilt <= setting.range.alpha_hi) {
    moved = false;
    for (const OrientedPoint& point : path.points) {
      if (!point.reachable) continue;
      const Scene::FirstFree free = first_allowed(setting, point.cc, 0, tilt, memory);
      if (!free.found) return 2 * geom::kPi;
      moved = moved || free.alpha > tilt;
      tilt = std::max(tilt, free.alpha);
    }
  }
  return tilt;
}

std::size_t blocked_at(const Setting& setting, const OrientedPath& path, double tilt) {
  Scene::Memory memory;
  std::size_t blocked = 0;
  for (const OrientedPoint& point : path.points)
    if (point.reachable && cause_at(setting, point.cc, {tilt, 0}, memory) != Cause::none) ++blocked;
  return blocked;
}

/// Lays the paths of all families by the strips of single points and adds up their lengths.
void lay_out(const std::vector<PathFamily>& families, const OrientOptions& options,
             const std::function<Strip(const CcPoint&)>& strip, Comparison& comparison) {
  for (const PathFamily& family : families) {
    const LanePlanner lanes = [&](const std::vector<double>& ws) {
      std::vector<Lane> planned;
      for (const double w : ws) {
        Lane lane{w, family.at(w), {}};
        for (const std::vector<CcPoint>& piece : lane.pieces) {
          lane.strips.emplace_back();
          for (const CcPoint& at : piece) lane.strips.back().push_back(strip(at));
        }
        planned.push_back(std::move(lane));
      }
      return planned;
    };
    const auto places = lay_paths(family, lanes, kMostPaths);
    if (!places) return;
    for (const double w : *places) {
      for (const std::vector<CcPoint>& piece : family.at(w)) {
        ++comparison.paths;
        comparison.cut_mm += length_of(piece);
      }
    }
  }
  comparison.minutes = comparison.cut_mm / options.feed_mm_min;
  comparison.possible = comparison.paths > 0;
}

}  // namespace

double length_of(const std::vector<CcPoint>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += distance(points[i - 1].c, points[i].c);
  return length;
}

SturzTilt sturz_tilt(const Setting& setting, const std::vector<OrientedPath>& paths, Workers& workers) {
  const AngleRange& range = setting.range;
  if (range.beta_lo > 0 || range.beta_hi < 0) return {range.alpha_lo, 0};
  SturzTilt found{range.alpha_lo, 0};
  // What suits one path may not suit another: the least of all grows until nothing changes.
  double before = -1;
  while (found.tilt > before && found.tilt <= range.alpha_hi) {
    before = found.tilt;
    const auto tilts = workers.map(
        paths.size(), [&](std::size_t i) { return bytes_of(suits_path(setting, paths[i], before)); });
    for (const std::string& bytes : tilts) found.tilt = std::max(found.tilt, double_of(bytes));
  }
  if (found.tilt <= range.alpha_hi) return found;
  const auto tilt_of = [&](int k) {
    return range.alpha_lo + k * (range.alpha_hi - range.alpha_lo) / (kTilts - 1);
  };
  const auto counts = workers.map(kTilts, [&](std::size_t k) {
    std::size_t blocked = 0;
    for (const OrientedPath& path : paths) blocked += blocked_at(setting, path, tilt_of(static_cast<int>(k)));
    return bytes_of(static_cast<double>(blocked));
  });
  found = {range.alpha_lo, static_cast<std::size_t>(double_of(counts[0]))};
  for (int k = 1; k < kTilts; ++k) {
    const auto blocked = static_cast<std::size_t>(double_of(counts[static_cast<std::size_t>(k)]));
    if (blocked < found.unreachable) found = {tilt_of(k), blocked};
  }
  return found;
}

Comparison compare_sturz(const std::vector<PathFamily>& families, const model::Mill& mill,
                         const OrientOptions& options, const SturzTilt& tilt) {
  Comparison comparison;
  comparison.name = "sturz";
  comparison.tilt = tilt.tilt;
  comparison.radius_mm = mill.radius;
  comparison.unreachable = tilt.unreachable;
  lay_out(
      families, options,
      [&](const CcPoint& at) {
        return strip_at(at, {tilt.tilt, 0}, mill, options.scallop_mm);
      },
      comparison);
  return comparison;
}

Comparison compare_ball(const std::vector<PathFamily>& families, const std::vector<OrientedPath>& paths,
                        const model::Mill& mill, const OrientOptions& options) {
  double bent = 0;
  for (const OrientedPath& path : paths) {
    for (const OrientedPoint& point : path.points) {
      const CcPoint& at = point.cc;
      const double mean = 0.5 * (at.k_ff + at.k_tt);
      bent = std::max(bent, mean + std::hypot(0.5 * (at.k_ff - at.k_tt), at.k_ft));
    }
  }
  Comparison comparison;
  comparison.name = "ball";
  comparison.radius_mm = bent * mill.radius > kBallShare ? kBallShare / bent : mill.radius;
  lay_out(
      families, options,
      [&](const CcPoint& at) { return ball_strip(at, comparison.radius_mm, options.scallop_mm); },
      comparison);
  return comparison;
}

}  // namespace burin::orient
