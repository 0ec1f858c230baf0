// SPDX-License-Identifier: Apache-2.0
// Tip and rotary angles for controls that keep the tip on its line themselves.
#include "burin/post/emit_tcp.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "burin/base/text.h"
#include "burin/post/axis_writer.h"
#include "burin/post/words.h"

namespace burin::post {
namespace {

using kinematics::JointMove;

// The feed a move runs at is the one in force when they agree to this: the rest is rounding of its time.
constexpr double kSameFeed = 1e-6;

class TcpEmitter : AxisWriter {
 public:
  TcpEmitter(const cl::Program& program, const kinematics::Kinematics& machine,
             const kinematics::JointPath& path, const Dialect& dialect, const EmitOptions& options,
             Diagnostics& diagnostics)
      : AxisWriter(program, machine, path, dialect, options, diagnostics) {}

  Result<NcText> run() {
    if (auto ok = check(); !ok) return ok.error();
    if (auto ok = begin(); !ok) return ok.error();
    auto ok = each_record([this](const JointMove& move) { return put_move(move); },
                          [this](const auto& record) { return state(record); });
    if (!ok) return ok.error();
    index_ = NcText::kNoRecord;
    if (auto off = switch_off(); !off) return off.error();
    return finish();
  }

 private:
  static std::string able() {
    std::string names;
    for (const std::string& name : dialect_names())
      if (const auto dialect = find_dialect(name); dialect && !dialect->tcp_on.empty())
        names += (names.empty() ? "" : ", ") + name;
    return names;
  }

  Result<void> check() const {
    if (machine_.rotary_count() == 0)
      return Error{ErrorCode::unsupported,
                   "tool-centre-point control for machine " + machine_.machine().name +
                       ", which has no rotary axes (without --tcp)",
                   {}};
    if (dialect_.tcp_on.empty())
      return Error{ErrorCode::unsupported,
                   "the dialect " + dialect_.name + " has no tool-centre-point control (" + able() +
                       ", a dialect file with tcp_on and tcp_off, or --joints)",
                   {}};
    return check_axes();
  }

  template <class Record>
  Result<void> state(const Record& record) {
    if constexpr (std::is_same_v<Record, cl::FeedRate>) {
      wanted_ = record.mm_min;
      return {};
    } else if constexpr (requires { this->put(record); }) {
      if constexpr (std::is_same_v<Record, cl::ToolChange>)
        if (auto ok = switch_off(); !ok) return ok;
      return this->put(record);
    } else {
      return {};
    }
  }

  Result<void> switch_off() {
    if (!std::exchange(on_, false)) return {};
    known_ = false;
    return line(dialect_.tcp_off);
  }

  /// Rotary axes first, while X, Y and Z stand; then the control takes the tip over.
  Result<void> switch_on(const Grid& to) {
    Grid turned = at_;
    for (std::size_t i = 3; i < axes_; ++i) turned[i] = to[i];
    std::string words;
    for (std::size_t i = 3; i < axes_; ++i)
      words += std::string(" ") + machine_.rotary_axis(static_cast<int>(i - 3)).letter +
               grid_text(to[i], dialect_.decimals, dialect_.require_point);
    length_.clear();  // the tool's length comes with the control
    if (auto ok = block(true, turned, words, ""); !ok) return ok;
    known_ = false;  // X, Y, Z mean something else from here on
    on_ = true;
    return line(fill(dialect_.tcp_on, "number", std::to_string(tool())));
  }

  /// The tool loaded last before the record at hand; 1 where the program loads none.
  int tool() const {
    for (std::size_t i = std::min(index_, program_.records.size()); i-- > 0;)
      if (const auto* change = std::get_if<cl::ToolChange>(&program_.records[i]);
          change != nullptr && change->number > 0)
        return change->number;
    return 1;
  }

  Result<void> put_move(const JointMove& move) {
    const geom::Point3 tip = machine_.forward(move.to).tip;
    Places places{tip.x, tip.y, tip.z};
    for (std::size_t i = 3; i < axes_; ++i) places[i] = geom::degrees(move.to.rotary[i - 3]);
    const auto to = rounded(places);
    if (!to) return to.error();
    if (!on_)
      if (auto ok = switch_on(*to); !ok) return ok;
    const std::string words = changes(*to);
    if (words.empty()) {
      ++out_.vanished;
    } else {
      std::string feed;
      if (!move.rapid) {
        auto word = feed_word(tip, *to, move.minutes);
        if (!word) return word.error();
        feed = *word;
      }
      if (auto ok = block(move.rapid, *to, words, feed); !ok) return ok;
    }
    tip_ = tip;
    return {};
  }

  /// Of the tip; where it rests, degrees of the rotary axes, which is what controls count then.
  Result<std::string> feed_word(const geom::Point3& tip, const Grid& to, double minutes) {
    bool rests = known_;
    for (std::size_t i = 0; i < 3; ++i) rests = rests && at_[i] == to[i];
    double counted = geom::distance(tip_, tip);
    if (rests) {
      counted = 0;
      for (std::size_t i = 3; i < axes_; ++i)
        counted = std::hypot(counted, static_cast<double>(to[i] - at_[i]) * from_grid(1, dialect_.decimals));
    }
    double feed = counted / std::max(minutes, 1e-9);
    if (!rests && std::abs(feed - wanted_) <= kSameFeed * wanted_) feed = wanted_;
    const std::string text = number_text(feed, dialect_.feed_decimals, dialect_.require_point);
    if (parse_double(text).value_or(0) <= 0)
      return error(ErrorCode::range, "a feed that rounds to 0 (a higher feed)");
    if (text == written_feed_) return std::string();
    return " F" + (written_feed_ = text);
  }

  bool on_ = false;
  double wanted_ = 0;  // mm/min
  geom::Point3 tip_;
  std::string written_feed_;
};

}  // namespace

Result<NcText> emit_tcp(const cl::Program& program, const kinematics::Kinematics& machine,
                        const kinematics::JointPath& path, const Dialect& dialect, const EmitOptions& options,
                        Diagnostics& diagnostics) {
  return TcpEmitter(program, machine, path, dialect, options, diagnostics).run();
}

}  // namespace burin::post
