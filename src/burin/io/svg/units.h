// SPDX-License-Identifier: Apache-2.0
// Lengths with units, viewBox and preserveAspectRatio.
#pragma once

#include <optional>
#include <string_view>

#include "burin/geom/vec.h"

namespace burin::io::svg {

enum class Unit { number, px, pt, pc, mm, cm, in, q, em, ex, percent };

struct Length {
  double value = 0;
  Unit unit = Unit::number;
  /// mm, cm, in, pt, pc, Q: has a size without knowing the resolution.
  bool physical() const;
};

/// "12", "1.5mm", "50%"; nothing when it is anything else. Surrounding blanks are allowed, units in any case.
std::optional<Length> parse_length(std::string_view text);

/// mm of a physical length; of px, a plain number, em (16 px) and ex (8 px) at `px_per_inch`.
/// Precondition: not a percentage.
double length_mm(Length length, double px_per_inch);

/// Rectangle that percentages refer to, in user units.
struct Viewport {
  double width = 0, height = 0;
  bool known = false;
};
enum class Axis { x, y, both };

/// A length in user units (user unit = px). Nothing for a percentage of an unknown viewport.
std::optional<double> length_in_user_units(Length length, double px_per_inch, const Viewport& viewport,
                                           Axis axis);

/// transform-origin: one or two lengths or left, center, right, top, bottom, relative to the viewport (a
/// length in z is left alone). Nothing when it cannot be read.
std::optional<geom::Point2> parse_origin(std::string_view text, double px_per_inch, const Viewport& viewport);

struct ViewBox {
  double x = 0, y = 0, width = 0, height = 0;
};
/// Four numbers, width and height positive; nothing otherwise.
std::optional<ViewBox> parse_view_box(std::string_view text);

struct AspectRatio {
  bool keep = true;                     ///< false: none
  double align_x = 0.5, align_y = 0.5;  ///< 0 min, 0.5 mid, 1 max
  bool slice = false;                   ///< cover the viewport instead of fitting into it
};
/// "xMidYMid meet" and so on; the default for "" and for what cannot be read, as browsers do.
AspectRatio parse_aspect_ratio(std::string_view text);

/// The map from viewBox coordinates into the rectangle (x, y, width, height).
geom::Affine2 view_box_map(const ViewBox& box, double x, double y, double width, double height,
                           const AspectRatio& ratio);

}  // namespace burin::io::svg
