// SPDX-License-Identifier: Apache-2.0
#include "burin/model/kerf_schema.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "burin/base/embedded.h"
#include "burin/base/file.h"
#include "burin/base/text.h"
#include "burin/model/toml_reader.h"

namespace burin::embedded {
std::vector<File> kerf_tables();
}

namespace burin::model {
namespace {

using sqlite::Connection;
using sqlite::Row;
using sqlite::Value;

/// "burK", so that a file of another program is not taken for a kerf database.
constexpr long long kApplicationId = 0x6275724b;
constexpr long long kSchemaVersion = 1;

constexpr const char* kTables = R"sql(
CREATE TABLE laser(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, description TEXT NOT NULL,
  max_power_w REAL, spot_mm REAL, source TEXT NOT NULL) STRICT;
CREATE TABLE material(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, description TEXT NOT NULL,
  source TEXT NOT NULL) STRICT;
CREATE TABLE sheet(id INTEGER PRIMARY KEY, material_id INTEGER NOT NULL REFERENCES material(id),
  thickness_mm REAL NOT NULL, UNIQUE(material_id, thickness_mm)) STRICT;
CREATE TABLE model(id INTEGER PRIMARY KEY, laser_id INTEGER NOT NULL REFERENCES laser(id),
  sheet_id INTEGER NOT NULL REFERENCES sheet(id), version INTEGER NOT NULL,
  lambda1 REAL NOT NULL, lambda2 REAL NOT NULL, r REAL NOT NULL, gas_mpa REAL, source TEXT NOT NULL,
  runs_accepted INTEGER NOT NULL, runs_rejected INTEGER NOT NULL,
  n INTEGER, se_lambda1 REAL, se_lambda2 REAL, residual_sd REAL, mean_q REAL, sum_sq_q REAL,
  checksum TEXT NOT NULL, UNIQUE(laser_id, sheet_id, version)) STRICT;
CREATE TABLE permissible(model_id INTEGER NOT NULL REFERENCES model(id), power_w REAL NOT NULL,
  speed_min REAL NOT NULL, speed_max REAL NOT NULL, PRIMARY KEY(model_id, power_w)) STRICT;
CREATE TABLE experiment(id INTEGER PRIMARY KEY, model_id INTEGER NOT NULL REFERENCES model(id),
  line INTEGER NOT NULL, power_w REAL NOT NULL, speed_mm_min REAL NOT NULL, gas_mpa REAL NOT NULL,
  kerf_top_mm REAL NOT NULL, kerf_bottom_mm REAL NOT NULL, dross_area_mm2 REAL NOT NULL,
  straightness_mm REAL NOT NULL, rejected TEXT, source TEXT NOT NULL) STRICT;
)sql";

std::string checksum(const KerfModel& m) {
  std::string text = m.laser + "\n" + m.material + "\n" + m.source + "\n";
  auto add = [&text](double value) { text += format_shortest(value) + " "; };
  for (const double value : {m.thickness_mm, static_cast<double>(m.version), m.lambda1, m.lambda2, m.r,
                             static_cast<double>(m.runs_accepted), static_cast<double>(m.runs_rejected)}) {
    add(value);
  }
  text += m.statistics ? "statistics " : "none ";
  if (m.statistics) {
    const auto& s = *m.statistics;
    for (const double value :
         {s.se_lambda1, s.se_lambda2, s.residual_sd, static_cast<double>(s.n), s.mean_q, s.sum_sq_q}) {
      add(value);
    }
  }
  for (const PermissibleRange& range : m.permissible) {
    for (const double value : {range.power_w, range.speed_min, range.speed_max}) add(value);
  }
  return sha256_hex(text);
}

/// The id of the row, made when it is not there yet.
Result<long long> row_id(const Connection& db, const std::string& find, const std::string& insert,
                         const std::vector<Value>& key, const std::vector<Value>& values) {
  auto rows = db.query(find, key, 1);
  if (!rows) return rows.error();
  if (!rows->empty()) {
    const auto* id = std::get_if<long long>(&rows->front().front());
    return id == nullptr ? -1 : *id;
  }
  if (auto inserted = db.execute(insert, values); !inserted) return inserted.error();
  return db.last_row_id();
}

Result<long long> laser_id(const Connection& db, const std::string& name, const std::string& description,
                           const Value& max_power, const Value& spot, const std::string& source) {
  return row_id(
      db, "SELECT id FROM laser WHERE name = ?1",
      "INSERT INTO laser(name, description, max_power_w, spot_mm, source) VALUES(?1, ?2, ?3, ?4, ?5)", {name},
      {name, description, max_power, spot, source});
}

Result<long long> sheet_id(const Connection& db, const std::string& material, const std::string& description,
                           const std::string& source, double thickness_mm) {
  auto material_id = row_id(db, "SELECT id FROM material WHERE name = ?1",
                            "INSERT INTO material(name, description, source) VALUES(?1, ?2, ?3)", {material},
                            {material, description, source});
  if (!material_id) return material_id.error();
  const std::vector<Value> key{*material_id, thickness_mm};
  return row_id(db, "SELECT id FROM sheet WHERE material_id = ?1 AND thickness_mm = ?2",
                "INSERT INTO sheet(material_id, thickness_mm) VALUES(?1, ?2)", key, key);
}

Result<long long> store_model(const Connection& db, const KerfModel& m, long long laser, long long sheet,
                              const Value& gas_mpa) {
  std::vector<Value> values{laser,
                            sheet,
                            static_cast<long long>(m.version),
                            m.lambda1,
                            m.lambda2,
                            m.r,
                            gas_mpa,
                            m.source,
                            static_cast<long long>(m.runs_accepted),
                            static_cast<long long>(m.runs_rejected)};
  if (m.statistics) {
    const auto& s = *m.statistics;
    values.insert(values.end(), {static_cast<long long>(s.n), s.se_lambda1, s.se_lambda2, s.residual_sd,
                                 s.mean_q, s.sum_sq_q});
  } else {
    values.resize(values.size() + 6);
  }
  values.emplace_back(checksum(m));
  auto stored = db.execute(
      "INSERT INTO model(laser_id, sheet_id, version, lambda1, lambda2, r, gas_mpa, source, runs_accepted, "
      "runs_rejected, n, se_lambda1, se_lambda2, residual_sd, mean_q, sum_sq_q, checksum) "
      "VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17)",
      values);
  if (!stored) return stored.error();
  const long long id = db.last_row_id();
  for (const PermissibleRange& range : m.permissible) {
    stored =
        db.execute("INSERT INTO permissible(model_id, power_w, speed_min, speed_max) VALUES(?1, ?2, ?3, ?4)",
                   {id, range.power_w, range.speed_min, range.speed_max});
    if (!stored) return stored.error();
  }
  return id;
}

KerfModel read_built_in_model(TomlReader& reader, const toml::table& table) {
  reader.only_keys(table, {"thickness_mm", "lambda1", "lambda2", "r", "gas_mpa", "source", "permissible"});
  KerfModel m;
  m.thickness_mm = reader.number(table, "thickness_mm", 0.001, 1000);
  m.lambda1 = reader.number(table, "lambda1", -1, 1);
  m.lambda2 = reader.number(table, "lambda2", -100, 100);
  m.r = reader.number(table, "r", -1, 1);
  m.source = reader.text(table, "source");
  for (const toml::table* row : reader.tables(table, "permissible")) {
    reader.only_keys(*row, {"power_w", "speed_min", "speed_max"});
    m.permissible.push_back({reader.number(*row, "power_w", 1, 1e6), reader.number(*row, "speed_min", 1, 1e7),
                             reader.number(*row, "speed_max", 1, 1e7)});
  }
  return m;
}

/// One file of data/kerf: one laser, one material, its thicknesses.
Result<void> seed(const Connection& db, const embedded::File& file) {
  TomlReader reader{std::string(file.name)};
  const toml::table root = reader.parse(file.text);
  reader.only_keys(root, {"laser", "material", "models"});
  const toml::table& laser = reader.subtable(root, "laser");
  reader.only_keys(laser, {"name", "description", "max_power_w", "spot_mm", "source"});
  const toml::table& material = reader.subtable(root, "material");
  reader.only_keys(material, {"name", "description", "source"});
  const std::string laser_name = reader.text(laser, "name"), material_name = reader.text(material, "name");
  auto laser_row =
      laser_id(db, laser_name, reader.text(laser, "description"), reader.number(laser, "max_power_w", 1, 1e6),
               reader.number(laser, "spot_mm", 0, 100), reader.text(laser, "source"));
  if (!laser_row) return laser_row.error();
  for (const toml::table* table : reader.tables(root, "models")) {
    KerfModel m = read_built_in_model(reader, *table);
    m.laser = laser_name;
    m.material = material_name;
    const double gas = reader.number(*table, "gas_mpa", 0, 1000);
    auto sheet = sheet_id(db, material_name, reader.text(material, "description"),
                          reader.text(material, "source"), m.thickness_mm);
    if (!sheet) return sheet.error();
    if (auto stored = store_model(db, m, *laser_row, *sheet, gas); !stored) return stored.error();
  }
  if (reader.error()) return *reader.error();
  return {};
}

/// Takes typed values out of a row; a wrong type (a damaged file) makes it bad.
class RowReader {
 public:
  explicit RowReader(const Row& row) : row_(row) {}
  double real() { return take<double>(); }
  long long integer() { return take<long long>(); }
  std::string text() { return take<std::string>(); }
  bool next_is_null() const { return at_ < row_.size() && std::holds_alternative<std::monostate>(row_[at_]); }
  bool good() const { return good_; }

