// SPDX-License-Identifier: Apache-2.0
// Joint moves -> NC text with rotary words; every block says its time.
#include <cmath>
#include <type_traits>

#include "burin/base/text.h"
#include "burin/post/axis_writer.h"
#include "burin/post/emit.h"
#include "burin/post/words.h"

namespace burin::post {
namespace {

using kinematics::JointMove;

class JointEmitter : AxisWriter {
 public:
  JointEmitter(const cl::Program& program, const kinematics::Kinematics& machine,
               const kinematics::JointPath& path, const Dialect& dialect, const JointEmitOptions& options,
               Diagnostics& diagnostics)
      : AxisWriter(program, machine, path, dialect, options, diagnostics),
        inverse_(options.feed == FeedMode::inverse_time) {}

  Result<NcText> run() {
    if (auto ok = check(); !ok) return ok.error();
    if (auto ok = begin(); !ok) return ok.error();
    if (inverse_)
      if (auto ok = line(dialect_.inverse_time); !ok) return ok.error();
    auto ok = each_record([this](const JointMove& move) { return put_move(move); },
                          [this](const auto& record) { return state(record); });
    if (!ok) return ok.error();
    index_ = NcText::kNoRecord;
    if (inverse_)
      if (auto said = line(dialect_.per_minute); !said) return said.error();
    return finish();
  }

 private:
  Result<void> check() const {
    if (auto ok = check_axes(); !ok) return ok;
    if (inverse_ && dialect_.inverse_time.empty())
      return Error{ErrorCode::unsupported,
                   "the dialect " + dialect_.name + " has no inverse-time feed (--feed-mode per-minute)",
                   {}};
    return {};
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

  Result<void> put_move(const JointMove& move) {
    Places places{move.to.linear[0], move.to.linear[1], move.to.linear[2]};
    for (std::size_t i = 3; i < axes_; ++i) places[i] = geom::degrees(move.to.rotary[i - 3]);
    const auto to = rounded(places);
    if (!to) return to.error();
    const std::string words = changes(*to);
    if (words.empty()) {
      ++out_.vanished;
      return {};
    }
    std::string feed;
    if (!move.rapid) {
      auto word = feed_word(at_, *to, move.minutes);
      if (!word) return word.error();
      feed = *word;
    }
    return block(move.rapid, *to, words, feed);
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

  bool inverse_;
  std::string written_feed_;
};

}  // namespace

Result<NcText> emit_joints(const cl::Program& program, const kinematics::Kinematics& machine,
                           const kinematics::JointPath& path, const Dialect& dialect,
                           const JointEmitOptions& options, Diagnostics& diagnostics) {
  return JointEmitter(program, machine, path, dialect, options, diagnostics).run();
}

}  // namespace burin::post
