// SPDX-License-Identifier: Apache-2.0
// How large one user unit of the root <svg> is, and where the page lies.
#pragma once

#include <string>

#include "burin/base/result.h"
#include "burin/io/drawing/drawing.h"
#include "burin/io/svg/document.h"
#include "burin/io/svg/units.h"

namespace burin::io::svg {

struct Page {
  geom::Affine2 to_mm;      ///< user units of the root (y down) -> mm (y up)
  double px_per_inch = 96;  ///< what a px inside the drawing is worth for lengths given in mm, in, ...
  Viewport viewport;        ///< in user units
  double mm_per_unit = 1;   ///< geometric mean of both axes when preserveAspectRatio is "none"
  std::string reason;
};

/// Errors: syntax and range (sizes or viewBox that are not positive, or not readable).
Result<Page> page_of(const Document& document, const ReadOptions& options);

}  // namespace burin::io::svg