 private:
  template <class T>
  T take() {
    const T* value = at_ < row_.size() ? std::get_if<T>(&row_[at_]) : nullptr;
    ++at_;
    if (value == nullptr) good_ = false;
    return value == nullptr ? T{} : *value;
  }
  const Row& row_;
  std::size_t at_ = 0;
  bool good_ = true;
};

int to_int(long long value) {
  return static_cast<int>(std::clamp<long long>(value, -1, 1'000'000'000));
}

bool plausible(const KerfModel& m) {
  bool good =
      m.thickness_mm > 0 && m.version >= 1 && std::isfinite(m.thickness_mm + m.lambda1 + m.lambda2 + m.r);
  if (m.statistics) {
    const auto& s = *m.statistics;
    good = good && s.n >= kMinAcceptedRuns && s.sum_sq_q > 0 && s.residual_sd >= 0 &&
           std::isfinite(s.se_lambda1 + s.se_lambda2 + s.residual_sd + s.mean_q + s.sum_sq_q);
  }
  double power = 0;
  for (const PermissibleRange& range : m.permissible) {
    good = good && range.power_w > power && range.speed_min > 0 && range.speed_max >= range.speed_min &&
           std::isfinite(range.power_w + range.speed_max);
    power = range.power_w;
  }
  return good;
}

Error damaged(const std::string& path, const std::string& what) {
  return {ErrorCode::data,
          "is damaged: " + what + " (restore a copy, or learn again into a new file)",
          {.file = path}};
}

Result<std::map<long long, std::vector<PermissibleRange>>> load_permissible(const Connection& db,
                                                                            const std::string& path) {
  auto rows =
      db.query("SELECT model_id, power_w, speed_min, speed_max FROM permissible ORDER BY model_id, power_w");
  if (!rows) return rows.error();
  std::map<long long, std::vector<PermissibleRange>> tables;
  for (const Row& row : *rows) {
    RowReader in(row);
    const long long id = in.integer();
    const double power = in.real(), low = in.real(), high = in.real();
    if (!in.good()) return damaged(path, "a permissible range cannot be read");
    tables[id].push_back({power, low, high});
  }
  return tables;
}

}  // namespace

Result<void> create_schema(const Connection& connection) {
  auto made = connection.run("PRAGMA application_id = " + std::to_string(kApplicationId) +
                             "; PRAGMA user_version = " + std::to_string(kSchemaVersion) + ";" + kTables);
  if (!made) return made.error();
  for (const embedded::File& file : embedded::kerf_tables()) {
    if (auto seeded = seed(connection, file); !seeded) return seeded.error();
  }
  return {};
}

Result<bool> is_blank(const Connection& connection) {
  // Pages do not tell: SQLite makes the first one when a transaction starts.
  for (const char* question :
       {"SELECT count(*) FROM sqlite_schema", "PRAGMA application_id", "PRAGMA user_version"}) {
    auto answer = connection.integer(question);
    if (!answer) return answer.error();
    if (*answer != 0) return false;
  }
  return true;
}

Result<void> check_schema(const Connection& connection, const std::string& path) {
  auto blank = is_blank(connection);
  if (!blank) return blank.error();
  if (*blank)
    return Error{ErrorCode::data, "is empty (a kerf database made by \"burin kerf learn\")", {.file = path}};
  auto application = connection.integer("PRAGMA application_id");
  if (!application) return application.error();
  if (*application != kApplicationId) {
    return Error{ErrorCode::data,
                 "is a database, but not of kerf models (one made by \"burin kerf learn\")",
                 {.file = path}};
  }
  auto version = connection.integer("PRAGMA user_version");
  if (!version) return version.error();
  if (*version > kSchemaVersion) {
    return Error{ErrorCode::data,
                 "has schema version " + std::to_string(*version) + ", made by a newer burin (version " +
                     std::to_string(kSchemaVersion) + ", or a newer burin)",
                 {.file = path}};
  }
  if (*version < 1) return damaged(path, "its schema version is " + std::to_string(*version));
  auto foreign = connection.integer("SELECT count(*) FROM sqlite_schema WHERE type IN ('trigger', 'view')");
  if (!foreign) return foreign.error();
  if (*foreign != 0) return Error{ErrorCode::data, "holds triggers or views (tables only)", {.file = path}};
  auto verdict = connection.query("PRAGMA integrity_check(1)");
  if (!verdict) return verdict.error();
  const auto* text = verdict->empty() ? nullptr : std::get_if<std::string>(&verdict->front().front());
  if (text == nullptr || *text != "ok") return damaged(path, text == nullptr ? "no integrity" : *text);
  auto dangling = connection.query("PRAGMA foreign_key_check");
  if (!dangling) return dangling.error();
  if (!dangling->empty()) return damaged(path, "entries refer to entries that are gone");
  return {};
}

Result<std::vector<KerfModel>> load_models(const Connection& connection, const std::string& path) {
  auto tables = load_permissible(connection, path);
  if (!tables) return tables.error();
  auto rows = connection.query(
      "SELECT m.id, l.name, t.name, s.thickness_mm, m.version, m.lambda1, m.lambda2, m.r, m.source, "
      "m.runs_accepted, "
      "m.runs_rejected, m.checksum, m.n, m.se_lambda1, m.se_lambda2, m.residual_sd, m.mean_q, m.sum_sq_q "
      "FROM model m JOIN laser l ON l.id = m.laser_id JOIN sheet s ON s.id = m.sheet_id "
      "JOIN material t ON t.id = s.material_id ORDER BY m.id");
  if (!rows) return rows.error();
  std::vector<KerfModel> models;
  for (const Row& row : *rows) {
    RowReader in(row);
    KerfModel m;
    const long long id = in.integer();
    m.laser = in.text();
    m.material = in.text();
    m.thickness_mm = in.real();
    m.version = to_int(in.integer());
    m.lambda1 = in.real();
    m.lambda2 = in.real();
    m.r = in.real();
    m.source = in.text();
    m.runs_accepted = to_int(in.integer());
    m.runs_rejected = to_int(in.integer());
    const std::string sum = in.text();
    if (!in.next_is_null()) {
      KerfStatistics& s = m.statistics.emplace();
      s.n = to_int(in.integer());
      s.se_lambda1 = in.real();
      s.se_lambda2 = in.real();
      s.residual_sd = in.real();
      s.mean_q = in.real();
      s.sum_sq_q = in.real();
    }
    m.permissible = (*tables)[id];
    if (!in.good() || !plausible(m) || checksum(m) != sum) {
      return damaged(path, "the figures of a model are not those that were written");
    }
    models.push_back(std::move(m));
  }
  std::sort(models.begin(), models.end(), [](const KerfModel& a, const KerfModel& b) {
    return std::tie(a.laser, a.material, a.thickness_mm, a.version) <
           std::tie(b.laser, b.material, b.thickness_mm, b.version);
  });
  return models;
}

Result<void> store_fit(const Connection& connection, KerfFit& fit) {
  KerfModel& m = fit.model;
  auto laser = laser_id(connection, m.laser, "", Value{}, Value{}, m.source);
  if (!laser) return laser.error();
  auto sheet = sheet_id(connection, m.material, "", m.source, m.thickness_mm);
  if (!sheet) return sheet.error();
  auto rows =
      connection.query("SELECT coalesce(max(version), 0) FROM model WHERE laser_id = ?1 AND sheet_id = ?2",
                       {*laser, *sheet}, 1);
  if (!rows) return rows.error();
  const auto* newest = rows->empty() ? nullptr : std::get_if<long long>(&rows->front().front());
  m.version = newest == nullptr ? 1 : to_int(*newest) + 1;

  const double gas = fit.runs.front().gas_mpa;
  const bool one_gas =
      std::all_of(fit.runs.begin(), fit.runs.end(), [gas](const KerfRun& run) { return run.gas_mpa == gas; });
  auto model = store_model(connection, m, *laser, *sheet, one_gas ? Value{gas} : Value{});
  if (!model) return model.error();
  for (const KerfRun& run : fit.runs) {
    const auto reason = rejection(run);
    auto stored = connection.execute(
        "INSERT INTO experiment(model_id, line, power_w, speed_mm_min, gas_mpa, kerf_top_mm, kerf_bottom_mm, "
        "dross_area_mm2, straightness_mm, rejected, source) VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, "
        "?11)",
        {*model, static_cast<long long>(run.line), run.power_w, run.speed_mm_min, run.gas_mpa,
         run.kerf_top_mm, run.kerf_bottom_mm, run.dross_area_mm2, run.straightness_mm,
         reason ? Value{*reason} : Value{}, m.source});
    if (!stored) return stored.error();
  }
  return {};
}

}  // namespace burin::model
