// SPDX-License-Identifier: Apache-2.0
// What stands behind PathFamily: one kind for iso-parametric paths, one for plane cuts. Internal to paths.
#pragma once

#include <memory>

#include "burin/plan/orient/path_face.h"

namespace burin::orient::detail {

/// A monotonic map from w in [0, 1] to the level of a family (a parameter, a plane's height), so that equal
/// steps of w are equal distances where the neighbours lie farthest apart.
class Levels {
 public:
  /// `density[i]`: largest distance per level between levels[i] and levels[i + 1]. At least two levels.
  Levels(std::vector<double> levels, const std::vector<double>& density);
  double at(double w) const;
  double length() const { return length_; }

 private:
  std::vector<double> levels_, sums_;
  double length_ = 0;
};

class Family {
 public:
  explicit Family(PathFace face, const PathOptions& options) : face_(std::move(face)), options_(options) {}
  virtual ~Family() = default;
  virtual std::vector<std::vector<CcPoint>> at(double w) const = 0;
  virtual std::vector<PathFamily::Abreast> abreast(const std::vector<CcPoint>& from, double w,
                                                   double w_to) const = 0;
  virtual double extent() const = 0;

 protected:
  PathFace face_;
  PathOptions options_;
};

/// Error (geometry): nothing is left of the face.
Result<std::unique_ptr<Family>> iso_family(PathFace face, const PathOptions& options);
Result<std::unique_ptr<Family>> plane_family(PathFace face, const PathOptions& options);

/// From a contact along t to a place of the surface nearby, on the surface: the arc that turns as the normals
/// do (exact for a circle).
double distance_along(const CcPoint& from, Point3 place, Vec3 normal);
/// From a contact at `here` to the neighbour's place at `there`, both in (u, v).
PathFamily::Abreast met_at(const PathFace& face, geom::SurfaceEvaluator& evaluator, const CcPoint& from,
                           Point2 here, Point2 there);

}  // namespace burin::orient::detail
