// SPDX-License-Identifier: Apache-2.0
// The inner loops of evaluation on one polynomial piece, compiled twice: for any processor and for AVX2. Both
// do the same operations in the same order on every number (no fused multiply-add), so their results are the
// same bits; which one runs is decided once by the processor. Plain C types only: nothing inline may be
// shared with other translation units, or code for AVX2 could end up in the program for all. Internal to
// geom/surface.
#pragma once

#include <cstddef>

namespace burin::geom::detail {

/// One piece of a surface. u_lo <= u < u_hi and v_lo <= v < v_hi lie in it (u_hi, v_hi are just above the end
/// of the domain in the last piece). c[j][i][4]: homogeneous coefficient (32-byte aligned); powers: of (u -
/// u0)^i (v - v0)^j; else Bezier point i, j over [u0, u1] x [v0, v1].
struct Piece {
  double u_lo = 1, u_hi = 0, v_lo = 1, v_hi = 0;
  double u0 = 0, v0 = 0, u1 = 1, v1 = 1;
  int p = 0, q = 0;
  const double* c = nullptr;
};

/// A piece with one parameter fixed: three curves c[f][i][4][4] (the surface's f-th derivative, over f!, with
/// respect to the fixed parameter; every number four times) in powers of t - t0, for t_lo <= t < t_hi.
struct IsoPiece {
  double t_lo = 1, t_hi = 0, t0 = 0;
  int degree = 0;
  const double* c = nullptr;
};

/// Outputs are the numbers of Point3 (3), SurfaceDerivatives (18), SurfaceDerivatives3 (30). Functions over n
/// places stop before the first group of 4 that leaves the piece, and return how many they did.
struct Kernels {
  void (*convert)(const double* mu, const double* mv, const double* net, std::ptrdiff_t row, int p, int q,
                  double* c);
  void (*point)(const Piece&, double u, double v, double* out);
  void (*derivatives)(const Piece&, double u, double v, double* out);
  void (*derivatives3)(const Piece&, double u, double v, double* out);
  std::size_t (*points)(const Piece&, const double* uv, std::size_t n, double* out);
  std::size_t (*derivatives_run)(const Piece&, const double* uv, std::size_t n, double* out);
};
struct IsoKernels {
  /// Fills IsoPiece::c (48 * (degree + 1) numbers, 32-byte aligned). along: Axis::power of the moving
  /// direction; across: basis functions of the fixed one, [f][j], over f!; steps between control points in
  /// numbers.
  void (*fix)(const double* along, const double* across, const double* net, std::ptrdiff_t step_along,
              std::ptrdiff_t step_across, int degree, int degree_across, double* c);
  std::size_t (*points)(const IsoPiece&, const double* t, std::size_t n, double* out);
  std::size_t (*derivatives)(const IsoPiece&, bool moving_u, const double* t, std::size_t n, double* out);
};

/// The tables live as long as the program. `convert` takes any degrees, the rest is for powers.
struct KernelSet {
  const Kernels& (*surface)(int p, int q);
  const IsoKernels& (*iso)(int degree);
};
KernelSet kernels_any();
/// The same as kernels_any() when the build or the processor has no AVX2.
KernelSet kernels_avx2();

}  // namespace burin::geom::detail
