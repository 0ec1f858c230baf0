// SPDX-License-Identifier: Apache-2.0
// What must not touch: shank and holder against part and obstacles on every move, the cutter against
// obstacles on every move and against the part on rapids (what it takes out of the part when feeding is the
// deviation's matter). Proven like check_mill: nothing is sampled. Against the stock as it is at that moment:
// burin/removal. mm. docs/verify.md
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/verify/path.h"

namespace burin::verify {

enum class Body { cutter, shank, holder };
enum class Against { part, stock, obstacle };
std::string_view name(Body body);
std::string_view name(Against against);

struct Collision {
  std::uint32_t move = 0;  ///< GOTO number
  Body body = Body::cutter;
  Against against = Against::part;
  double depth_mm = 0;  ///< distance of the deepest place to the surface of the body
  geom::Point3 at;
};

struct CollisionOptions {
  double tolerance_mm = 0.01;  ///< less deep is none
  double resolution_mm = 0.001;
  unsigned threads = 1;  ///< 0: as many as there are; the result is the same for any number
  /// The deepest are kept, in the order of the moves; chosen by a first look that sees at least nine tenths
  /// of each depth.
  std::size_t max_listed = 10'000;
};
struct CollisionReport {
  std::vector<Collision> collisions;  ///< one a move, body and counterpart: the deepest
  std::size_t count = 0;              ///< of all, listed or not
  /// Every move, body and counterpart deeper than the tolerance by this is among them, and none listed is
  /// deeper than it says by more. The deflection of the triangles comes on top. Wider than the resolution and
  /// the motion together only where very many are deep.
  double bound_mm = 0;
};
/// `obstacles` may be empty. A body wholly inside a solid meets no triangle: the move that brings it there is
/// found. Errors: of tool, options, motion and triangles as check_mill; what `progress` stops (usage).
Result<CollisionReport> find_collisions(const geom::Mesh& part, const geom::Mesh& obstacles,
                                        const CheckedPath& path, const CollisionOptions& options,
                                        ProgressSink* progress = nullptr);

}  // namespace burin::verify
