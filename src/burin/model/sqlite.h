// SPDX-License-Identifier: Apache-2.0
// A thin, throw-free layer over SQLite for small tables: statements with values in, rows of values out.
// Internal to model; the errors it returns are fit for the user.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "burin/base/result.h"

struct sqlite3;

namespace burin::model::sqlite {

using Value = std::variant<std::monostate, long long, double, std::string>;
using Row = std::vector<Value>;

enum class Mode { read_write, create, memory };

class Connection {
 public:
  /// Errors: io (cannot be opened, not a regular file), data (not a database, damaged, locked).
  static Result<Connection> open(const std::string& path, Mode mode);

  /// One or more statements without values.
  Result<void> run(const std::string& sql) const;
  Result<void> execute(std::string_view sql, const std::vector<Value>& values) const;
  /// More than `max_rows` rows are an error (data), so that a hostile file cannot fill the memory.
  Result<std::vector<Row>> query(std::string_view sql, const std::vector<Value>& values = {},
                                 std::size_t max_rows = 1'000'000) const;
  /// The first value of the first row as an integer.
  Result<long long> integer(const std::string& sql) const;
  bool read_only() const;
  long long last_row_id() const;

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  Connection(sqlite3* handle, std::string path) : handle_(handle), path_(std::move(path)) {}
  Error error(int code) const;

  std::unique_ptr<sqlite3, Close> handle_;
  std::string path_;
};

/// BEGIN IMMEDIATE ... COMMIT; the destructor rolls back what was not committed.
class Transaction {
 public:
  static Result<Transaction> begin(const Connection& connection);
  Result<void> commit();
  Transaction(Transaction&& other) noexcept : connection_(other.connection_) { other.connection_ = nullptr; }
  Transaction& operator=(Transaction&&) = delete;
  ~Transaction();

 private:
  explicit Transaction(const Connection& connection) : connection_(&connection) {}
  const Connection* connection_;
};

}  // namespace burin::model::sqlite
