// SPDX-License-Identifier: Apache-2.0
// The kernels for any processor.
#include "burin/geom/surface/kernels.h"

#define BURIN_KERNELS any
#include "burin/geom/surface/kernels.inc"

namespace burin::geom::detail {

KernelSet kernels_any() {
  return {any::kernels_of, any::iso_kernels_of};
}

}  // namespace burin::geom::detail
