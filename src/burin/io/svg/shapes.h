// SPDX-License-Identifier: Apache-2.0
// path, rect, circle, ellipse, line, polyline, polygon -> curves in user units of the element.
#pragma once

#include "burin/base/result.h"
#include "burin/io/svg/document.h"
#include "burin/io/svg/path_data.h"
#include "burin/io/svg/units.h"

namespace burin::io::svg {

/// What lengths of attributes refer to.
struct LengthFrame {
  double px_per_inch = 96;
  Viewport viewport;

  /// Value of the attribute in user units, `fallback` when it is absent or "auto".
  /// Errors: syntax (no length), unsupported (percentage without a page size).
  Result<double> read(const Element& element, std::string_view name, Axis axis, double fallback) const;
  /// The same for a text that is given; `name` is for messages.
  Result<double> read_text(std::string_view text, std::string_view name, Axis axis, double fallback) const;
};

bool is_shape(const Element& element);

/// Precondition: is_shape(). A shape of size zero gives no path and one dropped point. Errors: as
/// parse_path_data() and LengthFrame::read(), range (negative sizes).
Result<Outline> outline_of(const Element& element, const LengthFrame& frame, std::size_t max_curves);

}  // namespace burin::io::svg
