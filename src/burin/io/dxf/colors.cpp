// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/colors.h"

#include <array>
#include <cmath>

namespace burin::io::dxf {
namespace {

std::uint32_t rgb(int r, int g, int b) {
  return static_cast<std::uint32_t>(r) << 16 | static_cast<std::uint32_t>(g) << 8 |
         static_cast<std::uint32_t>(b);
}

// One channel of a fully saturated colour at `hue` (degrees), 0..1.
double channel(double hue, double peak) {
  const double away = std::abs(std::remainder(hue - peak, 360.0));
  return away <= 60 ? 1 : away >= 120 ? 0 : (120 - away) / 60;
}

}  // namespace

std::uint32_t indexed_color(int index) {
  constexpr std::array<std::uint32_t, 10> kFirst = {0x000000, 0xFF0000, 0xFFFF00, 0x00FF00, 0x00FFFF,
                                                    0x0000FF, 0xFF00FF, 0x000000, 0x414141, 0x808080};
  constexpr std::array<std::uint32_t, 6> kGreys = {0x333333, 0x505050, 0x696969,
                                                   0x828282, 0xBEBEBE, 0xFFFFFF};
  if (index < 0 || index > 255) return 0;
  if (index < 10) return kFirst[static_cast<std::size_t>(index)];
  if (index >= 250) return kGreys[static_cast<std::size_t>(index - 250)];
  // 10..249: 24 hues of 15 degrees; in each, 5 values from light to dark, odd ones half saturated.
  constexpr std::array<int, 5> kValues = {255, 165, 127, 76, 38};
  const int sector = index / 10 - 1;
  const double hue = sector * 15.0;
  const int value = kValues[static_cast<std::size_t>(index % 10 / 2)];
  const double floor = index % 2 != 0 ? 0.5 : 0.0;
  const auto of = [&](double peak) {
    return static_cast<int>(value * (floor + (1 - floor) * channel(hue, peak)));
  };
  return rgb(of(0), of(120), of(240));
}

}  // namespace burin::io::dxf
