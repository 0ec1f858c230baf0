// SPDX-License-Identifier: Apache-2.0
// A part around the X axis and the contact paths on it. Part frame, mm, radians.
//   swept (A in Suh & Lee, 3.3): S(u, w) = Rot(X, theta(x)) c(u) + x e_x,  x = w * length
//   general (B): loft, CAD faces, mesh: sections with planes x = const
// Positive twist is right-handed about +X: (y, z) -> (y cos - z sin, y sin + z cos).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/curve/arc_spline.h"
#include "burin/geom/mesh/mesh.h"

namespace burin::rotary {

/// Where the section stands and how far it is turned: straight lines between stations, x ascending.
struct Station {
  double x = 0;
  double turn = 0;
};

/// One closed section, counter-clockwise (y to the right, z up), the axis strictly inside.
struct SweptSection {
  geom::ArcSpline section;
  std::vector<Station> stations;  ///< at least two; the first at x = 0
  /// Same turn per mm everywhere: what is planned on one section holds for all (Suh & Lee, 3.3 A).
  bool uniform() const;
  double turn_at(double x) const;
};

struct LoftSection {
  geom::ArcSpline section;
  double x = 0;
};

/// The part as the planner uses it.
struct Part {
  std::string name;
  /// Closed (ends may be open): what must not be cut. Counter-clockwise from outside. Leaves the design by at
  /// most `deflection_mm`.
  geom::Mesh mesh;
  std::vector<std::array<geom::Vec3, 3>> corner_normals;
  double deflection_mm = 0;
  double x_min = 0, x_max = 0;  ///< what is machined
  double radius_max = 0;        ///< largest distance from the axis
  std::optional<SweptSection> swept;
};

struct PartOptions {
  double deflection_mm = 0.002;
  double crease_rad = 0.5;  ///< edges of a mesh bent by more are corners of the part
  std::size_t max_triangles = 4'000'000;
};

/// Error (geometry): the section is open, crosses itself, does not hold the axis, is smaller than the
/// deflection; stations that do not ascend; with the place.
Result<Part> make_swept(const SweptSection& swept, const PartOptions& options);
/// Sections matched by length along them from the place at angle 0 (+Y), natural cubic splines along X.
Result<Part> make_loft(const std::vector<LoftSection>& sections, const PartOptions& options);
/// Error (geometry): holes that do not go round the axis (place and size of the first three), edges shared by
/// many, a part whose axis runs outside.
Result<Part> make_meshed(geom::Mesh mesh, const std::string& name, const PartOptions& options,
                         Diagnostics& diagnostics);

// --- contact paths

/// A CC point: place on the part, outward unit normal, and where it is on the part: u along the section (0 ..
/// 1, by length from the section's start), w along X (0 .. 1).
struct Contact {
  geom::Point3 p;
  geom::Vec3 n;
  double u = 0, w = 0;
};

/// Contact points so dense that straight lines between them (and normals turned evenly) leave the ball's
/// centre path by less than the density asked for. At a convex edge of the part the point stands and the
/// normal turns; at a concave one two points at the same place have the two normals.
struct ContactPath {
  std::vector<Contact> points;
  bool closed = false;  ///< the last joins the first (not repeated)
};

enum class Pattern { rings, spiral, lines };

struct PatternOptions {
  Pattern pattern = Pattern::rings;
  double ball_radius = 0;
  /// Largest cusp between neighbouring paths; or the side step itself (on the surface, at most).
  double scallop = 0.05;
  std::optional<double> side_step;
  double density_mm = 1e-4;  ///< see ContactPath
  std::size_t max_paths = 100'000, max_points = 50'000'000;
};

struct PatternResult {
  std::vector<ContactPath> paths;  ///< in cutting order
  double side_step_min = 0, side_step_max = 0;
  double scallop_max = 0;  ///< cusp expected from curvature across the paths
};

/// rings: x = const, from x_min to x_max, as far apart as the cusp allows at the worst place between them;
/// spiral: one open path that climbs by a ring's step per turn, with a full ring at either end; lines: along
/// X at constant u, in zigzag; on a twisted part, where lines end at a slant, a ring at either end besides.
/// Error (range): more paths or points than allowed, with the scallop that would
/// do.
Result<PatternResult> make_paths(const Part& part, const PatternOptions& options, Diagnostics& diagnostics);

}  // namespace burin::rotary
