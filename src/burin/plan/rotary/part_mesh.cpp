// SPDX-License-Identifier: Apache-2.0
// A part from triangles: what is wrong with them is said with its place, what can be put right is.
#include <algorithm>
#include <cmath>
#include <utility>

#include "burin/base/text.h"
#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/edges.h"
#include "burin/geom/mesh/mesh_index.h"
#include "burin/plan/rotary/part.h"

namespace burin::rotary {

using geom::Mesh;
using geom::MeshHole;
using geom::Point3;

namespace {

/// As for CAD files: what is farther out is a wrong unit.
constexpr double kLargest = 1e7;
constexpr int kDecimals = 3;

std::string mm(double v) {
  return format_fixed(v, kDecimals);
}
std::string place(Point3 p) {
  return "(" + mm(p.x) + ", " + mm(p.y) + ", " + mm(p.z) + ")";
}
Error geometry(std::string message) {
  return {ErrorCode::geometry, std::move(message), {}};
}

Result<void> check_numbers(const Mesh& mesh, const PartOptions& options) {
  if (!(options.deflection_mm > 0) || !std::isfinite(options.deflection_mm))
    return Error{ErrorCode::usage, "the deflection must be above 0 mm", {}};
  if (mesh.triangles.empty()) return geometry("the mesh has no triangles");
  if (mesh.triangles.size() > options.max_triangles) {
    return Error{ErrorCode::range,
                 "the mesh has " + std::to_string(mesh.triangles.size()) + " triangles (" +
                     std::to_string(options.max_triangles) + " are allowed)",
                 {}};
  }
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t i : t) {
      if (i >= mesh.vertices.size())
        return geometry("the mesh has a triangle with a corner that does not exist");
      const Point3 p = mesh.vertices[i];
      if (!(std::abs(p.x) <= kLargest && std::abs(p.y) <= kLargest && std::abs(p.z) <= kLargest))
        return geometry("the mesh has a corner that is farther than 10 km out, or not a number");
    }
  }
  return {};
}

/// How often a closed line turns about the X axis, and how near it comes to it.
int turns_about_axis(const MeshHole& hole) {
  int turns = 0;
  for (std::size_t i = 0; i < hole.points.size(); ++i) {
    const Point3 a = hole.points[i], b = hole.points[(i + 1) % hole.points.size()];
    const bool up = a.z <= 0;
    if (up == (b.z <= 0)) continue;
    const Point3 lo = up ? a : b, hi = up ? b : a;
    if ((hi.y - lo.y) * (0 - lo.z) - (0 - lo.y) * (hi.z - lo.z) > 0) turns += up ? 1 : -1;
  }
  return turns;
}

/// All but the open ends: one ring round the axis at either end of the part.
std::vector<MeshHole> bad_holes(const geom::MeshReport& report, double near) {
  std::vector<MeshHole> out;
  bool low = false, high = false;
  for (const MeshHole& hole : report.holes) {
    const bool ring = std::abs(turns_about_axis(hole)) == 1;
    if (ring && !low && hole.box.lo.x <= report.bounds.lo.x + near) {
      low = true;
    } else if (ring && !high && hole.box.hi.x >= report.bounds.hi.x - near) {
      high = true;
    } else {
      out.push_back(hole);
    }
  }
  return out;
}

Error holes_error(const std::vector<MeshHole>& holes) {
  constexpr std::size_t kSaid = 3;
  std::string text =
      "the mesh has " + std::to_string(holes.size()) + (holes.size() == 1 ? " hole: " : " holes: ");
  for (std::size_t i = 0; i < std::min(kSaid, holes.size()); ++i) {
    text += (i ? ", " : "") + std::to_string(holes[i].points.size()) + " edges at " +
            place(lerp(holes[i].box.lo, holes[i].box.hi, 0.5)) + " of " + mm(holes[i].box.diagonal()) + " mm";
  }
  if (holes.size() > kSaid) text += ", ...";
  return geometry(text + " (a closed mesh; only its ends around the X axis may be open)");
}

Error many_error(const Mesh& mesh, const geom::Edges& edges) {
  std::string text = std::to_string(edges.shared_by_many) + " edges of the mesh have more than two triangles";
  for (geom::HalfEdge h = 0; h < edges.twin.size(); ++h) {
    if (edges.twin[h] != geom::kMany) continue;
    text += ", the first at " + place(lerp(mesh.vertices[from(mesh, h)], mesh.vertices[to(mesh, h)], 0.5));
    break;
  }
  return geometry(text +
                  " (two triangles to an edge: one body, not several that touch or run through each other)");
}

