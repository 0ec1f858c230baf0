// SPDX-License-Identifier: Apache-2.0
// What the user should know although the work went on: repaired, left out, doubtful. Collected by value and
// returned with the result; the program prints it and writes it into `warnings` of the JSON.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burin/base/error.h"

namespace burin {

/// `info`: repaired or assumed, exit code 0. `left_out`: something was not done that the user must know, exit
/// code 3.
enum class Severity { info, left_out };

struct Warning {
  Severity severity = Severity::info;
  std::string code;  ///< stable identifier, snake_case: "duplicate_removed", "open_chain", ...
  std::string message;
  Where where;
  std::optional<std::array<double, 3>> position_mm;
};

class Diagnostics {
 public:
  void add(Warning warning) { warnings_.push_back(std::move(warning)); }
  void info(std::string code, std::string message, Where where = {}) {
    add({Severity::info, std::move(code), std::move(message), std::move(where), std::nullopt});
  }
  void info_at(std::string code, std::string message, double x_mm, double y_mm, Where where = {}) {
    add({Severity::info, std::move(code), std::move(message), std::move(where), std::array{x_mm, y_mm, 0.0}});
  }
  void left_out(std::string code, std::string message, Where where = {}) {
    add({Severity::left_out, std::move(code), std::move(message), std::move(where), std::nullopt});
  }
  void left_out_at(std::string code, std::string message, double x_mm, double y_mm, Where where = {}) {
    add({Severity::left_out, std::move(code), std::move(message), std::move(where),
         std::array{x_mm, y_mm, 0.0}});
  }

  /// Names `file` in all warnings that have an entity or line but no file.
  void locate(const std::string& file);

  const std::vector<Warning>& warnings() const { return warnings_; }
  bool empty() const { return warnings_.empty(); }
  /// True when something was left out (exit code 3).
  bool anything_left_out() const;
  /// How many warnings carry this code.
  std::size_t count(std::string_view code) const;

 private:
  std::vector<Warning> warnings_;
};

/// Receives progress of long work: called from the working thread, seldom (at most about 100 times a stage).
class ProgressSink {
 public:
  virtual ~ProgressSink() = default;
  /// `stage`: short name of what is being done; `done` in [0, 1]. Returns false to ask for an early stop.
  virtual bool progress(std::string_view stage, double done) = 0;
};

/// Receives messages for developers (`--verbose`); never needed to understand a result.
class LogSink {
 public:
  virtual ~LogSink() = default;
  virtual void log(std::string_view message) = 0;
};

}  // namespace burin
