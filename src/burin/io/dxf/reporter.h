// SPDX-License-Identifier: Apache-2.0
// Messages about single entities, with place; a file that repeats one trouble a million times gets a summary.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "burin/base/diagnostics.h"
#include "burin/geom/vec.h"

namespace burin::io::dxf {

class Reporter {
 public:
  Reporter(Diagnostics& diagnostics, std::string file) : diagnostics_(diagnostics), file_(std::move(file)) {}

  void add(Severity severity, const std::string& code, std::string message, const std::string& entity,
           int line, std::optional<geom::Point2> at = std::nullopt) {
    Tally& tally = tallies_[code];
    tally.severity = std::max(tally.severity, severity);
    if (++tally.count > kMostOfOneKind) return;
    Warning warning{severity, code, std::move(message), {file_, line, 0, entity}, std::nullopt};
    if (at) warning.position_mm = {at->x, at->y, 0.0};
    diagnostics_.add(std::move(warning));
  }

  /// About the file as a whole.
  void add_for_file(Severity severity, const std::string& code, std::string message) {
    diagnostics_.add({severity, code, std::move(message), {file_, 0, 0, ""}, std::nullopt});
  }

  /// Says how many messages were held back.
  void finish() {
    for (const auto& [code, tally] : tallies_) {
      if (tally.count <= kMostOfOneKind) continue;
      add_for_file(tally.severity, code, std::to_string(tally.count - kMostOfOneKind) + " more of this kind");
    }
    tallies_.clear();
  }

 private:
  static constexpr long long kMostOfOneKind = 1000;
  struct Tally {
    long long count = 0;
    Severity severity = Severity::info;
  };
  Diagnostics& diagnostics_;
  std::string file_;
  std::map<std::string, Tally> tallies_;
};

}  // namespace burin::io::dxf
