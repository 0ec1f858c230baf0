// SPDX-License-Identifier: Apache-2.0
#include "session.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "burin/base/file.h"
#include "terminal.h"

namespace burin::cli {
namespace {

namespace fs = std::filesystem;

bool is_special(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}

/// The same file, also through links and different spellings. Devices (/dev/null) may be named as often as
/// one likes.
bool same_file(const std::string& a, const std::string& b) {
  if (a == "-" || b == "-") return a == b;
  if (is_special(a) || is_special(b)) return false;
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return true;
  // Absolute first: weakly_canonical leaves "a" as it is when there is no such file, but not "./a".
  const fs::path whole_a = fs::weakly_canonical(fs::absolute(a), error);
  if (error) return a == b;
  const fs::path whole_b = fs::weakly_canonical(fs::absolute(b), error);
  return error ? a == b : whole_a == whole_b;
}

Result<void> write_stdout(const std::string& text) {
  if (text.empty()) return {};
  const bool wrote = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  const bool flushed = std::fflush(stdout) == 0;
  if (wrote && flushed) return {};
  return Error{ErrorCode::io, std::string("standard output cannot be written: ") + std::strerror(errno), {}};
}

}  // namespace

Session::Session(std::string operation, Common common_options, std::string command, Cluster* cluster)
    : common(std::move(common_options)),
      command_line(std::move(command)),
      operation_(std::move(operation)),
      cluster_(cluster) {}

Result<std::string> Session::from_first(const std::function<Result<std::string>()>& ask) {
  return cluster_ == nullptr ? ask() : cluster_->from_first(ask);
}

std::unique_ptr<Workers> Session::workers() {
  const auto threads = static_cast<unsigned>(common.threads);
  return cluster_ == nullptr ? std::make_unique<LocalWorkers>(threads) : cluster_->workers(threads);
}

Session::Output* Session::find_output(const std::string& path) {
  for (Output& output : outputs_) {
    if (same_file(output.path, path)) return &output;
  }
  return nullptr;
}

Result<void> Session::protect(const std::string& path) {
  if (find_output(path) != nullptr) {
    return Error{
        ErrorCode::usage, "would be read and overwritten (give the output another name)", {.file = path}};
  }
  protected_.push_back(path);
  return {};
}

Result<std::string> Session::read_input(const std::string& path) {
  auto bytes = from_first([&]() -> Result<std::string> {
    if (auto fine = protect(path); !fine) return fine.error();
    return read_file(path);
  });
  if (bytes.ok()) inputs_.push_back({path, sha256_hex(*bytes)});
  return bytes;
}

Result<void> Session::reserve_output(const std::string& path) {
  const auto answer = from_first([&]() -> Result<std::string> {
    if (auto fine = reserve(path); !fine) return fine.error();
    return std::string();
  });
  return answer ? Result<void>() : answer.error();
}

Result<void> Session::reserve(const std::string& path) {
  if (path.empty())
    return Error{ErrorCode::usage, "an output has no name (a file, or - for standard output)", {}};
  for (const std::string& input : protected_) {
    if (same_file(input, path)) {
      return Error{
          ErrorCode::usage, "would be read and overwritten (give the output another name)", {.file = path}};
    }
  }
  if (find_output(path) != nullptr) {
    return Error{ErrorCode::usage,
                 path == "-" ? "two outputs go to standard output (give one of them a file)"
                             : "is named for two outputs (give each its own file)",
                 {.file = path == "-" ? "" : path}};
  }
  outputs_.push_back({path, {}, false});
  return {};
}

Result<void> Session::put(const std::string& path, std::string content) {
  if (!first()) return {};
  Output* output = find_output(path);
  if (output == nullptr || output->ready) {
    if (auto reserved = reserve(path); !reserved) return reserved.error();
    output = &outputs_.back();
  }
  output->content = std::move(content);
  output->ready = true;
  return {};
}

ProgressSink* Session::progress() {
  if (!progress_) progress_ = make_progress_bar(!common.quiet && first());
  return progress_.get();
}

Error in_file(Error error, const std::string& file) {
  if (error.where.file.empty() && error.code != ErrorCode::usage) error.where.file = file;
  return error;
}

Json to_json(const Warning& warning) {
  Json json;
  json["severity"] = warning.severity == Severity::left_out ? "left_out" : "info";
  json["code"] = warning.code;
  json["entity"] = warning.where.entity.empty() ? Json(nullptr) : Json(warning.where.entity);
  json["position_mm"] = warning.position_mm ? Json(*warning.position_mm) : Json(nullptr);
  json["message"] = warning.message;
  if (!warning.where.file.empty()) json["file"] = warning.where.file;
  if (warning.where.line > 0) json["line"] = warning.where.line;
  if (warning.where.column > 0) json["column"] = warning.where.column;
  return json;
}

Json Session::json() const {
  Json json;
  json["operation"] = operation_;
  json["version"] = BURIN_VERSION;
  json["input"] = inputs_.empty() ? Json(nullptr) : Json(inputs_.front().path);
  json["inputs_sha256"] = Json::object();
  for (const Input& input : inputs_) json["inputs_sha256"][input.path] = input.sha256;
  json["parameters"] = report.parameters;
  for (const auto& [key, value] : report.extra.items()) json[key] = value;
  json["counts"] = report.counts;
  json["lengths_mm"] = report.lengths_mm;
  json["time_s"] = report.time_s;
  json["quality"] = report.quality;
  json["warnings"] = Json::array();
  for (const Warning& warning : diagnostics.warnings()) json["warnings"].push_back(to_json(warning));
  json["outputs"] = Json::array();
  for (const Output& output : outputs_) json["outputs"].push_back(output.path);
  return json;
}

Result<void> Session::finish() {
  end_progress();
  if (!first()) return {};
  if (!report.time_s.contains("planning")) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    report.time_s["planning"] = spent.count();
  }
  if (!common.json.empty()) {
    if (find_output(common.json) == nullptr) {
      if (auto reserved = reserve(common.json); !reserved) return reserved.error();
    }
    // Names and texts from files may hold bytes that are not UTF-8: they become U+FFFD, never an exception.
    std::string text = json().dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    if (auto kept = put(common.json, std::move(text)); !kept) return kept.error();
  }
  std::vector<std::string> written;
  auto take_back = [&written] {
    for (const std::string& path : written) {
      std::error_code ignored;
      if (!is_special(path)) fs::remove(path, ignored);
    }
  };
  std::string standard_output;
  for (const Output& output : outputs_) {
    if (!output.ready) continue;
    if (output.path == "-") {
      standard_output += output.content;
      continue;
    }
    if (auto wrote = write_file(output.path, output.content); !wrote) {
      take_back();
      return wrote.error();
    }
    written.push_back(output.path);
  }
  // The answer for people gives way to an output that was asked for on standard output.
  if (auto wrote = write_stdout(standard_output.empty() ? answer_ : standard_output); !wrote) {
    take_back();
    return wrote.error();
  }
  return {};
}

}  // namespace burin::cli
