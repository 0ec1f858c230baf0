// SPDX-License-Identifier: Apache-2.0
#include "terminal.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string_view>

#include "burin/base/text.h"

namespace burin::cli {
namespace {

constexpr int kShownPerCode = 5;
constexpr auto kQuietTime = std::chrono::seconds(1);
constexpr auto kRedrawTime = std::chrono::milliseconds(100);

enum class Colour { red, yellow, cyan };

std::string coloured(std::string_view text, Colour colour) {
  const char* no_color = std::getenv("NO_COLOR");
  if (!stderr_is_terminal() || (no_color != nullptr && *no_color != '\0')) return std::string(text);
  const char* code = colour == Colour::red      ? "\033[1;31m"
                     : colour == Colour::yellow ? "\033[1;33m"
                                                : "\033[36m";
  return code + std::string(text) + "\033[0m";
}

/// Text from files goes to a terminal: control characters could move its cursor or change its colours.
std::string printable(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    safe += (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f ? '?' : c;
  }
  return safe;
}

void put_line(const std::string& line) {
  // A closed standard error must not end the run: there is nobody left to tell.
  std::fputs((line + "\n").c_str(), stderr);
  std::fflush(stderr);
}

std::string describe(const Warning& warning) {
  const std::string place = warning.where.to_string();
  std::string text = place.empty() ? warning.message : place + ": " + warning.message;
  if (warning.position_mm) {
    const auto& at = *warning.position_mm;
    text += " at (" + format_fixed(at[0], 4) + ", " + format_fixed(at[1], 4);
    if (at[2] != 0) text += ", " + format_fixed(at[2], 4);
    text += ") mm";
  }
  return printable(text) + " [" + warning.code + "]";
}

class ProgressBar : public ProgressSink {
 public:
  ~ProgressBar() override {
    if (drawn_) std::fputs("\r\033[K", stderr);
  }

  bool progress(std::string_view stage, double done) override {
    const auto now = std::chrono::steady_clock::now();
    if (now - start_ < kQuietTime || (drawn_ && now - last_ < kRedrawTime)) return true;
    last_ = now;
    drawn_ = true;
    constexpr int kWidth = 30;
    const double part = std::isfinite(done) ? std::clamp(done, 0.0, 1.0) : 0.0;
    const int full = static_cast<int>(part * kWidth);
    const std::string bar = std::string(full, '#') + std::string(kWidth - full, '.');
    std::fprintf(stderr, "\r\033[K[%s] %3d %% %.*s", bar.c_str(), static_cast<int>(part * 100),
                 static_cast<int>(std::min<std::size_t>(stage.size(), 40)), stage.data());
    std::fflush(stderr);
    return true;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_;
  bool drawn_ = false;
};

class NoProgress : public ProgressSink {
 public:
  bool progress(std::string_view, double) override { return true; }
};

}  // namespace

bool stderr_is_terminal() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && term != nullptr && std::string_view(term) != "dumb";
}

void print_error(const std::string& text) {
  put_line(coloured(printable(text), Colour::red));
}

void print_warnings(const Diagnostics& diagnostics, bool quiet) {
  struct Shown {
    std::size_t printed = 0, total = 0;
  };
  std::map<std::pair<std::string, Severity>, Shown> shown;
  for (const Warning& w : diagnostics.warnings()) ++shown[{w.code, w.severity}].total;
  for (const Warning& w : diagnostics.warnings()) {
    if (quiet && w.severity == Severity::info) continue;
    Shown& group = shown[{w.code, w.severity}];
    // Six of a kind are printed whole: "and 1 more" would take the same line.
    const std::size_t limit = group.total <= kShownPerCode + 1 ? group.total : kShownPerCode;
    if (group.printed > limit) continue;
    const std::string label = w.severity == Severity::left_out ? coloured("warning: ", Colour::yellow)
                                                               : coloured("note: ", Colour::cyan);
    if (group.printed++ < limit) {
      put_line(label + describe(w));
    } else {
      put_line(label + "... and " + std::to_string(group.total - limit) + " more [" + w.code +
               "] (see --json)");
    }
  }
}

std::unique_ptr<ProgressSink> make_progress_bar(bool enabled) {
  if (enabled && stderr_is_terminal()) return std::make_unique<ProgressBar>();
  return std::make_unique<NoProgress>();
}

}  // namespace burin::cli
