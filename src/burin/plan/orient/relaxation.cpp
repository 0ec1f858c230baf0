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
constexpr int kMostRises = 100;

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
  places_.push_back({dot(q, at_->f), dot(q, at_->t()), dot(q, at_->n), piece.radius,
                     piece.radius * piece.radius, piece.from, piece.to, piece.grow, piece.radius <= wide_});
  return true;
}

bool Relaxation::inside(const Place& place, const AtYaw& q, double sa, double ca) const {
  // The tool's axis passes the plane of the tube's centres at (R - r) (n sin(alpha) - d cos(alpha)).
  const double h = place.n * ca + q.d * sa + corner_;
  const double x = place.n * sa - q.d * ca - wide_;
  const double out2 = x * x + q.e2;
  if (place.grow <= 0) return out2 < place.radius2 && place.from < h && h < place.to;
  const double dh = std::max({0.0, place.from - h, h - place.to});
  if (dh >= place.grow) return false;
  if (out2 <= place.radius2) return true;
  const double dr = std::sqrt(out2) - place.radius;
  return dr * dr + dh * dh < place.grow * place.grow;
}

bool Relaxation::newest_blocks(const Angles& angles) const {
  if (places_.empty()) return false;
  const double beta = angles.alpha > kNoTilt ? angles.beta : 0;
  const Place& place = places_.back();
  return inside(place, at_yaw(place, std::sin(beta), std::cos(beta)), std::sin(angles.alpha),
                std::cos(angles.alpha));
}

std::optional<std::size_t> Relaxation::blocked(const Angles& angles) const {
  const double beta = angles.alpha > kNoTilt ? angles.beta : 0;
  const double sb = std::sin(beta), cb = std::cos(beta), sa = std::sin(angles.alpha),
               ca = std::cos(angles.alpha);
  for (std::size_t i = places_.size(); i-- > 0;) {
    if (!inside(places_[i], at_yaw(places_[i], sb, cb), sa, ca)) continue;
    ++uses_[i];
    return i;
  }
  return std::nullopt;
}

Relaxation::Reach Relaxation::blocked_from(double beta, double from, double to) const {
  double alpha = from;
  if (alpha <= kNoTilt && beta != 0) {
    // Lying in the tangent plane the tool has no yaw: that pose is asked for itself.
    if (!blocked({alpha, 0})) return {alpha, false};
    if (to <= 2 * kNoTilt) return {to, true};
    alpha = 2 * kNoTilt;
  }
  const double sb = std::sin(beta), cb = std::cos(beta);
  yaw_.clear();
  for (const Place& place : places_) yaw_.push_back(at_yaw(place, sb, cb));
  const double sin_to = std::sin(to), cos_to = std::cos(to);
  for (int rises = 0; rises < kMostRises; ++rises) {
    const double sa = std::sin(alpha), ca = std::cos(alpha);
    holding_.clear();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (!inside(places_[i], yaw_[i], sa, ca)) continue;
      if (places_[i].simple && inside(places_[i], yaw_[i], sin_to, cos_to)) {
        ++uses_[i];
        return {to, true};
      }
      holding_.push_back(i);
    }
    if (holding_.empty()) return {alpha, false};
    const double before = alpha;
    for (const std::size_t i : holding_) {
      if (places_[i].simple) continue;
      const double until = scene_->blocked_until(witnesses_[i], *at_, beta, before, to);
      if (until <= alpha) continue;
      ++uses_[i];
      alpha = until;
      if (alpha >= to && inside(places_[i], yaw_[i], sin_to, cos_to)) return {to, true};
    }
    // How far those that block here reach: halving the way to where none did.
    for (double end = to; end - alpha > kTiltStep;) {
      const double middle = (alpha + end) / 2, sm = std::sin(middle), cm = std::cos(middle);
      const auto reaching = std::find_if(holding_.begin(), holding_.end(), [&](std::size_t i) {
        return places_[i].simple && inside(places_[i], yaw_[i], sm, cm);
      });
      if (reaching == holding_.end()) {
        end = middle;
      } else {
        ++uses_[*reaching];
        alpha = middle;
      }
    }
    if (alpha == before) return {alpha, false};
  }
  return {alpha, false};
}

}  // namespace burin::orient
