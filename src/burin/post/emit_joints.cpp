// SPDX-License-Identifier: Apache-2.0
// Joint moves -> NC text with rotary words; every block says its time.
#include <array>
#include <cmath>

#include "burin/base/text.h"
#include "burin/post/emit.h"
#include "burin/post/nc_writer.h"
#include "burin/post/words.h"

namespace burin::post {
namespace {

using kinematics::JointMove;
using kinematics::Joints;

constexpr std::size_t kAxes = 5;  // X, Y, Z and two rotary ones
using Grid = std::array<std::int64_t, kAxes>;

class JointEmitter : NcWriter {
 public:
  JointEmitter(const cl::Program& program, const kinematics::Kinematics& machine,
               const kinematics::JointPath& path, const Dialect& dialect, const JointEmitOptions& options,
               Diagnostics& diagnostics)
      : NcWriter(program, dialect, options, diagnostics),
        machine_(machine),
        path_(path),
        inverse_(options.feed == FeedMode::inverse_time) {
    axes_ = 3 + static_cast<std::size_t>(machine.rotary_count());
    for (std::size_t i = 3; i < axes_; ++i) letters_[i] = machine.rotary_axis(static_cast<int>(i - 3)).letter;
  }

  Result<NcText> run() {
    if (auto ok = check(); !ok) return ok.error();
    if (dialect_.percent) raw_line("%");
    if (auto ok = frame(dialect_.header); !ok) return ok.error();
    if (inverse_)
      if (auto ok = line(dialect_.inverse_time); !ok) return ok.error();
    for (; index_ < program_.records.size(); ++index_) {
      auto ok =
          cl::is_motion(program_.records[index_])
              ? motion()
              : std::visit([this](const auto& record) { return state(record); }, program_.records[index_]);
      if (!ok) return ok.error();
    }
    index_ = NcText::kNoRecord;
    if (inverse_)
      if (auto ok = line(dialect_.per_minute); !ok) return ok.error();
    if (auto ok = frame(dialect_.footer); !ok) return ok.error();
    if (dialect_.percent) raw_line("%");
    return std::move(out_);
  }

 private:
  Result<void> check() const {
    if (options_.program_number < 1 || options_.program_number > 9999)
      return Error{
          ErrorCode::usage, "program number " + std::to_string(options_.program_number) + " (1 to 9999)", {}};
    if (machine_.rotary_count() > 0 && !dialect_.rotary_axes)
      return Error{ErrorCode::unsupported,
                   "the dialect " + dialect_.name + " has no rotary axes (linuxcnc or fanuc)",
                   {}};
    if (inverse_ && dialect_.inverse_time.empty())
      return Error{ErrorCode::unsupported,
                   "the dialect " + dialect_.name + " has no inverse-time feed (--feed-mode per-minute)",
                   {}};
    return cl::validate(program_, 0.013);
  }

  template <class Record>
  Result<void> state(const Record& record) {
    if constexpr (std::is_same_v<Record, cl::FeedRate>) {
      return {};  // it is in the time of the moves
    } else if constexpr (requires { this->put(record); }) {
      return this->put(record);
    } else {
      return {};
    }
  }

  /// All joint moves of the record at hand.
  Result<void> motion() {
    for (; next_ < path_.moves.size() && path_.moves[next_].record == index_; ++next_)
      if (auto ok = block(path_.moves[next_]); !ok) return ok;
    ++move_;
    return {};
  }

  Result<Grid> rounded(const Joints& joints) const {
    Grid grid{};
    for (std::size_t i = 0; i < axes_; ++i) {
      const double value = i < 3 ? joints.linear[i] : geom::degrees(joints.rotary[i - 3]);
      if (!(std::abs(value) <= dialect_.coordinate_limit_mm))
        return error(ErrorCode::range, std::string(1, letters_[i]) + format_shortest(value) + " (within " +
                                           format_shortest(dialect_.coordinate_limit_mm) + " for " +
                                           dialect_.name + ")");
      grid[i] = to_grid(value, dialect_.decimals);
    }
    return grid;
  }

  Result<void> block(const JointMove& move) {
    const auto to = rounded(move.to);
    if (!to) return to.error();
    std::string text;
    for (std::size_t i = 0; i < axes_; ++i) {
      if (known_ && at_[i] == (*to)[i] && !(i == 2 && !length_.empty())) continue;
      text += std::string(" ") + letters_[i] + grid_text((*to)[i], dialect_.decimals, dialect_.require_point);
    }
    if (text.empty()) {
      ++out_.vanished;
      return {};
    }
    if (!move.rapid) {
      auto word = feed_word(at_, *to, move.minutes);
      if (!word) return word.error();
      text += *word;
    }
    const int code = move.rapid ? 0 : 1;
    if (code != motion_code_) text.insert(0, " " + g(motion_code_ = code));
    if (!length_.empty()) text.insert(0, " " + std::exchange(length_, ""));
    at_ = *to;
    known_ = true;
    ++out_.moves;
    return line(text.substr(1));
  }

  /// Inverse time: 1 / minutes in every block. Per minute: what the control measures, over the time.
  Result<std::string> feed_word(const Grid& from, const Grid& to, double minutes) {
    const double resolution = from_grid(1, dialect_.decimals);
    minutes = std::max(minutes, 1e-9);
    if (inverse_) {
      const double value = 1 / minutes;
      const std::string text = number_text(value, dialect_.inverse_time_decimals, dialect_.require_point);
      if (parse_double(text).value_or(0) <= 0)
        return error(ErrorCode::range, "a move of " + format_fixed(minutes, 1) +
                                           " minutes rounds to F0 under inverse time (a higher feed)");
      return " F" + text;
    }
    double linear = 0, rotary = 0;
    for (std::size_t i = 0; i < axes_; ++i) {
      const double by = static_cast<double>(to[i] - from[i]) * resolution;
      (i < 3 ? linear : rotary) += by * by;
    }
    const double counted = !dialect_.feed_of_linear_only ? std::sqrt(linear + rotary)
                           : linear > 0                  ? std::sqrt(linear)
                                                         : std::sqrt(rotary);
    // More digits than a plain feed: F here makes up for what the control counts.
    const std::string text =
        number_text(counted / minutes, dialect_.inverse_time_decimals, dialect_.require_point);
    if (parse_double(text).value_or(0) <= 0)
      return error(ErrorCode::range, "a feed that rounds to 0 (--feed-mode inverse-time)");
    if (text == written_feed_) return std::string();
    return " F" + (written_feed_ = text);
  }

  const kinematics::Kinematics& machine_;
  const kinematics::JointPath& path_;
  bool inverse_;
  std::size_t axes_ = 3;
  std::array<char, kAxes> letters_{'X', 'Y', 'Z', 'A', 'C'};
  std::size_t next_ = 0;
  // What the control knows.
  Grid at_{};
  bool known_ = false;
  int motion_code_ = -1;
  std::string written_feed_;
};

}  // namespace

Result<NcText> emit_joints(const cl::Program& program, const kinematics::Kinematics& machine,
                           const kinematics::JointPath& path, const Dialect& dialect,
                           const JointEmitOptions& options, Diagnostics& diagnostics) {
  return JointEmitter(program, machine, path, dialect, options, diagnostics).run();
}

}  // namespace burin::post
