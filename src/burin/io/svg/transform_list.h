// SPDX-License-Identifier: Apache-2.0
// The transform attribute and property: a list of functions -> one affine map.
#pragma once

#include <string_view>

#include "burin/base/result.h"
#include "burin/geom/vec.h"

namespace burin::io::svg {

/// matrix translate translateX translateY scale scaleX scaleY rotate skewX skewY skew, applied right to left.
/// Lengths may carry px, angles deg, rad, grad or turn (as in CSS); "" and "none" are the identity.
/// Errors: syntax, unsupported (3-D functions, other units).
Result<geom::Affine2> parse_transform(std::string_view text);

}  // namespace burin::io::svg
