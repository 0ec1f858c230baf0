// SPDX-License-Identifier: Apache-2.0
// Marine propellers of the Wageningen B series (Oosterveld & van Oossanen 1975; tables: data/propeller):
// blade surfaces and hub. mm; the shaft is the Z axis, blade 0's generator line lies along +X (without rake).
// Right-handed. docs/propeller.md
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::model {

enum class BladeSide { face, back };  ///< face: the pressure side

struct PropellerData {
  int blades = 5;
  double diameter = 1000;
  double pitch_ratio = 1.0;
  double area_ratio = 0.75;  ///< expanded, Ae / Ao
  double hub_ratio = 0.18;
  double rake = 0;                   ///< radians, aft: towards the side that the faces look to
  BladeSide side = BladeSide::face;  ///< to be milled: this side looks towards +Z
};
/// Error (range): blades 2 to 7, ratios beyond the series' (with what would be accepted), sizes.
Result<void> validate(const PropellerData& data);

/// The surfaces of blade 0 from the hub to `tip_radius`. All have the same parameters v, outwards, and share
/// their edges exactly.
struct Propeller {
  /// The side to be milled; u along the chord (leading to trailing edge). Su x Sv or its opposite (reversed)
  /// looks away from the blade.
  geom::NurbsSurface side;
  bool reversed = false;
  geom::NurbsSurface other_side;
  bool other_reversed = false;
  /// The rounded edges; u from the side to the other side.
  geom::NurbsSurface leading_edge, trailing_edge;
  double hub_radius = 0, tip_radius = 0;  ///< the outline's last r / R is below 1: no pole
  double hub_bottom = 0, hub_height = 0;  ///< z of its lower end; a little more than the blades' roots need
};
/// r / R = hub_ratio .. 0.975, sections interpolated between those of the tables. Error (range): validate();
/// (geometry) blades that touch each other at the hub.
Result<Propeller> make_propeller(const PropellerData& data);

/// Section at r / R: points from the leading to the trailing edge where the tables have them, (along the
/// chord from the generator line, towards the trailing edge; height from the nose-tail pitch line, towards
/// the back), of face and back. mm.
struct BladeSection {
  std::vector<geom::Point2> face, back;
  double chord = 0, leading = 0, max_thickness = 0;  ///< leading: generator line to the leading edge
  double edge_thickness = 0;                         ///< at both edges, where they are rounded
  double pitch = 0;                                  ///< mm a turn
};
BladeSection blade_section(const PropellerData& data, double radius_ratio);

/// Closed mesh of all blades but blade 0, both sides with edges and tips, within the deflection; and the hub
/// (a closed cylinder).
geom::Mesh neighbour_blades(const PropellerData& data, const Propeller& propeller, double deflection_mm);
geom::Mesh hub_mesh(const PropellerData& data, const Propeller& propeller, double deflection_mm);
/// The part of blade 0 that is not milled: other side, edges, tip, the end in the hub.
geom::Mesh blade_back(const PropellerData& data, const Propeller& propeller, double deflection_mm);

}  // namespace burin::model
