// SPDX-License-Identifier: Apache-2.0
// What NC programs with rotary words share, whether X, Y, Z are joints or the tip: five axes on the grid of
// the dialect, blocks of what changes. Internal to post.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>

#include "burin/post/nc_writer.h"

namespace burin::post {

class AxisWriter : protected NcWriter {
 protected:
  static constexpr std::size_t kAxes = 5;    // X, Y, Z and two rotary ones
  using Places = std::array<double, kAxes>;  // mm, degrees
  using Grid = std::array<std::int64_t, kAxes>;

  AxisWriter(const cl::Program& program, const kinematics::Kinematics& machine,
             const kinematics::JointPath& path, const Dialect& dialect, const EmitOptions& options,
             Diagnostics& diagnostics);

  /// Error (unsupported): a dialect that knows no rotary axes.
  Result<void> check_axes() const;
  /// Calls motion(move) for each joint move of the program, and state(record) for each other record.
  template <class Motion, class State>
  Result<void> each_record(const Motion& motion, const State& state);

  /// Error (range): beyond what the control takes.
  Result<Grid> rounded(const Places& places) const;
  /// Words of the axes that change, all before the first block; "" when none does.
  std::string changes(const Grid& to) const;
  /// A motion block of these words (changes(to)) and the feed's.
  Result<void> block(bool rapid, const Grid& to, const std::string& words, const std::string& feed);

  const kinematics::Kinematics& machine_;
  const kinematics::JointPath& path_;
  std::size_t axes_ = 3;
  Grid at_{};  // what the control knows
  bool known_ = false;

 private:
  std::array<char, kAxes> letters_{'X', 'Y', 'Z', 'A', 'C'};
  std::size_t next_ = 0;
  int motion_code_ = -1;
};

template <class Motion, class State>
Result<void> AxisWriter::each_record(const Motion& motion, const State& state) {
  for (; index_ < program_.records.size(); ++index_) {
    const cl::Record& record = program_.records[index_];
    if (cl::is_motion(record)) {
      for (; next_ < path_.moves.size() && path_.moves[next_].record == index_; ++next_)
        if (auto ok = motion(path_.moves[next_]); !ok) return ok;
      ++move_;
    } else if (auto ok = std::visit(state, record); !ok) {
      return ok;
    }
  }
  return {};
}

}  // namespace burin::post
