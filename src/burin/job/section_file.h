// SPDX-License-Identifier: Apache-2.0
// The closed section curve of a rotational part from a drawing: drawing x, y become part y, z. mm.
#pragma once

#include <string>
#include <string_view>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/curve/arc_spline.h"

namespace burin::job {

/// DXF or SVG by the name's ending; counter-clockwise; free curves fitted within `tolerance_mm`. Of several
/// contours the outermost one around the origin counts ("contours_ignored" says how many do not). Errors
/// (geometry), with the place: nothing closed ("open"), crossing itself, none around the axis; (usage): a
/// file of another kind.
Result<geom::ArcSpline> read_section(std::string_view bytes, const std::string& file_name,
                                     double tolerance_mm, Diagnostics& diagnostics);

}  // namespace burin::job
