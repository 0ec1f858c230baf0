// SPDX-License-Identifier: Apache-2.0
#include "kerf_options.h"

namespace burin::cli {

void add_db(CLI::App& app, KerfOptions& options) {
  add_text(
      app, "--db", options.db, "FILE",
      "kerf database (default: $XDG_DATA_HOME/burin/kerf.db; the built-in table while that does not exist)");
}

void add_kerf_model(CLI::App& app, KerfOptions& options) {
  static constexpr NumberRule kThickness{"MM", "a sheet thickness in mm above 0, at most 1000", 0, 1000,
                                         true};
  add_number(app, "--thickness", options.thickness_mm, kThickness, "thickness of the sheet");
  add_text(app, "--laser", options.laser, "NAME",
           std::string("laser (default ") + model::kDefaultLaser + ")");
  add_text(app, "--material", options.material, "NAME",
           std::string("material (default ") + model::kDefaultMaterial + ")");
  add_integer(app, "--version", options.version, 1, 1'000'000'000,
              "version of the kerf model (default: the newest)");
  app.add_flag("--interpolate", options.interpolate, "between two known thicknesses, use both neighbours");
  add_db(app, options);
}

void add_power(CLI::App& app, KerfOptions& options) {
  add_number(app, "--power", options.power_w, kPower, "power of the laser");
}
void add_speed(CLI::App& app, KerfOptions& options) {
  add_number(app, "--speed", options.speed_mm_min, kSpeed, "cutting speed");
}
void add_force(CLI::App& app, KerfOptions& options) {
  app.add_flag("--force", options.force,
               "predict also outside the permissible range; recorded in the report");
}

model::KerfQuery to_query(const KerfOptions& options) {
  model::KerfQuery query;
  query.laser = options.laser;
  query.material = options.material;
  query.thickness_mm = options.thickness_mm.value_or(0);
  query.power_w = options.power_w.value_or(0);
  query.speed_mm_min = options.speed_mm_min.value_or(0);
  query.version = options.version;
  query.interpolate = options.interpolate;
  query.force = options.force;
  return query;
}

Result<model::KerfDatabase> open_database(const KerfOptions& options, Session& session) {
  const std::string path = options.db.empty() ? model::KerfDatabase::user_path() : options.db;
  if (!path.empty()) {
    if (auto guarded = session.protect(path); !guarded) return guarded.error();
  }
  return options.db.empty() ? model::KerfDatabase::open_default() : model::KerfDatabase::open(options.db);
}

Json to_json(const model::KerfModel& model) {
  Json json;
  json["laser"] = model.laser;
  json["material"] = model.material;
  json["thickness_mm"] = model.thickness_mm;
  json["lambda1"] = model.lambda1;
  json["lambda2"] = model.lambda2;
  json["r"] = model.r;
  json["source"] = model.source;
  json["version"] = model.version;
  json["runs_accepted"] = model.runs_accepted;
  json["runs_rejected"] = model.runs_rejected;
  json["standard_errors"] = nullptr;
  if (model.statistics) {
    json["standard_errors"] = {{"lambda1", model.statistics->se_lambda1},
                               {"lambda2", model.statistics->se_lambda2}};
    json["residual_sd_mm"] = model.statistics->residual_sd;
  }
  json["permissible"] = Json::array();
  for (const model::PermissibleRange& range : model.permissible) {
    json["permissible"].push_back({{"power_w", range.power_w},
                                   {"speed_min_mm_min", range.speed_min},
                                   {"speed_max_mm_min", range.speed_max}});
  }
  return json;
}

void warn(const model::KerfPrediction& prediction, Diagnostics& diagnostics) {
  if (prediction.note.empty()) return;
  diagnostics.info(prediction.permissible ? "kerf_interpolated" : "kerf_forced", "kerf " + prediction.note);
}

}  // namespace burin::cli
