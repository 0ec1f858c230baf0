// SPDX-License-Identifier: Apache-2.0
// The database as a file: creation, transactions, damage, locks, other programs' files.
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "burin/base/file.h"
#include "burin/model/kerf.h"

namespace burin::model {
namespace {

namespace fs = std::filesystem;

const std::string kRuns =
    "laser,material,thickness_mm,power_w,speed_mm_min,gas_mpa,kerf_top_mm,kerf_bottom_mm,dross_area_mm2,"
    "straightness_mm\n"
    "lab,steel,1.2,1000,5000,0.1,0.55,0.45,0.1,0.001\n"
    "lab,steel,1.2,1200,5000,0.1,0.58,0.46,0.1,0.001\n"
    "lab,steel,1.2,1400,4000,0.1,0.61,0.47,0.1,0.001\n"
    "lab,steel,1.2,1400,3000,0.1,0.69,0.48,0.9,0.001\n";

class KerfFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("burin-kerf-" + std::to_string(getpid()) + "-" +
                                          ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder);
    path = folder / "kerf.db";
  }
  void TearDown() override { fs::remove_all(folder); }

  void make() {
    auto database = KerfDatabase::open_or_create(path);
    ASSERT_TRUE(database.ok());
    const auto learned = database->learn(kRuns, "runs.csv");
    ASSERT_TRUE(learned.ok()) << learned.error().to_string();
  }
  /// What sqlite3_exec says, through a connection of its own.
  int exec(const std::string& sql) {
    sqlite3* handle = nullptr;
    sqlite3_open(path.c_str(), &handle);
    const int code = sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, nullptr);
    sqlite3_close(handle);
    return code;
  }
  Error refusal() {
    const auto database = KerfDatabase::open(path);
    if (!database.ok()) return database.error();
    const auto models = database->models();
    EXPECT_FALSE(models.ok());
    return models.ok() ? Error{} : models.error();
  }

  fs::path folder;
  std::string path;
};

TEST_F(KerfFile, FirstLearnMakesFolderAndFile) {
  path = folder / "a" / "b" / "kerf.db";
  {
    auto database = KerfDatabase::open_or_create(path);
    ASSERT_TRUE(database.ok());
    EXPECT_EQ(database->models()->size(), 4u);
    EXPECT_FALSE(fs::exists(path));  // nothing before something is learned
    EXPECT_FALSE(database->learn("nonsense", "runs.csv").ok());
    EXPECT_FALSE(fs::exists(folder / "a"));
    ASSERT_TRUE(database->learn(kRuns, "runs.csv").ok());
    EXPECT_EQ(database->models()->size(), 5u);
  }
  const auto again = KerfDatabase::open(path);
  ASSERT_TRUE(again.ok()) << again.error().to_string();
  EXPECT_EQ(again->models()->size(), 5u);
}

TEST_F(KerfFile, KeepsTheRunsWithTheirSource) {
  make();
  sqlite3* handle = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &handle), SQLITE_OK);
  sqlite3_stmt* statement = nullptr;
  ASSERT_EQ(
      sqlite3_prepare_v2(handle, "SELECT count(*), count(rejected), min(source), max(line) FROM experiment",
                         -1, &statement, nullptr),
      SQLITE_OK);
  ASSERT_EQ(sqlite3_step(statement), SQLITE_ROW);
  EXPECT_EQ(sqlite3_column_int(statement, 0), 4);
  EXPECT_EQ(sqlite3_column_int(statement, 1), 1);
  EXPECT_STREQ(reinterpret_cast<const char*>(sqlite3_column_text(statement, 2)), "runs.csv");
  EXPECT_EQ(sqlite3_column_int(statement, 3), 5);
  sqlite3_finalize(statement);
  sqlite3_close(handle);
}

TEST_F(KerfFile, TwoLearnersGetTwoVersions) {
  make();
  auto one = KerfDatabase::open_or_create(path), two = KerfDatabase::open_or_create(path);
  ASSERT_TRUE(one.ok() && two.ok());
  EXPECT_EQ(one->learn(kRuns, "a.csv")->models[0].version, 2);
  EXPECT_EQ(two->learn(kRuns, "b.csv")->models[0].version, 3);
  EXPECT_EQ(one->models()->size(), 7u);
}

TEST_F(KerfFile, TwoFirstLearnersBothKeepTheirModels) {
  auto one = KerfDatabase::open_or_create(path), two = KerfDatabase::open_or_create(path);
  ASSERT_TRUE(one.ok() && two.ok());
  EXPECT_EQ(one->learn(kRuns, "a.csv")->models[0].version, 1);
  EXPECT_EQ(two->learn(kRuns, "b.csv")->models[0].version, 2);
  EXPECT_EQ(KerfDatabase::open(path)->models()->size(), 6u);
}

