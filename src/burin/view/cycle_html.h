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
  /// Of a repeat. Patches and composite are without it, plan and setpoints with it.
  geom::Vec3 displacement;
  std::string title;            ///< "G106.2 I2 E1, N10 to N90"
  double tool_diameter_mm = 0;  ///< the cutter that is drawn; 0: a mark without size
  double stock_mm = 0;
  double feed_mm_min = 0;  ///< 0: that of the picture
  double scallop_mm = 0;   ///< 0: that of the picture
};

struct CyclePicture {
  std::string title;
  std::string command_line;
  std::vector<CycleGroup> groups;
  /// Of the whole program, in the order of the groups; `surface` counts over all different composites (or in
  /// its group). Without them the motions of the plans are drawn and there are no charts over time.
  const std::vector<servo::Setpoint>* setpoints = nullptr;
  double period_s = 0.001;
  double commanded_feed_mm_min = 0;
  double scallop_mm = 0;         ///< S, drawn as the limit
  double accel_limit_mm_s2 = 0;  ///< of an axis, drawn as the limit; 0: not drawn
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
///
/// The size is bounded whatever the picture holds (below about 6 MB): surfaces are sampled, setpoints thinned
/// out within tolerances that are stated on the page (extremes stay), long programs cut. The same picture
/// gives the same bytes.
std::string cycle_html(const CyclePicture& picture);

}  // namespace burin::view
