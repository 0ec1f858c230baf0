// SPDX-License-Identifier: Apache-2.0
// The deepest place of triangles in one piece of a moving tool: branch and bound over boxes, triangles and
// times. Internal to verify. mm. docs/verify-mill.md
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "burin/base/result.h"
#include "burin/verify/mill_bound.h"
#include "burin/verify/mill_check.h"
#include "burin/verify/triangle_tree.h"

namespace burin::verify {

/// What a tool is made of; the cutter comes first.
enum class ToolPart { cutter, shank, holder };
struct ToolPiece {
  MillBody body;
  ToolPart part = ToolPart::cutter;
};
std::vector<ToolPiece> pieces_of(const CheckedMill& tool);
/// No place of it is farther from the tip.
double span(const CheckedMill& tool);

/// Numbers that are finite and positive, a corner that fits (range).
Result<void> validate(const CheckedMill& tool);
/// Corners that are finite and there (geometry).
Result<void> validate_triangles(const geom::Mesh& mesh);

/// What is found is the depth of a real place at a real moment, and what was looked through since reset() is
/// nowhere deeper than
///   floor + resolution() when nothing was found, else found + max(resolution(), share * found).
class MillSearch {
 public:
  /// Nodes of the tree below which all lies that can matter.
  using Front = std::vector<std::uint32_t>;

  /// `budget`: after so many evaluations since reset() the resolution is doubled, and again after as many.
  /// 0: it stays. Keeps a reference.
  MillSearch(const TriangleTree& tree, const MillBody& body, double resolution, std::uint64_t budget = 0);

  /// Forgets what was found. What is not deeper than `floor` is not looked for.
  void reset(double floor, double share = 0);
  /// Goes on from what was found before.
  void know(const MillFinding& found);
  /// `at`, a place of triangle `triangle`, as a first find on the stretch.
  void seed(const Stretch& stretch, std::size_t move, geom::Point3 at, std::uint32_t triangle);
  void stretch(const Stretch& stretch, std::size_t move, const Front& front);

  /// The nodes below those of `front` in which a tool of this shape can be deeper than the floor that stands
  /// anywhere within `slack` of `mean`: no place of it is farther from where the same place is in `mean`.
  /// They are divided until they are about as small as the slack, or too many.
  void narrow(const Placed& mean, double slack, const Front& front, Front& out);
  /// All of the tree.
  Front root() const;

  double span() const { return body_.span(); }
  bool hit() const { return found_.mm > floor_; }
  const MillFinding& deepest() const { return found_; }
  double resolution() const { return resolution_; }
  std::uint64_t evaluations() const { return evaluations_; }

 private:
  using Corners = std::array<geom::Point3, 3>;

  bool settled(double value) const { return value <= enough_; }
  void update();
  void set(const Stretch& stretch, std::size_t move);
  void spend();

  template <class Extent>
  Upper bound(const Extent& extent, const Span& span);
  Upper of_node(const TriangleTree::Node& node, const Span& span);
  Upper of_triangle(const Corners& c, geom::Vec3 normal, const Span& span);
  void narrow_node(std::uint32_t index, const Span& still, double smallest, Front& out);
  void box(std::uint32_t index, const Span& span, const Upper& upper);
  void triangle(const Corners& c, std::uint32_t index, geom::Vec3 normal, const Span& span,
                const Upper& upper, int depth);
  void take(const Corners& c, std::uint32_t index, const Span& span, const Upper& upper);
  void take(double depth, geom::Point3 at, std::uint32_t index);

  const TriangleTree& tree_;
  MillBody body_;
  double resolution_asked_, resolution_;
  std::uint64_t budget_, allowed_ = 0;
  double floor_ = 0, share_ = 0;
  double enough_ = 0;  ///< cells that are nowhere deeper are dropped
  const Stretch* stretch_ = nullptr;
  std::size_t move_ = 0;
  MillFinding found_;
  std::uint64_t evaluations_ = 0;
};

}  // namespace burin::verify
