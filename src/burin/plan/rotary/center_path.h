// SPDX-License-Identifier: Apache-2.0
// From contact points to places of the ball: tool-size interference (TSI) resolved, then as few points as the
// tolerance allows (SSI). Suh & Lee 2.1, 2.2, 3.1. mm.
//   C = S + R n
#pragma once

#include <cstddef>
#include <vector>

#include "burin/geom/mesh/mesh_index.h"
#include "burin/plan/rotary/part.h"

namespace burin::rotary {

enum class State { ok, moved, unreachable };

/// A place of the ball: center = contact.p + R contact.n. `moved`: the ball could not touch at the planned CC
/// point and stands where it touches (contact is that place) without gouging; `excess_mm` is what is left at
/// the planned CC points it stands for.
struct Place {
  Contact contact;
  geom::Point3 center;
  State state = State::ok;
  double excess_mm = 0;
};

struct CenterPath {
  std::vector<Place> places;
  bool closed = false;
};

enum class Tsi { surface, path };

struct TsiOptions {
  Tsi method = Tsi::surface;
  double radius = 0;
  double tolerance_mm = 0.01;  ///< the ball may sink in by at most half of this here
  double deflection_mm = 0;    ///< of the mesh from the part: included in that half
};
struct TsiResult {
  CenterPath path;              ///< dense, gouge-free for `surface`
  std::size_t interfering = 0;  ///< contact points at which the ball would gouge (`surface`) or that the
                                ///< paper's procedure 2 removes (`path`)
  std::size_t moved = 0;
  double excess_max_mm = 0;
};
/// surface: the ball against the whole mesh. Where it gouges, the stretch is replaced by the way from the
/// last good place to the next on which the ball rolls over what stopped it (straight, pushed out of the part
/// to touch). Contacts that are left uncut are said by excess_mm. path: procedure 2 of the paper (curvature
/// along the path above 1/R, loops of the offset path in the plane of the path); points are removed, nothing
/// else is looked at.
TsiResult resolve_tsi(const ContactPath& path, const geom::MeshIndex& part, const TsiOptions& options);

struct SsiResult {
  std::vector<Place> points;  ///< of the places, as few as the tolerance allows; ends are kept
  /// Where on the path each point stands: number of the dense place before it, and the part of the way to the
  /// next one. Ascending; on a closed path it goes on over the number of places.
  std::vector<double> at;
  double error_max_mm = 0;         ///< largest error of a step
  std::size_t split = 0;           ///< steps halved by the paper's procedure 1 on this path
  std::size_t halving_points = 0;  ///< CL points it would take
};
/// Errors of a step: eq. 2 (overcut) and eq. 3 (undercut) for all CC points between its ends, not only the
/// middle one. The longest step within the tolerance, from the start that needs the fewest (closed paths).
SsiResult thin(const CenterPath& path, double radius, double tolerance_mm);

}  // namespace burin::rotary
