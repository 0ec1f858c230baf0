// SPDX-License-Identifier: Apache-2.0
// Pictures of laser jobs: an SVG drawing and a self-contained HTML report. Text in, text out; no files.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/plan/laser/profile.h"
#include "burin/plan/laser/toolpath.h"

namespace burin::view {

struct LaserPicture {
  const laser::Profile* profile = nullptr;
  const laser::Toolpath* toolpath = nullptr;
  const io::Drawing* drawing = nullptr;
  double kerf_mm = 0;  ///< drawn as the width of the cut
  std::string title;
  std::string command_line;
  std::string nc_text;  ///< shown and linked with the path; may be empty
  std::vector<std::uint32_t> nc_line_to_record;
  const Diagnostics* diagnostics = nullptr;
  /// Rows of the table of figures: {group, name, value with unit}.
  struct Figure {
    std::string group, name, value;
  };
  std::vector<Figure> figures;
};

/// Outline, beam centre line, leads, pierces, rapids; arcs stay arcs; size in mm.
std::string laser_svg(const LaserPicture& picture);
/// One page without network: the drawing with zoom and pan, coloured by order, arcs against lines,
/// deviations, pierces, kerf to scale, tables, warnings with positions that can be clicked, NC listing. Light
/// and dark.
std::string laser_html(const LaserPicture& picture);

}  // namespace burin::view
