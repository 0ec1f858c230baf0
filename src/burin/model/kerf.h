// SPDX-License-Identifier: Apache-2.0
// Process knowledge of laser cutting (Park & Ahn 2007, section 3): kerf = lambda1 * P / V + lambda2 per
// laser, material and thickness, with its permissible range, in an SQLite database. mm, W, mm/min, MPa.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/result.h"

namespace burin::model {

inline constexpr const char* kDefaultLaser = "ndyag-cw";
inline constexpr const char* kDefaultMaterial = "CSP1N";

/// Which speeds are permissible at one power.
struct PermissibleRange {
  double power_w = 0;
  double speed_min = 0, speed_max = 0;  ///< mm/min
};

/// How sure a fitted model is: standard errors of lambda1 and lambda2, and what a prediction interval needs.
struct KerfStatistics {
  double se_lambda1 = 0, se_lambda2 = 0;
  double residual_sd = 0;  ///< mm
  int n = 0;
  double mean_q = 0, sum_sq_q = 0;  ///< of Q = P / V
  bool operator==(const KerfStatistics&) const = default;
};

/// One fitted model: kerf [mm] = lambda1 * P [W] / V [mm/min] + lambda2.
struct KerfModel {
  std::string laser, material;
  double thickness_mm = 0;
  int version = 1;
  double lambda1 = 0, lambda2 = 0;
  double r = 0;        ///< correlation coefficient
  std::string source;  ///< "Park & Ahn 2007, table 3" or the file it was learned from
  int runs_accepted = 0, runs_rejected = 0;
  std::optional<KerfStatistics> statistics;   ///< absent for literature models
  std::vector<PermissibleRange> permissible;  ///< sorted by power
};

struct KerfQuery {
  std::string laser = kDefaultLaser, material = kDefaultMaterial;
  double thickness_mm = 0;
  double power_w = 0, speed_mm_min = 0;
  std::optional<int> version;  ///< default: the newest
  bool interpolate = false;    ///< between two known thicknesses
  bool force = false;          ///< also outside the permissible range
};

struct KerfPrediction {
  double kerf_mm = 0;
  double offset_mm = 0;  ///< kerf / 2
  bool permissible = true;
  bool interpolated = false;
  KerfModel model;  ///< the one used; interpolated: blended coefficients
  std::optional<std::pair<double, double>> prediction_interval_mm;  ///< 95 %
  std::string note;  ///< what the user should know (forced, interpolated); may be empty
};

/// A setting that cuts cleanly.
struct KerfSuggestion {
  double power_w = 0, speed_min = 0, speed_max = 0;
  double kerf_at_max_mm = 0, kerf_at_min_mm = 0;  ///< kerf at the fastest and the slowest speed
};

struct RejectedRun {
  int line = 0;  ///< of the CSV, from 1
  std::string reason;
};
struct LearnReport {
  std::vector<KerfModel> models;
  std::vector<RejectedRun> rejected;
};

class KerfDatabase {
 public:
  /// The built-in table, in memory.
  static Result<KerfDatabase> built_in();
  /// An existing database file. Errors (data): not a database, damaged, locked, newer schema, missing tables;
  /// (io).
  static Result<KerfDatabase> open(const std::string& path);
  /// Opens or creates (with the built-in table in it) a file for learning.
  static Result<KerfDatabase> open_or_create(const std::string& path);
  /// `$XDG_DATA_HOME/burin/kerf.db`, else `~/.local/share/burin/kerf.db`; "" when neither is set.
  static std::string user_path();
  /// What a command without --db reads: the user's file when it exists, else the built-in table.
  static Result<KerfDatabase> open_default();

  KerfDatabase(KerfDatabase&&) noexcept;
  KerfDatabase& operator=(KerfDatabase&&) noexcept;
  ~KerfDatabase();

  Result<std::vector<KerfModel>> models() const;  ///< all versions, sorted
  /// Error (range) outside the permissible range: names the nearest permissible setting (smallest change of
  /// speed at the same power, else of power), unless `force`. Error (range) for an unknown laser, material,
  /// thickness, version: names what is known.
  Result<KerfPrediction> predict(const KerfQuery& query) const;
  /// Permissible settings, fastest first; `power_w` <= 0: all powers of the model.
  Result<std::vector<KerfSuggestion>> suggest(const KerfQuery& query) const;
  /// Adds new model versions from a CSV of runs, in one transaction; nothing changes when any line is bad.
  Result<LearnReport> learn(std::string_view csv, const std::string& file_name);
  /// All models as CSV text.
  Result<std::string> export_csv() const;

 private:
  struct Impl;
  explicit KerfDatabase(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace burin::model
