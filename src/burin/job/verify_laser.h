// SPDX-License-Identifier: Apache-2.0
// What the check of a laser program needs, from files: the outlines that a drawing asks for and the program
// that cuts them. mm. docs/verify-beam.md
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/io/drawing/drawing.h"
#include "burin/plan/laser/options.h"
#include "burin/verify/beam_check.h"

namespace burin::job {

/// As `burin laser` takes them; the defaults are the same.
struct LaserOutlineOptions {
  io::Units units = io::Units::from_file;
  std::map<std::string, laser::Treatment> layers;  ///< others are cut; engraved ones are centre lines
  /// automatic: the part by nesting; outside, inside: the part within, around every closed contour; on: all
  /// are centre lines.
  laser::Side side = laser::Side::automatic;
  double join_mm = 0.01;   ///< ends this close are joined
  double curve_mm = 2e-4;  ///< arcs may leave ellipses and splines by this
};

/// Parallel to `outlines`: what the drawing calls the first entity, for messages.
struct LaserOutlines {
  std::vector<verify::Outline> outlines;
  std::vector<std::string> names;
  double bound_mm = 0;  ///< they leave the drawn curves by at most this
};
/// Whether `file` is named like a drawing (.dxf, .svg).
bool is_drawing(std::string_view file);
/// By the name's ending. Errors: of the readers; no kind of drawing (usage).
Result<io::Drawing> read_drawing(std::string_view bytes, const std::string& file, io::Units units,
                                 Diagnostics& diagnostics);
/// Curves are joined as `burin laser` joins them (what was repaired or left out goes to `diagnostics`); which
/// side the part is on is found here. Errors: as read_drawing; an unknown layer (usage); nothing to cut
/// (geometry).
Result<LaserOutlines> read_laser_outlines(std::string_view bytes, const std::string& file,
                                          const LaserOutlineOptions& options, Diagnostics& diagnostics);
Result<LaserOutlines> make_laser_outlines(const io::Drawing& drawing, const LaserOutlineOptions& options,
                                          Diagnostics& diagnostics);
/// CL or NC, told by content; S, M3 and M4 are the beam.
Result<cl::Program> read_laser_program(std::string_view bytes, const std::string& file,
                                       Diagnostics& diagnostics);

}  // namespace burin::job
