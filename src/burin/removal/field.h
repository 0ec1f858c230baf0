// SPDX-License-Identifier: Apache-2.0
// What is behind a Removal. Internal to removal. mm.
#pragma once

#include <optional>
#include <vector>

#include "burin/removal/dexels.h"
#include "burin/removal/removal.h"
#include "burin/removal/tile_cutter.h"

namespace burin::removal {

/// Takes away all that the path takes, tile by tile, in the order of the path. `times` belongs to the field
/// along Z. Error: `usage` "stopped" when the sink asks for it.
Result<std::vector<ContactPart>> cut_all(std::vector<DexelField>& fields, const verify::CheckedPath& path,
                                         const CutLimits& limits, unsigned threads, ProgressSink* progress,
                                         NodeTimes times = {});

class Field {
 public:
  Grid grid;
  std::vector<DexelField> fields;  ///< along Z; or along X, Y, Z
  RemovalOptions options;          ///< resolution and threads as they were used
  double stock_mm3 = 0, removed_mm3 = 0;
  std::vector<StockContact> contacts;
  /// Kept for the clock only.
  std::optional<Stock> stock;
  std::optional<verify::CheckedPath> path;
};

/// What is left as a closed mesh, for three directions or for one along Z.
geom::Mesh surface(const Grid& grid, const std::vector<DexelField>& fields);

StockClock make_clock(const Stock& stock, const verify::CheckedPath& path, const CutLimits& limits,
                      unsigned threads, std::size_t max_nodes);

}  // namespace burin::removal
