// SPDX-License-Identifier: Apache-2.0
#include "burin/model/kerf.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>

#include "burin/model/kerf_predict.h"
#include "burin/model/kerf_runs.h"
#include "burin/model/kerf_schema.h"
#include "burin/model/sqlite.h"

namespace burin::model {
namespace {

namespace fs = std::filesystem;
using sqlite::Connection;
using sqlite::Mode;
using sqlite::Transaction;

/// Checking a file takes time in proportion to its size; a kerf database has some hundred kilobytes.
constexpr std::uintmax_t kMaxFileBytes = 1ull << 30;

/// Public functions do not throw: memory is the only thing that can run out in here.
template <class Function>
auto guarded(const std::string& path, Function function) -> decltype(function()) {
  try {
    return function();
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::io, "out of memory", {.file = path}};
  } catch (const std::exception& problem) {
    return Error{ErrorCode::internal, problem.what(), {.file = path}};
  }
}

Result<Connection> open_built_in() {
  auto connection = Connection::open("", Mode::memory);
  if (!connection) return connection.error();
  auto transaction = Transaction::begin(*connection);
  if (!transaction) return transaction.error();
  if (auto made = create_schema(*connection); !made) return made.error();
  if (auto committed = transaction->commit(); !committed) return committed.error();
  return connection;
}

Result<Connection> open_file(const std::string& path) {
  std::error_code ignored;
  const auto size = fs::file_size(path, ignored);
  if (!ignored && size > kMaxFileBytes) {
    return Error{ErrorCode::data, "is far too large for a kerf database (at most 1 GiB)", {.file = path}};
  }
  auto connection = Connection::open(path, Mode::read_write);
  if (!connection) return connection.error();
  if (auto checked = check_schema(*connection, path); !checked) return checked.error();
  return connection;
}

/// True when there is nothing yet that could be opened: no file, or one without a byte.
bool nothing_there(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return !error;
  return fs::is_regular_file(path, error) && !error && fs::file_size(path, error) == 0 && !error;
}

/// Removes a file that this run has made and that has stayed empty because of an error.
class EmptyFileRemover {
 public:
  explicit EmptyFileRemover(const std::string& path) : path_(path) {
    std::error_code error;
    is_new_ = !fs::exists(path, error) && !error;
  }
  ~EmptyFileRemover() {
    std::error_code ignored;
    if (is_new_ && fs::file_size(path_, ignored) == 0 && !ignored) fs::remove(path_, ignored);
  }
  EmptyFileRemover(const EmptyFileRemover&) = delete;
  EmptyFileRemover& operator=(const EmptyFileRemover&) = delete;

 private:
  std::string path_;
  bool is_new_ = false;
};

}  // namespace

struct KerfDatabase::Impl {
  Connection connection;
  std::string path;  ///< empty: the built-in table in memory
  bool pending =
      false;  ///< the file at `path` is made by the first learn(); until then the built-in table serves

  Result<void> store(const Connection& target, std::vector<KerfFit>& fits, bool create) const;
  Result<void> store_in_new_file(std::vector<KerfFit>& fits);
};

/// All or nothing. The write lock is taken before the newest version is read, so two learners get two
/// versions.
Result<void> KerfDatabase::Impl::store(const Connection& target, std::vector<KerfFit>& fits,
                                       bool create) const {
  auto transaction = Transaction::begin(target);
  if (!transaction) return transaction.error();
  if (create) {
    auto blank = is_blank(target);
    if (!blank) return blank.error();
    // Another process may have made the file since we looked: then it is used as it is.
    if (auto ready = *blank ? create_schema(target) : check_schema(target, path); !ready)
      return ready.error();
  }
  for (KerfFit& fit : fits) {
    if (auto stored = store_fit(target, fit); !stored) return stored.error();
  }
  return transaction->commit();
}

Result<void> KerfDatabase::Impl::store_in_new_file(std::vector<KerfFit>& fits) {
  const fs::path folder = fs::path(path).parent_path();
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) return Error{ErrorCode::io, "its folder cannot be made: " + error.message(), {.file = path}};
  const EmptyFileRemover remover(path);
  auto file = Connection::open(path, Mode::create);
  if (!file) return file.error();
  if (auto stored = store(*file, fits, true); !stored) return stored.error();
  connection = std::move(file).value();
  pending = false;
  return {};
}

