// SPDX-License-Identifier: Apache-2.0
// Report of a surface program: one self-contained page. Text out; no files.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/geom/surface/join.h"
#include "burin/plan/cycle/cycle.h"
#include "burin/servo/measure.h"

namespace burin::view {

/// One machining of a group of surfaces.
struct CycleGroup {
  std::vector<geom::NurbsSurface> patches;  ///< as the program gives them
  std::vector<std::string> patch_names;     ///< "N10"
  const geom::Composite* composite = nullptr;
  const cycle::SurfacePlan* plan = nullptr;
  geom::Vec3 displacement;
  std::string title;  ///< "G106.2 I2 E1, N10 to N90"
};

struct CyclePicture {
  std::string title;
  std::string command_line;
  std::vector<CycleGroup> groups;
  const std::vector<servo::Setpoint>* setpoints = nullptr;  ///< of the whole program
  double period_s = 0.001;
  double commanded_feed_mm_min = 0;
  double scallop_mm = 0;  ///< S, drawn as the limit
  const Diagnostics* diagnostics = nullptr;
  /// Rows of the table of figures: {group, name, value with unit}.
  struct Figure {
    std::string group, name, value;
  };
  std::vector<Figure> figures;
  std::string nc_text;  ///< the program that was read; listed
};

/// One page without network, light and dark: the patches before and the surfaces after joining (shaded, own
/// colours, joints drawn), the tool path over them in 3-D (drag to turn, wheel to zoom; canvas or WebGL, no
/// library) coloured by pass, feed, scallop, lift or kind; feed, acceleration and scallop along the path as
/// charts with units, linked with the picture (hover shows the place); tables of figures, joints, passes;
/// warnings with places to click.
std::string cycle_html(const CyclePicture& picture);

}  // namespace burin::view
