// SPDX-License-Identifier: Apache-2.0
#include "burin/view/cspace_contours.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace burin::view {
namespace {

using orient::AngleRange;
using orient::Angles;

constexpr int kBisections = 60;
constexpr int kYaws = 480;  ///< steps of a contour over the whole range of yaws
constexpr std::size_t kMostLevels = 40;

/// The radius falls from the widest corner along the least tilt's yaw to the greatest tilt, and from there
/// along the greatest tilt to the farther end of the yaws: every contour crosses this way once.
struct Way {
  AngleRange range;
  Angles corner;
  double along_tilt = 0, along_yaw = 0, far_yaw = 0;  ///< lengths in the picture; the end of the yaws

  Way(const AngleRange& r, double width, double height) : range(r), corner(r.widest()), along_tilt(width) {
    far_yaw = r.beta_hi - corner.beta > corner.beta - r.beta_lo ? r.beta_hi : r.beta_lo;
    const double span = r.beta_hi - r.beta_lo;
    along_yaw = span > 0 ? std::abs(far_yaw - corner.beta) / span * height : 0;
  }
  double length() const { return along_tilt + along_yaw; }
  Angles at(double s) const {
    if (s <= along_tilt)
      return {range.alpha_lo + (range.alpha_hi - range.alpha_lo) * (s / along_tilt), corner.beta};
    return {range.alpha_hi, corner.beta + (far_yaw - corner.beta) * ((s - along_tilt) / along_yaw)};
  }
};

/// Where a falling function passes the value, between lo and hi.
double crossing(const std::function<double(double)>& f, double value, double lo, double hi) {
  for (int k = 0; k < kBisections; ++k) {
    const double mid = (lo + hi) / 2;
    (f(mid) > value ? lo : hi) = mid;
  }
  return (lo + hi) / 2;
}

}  // namespace

std::vector<double> contour_levels(const AngleRange& range, const model::Mill& mill, double width,
                                   double height, double gap) {
  std::vector<double> levels, places;
  if (!(range.alpha_hi > range.alpha_lo) || !(width > 0)) return levels;
  const Way way(range, width, height);
  const auto rho = [&](double s) { return effective_radius(way.at(s), mill); };
  // Not at the very corners: there a contour has no length (and at no tilt no end).
  const double most = rho(gap / 2), least = std::max(rho(way.length() - gap / 3), most * 1e-6);
  if (!(most > least) || !std::isfinite(most)) return levels;
  const std::vector<std::vector<double>> rounds{{1}, {2, 5}, {1.5, 3, 7}};
  for (const auto& factors : rounds) {
    for (double ten = std::pow(10, std::floor(std::log10(least))); ten <= most; ten *= 10) {
      for (const double factor : factors) {
        const double level = factor * ten;
        if (level > most || level < least || levels.size() >= kMostLevels) continue;
        const double s = crossing(rho, level, 0, way.length());
        if (std::any_of(places.begin(), places.end(), [&](double p) { return std::abs(p - s) < gap; }))
          continue;
        levels.push_back(level);
        places.push_back(s);
      }
    }
  }
  std::sort(levels.begin(), levels.end(), std::greater<>());
  return levels;
}

std::vector<std::vector<Angles>> contour_of(double rho, const AngleRange& range, const model::Mill& mill) {
  // Tilts beyond the range count as such, so that the borders can be bisected for.
  const auto tilt = [&](double beta) { return orient::contour_tilt(rho, beta, mill); };
  const auto inside = [&](double beta) {
    const auto a = tilt(beta);
    return a && *a >= range.alpha_lo && *a <= range.alpha_hi;
  };
  const auto end_between = [&](double in, double out) {
    for (int k = 0; k < kBisections; ++k) {
      const double mid = (in + out) / 2;
      (inside(mid) ? in : out) = mid;
    }
    return Angles{*tilt(in), in};
  };
  std::vector<std::vector<Angles>> pieces;
  bool before = false;
  double last = range.beta_lo;
  for (int k = 0; k <= kYaws; ++k) {
    const double beta =
        k < kYaws ? range.beta_lo + (range.beta_hi - range.beta_lo) * k / kYaws : range.beta_hi;
    const bool now = inside(beta);
    if (now && !before) {
      pieces.emplace_back();
      if (k > 0) pieces.back().push_back(end_between(beta, last));
    }
    if (now) pieces.back().push_back({*tilt(beta), beta});
    if (!now && before) pieces.back().push_back(end_between(last, beta));
    before = now;
    last = beta;
  }
  return pieces;
}

}  // namespace burin::view
