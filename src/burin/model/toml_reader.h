// SPDX-License-Identifier: Apache-2.0
// TOML tables read with every key checked and every message with file, line and column. The first error
// sticks; the values after it are meaningless. Internal to model.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burin/base/result.h"

namespace burin::model {

class TomlReader {
 public:
  explicit TomlReader(std::string file_name) : file_(std::move(file_name)) {}

  /// The whole text as a table; an empty one after an error.
  toml::table parse(std::string_view text);

  /// Unknown keys are errors that name the nearest known one.
  void only_keys(const toml::table& table, const std::vector<std::string>& known);
  std::string text(const toml::table& table, std::string_view key,
                   std::optional<std::string> fallback = std::nullopt);
  double number(const toml::table& table, std::string_view key, double min, double max,
                std::optional<double> fallback = std::nullopt);
  /// Three finite numbers.
  std::vector<double> triple(const toml::table& table, std::string_view key,
                             std::optional<std::vector<double>> fallback = std::nullopt);
  /// The entries of an array of tables; nothing when the key is missing.
  std::vector<const toml::table*> tables(const toml::table& table, std::string_view key);
  const toml::table& subtable(const toml::table& table, std::string_view key);
  bool flag(const toml::table& table, std::string_view key, bool fallback);
  /// Two finite numbers in [min, max], the first not above the second.
  std::pair<double, double> range(const toml::table& table, std::string_view key, double min, double max,
                                  std::pair<double, double> fallback);
  /// One of a few words, each standing for a value.
  template <class T>
  T choice(const toml::table& table, std::string_view key,
           const std::vector<std::pair<std::string, T>>& choices, T fallback) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return fallback;
    const std::string word = text(table, key);
    std::string list;
    for (const auto& [name, value] : choices) {
      if (name == word) return value;
      list += (list.empty() ? "" : ", ") + name;
    }
    fail(*node, "\"" + std::string(key) + "\" is \"" + word + "\" (" + list + ")");
    return fallback;
  }

  void fail(const toml::node& node, std::string message, ErrorCode code = ErrorCode::syntax);
  const std::optional<Error>& error() const { return error_; }

 private:
  std::string file_;
  std::optional<Error> error_;
  toml::table empty_;
};

}  // namespace burin::model
