// SPDX-License-Identifier: Apache-2.0
// The stock on the lines of a dexel field. Internal to removal. mm.
#pragma once

#include "burin/base/result.h"
#include "burin/removal/dexels.h"
#include "burin/removal/stock.h"

namespace burin::removal {

/// Fills an empty field. Precondition: validate(stock). Error (range): a mesh with more layers than memory
/// should be spent on.
Result<void> fill(DexelField& field, const Stock& stock, unsigned threads);

}  // namespace burin::removal
