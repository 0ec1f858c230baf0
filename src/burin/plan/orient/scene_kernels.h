// SPDX-License-Identifier: Apache-2.0
// Eight oriented boxes at once against the pieces of a tool. Compiled twice: for any processor and for AVX2,
// with the same operations in the same order on every number (no fused multiply-add), so that the results are
// the same bits. Plain C types only: nothing inline may be shared with other translation units. Internal to
// plan/orient. See docs/tool-interference.md.
#pragma once

namespace burin::orient::detail {

/// Boxes {c + i a + j b + k t n : i, j, k in [-1, 1]} about `origin`, single precision, grown for all
/// rounding of their own; n is a unit vector up to that. Lanes that are not `used` are zero.
struct alignas(32) SceneNode {
  float c[3][8], a[3][8], b[3][8], n[3][8], t[8];
  int child[8];  ///< >= 0: a node; else ~child is a packet
  double origin[3];
  float reach;  ///< no place of the boxes is further from the origin
  int used;     ///< bits
};

/// The pieces of one walk: this many at most.
inline constexpr int kScenePieces = 8;

struct SceneQuery {
  double tip[3];
  float axis[3];
  float size;  ///< no place of the pieces is further from the tip
  /// How the tool is about to turn, for the order only: unit vector from the line about which it turns to the
  /// axis, across it, how long, and the height of the line.
  float lever[3], arm, corner;
  int count;
  float middle[kScenePieces], half[kScenePieces], radius[kScenePieces], grow[kScenePieces];
};

struct alignas(32) SceneHits {
  float last[8];                    ///< the order to look at them: greatest first
  unsigned char hit[kScenePieces];  ///< bit i: box i may meet the piece; where not, it does not
};

struct SceneKernels {
  /// Only pieces whose bit is set in `pieces` are looked at.
  /// `last`: how deep the middle of the box is.
  void (*boxes)(const SceneNode&, const SceneQuery&, unsigned pieces, SceneHits&);
  /// `last`: about the tilt (rad, from now) at which the box will have left the pieces that it may meet.
  void (*turning)(const SceneNode&, const SceneQuery&, unsigned pieces, SceneHits&);
};
const SceneKernels& scene_kernels_any();
/// The same as scene_kernels_any() when the build or the processor has no AVX2.
const SceneKernels& scene_kernels_avx2();

}  // namespace burin::orient::detail
