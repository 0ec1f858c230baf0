// SPDX-License-Identifier: Apache-2.0
#include "burin/job/cad_part.h"

#include "burin/io/step/read_step.h"

namespace burin::job {

namespace {

/// The faces are meshed each for itself where the file does not say that they share edges: two polylines
/// along one seam, each within a third of the deflection, and the file's own gap. Sewing may take two thirds.
constexpr double kMeshShare = 1.0 / 3, kSewShare = 2.0 / 3;
/// Neighbouring normals of curved faces: far below what make_meshed takes for an edge.
constexpr double kAngle = 0.2;

}  // namespace

Result<rotary::Part> part_from_cad(std::string_view bytes, const std::string& file_name,
                                   const rotary::PartOptions& options, Diagnostics& diagnostics) {
  const double deflection = options.deflection_mm;
  auto cad = io::mesh_cad(bytes, {.file_name = file_name}, kMeshShare * deflection, kAngle, diagnostics);
  if (!cad) return cad.error();
  rotary::PartOptions sewn = options;
  sewn.deflection_mm = kSewShare * deflection;
  auto part = rotary::make_meshed(std::move(cad->mesh), file_name, sewn, diagnostics);
  if (!part) {
    Error error = part.error();
    error.where.file = file_name;
    return error;
  }
  part->deflection_mm += kMeshShare * deflection;
  return part;
}

}  // namespace burin::job
