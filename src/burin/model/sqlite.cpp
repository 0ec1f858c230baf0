// SPDX-License-Identifier: Apache-2.0
#include "burin/model/sqlite.h"

#include <sqlite3.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

namespace burin::model::sqlite {
namespace {

/// How long another process may hold the file before the user is told.
constexpr int kBusyMilliseconds = 1500;
/// Virtual-machine steps after which a statement is stopped: far above any honest database of this kind, and
/// the end of a statement that a damaged or hostile file has made endless.
constexpr int kStepsPerCheck = 1'000'000;
constexpr int kMaxChecks = 2000;

struct Finalize {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

int bind(sqlite3_stmt* statement, int index, const Value& value) {
  if (const auto* integer = std::get_if<long long>(&value))
    return sqlite3_bind_int64(statement, index, *integer);
  if (const auto* real = std::get_if<double>(&value)) return sqlite3_bind_double(statement, index, *real);
  if (const auto* text = std::get_if<std::string>(&value)) {
    return sqlite3_bind_text64(statement, index, text->data(), text->size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  }
  return sqlite3_bind_null(statement, index);
}

Value column(sqlite3_stmt* statement, int index) {
  switch (sqlite3_column_type(statement, index)) {
    case SQLITE_INTEGER:
      return static_cast<long long>(sqlite3_column_int64(statement, index));
    case SQLITE_FLOAT:
      return sqlite3_column_double(statement, index);
    case SQLITE_TEXT: {
      const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, index));
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, index));
      return text == nullptr ? Value{} : Value{std::string(text, size)};
    }
    default:
      return {};
  }
}

/// Stops a statement that runs on and on; the counter belongs to the statement, not to the connection.
class StepLimit {
 public:
  explicit StepLimit(sqlite3* handle) : handle_(handle) {
    sqlite3_progress_handler(handle_, kStepsPerCheck, &check, this);
  }
  ~StepLimit() { sqlite3_progress_handler(handle_, 0, nullptr, nullptr); }
  StepLimit(const StepLimit&) = delete;
  StepLimit& operator=(const StepLimit&) = delete;

 private:
  static int check(void* self) { return ++static_cast<StepLimit*>(self)->checks_ > kMaxChecks ? 1 : 0; }
  sqlite3* handle_;
  int checks_ = 0;
};

Result<void> regular_or_missing(const std::string& path, Mode mode) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) {
    if (errno == ENOENT && mode == Mode::create) return {};
    return Error{ErrorCode::io, std::string("cannot be opened: ") + std::strerror(errno), {.file = path}};
  }
  if (!S_ISREG(info.st_mode))
    return Error{ErrorCode::io, "is not a file (a kerf database is wanted)", {.file = path}};
  return {};
}

}  // namespace

void Connection::Close::operator()(sqlite3* handle) const {
  sqlite3_close_v2(handle);
}

Error Connection::error(int code) const {
  const Where where{.file = path_};
  switch (code & 0xff) {
    case SQLITE_NOTADB:
      return {ErrorCode::data, "is not a database (a kerf database made by \"burin kerf learn\")", where};
    case SQLITE_CORRUPT:
    case SQLITE_FORMAT:
      return {ErrorCode::data, "is damaged (restore a copy, or learn again into a new file)", where};
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_PROTOCOL:
      return {ErrorCode::data, "is locked by another program (try again when it has finished)", where};
    case SQLITE_READONLY:
      return {ErrorCode::io, "cannot be written: it or its folder is read-only", where};
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return {ErrorCode::io, "cannot be written: permission denied", where};
    case SQLITE_FULL:
      return {ErrorCode::io, "cannot be written: no space left; nothing was changed", where};
    case SQLITE_IOERR:
      return {ErrorCode::io, "cannot be read or written: input/output error; nothing was changed", where};
    case SQLITE_CANTOPEN:
      return {ErrorCode::io, "cannot be opened (a file in a folder that exists and can be written)", where};
    case SQLITE_NOMEM:
      return {ErrorCode::io, "out of memory", where};
    case SQLITE_INTERRUPT:
      return {ErrorCode::data, "is damaged or far too large: a query did not end", where};
    default:
      return {ErrorCode::data,
              std::string("is not usable as a kerf database: ") + sqlite3_errmsg(handle_.get()), where};
  }
}