/// Where the X axis passes through the surface: in ascending order.
std::vector<double> axis_crossings(const Mesh& mesh) {
  std::vector<double> out;
  for (const auto& t : mesh.triangles) {
    const std::array<Point3, 3> p{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    if (turns_about_axis(MeshHole{{p[0], p[1], p[2]}, {}}) == 0) continue;
    const geom::Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
    const double x = p[0].x + (n.y * p[0].y + n.z * p[0].z) / n.x;
    const auto [lo, hi] = std::minmax({p[0].x, p[1].x, p[2].x});
    out.push_back(std::isfinite(x) ? std::clamp(x, lo, hi) : lo);
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// The axis must be inside between all places where that may change.
Result<void> check_axis(const Mesh& mesh, const std::vector<MeshHole>& ends, double x_min, double x_max,
                        double shortest) {
  std::vector<double> at = axis_crossings(mesh);
  for (const MeshHole& hole : ends) at.insert(at.end(), {hole.box.lo.x, hole.box.hi.x});
  at.insert(at.end(), {x_min, x_max});
  std::sort(at.begin(), at.end());
  const geom::MeshIndex index(mesh);
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    if (!(at[i + 1] - at[i] > shortest)) continue;
    if (index.inside({0.5 * (at[i] + at[i + 1]), 0, 0})) continue;
    return geometry("the X axis runs outside of the part from x = " + mm(at[i]) + " to " + mm(at[i + 1]) +
                    " (a part around the X axis, from x = " + mm(x_min) + " to " + mm(x_max) +
                    ", without bore)");
  }
  return {};
}

/// Turns what faces the wrong way; says so.
Result<void> orient(Mesh& mesh, Diagnostics& diagnostics) {
  const auto before = mesh.triangles;
  if (!geom::orient(mesh))
    return geometry("the mesh has only one side (a Moebius strip; a surface around a body)");
  std::size_t turned = 0;
  for (std::size_t i = 0; i < before.size(); ++i) turned += before[i] != mesh.triangles[i];
  if (turned > 0) {
    diagnostics.info("mesh_turned", std::to_string(turned) + " of " + std::to_string(before.size()) +
                                        " triangles faced inwards and are turned");
  }
  return {};
}

}  // namespace

Result<Part> make_meshed(Mesh mesh, const std::string& name, const PartOptions& options,
                         Diagnostics& diagnostics) {
  if (auto ok = check_numbers(mesh, options); !ok) return ok.error();
  mesh = geom::welded(mesh, 0);
  if (mesh.triangles.empty()) return geometry("the mesh has no triangles with three corners");
  Part part;
  part.name = name;
  if (const auto holes = bad_holes(geom::examine(mesh), options.deflection_mm); !holes.empty()) {
    Mesh closed = geom::stitched(mesh, options.deflection_mm);
    const auto left = bad_holes(geom::examine(closed), options.deflection_mm);
    if (closed.triangles.empty() || !left.empty()) return holes_error(left.empty() ? holes : left);
    mesh = std::move(closed);
    part.deflection_mm = options.deflection_mm;
    diagnostics.info("mesh_stitched", std::to_string(holes.size()) + " gaps of the mesh narrower than " +
                                          format_shortest(options.deflection_mm) + " mm are closed");
  }
  if (const geom::Edges edges = geom::find_edges(mesh); edges.shared_by_many > 0)
    return many_error(mesh, edges);
  if (auto ok = orient(mesh, diagnostics); !ok) return ok.error();
  const geom::MeshReport report = geom::examine(mesh);
  part.x_min = report.bounds.lo.x, part.x_max = report.bounds.hi.x;
  if (!(part.x_max - part.x_min > options.deflection_mm)) {
    return geometry("the part is " + mm(part.x_max - part.x_min) +
                    " mm long along X (more than the deflection, " + format_shortest(options.deflection_mm) +
                    " mm)");
  }
  if (auto ok = check_axis(mesh, report.holes, part.x_min, part.x_max, options.deflection_mm); !ok)
    return ok.error();
  for (const Point3& p : mesh.vertices) part.radius_max = std::max(part.radius_max, std::hypot(p.y, p.z));
  part.corner_normals = geom::corner_normals(mesh, options.crease_rad);
  part.mesh = std::move(mesh);
  return part;
}

}  // namespace burin::rotary
