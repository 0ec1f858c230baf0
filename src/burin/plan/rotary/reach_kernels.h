// SPDX-License-Identifier: Apache-2.0
// Four boxes, or four triangles, at once against a cylinder about the tool axis: whether they
// matter, and the arc of angles at which they meet. Compiled twice: for any processor and for AVX2, with the
// same operations in the same order on every number (no fused multiply-add), so that the results are the same
// bits. Plain C types only: nothing inline may be shared with other translation units. Internal to
// plan/rotary. See docs/reachable-angles.md.
#pragma once

#include <cstdint>

namespace burin::rotary::detail {

/// Four boxes: an interval of x, and in the YZ plane a rectangle with sides along (c, s) and (-s, c) that
/// moves with x along the first: u0 <= u - tilt x <= u1 along (c, s), v0 <= v <= v1 along (-s, c). c belongs
/// to Z and s to Y. An empty lane has x0 > x1.
struct alignas(32) NodeBlock {
  double x0[4], x1[4], c[4], s[4], tilt[4], u0[4], u1[4], v0[4], v1[4];
  std::uint32_t child[4];  ///< kLeaf + block of triangles, or node
};
constexpr std::uint32_t kLeaf = 0x80000000u;

/// Four triangles: [corner][lane]. Lanes without one repeat another.
struct alignas(32) LeafBlock {
  double x[3][4], y[3][4], z[3][4];
};

/// Angles that are still free, from `from` counter-clockwise to `to`, at most half the circle: axis
/// directions (c, s) at both ends and in the middle, cosine and sine of half the width.
struct ReachGap {
  double from[2], to[2], middle[2], cos_half, sin_half;
};

/// The cylinder h0 <= h <= h1 of `radius` about the axis through the ball's centre; what it forbids matters
/// in the gaps only.
struct ReachQuery {
  double x = 0, y = 0, z = 0;
  double h0 = 0, h1 = 0, radius = 0;
  const ReachGap* gaps = nullptr;
  int gap_count = 0;
};

/// Bit i of the masks is lane i.
struct alignas(32) ReachFound {
  double near2[4];      ///< boxes: square of the distance from the centre in the YZ plane, or less
  double depth[4];      ///< how far (mm) the lane reaches into what the cylinder sweeps in a gap, or more
  double lo[4], hi[4];  ///< exact: arc of angles from lo counter-clockwise to hi, as turns (reach_arcs.h)
  int meets = 0;        ///< lanes that meet the cylinder at some angle, at most
  int unsure = 0;       ///< exact: of these, those whose arc is not known
};

struct ReachKernels {
  void (*boxes)(const NodeBlock&, const ReachQuery&, ReachFound&);
  /// The same for triangles, from their corners alone.
  void (*triangles)(const LeafBlock&, const ReachQuery&, ReachFound&);
  /// The arcs of the triangles. `unsure`: take forbid_exactly().
  void (*exact)(const LeafBlock&, const ReachQuery&, ReachFound&);
};
const ReachKernels& reach_kernels_any();
/// The same as reach_kernels_any() when the build or the processor has no AVX2.
const ReachKernels& reach_kernels_avx2();

}  // namespace burin::rotary::detail