TEST_F(KerfFile, AFailedLearnChangesNoByte) {
  make();
  const std::string before = read_file(path).value();
  auto database = KerfDatabase::open(path);
  ASSERT_TRUE(database.ok());
  EXPECT_FALSE(database->learn(kRuns + "lab,steel,1.2,x,1,1,1,1,1,1\n", "bad.csv").ok());
  EXPECT_FALSE(database->learn(kRuns + "other,steel,1.2,1400,4000,0.1,0.6,0.5,0.1,0.001\n", "few.csv").ok());
  EXPECT_EQ(read_file(path).value(), before);
}

TEST_F(KerfFile, LockedByAnotherConnectionIsSaidAndNothingIsLost) {
  make();
  const auto before = KerfDatabase::open(path)->export_csv();
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr), SQLITE_OK);
  const auto locked = KerfDatabase::open(path);
  ASSERT_FALSE(locked.ok());
  EXPECT_EQ(locked.error().code, ErrorCode::data);
  EXPECT_NE(locked.error().message.find("locked"), std::string::npos);
  sqlite3_exec(other, "ROLLBACK; BEGIN IMMEDIATE", nullptr, nullptr, nullptr);
  auto readable = KerfDatabase::open(path);  // a writer that has not written yet leaves readers alone
  ASSERT_TRUE(readable.ok());
  const auto learned = readable->learn(kRuns, "c.csv");
  ASSERT_FALSE(learned.ok());
  EXPECT_NE(learned.error().message.find("locked"), std::string::npos);
  sqlite3_close(other);
  EXPECT_EQ(readable->export_csv().value(), before.value());
  EXPECT_TRUE(readable->learn(kRuns, "c.csv").ok());
}

TEST_F(KerfFile, NoSpaceIsSaidAndNothingIsLost) {
  make();
  auto database = KerfDatabase::open(path);
  ASSERT_TRUE(database.ok());
  const auto before = database->export_csv();
  std::string many = kRuns;
  for (int i = 0; i < 20000; ++i) many += "lab,steel,1.2,1400,4000,0.1,0.61,0.47,0.1,0.001\n";
  // A file size limit stands in for a full disk: SQLite sees the same failing write.
  rlimit old{}, tight{};
  getrlimit(RLIMIT_FSIZE, &old);
  tight = old;
  tight.rlim_cur = fs::file_size(path) + 4096;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &tight);
  const auto learned = database->learn(many, "many.csv");
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(learned.ok());
  EXPECT_EQ(learned.error().code, ErrorCode::io) << learned.error().to_string();
  EXPECT_EQ(KerfDatabase::open(path)->export_csv().value(), before.value());
}

TEST_F(KerfFile, NoSpaceOnTheFirstLearnLeavesNoFile) {
  auto database = KerfDatabase::open_or_create(path);
  ASSERT_TRUE(database.ok());
  rlimit old{}, tight{};
  getrlimit(RLIMIT_FSIZE, &old);
  tight = old;
  tight.rlim_cur = 0;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &tight);
  const auto learned = database->learn(kRuns, "runs.csv");
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(learned.ok());
  EXPECT_EQ(learned.error().code, ErrorCode::io) << learned.error().to_string();
  EXPECT_TRUE(fs::is_empty(folder));
  EXPECT_TRUE(database->learn(kRuns, "runs.csv").ok());
}

TEST_F(KerfFile, OtherFilesAreRefused) {
  ASSERT_TRUE(write_file(path, "").ok());
  EXPECT_NE(refusal().message.find("is empty"), std::string::npos);
  ASSERT_TRUE(write_file(path, std::string(5000, 'x')).ok());
  EXPECT_NE(refusal().message.find("is not a database"), std::string::npos);
  EXPECT_FALSE(KerfDatabase::open_or_create(path).ok());
  fs::remove(path);
  ASSERT_EQ(exec("CREATE TABLE other(a)"), SQLITE_OK);
  EXPECT_NE(refusal().message.find("not of kerf models"), std::string::npos);
  fs::remove(path);
  EXPECT_EQ(refusal().code, ErrorCode::io);
  fs::create_directory(path);
  EXPECT_EQ(refusal().code, ErrorCode::io);
  fs::remove(path);
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(refusal().code, ErrorCode::io);  // and it does not wait for somebody to write
  EXPECT_EQ(KerfDatabase::open("/proc/none/kerf.db").error().code, ErrorCode::io);
  auto nowhere = KerfDatabase::open_or_create("/proc/none/kerf.db");
  ASSERT_TRUE(nowhere.ok());
  EXPECT_EQ(nowhere->learn(kRuns, "runs.csv").error().code, ErrorCode::io);
}

