// SPDX-License-Identifier: Apache-2.0
// Ball-end paths over joined surfaces (Koo & Jee 2007): iso-parametric (I1) and iso-scallop (I2), scallop
// from the true tool positions, lifted where they would gouge, linked on the surface or over the safety
// height. See docs/surface-paths.md. mm, tip of the tool, axis +Z, part frame.
//   tip = S + (R + L) n - R k,  n = Su x Sv, turned as a whole so that n.k >= 0 in the middle of the surface
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/base/tolerance.h"
#include "burin/geom/quintic.h"
#include "burin/geom/surface/join.h"

namespace burin::cycle {

enum class Method { iso_parametric, iso_scallop };
enum class Along { u, v, automatic };

/// A loop that bounds what is machined, in the parameters of an input patch. Even-odd over all loops of a
/// patch.
struct Trim {
  std::size_t patch = 0;
  std::vector<geom::Point2> points;
};

struct PlanOptions {
  Method method = Method::iso_parametric;
  Along along = Along::automatic;
  double tool_diameter = 0;  ///< D > 0
  double stock = 0;          ///< L, left on the surface
  double scallop = 0;        ///< S > 0, over the surface with its stock
  std::optional<double> side_step;
  double safety_z = 0;
  double tolerance_mm = 0.01;  ///< lifting begins when the ball would go deeper than this
  /// Distance of the quintic path from the exact tool path, at most.
  double path_mm = 1e-6;
  std::size_t max_paths = 200'000;  ///< more are refused with what would be accepted
  unsigned threads = 1;             ///< the plan does not depend on it
};

enum class MotionKind : std::uint8_t {
  rapid,   ///< straight, at rapid speed
  plunge,  ///< straight, at the feed: down onto the surface
  cut,     ///< a path on the surface
  link,    ///< from one path to the next, on or above the surface, at the feed
};

/// A stretch of motion; each starts where the one before ended.
struct Motion {
  MotionKind kind = MotionKind::cut;
  geom::QuinticPath path;  ///< of the tip
  /// Surface parameters along `path` (cut and link on the surface): one node of (u, v, 0) for each node of
  /// path, the same t; empty otherwise.
  geom::QuinticPath uv;
  int surface = -1;  ///< index of the joined surface; -1: none
  /// Number of the path on that surface, from 0; also of the links by which it runs over the edges. -1 for
  /// links between paths and for rapids.
  int pass = -1;
  double lift_max = 0;  ///< how far it was lifted above the surface at most
};

/// What the planner found about two neighbouring paths, where the ball fits the surface (no figures where it
/// fits nowhere between two).
struct PassFigures {
  int surface = 0, pass = 0;  ///< between pass - 1 and pass
  double scallop_min = 0, scallop_max = 0;
  double side_step_max = 0;  ///< distance on the surface
  bool last = false;         ///< ends at the border: narrower than it could be
  bool side_step_binds = false;
};

struct SurfacePlan {
  std::vector<Motion> motions;  ///< from the approach to the retract, of all surfaces of the group
  std::vector<PassFigures> figures;
  Along along = Along::u;  ///< direction the paths run in (the first surface's)
  std::size_t paths = 0;   ///< passes
  std::size_t lifted = 0;  ///< paths that had to be lifted somewhere
  double lift_max_mm = 0;
  /// Deepest gouge that was left (below tolerance_mm), mm.
  double gouge_max_mm = 0;
  double cut_mm = 0, link_mm = 0, rapid_mm = 0;
};

/// `start`: where the tool stands. Plans all surfaces of the composite, one after the other; the composite as
/// a whole is what must not be gouged. Errors (usage, geometry): D or S not positive, S >= R, a safety height
/// below the highest tip (says it), surfaces whose normal has no side (n.k = 0 in the middle and around), too
/// many paths. Diagnostics: "lifted" with place and height (info), "surface_steep" ...
Result<SurfacePlan> plan(const geom::Composite& composite, const std::vector<Trim>& trims, geom::Point3 start,
                         const PlanOptions& options, Diagnostics& diagnostics);

/// The rapids from where the tool stands to `to`, never below `safety_z` before the last of them: up first,
/// and down only over the place. A start above the safety height is kept until then.
std::vector<Motion> approach(geom::Point3 from, geom::Point3 to, double safety_z);

}  // namespace burin::cycle