KerfDatabase::KerfDatabase(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
KerfDatabase::KerfDatabase(KerfDatabase&&) noexcept = default;
KerfDatabase& KerfDatabase::operator=(KerfDatabase&&) noexcept = default;
KerfDatabase::~KerfDatabase() = default;

Result<KerfDatabase> KerfDatabase::built_in() {
  return guarded("", []() -> Result<KerfDatabase> {
    auto connection = open_built_in();
    if (!connection) return connection.error();
    return KerfDatabase(std::make_unique<Impl>(Impl{std::move(connection).value(), "", false}));
  });
}

Result<KerfDatabase> KerfDatabase::open(const std::string& path) {
  return guarded(path, [&]() -> Result<KerfDatabase> {
    auto connection = open_file(path);
    if (!connection) return connection.error();
    return KerfDatabase(std::make_unique<Impl>(Impl{std::move(connection).value(), path, false}));
  });
}

Result<KerfDatabase> KerfDatabase::open_or_create(const std::string& path) {
  return guarded(path, [&]() -> Result<KerfDatabase> {
    if (path.empty()) {
      return Error{
          ErrorCode::usage, "the kerf database has no place (--db FILE, or XDG_DATA_HOME or HOME set)", {}};
    }
    if (!nothing_there(path)) return open(path);
    auto connection = open_built_in();
    if (!connection) return connection.error();
    return KerfDatabase(std::make_unique<Impl>(Impl{std::move(connection).value(), path, true}));
  });
}

std::string KerfDatabase::user_path() {
  // The base-directory rule: a relative XDG_DATA_HOME is to be ignored.
  const char* data_home = std::getenv("XDG_DATA_HOME");
  if (data_home != nullptr && data_home[0] == '/') return std::string(data_home) + "/burin/kerf.db";
  const char* home = std::getenv("HOME");
  if (home != nullptr && home[0] != '\0') return std::string(home) + "/.local/share/burin/kerf.db";
  return "";
}

Result<KerfDatabase> KerfDatabase::open_default() {
  const std::string path = user_path();
  std::error_code error;
  const bool exists = !path.empty() && fs::exists(path, error);
  if (error) return Error{ErrorCode::io, "cannot be read: " + error.message(), {.file = path}};
  return exists ? open(path) : built_in();
}

Result<std::vector<KerfModel>> KerfDatabase::models() const {
  return guarded(impl_->path, [&] { return load_models(impl_->connection, impl_->path); });
}

Result<KerfPrediction> KerfDatabase::predict(const KerfQuery& query) const {
  return guarded(impl_->path, [&]() -> Result<KerfPrediction> {
    auto known = models();
    if (!known) return known.error();
    return predict_kerf(*known, query);
  });
}

Result<std::vector<KerfSuggestion>> KerfDatabase::suggest(const KerfQuery& query) const {
  return guarded(impl_->path, [&]() -> Result<std::vector<KerfSuggestion>> {
    auto known = models();
    if (!known) return known.error();
    return suggest_settings(*known, query);
  });
}

Result<LearnReport> KerfDatabase::learn(std::string_view csv, const std::string& file_name) {
  return guarded(impl_->path, [&]() -> Result<LearnReport> {
    auto runs = parse_runs(csv, file_name);
    if (!runs) return runs.error();
    auto fits = fit_runs(*runs, file_name);
    if (!fits) return fits.error();
    if (!impl_->pending && impl_->connection.read_only()) {
      return Error{ErrorCode::io,
                   "cannot be written: it is read-only (--db FILE names another one)",
                   {.file = impl_->path}};
    }
    auto stored =
        impl_->pending ? impl_->store_in_new_file(*fits) : impl_->store(impl_->connection, *fits, false);
    if (!stored) return stored.error();
    LearnReport report;
    for (KerfFit& fit : *fits) report.models.push_back(std::move(fit.model));
    for (const KerfRun& run : *runs) {
      if (auto reason = rejection(run)) report.rejected.push_back({run.line, *reason});
    }
    return report;
  });
}

Result<std::string> KerfDatabase::export_csv() const {
  return guarded(impl_->path, [&]() -> Result<std::string> {
    auto known = models();
    if (!known) return known.error();
    return models_to_csv(*known);
  });
}

}  // namespace burin::model
