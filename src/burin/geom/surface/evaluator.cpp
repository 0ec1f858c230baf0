// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/evaluate.h"

namespace burin::geom {

struct SurfaceEvaluator::State {
  NurbsSurface surface;
};

SurfaceEvaluator::SurfaceEvaluator(const NurbsSurface& surface)
    : state_(std::make_unique<State>(State{surface})) {}
SurfaceEvaluator::~SurfaceEvaluator() = default;
SurfaceEvaluator::SurfaceEvaluator(const SurfaceEvaluator& o) : state_(std::make_unique<State>(*o.state_)) {}
SurfaceEvaluator& SurfaceEvaluator::operator=(const SurfaceEvaluator& o) {
  if (this != &o) state_ = std::make_unique<State>(*o.state_);
  return *this;
}
SurfaceEvaluator::SurfaceEvaluator(SurfaceEvaluator&&) noexcept = default;
SurfaceEvaluator& SurfaceEvaluator::operator=(SurfaceEvaluator&&) noexcept = default;

Point3 SurfaceEvaluator::point(double u, double v) {
  return geom::point(state_->surface, u, v);
}
SurfaceDerivatives SurfaceEvaluator::derivatives(double u, double v, Side side_u, Side side_v) {
  return geom::derivatives(state_->surface, u, v, side_u, side_v);
}
SurfaceDerivatives3 SurfaceEvaluator::derivatives3(double u, double v, Side side_u, Side side_v) {
  return geom::derivatives3(state_->surface, u, v, side_u, side_v);
}

void SurfaceEvaluator::iso_points(Direction moving, double fixed, std::span<const double> parameters,
                                  std::span<Point3> out) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    out[i] = moving == Direction::u ? point(parameters[i], fixed) : point(fixed, parameters[i]);
  }
}
void SurfaceEvaluator::iso_derivatives(Direction moving, double fixed, std::span<const double> parameters,
                                       std::span<SurfaceDerivatives> out) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    out[i] = moving == Direction::u ? derivatives(parameters[i], fixed) : derivatives(fixed, parameters[i]);
  }
}
void SurfaceEvaluator::points(std::span<const Point2> uv, std::span<Point3> out) {
  for (std::size_t i = 0; i < uv.size(); ++i) out[i] = point(uv[i].x, uv[i].y);
}
void SurfaceEvaluator::derivatives(std::span<const Point2> uv, std::span<SurfaceDerivatives> out) {
  for (std::size_t i = 0; i < uv.size(); ++i) out[i] = derivatives(uv[i].x, uv[i].y);
}

}  // namespace burin::geom
