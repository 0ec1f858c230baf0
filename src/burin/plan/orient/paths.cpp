// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "burin/plan/orient/path_family.h"

namespace burin::orient {

namespace {
/// Of the face's size (the diagonal of its control points' box), where no step is given.
constexpr double kWidestStep = 1.0 / 64;
}  // namespace

struct PathFamily::State {
  std::unique_ptr<detail::Family> family;
};

PathFamily::PathFamily() : state_(std::make_unique<State>()) {}
PathFamily::~PathFamily() = default;
PathFamily::PathFamily(PathFamily&&) noexcept = default;
PathFamily& PathFamily::operator=(PathFamily&&) noexcept = default;

Result<PathFamily> PathFamily::make(const Part& part, int face, const PathOptions& options) {
  if (face < 0 || face >= static_cast<int>(part.faces.size())) {
    return Error{ErrorCode::geometry,
                 "face " + std::to_string(face) + " of a design with " + std::to_string(part.faces.size()) +
                     " faces (paths need a face; contacts on triangles come from a file)",
                 {}};
  }
  const DesignFace& design = part.faces[static_cast<std::size_t>(face)];
  if (auto valid = geom::validate(design.surface); !valid) return valid.error();
  if (!(options.chord_mm > 0) || !(options.max_turn > 0) || !(options.edge_mm >= 0)) {
    return Error{
        ErrorCode::usage, "limits of the contact points that are not positive (chord and turn above 0)", {}};
  }
  detail::PathFace patch(design, options.edge_mm);
  // Angles, strips and obstacles are looked at in the contact points only: not too few of them on flat faces.
  PathOptions limits = options;
  if (!(limits.max_step_mm > 0)) limits.max_step_mm = kWidestStep * patch.size();
  auto family = options.pattern == Pattern::plane ? detail::plane_family(std::move(patch), limits)
                                                  : detail::iso_family(std::move(patch), limits);
  if (!family) {
    Error error = family.error();
    error.message += "; face " + std::to_string(design.number);
    return error;
  }
  PathFamily made;
  made.state_->family = std::move(*family);
  return made;
}

std::vector<std::vector<CcPoint>> PathFamily::at(double w) const {
  return state_->family->at(std::clamp(w, 0.0, 1.0));
}

std::vector<PathFamily::Abreast> PathFamily::abreast(const std::vector<CcPoint>& from, double w,
                                                     double w_to) const {
  return state_->family->abreast(from, std::clamp(w, 0.0, 1.0), std::clamp(w_to, 0.0, 1.0));
}

double PathFamily::distance(const CcPoint& from, double w, double w_to) const {
  const Abreast there = abreast({from}, w, w_to).front();
  return there.found ? there.distance : std::numeric_limits<double>::infinity();
}

double PathFamily::extent() const {
  return state_->family->extent();
}

namespace detail {

Levels::Levels(std::vector<double> levels, const std::vector<double>& density) : levels_(std::move(levels)) {
  sums_.push_back(0);
  for (std::size_t i = 0; i + 1 < levels_.size(); ++i) {
    sums_.push_back(sums_.back() + density[i] * (levels_[i + 1] - levels_[i]));
  }
  length_ = sums_.back();
}

double Levels::at(double w) const {
  if (w <= 0) return levels_.front();
  if (w >= 1) return levels_.back();
  const double s = w * length_;
  const auto next = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, s);
  const auto i = static_cast<std::size_t>(next - sums_.begin()) - 1;
  const double step = sums_[i + 1] - sums_[i];
  return levels_[i] + (step > 0 ? (s - sums_[i]) / step : 0) * (levels_[i + 1] - levels_[i]);
}

double distance_along(const CcPoint& from, Point3 place, Vec3 normal) {
  const double chord = distance(from.c, place);
  const double turn = std::acos(std::clamp(dot(from.n, normal), -1.0, 1.0));
  // (turn / 2) / sin(turn / 2), by its series where the quotient loses digits.
  return chord * (turn < 1e-3 ? 1 + turn * turn / 24 : 0.5 * turn / std::sin(0.5 * turn));
}

PathFamily::Abreast met_at(const PathFace& face, geom::SurfaceEvaluator& evaluator, const CcPoint& from,
                           Point2 here, Point2 there) {
  const geom::SurfaceDerivatives d = evaluator.derivatives(there.x, there.y);
  PathFamily::Abreast out;
  out.found = face.inside(there);
  out.place = d.p;
  out.distance = distance_along(from, d.p, face.normal(d, there));
  out.left = dot(d.p - from.c, from.t()) >= 0;
  if (out.found) return out;
  // A path may lie on the border itself: a look from just inside of it.
  constexpr double kInside = 1e-6;
  double in = 0, outside = 1;
  if (face.inside(lerp(here, there, 1 - kInside))) in = 1 - kInside;
  for (int i = 0; i < 30 && outside - in > kInside; ++i) {
    const double x = 0.5 * (in + outside);
    (face.inside(lerp(here, there, x)) ? in : outside) = x;
  }
  out.border = in * out.distance;
  return out;
}

}  // namespace detail
}  // namespace burin::orient
