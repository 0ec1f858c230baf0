// SPDX-License-Identifier: Apache-2.0
// What `burin verify` takes from a job file of any command: [part], [tool] (or several [[tools]]),
// [operation] tolerance, [machine], [stock]. Internal to job; the rest is the planners'. mm. docs/verify.md
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/vec.h"
#include "burin/job/orient_job.h"
#include "burin/job/rotary_job.h"
#include "burin/model/tool.h"
#include "burin/removal/stock.h"

namespace burin::job {

struct JobTool {
  std::optional<int> number;  ///< nothing: of every change that no other entry names
  std::variant<model::BallTool, model::Mill> shape;
};

/// Sides that are not given come from the design's box, grown by the margin.
struct BlockTable {
  std::optional<geom::Point3> lo, hi;
  geom::Vec3 margin;
};
/// About `axis` (unit) through `point`; ends and radius that are not given come from the design.
struct CylinderTable {
  geom::Vec3 axis{0, 0, 1};
  geom::Point3 point;
  std::optional<double> from, radius, length;  ///< `from`: along the axis, of the first end
  double margin = 0;
};
struct StockFile {
  std::string path;
};
using StockTable = std::variant<BlockTable, CylinderTable, StockFile>;

struct VerifyTables {
  bool rotary = false;       ///< the job is one of `burin rotary`
  RotaryPartSource section;  ///< its part
  OrientJobFile faces;       ///< else: part and obstacles
  std::vector<JobTool> tools;
  std::optional<double> tolerance_mm;
  std::string machine = "none";
  std::optional<StockTable> stock;  ///< file paths as in the job
};

/// Unknown keys of these tables are errors that name the nearest known one; other tables and the other keys
/// of [operation] are not looked at.
Result<VerifyTables> read_verify_tables(std::string_view toml, const std::string& file_name);

/// Margin of stock that nothing else is said of.
inline constexpr double kStockMargin_mm = 1;
/// Error (geometry): a design without extent where the table needs it; of removal::validate.
Result<removal::Stock> make_stock(const StockTable& table, const geom::Mesh& design, geom::Mesh file);

}  // namespace burin::job
