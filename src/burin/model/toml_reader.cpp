// SPDX-License-Identifier: Apache-2.0
#include "burin/model/toml_reader.h"

#include <cmath>

#include "burin/base/text.h"

namespace burin::model {

toml::table TomlReader::parse(std::string_view text) {
  try {
    return toml::parse(text, file_);
  } catch (const toml::parse_error& problem) {
    error_ = Error{ErrorCode::syntax,
                   std::string(problem.description()) + " (TOML is wanted)",
                   {.file = file_,
                    .line = static_cast<int>(problem.source().begin.line),
                    .column = static_cast<int>(problem.source().begin.column)}};
  }
  return {};
}

void TomlReader::fail(const toml::node& node, std::string message, ErrorCode code) {
  if (error_) return;
  const auto& at = node.source().begin;
  error_ = Error{code,
                 std::move(message),
                 {.file = file_, .line = static_cast<int>(at.line), .column = static_cast<int>(at.column)}};
}

void TomlReader::only_keys(const toml::table& table, const std::vector<std::string>& known) {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    bool fine = false;
    for (const std::string& word : known) fine = fine || word == name;
    if (fine) continue;
    std::string list;
    for (const std::string& word : known) list += (list.empty() ? "" : ", ") + word;
    const std::string near = nearest_word(name, known);
    fail(node, "unknown key \"" + name + "\" (" +
                   (near.empty() ? "one of: " + list : "did you mean " + near + "?") + ")");
  }
}

std::string TomlReader::text(const toml::table& table, std::string_view key,
                             std::optional<std::string> fallback) {
  const toml::node* node = table.get(key);
  if (node == nullptr) {
    if (fallback) return *fallback;
    fail(table, "key \"" + std::string(key) + "\" is missing (a text)");
    return {};
  }
  if (const auto* value = node->as_string()) return value->get();
  fail(*node, "\"" + std::string(key) + "\" is not a text (a text in quotes)");
  return {};
}

double TomlReader::number(const toml::table& table, std::string_view key, double min, double max,
                          std::optional<double> fallback) {
  const std::string accepted = " (" + format_shortest(min) + " to " + format_shortest(max) + ")";
  const toml::node* node = table.get(key);
  if (node == nullptr) {
    if (fallback) return *fallback;
    fail(table, "key \"" + std::string(key) + "\" is missing" + accepted);
    return 0;
  }
  if (!node->is_number()) {
    fail(*node, "\"" + std::string(key) + "\" is not a number" + accepted);
    return 0;
  }
  const double value = *node->value<double>();
  if (!std::isfinite(value) || value < min || value > max) {
    fail(*node, "\"" + std::string(key) + "\" is out of range" + accepted);
    return 0;
  }
  return value;
}

std::vector<double> TomlReader::triple(const toml::table& table, std::string_view key,
                                       std::optional<std::vector<double>> fallback) {
  const toml::node* node = table.get(key);
  const std::string message = "\"" + std::string(key) + "\" is not a triple (three numbers, [x, y, z])";
  if (node == nullptr) {
    if (fallback) return *fallback;
    fail(table, "key \"" + std::string(key) + "\" is missing (three numbers, [x, y, z])");
    return {0, 0, 0};
  }
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != 3) {
    fail(*node, message);
    return {0, 0, 0};
  }
  std::vector<double> values;
  for (const toml::node& entry : *array) {
    const double value = entry.is_number() ? *entry.value<double>() : std::nan("");
    if (!std::isfinite(value)) {
      fail(entry, message);
      return {0, 0, 0};
    }
    values.push_back(value);
  }
  return values;
}

std::vector<const toml::table*> TomlReader::tables(const toml::table& table, std::string_view key) {
  std::vector<const toml::table*> entries;
  const toml::node* node = table.get(key);
  if (node == nullptr) return entries;
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    fail(*node, "\"" + std::string(key) + "\" is not a list of tables ([[" + std::string(key) + "]])");
    return entries;
  }
  for (const toml::node& entry : *array) {
    if (const toml::table* inner = entry.as_table()) {
      entries.push_back(inner);
    } else {
      fail(entry,
           "\"" + std::string(key) + "\" holds something that is no table ([[" + std::string(key) + "]])");
    }
  }
  return entries;
}

const toml::table& TomlReader::subtable(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  if (node != nullptr && node->is_table()) return *node->as_table();
  fail(node == nullptr ? static_cast<const toml::node&>(table) : *node,
       "table [" + std::string(key) + "] is missing");
  return empty_;
}

bool TomlReader::flag(const toml::table& table, std::string_view key, bool fallback) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) {
    fail(*node, "\"" + std::string(key) + "\" is not true or false (true, false)");
    return fallback;
  }
  return *node->value<bool>();
}

std::pair<double, double> TomlReader::range(const toml::table& table, std::string_view key, double min,
                                            double max, std::pair<double, double> fallback) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return fallback;
  const std::string name = "\"" + std::string(key) + "\"";
  const std::string accepted =
      " ([lo, hi], both from " + format_shortest(min) + " to " + format_shortest(max) + ", lo not above hi)";
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != 2) {
    fail(*node, name + " is not a range" + accepted);
    return fallback;
  }
  double ends[2] = {};
  for (std::size_t i = 0; i < 2; ++i) {
    const toml::node& entry = *array->get(i);
    ends[i] = entry.is_number() ? *entry.value<double>() : std::nan("");
    if (ends[i] >= min && ends[i] <= max) continue;
    fail(entry,
         name + (entry.is_number() ? " is out of range" : " holds something that is no number") + accepted);
    return fallback;
  }
  if (ends[0] > ends[1]) {
    fail(*node, name + " is empty: " + format_shortest(ends[0]) + " is above " + format_shortest(ends[1]) +
                    accepted);
    return fallback;
  }
  return {ends[0], ends[1]};
}

}  // namespace burin::model
