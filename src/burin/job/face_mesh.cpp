// SPDX-License-Identifier: Apache-2.0
#include "burin/job/face_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "burin/geom/surface/tessellate.h"

namespace burin::job {

using geom::Mesh;

void append(Mesh& to, const Mesh& mesh) {
  const auto base = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const auto& t : mesh.triangles) to.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

namespace {

/// Steps of the deflection when there would be too many triangles: the number falls with its inverse, or
/// more slowly.
constexpr double kMargin = 1.05, kTowards = 0.8;
constexpr double kCoarsest = 1e6;  ///< mm: fewer triangles do not come from more

std::string face_text(int number) {
  return "face " + std::to_string(number);
}

Error of_face(Error error, const orient::DesignFace& face) {
  error.where.entity = face_text(face.number);
  return error;
}

}  // namespace

Result<double> add_faces(const std::vector<orient::DesignFace>& faces, double wanted, std::size_t most,
                         Mesh& mesh) {
  std::vector<geom::Tessellator> tessellators;
  for (const orient::DesignFace& face : faces) {
    auto tessellator = geom::Tessellator::make(face.surface, face.trims);
    if (!tessellator) return of_face(tessellator.error(), face);
    tessellators.push_back(*std::move(tessellator));
  }
  double deflection = wanted, reached = 0;
  for (;;) {
    double total = 0;
    for (const auto& tessellator : tessellators) total += tessellator.triangles(deflection);
    if (!(total > double(most))) break;
    const double next = deflection * std::max(kMargin, kTowards * total / double(most));
    if (!std::isfinite(next) || !(next < kCoarsest))
      return Error{ErrorCode::range,
                   "too many faces or pieces of them for " + std::to_string(most) + " triangles",
                   {}};
    deflection = next;
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    auto part = tessellators[i].build(faces[i].reversed, {deflection, 0, most});
    if (!part) return of_face(part.error(), faces[i]);
    append(mesh, part->mesh);
    reached = std::max(reached, part->deflection_mm);
  }
  return reached;
}

}  // namespace burin::job
