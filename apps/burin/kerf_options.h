// SPDX-License-Identifier: Apache-2.0
// What `burin kerf` and `burin laser` share: the options that choose a kerf model, the database behind them,
// and a model as JSON.
#pragma once

#include <optional>
#include <string>

#include "burin/model/kerf.h"
#include "cli.h"

namespace burin::cli {

struct KerfOptions {
  std::string laser = model::kDefaultLaser, material = model::kDefaultMaterial;
  std::optional<double> thickness_mm, power_w, speed_mm_min;
  std::optional<int> version;
  std::string db;  ///< empty: the user's database when there is one, else the built-in table
  bool interpolate = false, force = false;
};

void add_db(CLI::App& app, KerfOptions& options);
/// --laser --material --thickness --version --interpolate --db; none is required here.
void add_kerf_model(CLI::App& app, KerfOptions& options);
void add_power(CLI::App& app, KerfOptions& options);
void add_speed(CLI::App& app, KerfOptions& options);
void add_force(CLI::App& app, KerfOptions& options);

model::KerfQuery to_query(const KerfOptions& options);

/// Opens for reading; an output of the same name is refused.
Result<model::KerfDatabase> open_database(const KerfOptions& options, Session& session);

/// {laser, material, thickness_mm, lambda1, lambda2, r, source, version, ...}
Json to_json(const model::KerfModel& model);

/// What the user should know of a prediction: "kerf_forced" (also interpolated, perhaps) or
/// "kerf_interpolated".
void warn(const model::KerfPrediction& prediction, Diagnostics& diagnostics);

}  // namespace burin::cli
