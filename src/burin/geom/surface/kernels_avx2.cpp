// SPDX-License-Identifier: Apache-2.0
// The kernels for processors with AVX2: the only file compiled for them (see CMakeLists.txt).
#include "burin/geom/surface/kernels.h"

#ifdef __AVX2__
#define BURIN_KERNELS avx2
#include "burin/geom/surface/kernels.inc"
#endif

namespace burin::geom::detail {

KernelSet kernels_avx2() {
#ifdef __AVX2__
  if (__builtin_cpu_supports("avx2")) return {avx2::kernels_of, avx2::iso_kernels_of};
#endif
  return kernels_any();
}

}  // namespace burin::geom::detail
