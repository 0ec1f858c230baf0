// SPDX-License-Identifier: Apache-2.0
// `burin kerf list|predict|suggest|learn|export`: process knowledge of laser cutting.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "burin/base/text.h"
#include "cli.h"
#include "commands.h"
#include "kerf_options.h"
#include "table.h"

namespace burin::cli {
namespace {

using model::KerfDatabase;
using model::KerfModel;

std::string mm(double value) {
  return format_fixed(value, 4) + " mm";
}

std::string ranges(const KerfModel& model) {
  std::string text;
  for (const model::PermissibleRange& range : model.permissible) {
    text += (text.empty() ? "" : ", ") + format_fixed(range.speed_min, 1) + "-" +
            format_fixed(range.speed_max, 1) + " at " + format_fixed(range.power_w, 1) + " W";
  }
  return text;
}

std::string formula(const KerfModel& model) {
  return "kerf = " + format_fixed(model.lambda1, 6) + " * P / V " + (model.lambda2 < 0 ? "- " : "+ ") +
         format_fixed(std::abs(model.lambda2), 6);
}

void record_query(const KerfOptions& options, Session& session) {
  Json& p = session.report.parameters;
  p["laser"] = options.laser;
  p["material"] = options.material;
  p["thickness_mm"] = *options.thickness_mm;
  p["power_w"] = options.power_w ? Json(*options.power_w) : Json(nullptr);
  p["speed_mm_min"] = options.speed_mm_min ? Json(*options.speed_mm_min) : Json(nullptr);
  p["version"] = options.version ? Json(*options.version) : Json(nullptr);
  p["interpolate"] = options.interpolate;
  p["force"] = options.force;
}

Result<void> run_predict(const KerfOptions& options, Session& session) {
  auto database = open_database(options, session);
  if (!database) return database.error();
  auto found = database->predict(to_query(options));
  if (!found) return found.error();
  const model::KerfPrediction& prediction = *found;
  warn(prediction, session.diagnostics);

  record_query(options, session);
  Json& json = session.report.extra;
  json["kerf_mm"] = prediction.kerf_mm;
  json["offset_mm"] = prediction.offset_mm;
  json["permissible"] = prediction.permissible;
  json["forced"] = options.force && !prediction.permissible;
  json["interpolated"] = prediction.interpolated;
  json["model"] = to_json(prediction.model);
  const auto& interval = prediction.prediction_interval_mm;
  json["prediction_interval_mm"] =
      interval ? Json::array({interval->first, interval->second}) : Json(nullptr);

  std::vector<std::vector<std::string>> rows{{"kerf", mm(prediction.kerf_mm)},
                                             {"offset", mm(prediction.offset_mm)}};
  if (interval) rows.push_back({"95 % of cuts", mm(interval->first) + " to " + mm(interval->second)});
  rows.push_back({"permissible", prediction.permissible ? "yes" : "no (forced)"});
  rows.push_back({"model", formula(prediction.model) + ", r " + format_fixed(prediction.model.r, 4)});
  rows.push_back(
      {"source", prediction.model.source + ", version " + std::to_string(prediction.model.version)});
  session.print(table(rows));
  return {};
}

Result<void> run_suggest(const KerfOptions& options, Session& session) {
  auto database = open_database(options, session);
  if (!database) return database.error();
  auto suggestions = database->suggest(to_query(options));
  if (!suggestions) return suggestions.error();
  record_query(options, session);
  Json& list = session.report.extra["suggestions"] = Json::array();
  std::vector<std::vector<std::string>> rows{{"power W", "speed mm/min", "kerf mm"}};
  for (const model::KerfSuggestion& s : *suggestions) {
    list.push_back({{"power_w", s.power_w},
                    {"speed_min_mm_min", s.speed_min},
                    {"speed_max_mm_min", s.speed_max},
                    {"kerf_at_speed_max_mm", s.kerf_at_max_mm},
                    {"kerf_at_speed_min_mm", s.kerf_at_min_mm}});
    rows.push_back({format_fixed(s.power_w, 1),
                    format_fixed(s.speed_max, 1) + " to " + format_fixed(s.speed_min, 1),
                    format_fixed(s.kerf_at_max_mm, 4) + " to " + format_fixed(s.kerf_at_min_mm, 4)});
  }
  session.report.counts["suggestions"] = suggestions->size();
  session.print(table(rows));
  return {};
}

Result<void> run_list(const KerfOptions& options, Session& session) {
  auto database = open_database(options, session);
  if (!database) return database.error();
  auto models = database->models();
  if (!models) return models.error();
  Json& list = session.report.extra["models"] = Json::array();
  std::vector<std::vector<std::string>> rows{
      {"laser", "material", "mm", "version", "lambda1", "lambda2", "r", "source"}};
  std::string permissible = "\nPermissible speeds, mm/min\n";
  for (const KerfModel& m : *models) {
    list.push_back(to_json(m));
    rows.push_back({m.laser, m.material, format_shortest(m.thickness_mm), std::to_string(m.version),
                    format_fixed(m.lambda1, 6), format_fixed(m.lambda2, 6), format_fixed(m.r, 4), m.source});
    permissible += "  " + m.laser + " " + m.material + " " + format_shortest(m.thickness_mm) +
                   " mm, version " + std::to_string(m.version) + ": " + ranges(m) + "\n";
  }
  session.report.counts["models"] = models->size();
  session.print(table(rows) + permissible);
  return {};
}

Result<void> run_export(const KerfOptions& options, const std::string& csv_path, Session& session) {
  auto reserved = session.reserve_output(csv_path);
  if (!reserved) return reserved.error();
  auto database = open_database(options, session);
  if (!database) return database.error();
  auto csv = database->export_csv();
  if (!csv) return csv.error();
  return session.put(csv_path, std::move(csv).value());
}

Result<void> run_learn(const KerfOptions& options, const std::string& runs, Session& session) {
  const std::string path = options.db.empty() ? KerfDatabase::user_path() : options.db;
  if (!path.empty()) {
    if (auto guarded = session.protect(path); !guarded) return guarded.error();
  }
  auto csv = session.read_input(runs);
  if (!csv) return csv.error();
  auto database = KerfDatabase::open_or_create(path);
  if (!database) return database.error();
  auto report = database->learn(*csv, runs);
  if (!report) return report.error();

  session.report.parameters["db"] = path;
  // Built apart: a new key moves the values of an ordered object.
  Json models = Json::array(), rejected = Json::array();
  int accepted = 0;
  std::string text;
  for (const KerfModel& m : report->models) {
    models.push_back(to_json(m));
    accepted += m.runs_accepted;
    text += m.laser + ", " + m.material + ", " + format_shortest(m.thickness_mm) + " mm: " + formula(m) +
            ", r " + format_fixed(m.r, 4) + ", version " + std::to_string(m.version) +
            "\n  standard errors " + format_fixed(m.statistics->se_lambda1, 6) + " and " +
            format_fixed(m.statistics->se_lambda2, 6) + " from " + std::to_string(m.runs_accepted) +
            " runs, " + std::to_string(m.runs_rejected) + " rejected\n  permissible " + ranges(m) + "\n";
  }
  for (const model::RejectedRun& run : report->rejected) {
    rejected.push_back({{"line", run.line}, {"reason", run.reason}});
    session.diagnostics.info("run_rejected", "not used: " + run.reason, {.file = runs, .line = run.line});
  }
  session.report.extra["models"] = std::move(models);
  session.report.extra["rejected"] = std::move(rejected);
  session.report.counts["models"] = report->models.size();
  session.report.counts["runs_accepted"] = accepted;
  session.report.counts["runs_rejected"] = report->rejected.size();
  session.print(text + "stored in " + path + "\n");
  return {};
}

void add_predict(Cli& cli, CLI::App& kerf) {
  auto options = std::make_shared<KerfOptions>();
  CLI::App& app =
      cli.add_command(kerf, "predict", "width of the cut for one setting",
                      "  burin kerf predict --thickness 2.0 --power 1800 --speed 4000\n"
                      "  burin kerf predict --thickness 1.2 --power 1400 --speed 4500 --interpolate\n",
                      [options](Session& session) { return run_predict(*options, session); });
  add_kerf_model(app, *options);
  add_power(app, *options);
  add_speed(app, *options);
  add_force(app, *options);
  cli.add_json(app);
  for (const char* name : {"--thickness", "--power", "--speed"}) app.get_option(name)->required();
}

void add_suggest(Cli& cli, CLI::App& kerf) {
  auto options = std::make_shared<KerfOptions>();
  CLI::App& app = cli.add_command(kerf, "suggest", "permissible settings, fastest first",
                                  "  burin kerf suggest --thickness 1.0\n"
                                  "  burin kerf suggest --thickness 1.0 --power 1500 --json settings.json\n",
                                  [options](Session& session) { return run_suggest(*options, session); });
  add_kerf_model(app, *options);
  add_power(app, *options);
  cli.add_json(app);
  app.get_option("--thickness")->required();
}

void add_list(Cli& cli, CLI::App& kerf) {
  auto options = std::make_shared<KerfOptions>();
  CLI::App& app = cli.add_command(kerf, "list", "all kerf models with their permissible ranges",
                                  "  burin kerf list\n  burin kerf list --db shop.db --json models.json\n",
                                  [options](Session& session) { return run_list(*options, session); });
  add_db(app, *options);
  cli.add_json(app);
}

void add_export(Cli& cli, CLI::App& kerf) {
  auto options = std::make_shared<KerfOptions>();
  auto csv = std::make_shared<std::string>("-");
  CLI::App& app =
      cli.add_command(kerf, "export", "all kerf models as CSV",
                      "  burin kerf export --csv models.csv\n  burin kerf export --db shop.db\n",
                      [options, csv](Session& session) { return run_export(*options, *csv, session); });
  add_text(app, "--csv", *csv, "FILE", "where to (default -, standard output)");
  add_db(app, *options);
  cli.add_json(app);
}

void add_learn(Cli& cli, CLI::App& kerf) {
  auto options = std::make_shared<KerfOptions>();
  auto runs = std::make_shared<std::string>();
  CLI::App& app = cli.add_command(
      kerf, "learn", "fit kerf models to cutting experiments and store them as new versions",
      "  burin kerf learn runs.csv\n  burin kerf learn runs.csv --db shop.db --json fit.json\n"
      "Columns of RUNS.csv:\n"
      "  "
      "laser,material,thickness_mm,power_w,speed_mm_min,gas_mpa,kerf_top_mm,kerf_bottom_mm,dross_area_mm2,"
      "straightness_mm\n",
      [options, runs](Session& session) { return run_learn(*options, *runs, session); });
  add_text(app, "RUNS.csv", *runs, "FILE", "experiments, one a line")->required();
  add_db(app, *options);
  cli.add_json(app);
}

}  // namespace

void add_kerf(Cli& cli) {
  CLI::App& kerf = cli.add_group("kerf", "process knowledge of laser cutting: the width of the cut",
                                 "  burin kerf list\n  burin kerf suggest --thickness 2.0\n"
                                 "  burin kerf predict --thickness 2.0 --power 1800 --speed 4000\n");
  add_predict(cli, kerf);
  add_suggest(cli, kerf);
  add_list(cli, kerf);
  add_learn(cli, kerf);
  add_export(cli, kerf);
}

}  // namespace burin::cli
