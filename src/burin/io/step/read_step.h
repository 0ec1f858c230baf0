// SPDX-License-Identifier: Apache-2.0
// STEP and IGES through OpenCASCADE: bytes -> faces as NURBS with their trimming curves. The only folder that
// touches OpenCASCADE; -DBURIN_STEP=OFF leaves it out (both functions then return unsupported). mm whatever
// the file's unit.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::io {

/// A closed loop in the parameters of its surface, as a polygon that leaves the true trimming curve by at
/// most ReadCadOptions::trim_tolerance_mm on the surface; the last point joins the first (not repeated). The
/// outer loop runs counter-clockwise, holes clockwise.
struct TrimLoop {
  std::vector<geom::Point2> points;
};

struct CadFace {
  int number = 0;    ///< from 1, in the file's order (what --faces takes)
  std::string name;  ///< "" when the file has none
  std::string kind;  ///< "plane", "cylinder", "bspline", ...: what it was in the file
  geom::NurbsSurface surface;
  bool reversed = false;        ///< the face's outside is against Su x Sv
  bool of_solid = false;        ///< of a solid: it has an outside; otherwise an open sheet with two sides
  bool trimmed = false;         ///< false: the loops are just the surface's four sides (loops is then empty)
  std::vector<TrimLoop> loops;  ///< first the outer one(s)
  geom::Box3 box;               ///< contains the surface, closely
};

struct CadModel {
  std::string name;
  std::string unit;  ///< as the file says: "mm", "inch", "m"; everything here is in mm already
  std::vector<CadFace> faces;
  geom::Box3 bounds;
};

struct ReadCadOptions {
  std::string file_name;
  double trim_tolerance_mm = 0.005;
  /// Analytic faces become rational NURBS exactly (planes, cylinders, cones, spheres, tori, revolutions,
  /// extrusions). Only offset surfaces and the like are approximated, within this.
  double approximation_mm = 1e-4;
  std::vector<int> faces;  ///< only these; empty: all
};

/// By content (ISO-10303-21 header or IGES' start section), not by name. Errors: neither of the two (syntax),
/// damaged (syntax), no faces in it (geometry; says what it holds instead: wireframe only), a face number
/// that does not exist (usage). Faces that OpenCASCADE cannot convert: diagnostics left_out "face_left_out"
/// with the entity.
Result<CadModel> read_cad(std::string_view bytes, const ReadCadOptions& options, Diagnostics& diagnostics);

/// Triangles of the trimmed faces at a given chordal deflection, for checks and pictures. `face_of[i]` is the
/// number of the face triangle i belongs to.
struct CadMesh {
  geom::Mesh mesh;
  std::vector<std::uint32_t> face_of;
};
Result<CadMesh> mesh_cad(std::string_view bytes, const ReadCadOptions& options, double deflection_mm,
                         double angle_rad, Diagnostics& diagnostics);

/// Writes surfaces as one STEP file (AP214, mm): round trips in tests, and a way back to CAD for joined
/// surfaces.
Result<std::string> write_step(const std::vector<geom::NurbsSurface>& surfaces, const std::string& name);

}  // namespace burin::io
