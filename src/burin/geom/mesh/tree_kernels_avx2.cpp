// SPDX-License-Identifier: Apache-2.0
// The walks for processors with AVX2: the only file compiled for them (see CMakeLists.txt).
#include "burin/geom/mesh/tree_kernels.h"

#ifdef __AVX2__
#define BURIN_KERNELS avx2
#include "burin/geom/mesh/tree_kernels.inc"
#endif

namespace burin::geom::detail {

const TreeKernels& tree_kernels_avx2() {
#ifdef __AVX2__
  if (__builtin_cpu_supports("avx2")) return avx2::kKernels;
#endif
  return tree_kernels_any();
}

}  // namespace burin::geom::detail
