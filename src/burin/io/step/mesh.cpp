// SPDX-License-Identifier: Apache-2.0
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopLoc_Location.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "burin/io/step/convert.h"
#include "burin/io/step/load.h"
#include "burin/io/step/read_step.h"

namespace burin::io {

using step::Loaded;

namespace {

/// Collects triangles; equal points (faces that share an edge share its points) become one vertex.
class Collector {
 public:
  explicit Collector(CadMesh& out) : out_(out) {}

  /// False when a coordinate is out of bounds.
  bool add(const TopoDS_Face& face, std::uint32_t number) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
    if (mesh.IsNull()) return true;
    const gp_Trsf& by = location.Transformation();
    std::vector<std::uint32_t> index;
    for (int i = 1; i <= mesh->NbNodes(); ++i) {
      const gp_Pnt p = mesh->Node(i).Transformed(by);
      const double largest = std::max({std::abs(p.X()), std::abs(p.Y()), std::abs(p.Z())});
      if (!(largest <= step::kMaxCoordinate)) return false;
      index.push_back(vertex({p.X(), p.Y(), p.Z()}));
    }
    const bool turned = (face.Orientation() == TopAbs_REVERSED) != by.IsNegative();
    for (int i = 1; i <= mesh->NbTriangles(); ++i) {
      int a = 0, b = 0, c = 0;
      mesh->Triangle(i).Get(a, b, c);
      if (turned) std::swap(b, c);
      const std::array<std::uint32_t, 3> t{index[static_cast<std::size_t>(a) - 1],
                                           index[static_cast<std::size_t>(b) - 1],
                                           index[static_cast<std::size_t>(c) - 1]};
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      out_.mesh.triangles.push_back(t);
      out_.face_of.push_back(number);
    }
    return true;
  }

 private:
  std::uint32_t vertex(geom::Point3 p) {
    const auto [found, is_new] =
        index_.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(out_.mesh.vertices.size()));
    if (is_new) out_.mesh.vertices.push_back(p);
    return found->second;
  }

  CadMesh& out_;
  std::map<std::tuple<double, double, double>, std::uint32_t> index_;
};

Result<void> collect(const Loaded& loaded, const ReadCadOptions& options, Diagnostics& diagnostics,
                     CadMesh& out) {
  Collector collector(out);
  for (std::size_t i = 0; i < loaded.faces.size(); ++i) {
    const auto number = static_cast<std::uint32_t>(i + 1);
    if (!options.faces.empty() && std::find(options.faces.begin(), options.faces.end(),
                                            static_cast<int>(number)) == options.faces.end())
      continue;
    const std::size_t before = out.mesh.triangles.size();
    const bool bounded = collector.add(loaded.faces[i].face, number);
    if (bounded && out.mesh.triangles.size() > before) continue;
    out.mesh.triangles.resize(before);
    out.face_of.resize(before);
    diagnostics.left_out("face_left_out",
                         "face " + std::to_string(number) + " has no triangles" +
                             (bounded ? "" : ": it reaches farther than 10 km out"),
                         {.file = options.file_name, .entity = loaded.faces[i].entity});
  }
  if (out.mesh.triangles.empty()) return Error{ErrorCode::geometry, "none of its faces can be meshed", {}};
  return {};
}

}  // namespace

Result<CadMesh> mesh_cad(std::string_view bytes, const ReadCadOptions& options, double deflection_mm,
                         double angle_rad, Diagnostics& diagnostics) {
  if (!(deflection_mm > 0) || !(angle_rad > 0) || !std::isfinite(deflection_mm) ||
      !std::isfinite(angle_rad)) {
    return Error{ErrorCode::usage, "the deflection and the angle of the mesh are not both above 0", {}};
  }
  CadMesh out;
  const auto done = step::with_occt(options, [&]() -> Result<void> {
    auto loaded = step::load(bytes, options, diagnostics);
    if (!loaded) return loaded.error();
    for (const int number : options.faces) {
      if (number < 1 || static_cast<std::size_t>(number) > loaded->faces.size()) {
        return Error{ErrorCode::usage,
                     "has no face " + std::to_string(number) + " (faces 1 to " +
                         std::to_string(loaded->faces.size()) + ")",
                     {}};
      }
    }
    constexpr bool kRelative = false, kParallel = false;
    const BRepMesh_IncrementalMesh mesher(loaded->shape, deflection_mm, kRelative, angle_rad, kParallel);
    return collect(*loaded, options, diagnostics, out);
  });
  if (!done) return done.error();
  return out;
}

}  // namespace burin::io
