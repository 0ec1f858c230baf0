// SPDX-License-Identifier: Apache-2.0
#include "burin/model/permissible.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::model {
namespace {

/// Limits interpolated between powers carry rounding of a few units in the last place; settings have four
/// digits.
constexpr double kRelativeSlack = 1e-9;

std::optional<PermissibleRange> interpolate(const std::vector<PermissibleRange>& table, double power) {
  if (table.empty() || power < table.front().power_w || power > table.back().power_w) return std::nullopt;
  const auto above =
      std::lower_bound(table.begin(), table.end(), power,
                       [](const PermissibleRange& range, double p) { return range.power_w < p; });
  if (above->power_w == power) return *above;
  const PermissibleRange& high = *above;
  const PermissibleRange& low = *(above - 1);
  const double t = (power - low.power_w) / (high.power_w - low.power_w);
  return PermissibleRange{power, low.speed_min + t * (high.speed_min - low.speed_min),
                          low.speed_max + t * (high.speed_max - low.speed_max)};
}

}  // namespace

std::optional<PermissibleRange> PermissibleRegion::at(double power_w) const {
  PermissibleRange common{power_w, 0, std::numeric_limits<double>::max()};
  for (const auto& table : tables_) {
    const auto range = interpolate(table, power_w);
    if (!range) return std::nullopt;
    common.speed_min = std::max(common.speed_min, range->speed_min);
    common.speed_max = std::min(common.speed_max, range->speed_max);
  }
  if (tables_.empty() || common.speed_min > common.speed_max * (1 + kRelativeSlack)) return std::nullopt;
  common.speed_max = std::max(common.speed_max, common.speed_min);
  return common;
}

bool PermissibleRegion::contains(double power_w, double speed_mm_min) const {
  const auto range = at(power_w);
  return range && speed_mm_min >= range->speed_min * (1 - kRelativeSlack) &&
         speed_mm_min <= range->speed_max * (1 + kRelativeSlack);
}

std::vector<double> PermissibleRegion::named_powers() const {
  std::vector<double> powers;
  for (const auto& table : tables_) {
    for (const PermissibleRange& range : table) powers.push_back(range.power_w);
  }
  std::sort(powers.begin(), powers.end());
  powers.erase(std::unique(powers.begin(), powers.end()), powers.end());
  return powers;
}

std::vector<double> PermissibleRegion::candidate_powers() const {
  const std::vector<double> named = named_powers();
  std::vector<double> powers = named;
  // Between two neighbouring named powers every limit is linear: the common range opens or closes where the
  // lower limit of one table meets the upper limit of another.
  for (std::size_t i = 0; i + 1 < named.size(); ++i) {
    for (const auto& lower : tables_) {
      for (const auto& upper : tables_) {
        const auto low0 = interpolate(lower, named[i]), low1 = interpolate(lower, named[i + 1]);
        const auto up0 = interpolate(upper, named[i]), up1 = interpolate(upper, named[i + 1]);
        if (!low0 || !low1 || !up0 || !up1) continue;
        const double gap0 = low0->speed_min - up0->speed_max, gap1 = low1->speed_min - up1->speed_max;
        if (gap0 * gap1 < 0) powers.push_back(named[i] + (named[i + 1] - named[i]) * gap0 / (gap0 - gap1));
      }
    }
  }
  return powers;
}

std::optional<std::pair<double, double>> PermissibleRegion::nearest(double power_w,
                                                                    double speed_mm_min) const {
  auto range = at(power_w);
  if (!range) {
    double best = std::numeric_limits<double>::max();
    for (const double power : candidate_powers()) {
      const auto there = at(power);
      const double change = std::abs(power - power_w);
      if (there && change < best) {
        best = change;
        range = there;
      }
    }
  }
  if (!range) return std::nullopt;
  return std::pair{range->power_w, std::clamp(speed_mm_min, range->speed_min, range->speed_max)};
}

std::vector<PermissibleRange> PermissibleRegion::table() const {
  std::vector<PermissibleRange> rows;
  for (const double power : named_powers()) {
    if (const auto range = at(power)) rows.push_back(*range);
  }
  return rows;
}

}  // namespace burin::model
