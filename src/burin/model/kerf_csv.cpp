// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "burin/base/text.h"
#include "burin/model/kerf_runs.h"

namespace burin::model {
namespace {

struct Record {
  int line = 0;  ///< where it starts, from 1
  std::vector<std::string> fields;
};

/// RFC 4180, one record at a time. Field sizes are bounded by the text itself.
class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& file_name) : text_(text), file_(file_name) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  }

  bool at_end() const { return at_ >= text_.size(); }

  Result<Record> next() {
    Record record{.line = line_, .fields = {}};
    for (;;) {
      auto field = text_[at_ < text_.size() ? at_ : 0] == '"' && !at_end() ? quoted_field() : plain_field();
      if (!field) return field.error();
      record.fields.push_back(std::move(field).value());
      if (at_end()) return record;
      const char separator = text_[at_++];
      if (separator == ',') continue;
      ++line_;
      return record;
    }
  }

 private:
  Error error(const std::string& message) const {
    return {ErrorCode::syntax, message, {.file = file_, .line = line_}};
  }

  Result<std::string> plain_field() {
    const std::size_t start = at_;
    while (!at_end() && text_[at_] != ',' && text_[at_] != '\n') {
      if (text_[at_] == '"')
        return error("a quote inside a field (quote the whole field and double the quotes in it)");
      if (text_[at_] == '\0') return error("a zero byte (CSV text is wanted)");
      ++at_;
    }
    return std::string(trim(text_.substr(start, at_ - start)));
  }

  Result<std::string> quoted_field() {
    const int start_line = line_;
    std::string field;
    for (++at_;; ++at_) {
      if (at_end()) {
        line_ = start_line;
        return error("a quote is not closed (\")");
      }
      const char c = text_[at_];
      if (c == '\n') ++line_;
      if (c != '"') {
        field += c;
        continue;
      }
      if (at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
        field += text_[++at_];
        continue;
      }
      break;
    }
    ++at_;
    while (!at_end() && (text_[at_] == ' ' || text_[at_] == '\r')) ++at_;
    if (!at_end() && text_[at_] != ',' && text_[at_] != '\n') {
      return error("text after a closing quote (a comma or the end of the line)");
    }
    return field;
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// One column of the contract. Names have no number rule.
struct Column {
  const char* name;
  double KerfRun::*number = nullptr;
  std::string KerfRun::*text = nullptr;
  double max = 0;
  bool zero_allowed = false;
};
/// The upper bounds only catch slips (a speed in m/s, a width in micrometres).
constexpr std::array<Column, 10> kColumns{{
    {"laser", nullptr, &KerfRun::laser},
    {"material", nullptr, &KerfRun::material},
    {"thickness_mm", &KerfRun::thickness_mm, nullptr, 1000},
    {"power_w", &KerfRun::power_w, nullptr, 1e6},
    {"speed_mm_min", &KerfRun::speed_mm_min, nullptr, 1e7},
    {"gas_mpa", &KerfRun::gas_mpa, nullptr, 1000, true},
    {"kerf_top_mm", &KerfRun::kerf_top_mm, nullptr, 100, true},
    {"kerf_bottom_mm", &KerfRun::kerf_bottom_mm, nullptr, 100, true},
    {"dross_area_mm2", &KerfRun::dross_area_mm2, nullptr, 1e6, true},
    {"straightness_mm", &KerfRun::straightness_mm, nullptr, 1000, true},
}};
constexpr std::size_t kMaxNameLength = 100;

std::string column_list() {
  std::string text;
  for (const Column& column : kColumns) text += (text.empty() ? "" : ",") + std::string(column.name);
  return text;
}

/// For each field of a record the column it belongs to.
Result<std::vector<const Column*>> read_header(const Record& record, const std::string& file) {
  const Where where{.file = file, .line = record.line};
  std::vector<std::string> names;
  for (const Column& column : kColumns) names.push_back(column.name);
  std::vector<const Column*> order;
  for (const std::string& field : record.fields) {
    const Column* found = nullptr;
    for (const Column& column : kColumns) {
      if (field == column.name) found = &column;
    }
    if (found == nullptr) {
      const std::string near = nearest_word(field, names);
      return Error{ErrorCode::syntax,
                   "unknown column \"" + field + "\" (" +
                       (near.empty() ? "the first line names the columns: " + column_list()
                                     : "did you mean " + near + "?") +
                       ")",
                   where};
    }
    for (const Column* earlier : order) {
      if (earlier == found)
        return Error{ErrorCode::syntax, "column " + field + " stands twice (once each)", where};
    }
    order.push_back(found);
  }
  for (const Column& column : kColumns) {
    bool there = false;
    for (const Column* given : order) there = there || given == &column;
    if (!there) {
      return Error{ErrorCode::syntax,
                   std::string("column ") + column.name + " is missing (" + column_list() + ")", where};
    }
  }
  return order;
}

Result<void> take_field(const Column& column, const std::string& field, const Where& where, KerfRun& run) {
  if (column.text != nullptr) {
    const std::string name(trim(field));
    bool fine = !name.empty() && name.size() <= kMaxNameLength;
    for (const char c : name) fine = fine && static_cast<unsigned char>(c) >= 0x20;
    if (!fine) {
      return Error{ErrorCode::syntax,
                   std::string(column.name) + " is not a name (1 to " + std::to_string(kMaxNameLength) +
                       " characters)",
                   where};
    }
    run.*column.text = name;
    return {};
  }
  const std::string accepted = std::string(" (") + (column.zero_allowed ? "0" : "above 0") + " to " +
                               format_fixed(column.max, 0) + ", with a decimal point)";
  const auto value = parse_double(field);
  if (!value) {
    return Error{ErrorCode::syntax,
                 std::string(column.name) + " \"" + field + "\" is not a number" + accepted, where};
  }
  if (*value < 0 || *value > column.max || (*value == 0 && !column.zero_allowed)) {
    return Error{ErrorCode::syntax, std::string(column.name) + " " + field + " is not possible" + accepted,
                 where};
  }
  run.*column.number = *value;
  return {};
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

}  // namespace

Result<std::vector<KerfRun>> parse_runs(std::string_view csv, const std::string& file_name) {
  CsvReader reader(csv, file_name);
  std::vector<const Column*> columns;
  std::vector<KerfRun> runs;
  while (!reader.at_end()) {
    auto record = reader.next();
    if (!record) return record.error();
    if (record->fields.size() == 1 && record->fields.front().empty()) continue;
    if (columns.empty()) {
      auto header = read_header(*record, file_name);
      if (!header) return header.error();
      columns = std::move(header).value();
      continue;
    }
    const Where where{.file = file_name, .line = record->line};
    if (record->fields.size() != columns.size()) {
      return Error{ErrorCode::syntax,
                   std::to_string(record->fields.size()) + " fields (" + std::to_string(columns.size()) +
                       ", as the first line names them)",
                   where};
    }
    KerfRun run{.line = record->line};
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (auto taken = take_field(*columns[i], record->fields[i], where, run); !taken) return taken.error();
    }
    runs.push_back(std::move(run));
  }
  if (columns.empty()) {
    return Error{ErrorCode::syntax,
                 "is empty (the first line names the columns: " + column_list() + ")",
                 {.file = file_name}};
  }
  if (runs.empty())
    return Error{
        ErrorCode::data, "holds no runs (one a line below the names of the columns)", {.file = file_name}};
  return runs;
}

