// SPDX-License-Identifier: Apache-2.0
// What went wrong and where. The library never prints: functions return Result<T> (result.h), and collect
// what the user should know besides in a Diagnostics (diagnostics.h); only the programs in apps/ talk.
#pragma once

#include <string>
#include <utility>

namespace burin {

/// What kind of failure; the program derives its exit code from it (Usage -> 2, everything else -> 1).
enum class ErrorCode {
  usage,        ///< an impossible value or combination of options
  io,           ///< a file cannot be opened, read, written or renamed
  syntax,       ///< a file is damaged or not of the format it should be
  unsupported,  ///< well formed, but something burin does not take
  range,        ///< a value outside its permissible range (kerf model, machine limit, size limit)
  geometry,     ///< the geometry cannot be processed (nothing left to cut, degenerate input)
  data,         ///< a database is damaged, locked or of a newer schema
  internal,     ///< a bug in burin
};

/// Where: FILE:LINE:COLUMN for texts, FILE:ENTITY for drawings. Fields that do not apply stay empty or 0.
struct Where {
  std::string file;
  int line = 0;        ///< from 1
  int column = 0;      ///< from 1
  std::string entity;  ///< handle or id in a drawing, e.g. "LINE 2F" or "path#outline"

  /// "file:12:5", "file:12", "file: LINE 2F", or "" when nothing is known.
  std::string to_string() const;
  bool operator==(const Where&) const = default;
};

/// `message` says what is wrong and, in parentheses, what would be accepted.
struct Error {
  ErrorCode code = ErrorCode::internal;
  std::string message;
  Where where;

  /// "FILE:LINE:COLUMN: message", the form of the command-line contract.
  std::string to_string() const;
  bool operator==(const Error&) const = default;
};

}  // namespace burin
