// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/measure.h"

#include <gtest/gtest.h>
