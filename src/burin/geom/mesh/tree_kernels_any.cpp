// SPDX-License-Identifier: Apache-2.0
// The walks for any processor.
#include "burin/geom/mesh/tree_kernels.h"

#define BURIN_KERNELS any
#include "burin/geom/mesh/tree_kernels.inc"

namespace burin::geom::detail {

const TreeKernels& tree_kernels_any() {
  return any::kKernels;
}

}  // namespace burin::geom::detail
