// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/relaxation.h"

#include <algorithm>
#include <cmath>

namespace burin::orient {
namespace {

using geom::Vec3;

// More would cost more than they save; those that matter at one contact point are a handful.
constexpr std::size_t kMostWitnesses = 96;
// Rises of the tilt at one yaw before the bound is taken as it is: it stays a bound.
constexpr int kMostRises = 200;
// rad; a witness' interval is left by at least this, so that rounding at its end cannot hold the walk.
constexpr double kLeastRise = 1e-12;

}  // namespace

Relaxation::Relaxation(const Scene& scene, const CcPoint& at)
    : scene_(&scene),
      at_(&at),
      corner_(scene.mill().kind == model::MillKind::flat ? 0 : scene.mill().corner_radius),
      wide_(scene.mill().radius - corner_) {}

bool Relaxation::add(const Witness& witness) {
  if (witnesses_.size() >= kMostWitnesses || witness.piece >= scene_->body().size()) return false;
  for (const Witness& w : witnesses_)
    if (w.piece == witness.piece && w.q == witness.q) return false;
  const BodyPiece& piece = scene_->body()[witness.piece];
  const Vec3 q = witness.q - (at_->c + corner_ * at_->n);
  witnesses_.push_back(witness);
  uses_.push_back(0);
  places_.push_back({dot(q, at_->f), dot(q, at_->t()), dot(q, at_->n), piece.radius * piece.radius,
                     piece.radius, piece.from, piece.to, piece.grow, piece.grow * piece.grow});
  return true;
}

bool Relaxation::inside(const Place& place, double xd, double y2, double sa, double ca) const {
  // The tool's axis passes the plane of the tube's centres at (R - r) (n sin(alpha) - d cos(alpha)).
  const double h = place.n * ca + xd * sa + corner_;
  const double x = place.n * sa - xd * ca - wide_;
  const double rho2 = x * x + y2;
  if (place.grow2 <= 0) return rho2 < place.radius2 && place.from < h && h < place.to;
  const double dh = std::max({0.0, place.from - h, h - place.to});
  if (dh >= place.grow) return false;
  if (rho2 <= place.radius2) return true;
  const double dr = std::sqrt(rho2) - place.radius;
  return dr * dr + dh * dh < place.grow2;
}

bool Relaxation::blocks(std::size_t witness, const Angles& angles) const {
  const Place& place = places_[witness];
  const double beta = angles.alpha > kNoTilt ? angles.beta : 0;
  const double sb = std::sin(beta), cb = std::cos(beta);
  const double y = place.t * cb - place.f * sb;
  return inside(place, place.f * cb + place.t * sb, y * y, std::sin(angles.alpha), std::cos(angles.alpha));
}

std::optional<std::size_t> Relaxation::blocked_at(double beta, double alpha) const {
  const double sb = std::sin(beta), cb = std::cos(beta), sa = std::sin(alpha), ca = std::cos(alpha);
  const std::size_t count = places_.size();
  for (std::size_t k = 0, i = hot_; k < count; ++k, i = i + 1 == count ? 0 : i + 1) {
    const Place& place = places_[i];
    const double y = place.t * cb - place.f * sb;
    if (!inside(place, place.f * cb + place.t * sb, y * y, sa, ca)) continue;
    hot_ = i;
    ++uses_[i];
    return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> Relaxation::blocked(const Angles& angles) const {
  return blocked_at(angles.alpha > kNoTilt ? angles.beta : 0, angles.alpha);
}

double Relaxation::first_tilt(double beta, double from, double to) const {
  double alpha = from;
  if (alpha <= kNoTilt && beta != 0) {
    // Lying in the tangent plane the tool has no yaw: that pose is asked for itself.
    if (!blocked_at(0, alpha)) return alpha;
    alpha = 2 * kNoTilt;
  }
  for (int rises = 0; rises < kMostRises; ++rises) {
    const auto which = blocked_at(beta, alpha);
    if (!which) return alpha;
    const double until = scene_->blocked_until(witnesses_[*which], *at_, beta, alpha, to);
    alpha = std::max(until, alpha + kLeastRise);
    if (alpha >= to && blocked_at(beta, to)) return std::nextafter(to, 10.0);
    alpha = std::min(alpha, to);
  }
  return alpha;
}

}  // namespace burin::orient
