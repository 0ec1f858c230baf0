// SPDX-License-Identifier: Apache-2.0
// What the tool may not run into, and whether it does: triangles of design and obstacles in a tree of
// oriented boxes, against a stack of cylinders about the tool axis (docs/tool-interference.md). mm, radians,
// part frame.
//
// 1. Exact: a pose is blocked exactly when some triangle comes nearer to some piece than its `grow` (grow 0:
//    when it has a point strictly inside the cylinder), up to rounding, 1e-9 mm per metre of coordinates.
// 2. Answers are functions of the arguments; Memory changes speed only (and which of several blockers is
//    named).
// 3. Immutable after construction: any number of threads may ask, each with a Memory of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/geom/vec.h"
#include "burin/model/tool.h"
#include "burin/plan/orient/cause.h"
#include "burin/plan/orient/tool_angles.h"

namespace burin::orient {

/// Solid cylinder about the tool axis, heights above the tip centre, grown by a ball: a triangle nearer than
/// `grow` blocks.
struct BodyPiece {
  double radius = 0, from = 0, to = 0, grow = 0;
  Cause cause = Cause::gouge;
};
/// The cutting body less the tolerance (nothing of the part may be deeper inside), then the holder's pieces
/// grown by the clearance. A flat end: radius R - tol from tol to length; a bull nose: the disc R - r at
/// height r, grown by r - tol, and radius R - tol from r to length. Gouging pieces stand first. A tolerance
/// of the whole body leaves no cutter piece.
std::vector<BodyPiece> tool_body(const model::Mill& mill, double tolerance_mm, double clearance_mm);

struct Blocker {
  std::uint32_t triangle = 0;
  std::uint8_t piece = 0;
  bool operator==(const Blocker&) const = default;
};

/// A place of the part that stood in the way, kept to rule out whole ranges of angles without asking the
/// tree.
struct Witness {
  geom::Point3 q;
  std::uint8_t piece = 0;
};

class Scene {
 public:
  /// Triangles of `mesh` (any soup; degenerate ones count as what they are: segments, points). Error-free:
  /// coordinates are checked where meshes are read. `mill` and `body` belong together (tool_body, or pieces
  /// of a caller's own; from the 255th on they become one that holds them).
  Scene(const geom::Mesh& mesh, const model::Mill& mill, std::vector<BodyPiece> body);
  /// The same triangles and mill with another body; shares the tree.
  Scene(const Scene& same_part, std::vector<BodyPiece> body);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// The last blockers, tried first. Fresh for each path, so that counts do not depend on threads.
  struct Memory {
    std::array<Blocker, 4> last{};
    int count = 0;
    std::uint64_t tests = 0;  ///< poses put to the tree; each walk of first_free counts as one
  };

  /// Some triangle that blocks, nothing when the pose is free.
  std::optional<Blocker> blocker(const cl::Pose& pose, Memory& memory) const;
  /// none, gouge or collision; gouge when both.
  Cause cause(const cl::Pose& pose, Memory& memory) const;

  struct FirstFree {
    double alpha = 0;
    bool found = false;  ///< false: blocked up to the end; alpha is then `to`
    /// What blocks just below alpha (or at the end): nothing when `from` itself is free.
    std::optional<Witness> witness;
    Cause cause = Cause::none;
  };
  /// The smallest tilt in [from, to] at which the pose at this yaw is free, within 1e-9 rad from above (it is
  /// free as returned). Gaps narrower than kLeastGap between two blocked intervals may be passed over.
  FirstFree first_free(const CcPoint& at, double beta, double from, double to, Memory& memory) const;
  static constexpr double kLeastGap = 1e-6;

  /// Whether the witness alone blocks the pose, and until which tilt it does at this yaw (the end of its
  /// blocked interval that contains `alpha`; at most `to`). Needs no tree.
  bool blocks(const Witness& witness, const cl::Pose& pose) const;
  double blocked_until(const Witness& witness, const CcPoint& at, double beta, double alpha, double to) const;

  const model::Mill& mill() const;
  const std::vector<BodyPiece>& body() const;
  std::size_t triangle_count() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace burin::orient