TEST_F(KerfFile, AnEmptyFileIsFilledByTheFirstLearn) {
  ASSERT_TRUE(write_file(path, "").ok());
  make();
  EXPECT_EQ(KerfDatabase::open(path)->models()->size(), 5u);
}

TEST_F(KerfFile, NewerSchemaMissingTablesTriggersAndEditsAreRefused) {
  const struct {
    const char* sql;
    const char* message;
  } rows[] = {
      {"PRAGMA user_version = 2", "newer burin"},
      {"PRAGMA user_version = 0", "damaged"},
      {"DROP TABLE permissible", "permissible"},
      {"ALTER TABLE model RENAME COLUMN lambda1 TO slope", "lambda1"},
      {"CREATE TRIGGER t AFTER INSERT ON model BEGIN DELETE FROM experiment; END", "triggers"},
      {"CREATE VIEW v AS SELECT 1", "views"},
      {"UPDATE model SET lambda2 = 0.561 WHERE lambda2 = 0.56", "damaged"},
      {"UPDATE permissible SET speed_max = 20000", "damaged"},
      {"DELETE FROM permissible WHERE power_w = 1200", "damaged"},
      {"DELETE FROM material", "refer to entries that are gone"},
      {"UPDATE model SET version = -1 WHERE id = 1", "damaged"},
  };
  for (const auto& row : rows) {
    fs::remove(path);
    make();
    ASSERT_EQ(exec(row.sql), SQLITE_OK) << row.sql;
    const Error error = refusal();
    EXPECT_EQ(error.code, ErrorCode::data) << row.sql;
    EXPECT_NE(error.message.find(row.message), std::string::npos) << row.sql << ": " << error.to_string();
    EXPECT_EQ(error.where.file, path);
  }
}

TEST_F(KerfFile, DamagedBytesAreAnErrorOrHarmless) {
  make();
  const std::string good = read_file(path).value();
  const std::string models = KerfDatabase::open(path)->export_csv().value();
  std::mt19937_64 random(17);
  int refused = 0;
  for (int i = 0; i < 600; ++i) {
    std::string bytes = good;
    const int flips = i % 3 == 0 ? 1 : 20;
    for (int k = 0; k < flips; ++k) bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
    if (i % 5 == 4) bytes.resize(random() % bytes.size());
    ASSERT_TRUE(write_file(path, bytes).ok());
    const auto database = KerfDatabase::open(path);
    const auto csv = database.ok() ? database->export_csv() : Result<std::string>(database.error());
    if (csv.ok()) {
      // Unused space, descriptions, counters: the figures must be those that were written.
      EXPECT_EQ(csv.value(), models);
      continue;
    }
    ++refused;
    EXPECT_TRUE(csv.error().code == ErrorCode::data || csv.error().code == ErrorCode::io)
        << csv.error().to_string();
  }
  EXPECT_GT(refused, 100);
}

TEST_F(KerfFile, UserPathFollowsTheEnvironment) {
  const char* old_data = std::getenv("XDG_DATA_HOME");
  const char* old_home = std::getenv("HOME");
  const std::string data = old_data == nullptr ? "" : old_data, home = old_home == nullptr ? "" : old_home;
  setenv("XDG_DATA_HOME", folder.c_str(), 1);
  EXPECT_EQ(KerfDatabase::user_path(), folder.string() + "/burin/kerf.db");
  EXPECT_EQ(KerfDatabase::open_default()->models()->size(), 4u);
  path = KerfDatabase::user_path();
  make();
  EXPECT_EQ(KerfDatabase::open_default()->models()->size(), 5u);
  setenv("XDG_DATA_HOME", "relative", 1);
  setenv("HOME", "/home/somebody", 1);
  EXPECT_EQ(KerfDatabase::user_path(), "/home/somebody/.local/share/burin/kerf.db");
  unsetenv("HOME");
  EXPECT_EQ(KerfDatabase::user_path(), "");
  EXPECT_TRUE(KerfDatabase::open_default().ok());
  EXPECT_EQ(KerfDatabase::open_or_create("").error().code, ErrorCode::usage);
  old_data == nullptr ? unsetenv("XDG_DATA_HOME") : setenv("XDG_DATA_HOME", data.c_str(), 1);
  if (old_home != nullptr) setenv("HOME", home.c_str(), 1);
}

}  // namespace
}  // namespace burin::model
