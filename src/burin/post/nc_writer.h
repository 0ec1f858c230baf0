// SPDX-License-Identifier: Apache-2.0
// What every kind of NC program shares: lines with their records, header and footer, state records. The
// motion words are the derived writers'. Internal to post.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "burin/post/emit.h"

namespace burin::post {

class NcWriter {
 protected:
  NcWriter(const cl::Program& program, const Dialect& dialect, const EmitOptions& options,
           Diagnostics& diagnostics)
      : program_(program), dialect_(dialect), options_(options), diagnostics_(diagnostics) {}

  /// Arcs of other systems may start and end on radii that differ by what controls take (0.0127 mm).
  static constexpr double kArcInput_mm = 0.013;

  /// Checks program number and program; the lines before the first record.
  Result<void> begin();
  /// The lines behind the last record.
  Result<NcText> finish();

  Error error(ErrorCode code, const std::string& what) const;
  void raw_line(const std::string& text);
  Result<void> line(std::string text, bool has_comment = false);
  /// Header and footer. Without a name the empty comment around {name} goes.
  Result<void> frame(const std::vector<std::string>& lines);
  std::string g(int code) const;
  /// A line from the dialect, which may have no words for it.
  Result<void> word_line(const std::string& text, const std::string& what);
  void once(const std::string& code, const std::string& message);

  Result<void> put(const cl::FeedRate& feed);
  Result<void> put(const cl::Spindle& spindle);
  Result<void> put(const cl::Beam& beam);
  Result<void> put(const cl::Dwell& dwell);
  Result<void> put(const cl::ToolChange& tool);
  Result<void> put(const cl::Coolant& coolant);
  Result<void> put(const cl::Comment& comment);
  Result<void> put(const cl::Unknown& unknown);

  const cl::Program& program_;
  const Dialect& dialect_;
  const EmitOptions& options_;
  Diagnostics& diagnostics_;
  NcText out_;
  std::size_t index_ = 0, move_ = 0;  // of the record and the motion at hand
  // What the control knows.
  std::string feed_, length_;  // the feed in force; G43 that waits for a Z

 private:
  bool in_frame_ = false;
  int number_ = 0;
  std::set<std::string> said_;
  std::optional<cl::Beam> beam_;
  bool said_no_power_ = false;
  std::optional<cl::Spindle> spindle_;
  std::optional<cl::Coolant> coolant_;
};

}  // namespace burin::post
