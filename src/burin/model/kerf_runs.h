// SPDX-License-Identifier: Apache-2.0
// Cutting experiments: reading them from CSV, judging them, and fitting kerf models to the accepted ones
// (Park & Ahn 2007, section 3). Pure functions; the database is not involved. Internal to model.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/result.h"
#include "burin/model/kerf.h"

namespace burin::model {

/// Acceptance (section 3.2): measured at the bottom of the sheet.
inline constexpr double kMaxDrossArea_mm2 = 0.5;
inline constexpr double kMaxStraightness_mm = 0.01;
/// A straight line needs three points to say anything about its error.
inline constexpr int kMinAcceptedRuns = 3;

struct KerfRun {
  int line = 0;  ///< of the CSV, from 1
  std::string laser, material;
  double thickness_mm = 0, power_w = 0, speed_mm_min = 0, gas_mpa = 0;
  double kerf_top_mm = 0, kerf_bottom_mm = 0;
  double dross_area_mm2 = 0, straightness_mm = 0;

  double kerf_mm() const { return (kerf_top_mm + kerf_bottom_mm) / 2; }
  double heat() const { return power_w / speed_mm_min; }  ///< Q = P / V
};

/// Columns in any order, named by the first line; quotes and CRLF as in RFC 4180; blank lines are skipped.
/// Errors (syntax) with file and line.
Result<std::vector<KerfRun>> parse_runs(std::string_view csv, const std::string& file_name);

/// Why a run does not count, nothing when it is accepted.
std::optional<std::string> rejection(const KerfRun& run);

/// One fitted model (version still 0) with all its runs, the rejected ones too.
struct KerfFit {
  KerfModel model;
  std::vector<KerfRun> runs;
};

/// Groups by laser, material and thickness (sorted), fits each. Error (data): too few or degenerate runs in
/// any group.
Result<std::vector<KerfFit>> fit_runs(const std::vector<KerfRun>& runs, const std::string& file_name);

/// The models as CSV, one a line.
std::string models_to_csv(const std::vector<KerfModel>& models);

}  // namespace burin::model
