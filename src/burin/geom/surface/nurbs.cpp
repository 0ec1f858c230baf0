// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/nurbs.h"
