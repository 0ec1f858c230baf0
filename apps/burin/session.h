// SPDX-License-Identifier: Apache-2.0
// One run of a subcommand: what it reads, what it warns of, what it reports, and what it will write. Outputs
// are kept in memory and written together at the end, so that an error leaves no file behind.
#pragma once

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "cluster.h"

namespace burin::cli {

using Json = nlohmann::ordered_json;

/// Values of the common options; empty: not given.
struct Common {
  std::string output, cl, json, html, svg;
  double tolerance_mm = 0.01;
  std::string dialect = "linuxcnc";
  int threads = 0;  ///< 0: as many as the machine has
  bool quiet = false;
};

/// The parts of the `--json` object that a subcommand fills; the rest of the envelope comes from the Session.
struct Report {
  Json parameters = Json::object();
  Json counts = Json::object();
  Json lengths_mm = Json::object();
  Json time_s = Json::object();  ///< `planning` is added by the Session
  Json quality = Json::object();
  Json extra = Json::object();  ///< further keys at the top level, after `parameters`
};

class Session {
 public:
  /// `cluster`: of a run on several processes, else nullptr; must outlive the session.
  Session(std::string operation, Common common_options, std::string command_line, Cluster* cluster = nullptr);

  const Common common;
  /// As typed, for reports: "burin laser part.dxf --kerf 0.4".
  const std::string command_line;
  Diagnostics diagnostics;
  Report report;

  /// Reads an input; the first one becomes `input` of the JSON, all are hashed. Error (usage) when it is also
  /// an output.
  Result<std::string> read_input(const std::string& path);
  /// A file that something else reads or keeps (a database). Error (usage) when it is also an output.
  Result<void> protect(const std::string& path);
  /// Says before long work that `path` will be written. Error (usage): the same file twice, or an input.
  Result<void> reserve_output(const std::string& path);
  /// An output, "-" is standard output. Reserves it when that has not been done. Kept until everything has
  /// succeeded.
  Result<void> put(const std::string& path, std::string content);
  /// The same with what make() gives, unless the output is not asked for (an empty path): then nothing is
  /// made.
  template <class Make>
  Result<void> put_made(const std::string& path, const Make& make) {
    if (path.empty()) return {};
    return put(path, make());
  }
  /// To standard output after all files are written: what a command that only answers prints.
  void print(std::string_view text) { answer_ += text; }

  /// What was asked for does not hold, though everything was done: the files are written, and the exit code
  /// is that of a failure.
  void fall_short(std::string why) { short_of_.push_back(std::move(why)); }
  const std::vector<std::string>& short_of() const { return short_of_; }

  /// Progress bar on standard error: only on a terminal, after a second of work, gone when done.
  ProgressSink* progress();
  /// Threads as asked for, on all processes of the run.
  std::unique_ptr<Workers> workers();
  /// The process that prints and writes: pictures, checks and texts are made there only. Everything up to
  /// them runs on all processes alike; inputs and answers about files come from the first.
  bool first() const { return cluster_ == nullptr || cluster_->rank() == 0; }
  void end_progress() { progress_.reset(); }

  /// Adds the JSON report when asked for, writes all files, then standard output. On failure what was
  /// written in this run is removed again.
  Result<void> finish();

 private:
  struct Output {
    std::string path, content;
    bool ready = false;
  };
  struct Input {
    std::string path, sha256;
  };
  Json json() const;
  Output* find_output(const std::string& path);

  Result<void> reserve(const std::string& path);
  /// What `ask` answers on the first process.
  Result<std::string> from_first(const std::function<Result<std::string>()>& ask);

  std::string operation_;
  Cluster* cluster_ = nullptr;
  std::vector<Input> inputs_;
  std::vector<std::string> protected_;
  std::vector<Output> outputs_;
  std::string answer_;
  std::vector<std::string> short_of_;
  std::unique_ptr<ProgressSink> progress_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Names the file in an error about content that has none yet; how the program is used is no matter of a
/// file.
Error in_file(Error error, const std::string& file);

/// JSON of a warning: {severity, code, entity, position_mm, message} and file, line when known.
Json to_json(const Warning& warning);

}  // namespace burin::cli
