// SPDX-License-Identifier: Apache-2.0
// Cutter and holder as a stack of grown cylinders (docs/tool-interference.md).
#include <cmath>

#include "burin/plan/orient/scene.h"

namespace burin::orient {

std::vector<BodyPiece> tool_body(const model::Mill& mill, double tolerance_mm, double clearance_mm) {
  std::vector<BodyPiece> out;
  const double r = mill.kind == model::MillKind::flat ? 0 : mill.corner_radius, tol = tolerance_mm;
  // What is left when the tolerance is taken off all around but at the top, where the holder begins.
  if (tol < mill.radius && tol < mill.length) {
    if (r > tol) {
      // The corner: a disc grown by a ball; the side above it. Together they are the body itself, which one
      // grown cylinder up to the top would leave there.
      out.push_back({mill.radius - r, r, r, r - tol, Cause::gouge});
      if (mill.length > r) out.push_back({mill.radius - tol, r, mill.length, 0, Cause::gouge});
    } else {
      out.push_back({mill.radius - tol, tol, mill.length, 0, Cause::gouge});
    }
  }
  double at = mill.length;
  for (const model::HolderPiece& piece : mill.holder) {
    out.push_back({piece.radius, at, at + piece.height, clearance_mm, Cause::collision});
    at += piece.height;
  }
  return out;
}

}  // namespace burin::orient