std::string models_to_csv(const std::vector<KerfModel>& models) {
  std::string csv =
      "laser,material,thickness_mm,version,lambda1,lambda2,r,runs_accepted,runs_rejected,se_lambda1,se_"
      "lambda2,"
      "residual_sd_mm,permissible,source\n";
  for (const KerfModel& m : models) {
    csv += csv_field(m.laser) + "," + csv_field(m.material) + "," + format_shortest(m.thickness_mm) + "," +
           std::to_string(m.version) + "," + format_shortest(m.lambda1) + "," + format_shortest(m.lambda2) +
           "," + format_shortest(m.r) + "," + std::to_string(m.runs_accepted) + "," +
           std::to_string(m.runs_rejected) + ",";
    if (m.statistics) {
      csv += format_shortest(m.statistics->se_lambda1) + "," + format_shortest(m.statistics->se_lambda2) +
             "," + format_shortest(m.statistics->residual_sd);
    } else {
      csv += ",,";
    }
    std::string ranges;
    for (const PermissibleRange& range : m.permissible) {
      ranges += (ranges.empty() ? "" : " ") + format_shortest(range.power_w) + ":" +
                format_shortest(range.speed_min) + "-" + format_shortest(range.speed_max);
    }
    csv += "," + ranges + "," + csv_field(m.source) + "\n";
  }
  return csv;
}

}  // namespace burin::model