Result<Connection> Connection::open(const std::string& path, Mode mode) {
  if (mode != Mode::memory) {
    if (auto fine = regular_or_missing(path, mode); !fine) return fine.error();
  }
  // SQLite gives ":memory:" and names without folder a meaning of its own.
  const std::string name = mode == Mode::memory ? ":memory:" : path.starts_with('/') ? path : "./" + path;
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_PRIVATECACHE | SQLITE_OPEN_EXRESCODE |
                    (mode == Mode::read_write ? 0 : SQLITE_OPEN_CREATE);
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &handle, flags, nullptr);
  Connection connection(handle, path);
  if (code != SQLITE_OK) return connection.error(code);
  sqlite3_busy_timeout(handle, kBusyMilliseconds);
  // The file may be hostile: no loading of code, no tricks through the schema, cells checked while they are
  // read.
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, 16 << 20);
  if (auto set =
          connection.run("PRAGMA cell_size_check = ON; PRAGMA foreign_keys = ON; PRAGMA mmap_size = 0");
      !set) {
    return set.error();
  }
  return connection;
}

Result<void> Connection::run(const std::string& sql) const {
  const StepLimit limit(handle_.get());
  const int code = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return error(code);
  return {};
}

Result<std::vector<Row>> Connection::query(std::string_view sql, const std::vector<Value>& values,
                                           std::size_t max_rows) const {
  const StepLimit limit(handle_.get());
  sqlite3_stmt* raw = nullptr;
  int code = sqlite3_prepare_v2(handle_.get(), sql.data(), static_cast<int>(sql.size()), &raw, nullptr);
  const Statement statement(raw);
  if (code != SQLITE_OK) return error(code);
  for (std::size_t i = 0; i < values.size(); ++i) {
    code = bind(raw, static_cast<int>(i) + 1, values[i]);
    if (code != SQLITE_OK) return error(code);
  }
  std::vector<Row> rows;
  while ((code = sqlite3_step(raw)) == SQLITE_ROW) {
    if (rows.size() == max_rows) {
      return Error{
          ErrorCode::data, "holds more than " + std::to_string(max_rows) + " entries", {.file = path_}};
    }
    Row row;
    for (int i = 0; i < sqlite3_column_count(raw); ++i) row.push_back(column(raw, i));
    rows.push_back(std::move(row));
  }
  if (code != SQLITE_DONE) return error(code);
  return rows;
}

Result<void> Connection::execute(std::string_view sql, const std::vector<Value>& values) const {
  if (auto rows = query(sql, values); !rows) return rows.error();
  return {};
}

Result<long long> Connection::integer(const std::string& sql) const {
  auto rows = query(sql, {}, 1);
  if (!rows) return rows.error();
  if (rows->empty() || rows->front().empty()) return error(SQLITE_CORRUPT);
  const auto* value = std::get_if<long long>(&rows->front().front());
  return value == nullptr ? Result<long long>(error(SQLITE_CORRUPT)) : Result<long long>(*value);
}

bool Connection::read_only() const {
  return sqlite3_db_readonly(handle_.get(), "main") == 1;
}

long long Connection::last_row_id() const {
  return sqlite3_last_insert_rowid(handle_.get());
}

Result<Transaction> Transaction::begin(const Connection& connection) {
  if (auto begun = connection.run("BEGIN IMMEDIATE"); !begun) return begun.error();
  return Transaction(connection);
}

Result<void> Transaction::commit() {
  auto committed = connection_->run("COMMIT");
  if (committed) connection_ = nullptr;
  return committed;
}

Transaction::~Transaction() {
  if (connection_ == nullptr) return;
  // Some errors (disk full) have rolled back already; a second time is refused, which changes nothing.
  [[maybe_unused]] const auto ignored = connection_->run("ROLLBACK");
}

}  // namespace burin::model::sqlite
