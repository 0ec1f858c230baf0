// SPDX-License-Identifier: Apache-2.0
// What the ordinary words of a block do: modes, feed, spindle, tool, straight and circular moves. The reader
// of motion programs (interpret) hands whole blocks over; the reader of surface programs takes its own words
// out first and hands the rest over.
#pragma once

#include <functional>
#include <set>

#include "burin/base/diagnostics.h"
#include "burin/nc/codes.h"
#include "burin/nc/program.h"

namespace burin::nc {

// Coordinates beyond this are no place in a machine; it keeps every later sum and square finite and exact
// enough.
inline constexpr double kMaxCoordinate_mm = 1e7;

class ModalMachine {
 public:
  using Sink = std::function<void(cl::Record, int line)>;
  /// `options`, `diagnostics` and `sink` must outlive the machine; records arrive in order.
  ModalMachine(const InterpretOptions& options, Diagnostics& diagnostics, Sink sink);

  /// Sorts the words of a block; `block` must live until carry_out() returns. `m_is_value`: M is a number of
  /// this block (the side step of a surface cycle), not a code.
  Result<void> open(const Block& block, bool m_is_value = false);
  /// Takes a word out, so that carry_out() does not see it; nullptr when there is none.
  const Word* take(char letter);
  const Word* take_code(Group group);
  const Grouped& words() const { return words_; }
  /// Does what the words still there say. A word that nothing takes is an error.
  Result<void> carry_out();

  // --- after carry_out(): the modes of this block are in force

  const ModalState& state() const { return state_; }
  double scale() const;  ///< mm per unit of length
  /// The word as a length in mm, bounded by kMaxCoordinate_mm.
  Result<double> length(const Word& word) const;
  /// The end of a move by these words (nullptr: the axis stays), from `from`, absolute or incremental.
  Result<geom::Point3> target(const std::array<const Word*, 3>& axes, geom::Point3 from);
  /// Error when no feed is in force or an axis stands at a place only the machine knows.
  Result<void> may_feed(const Word* word) const;
  /// Where the axes stand.
  kinematics::Joints joints() const;
  /// The tool moves: notes the unit assumed.
  void add_motion(cl::Record record, const geom::Point3& end);
  void move_to(const geom::Point3& end);
  void set_motion(MotionMode mode) { state_.motion = mode; }
  void note_units();
  /// Says it once for each `key`.
  void once(Severity severity, const std::string& code, const std::string& key, std::string message,
            const Word* word);
  Error error(ErrorCode code, std::string message, const Word* word) const;

  bool ended() const { return ended_; }
  /// The comment beside the program number that stands before everything else.
  const std::string& name() const { return name_; }
  bool moved() const { return moved_; }
  /// Every axis stands where the program has sent it.
  bool placed() const;
  bool began_with_feed() const { return began_with_feed_; }

 private:
  Where where(const Word* word) const;
  void add(cl::Record record);
  Result<std::optional<double>> take_length(char letter);
  Result<void> refused();
  Result<void> program_number();
  Result<void> comment();
  Result<void> modes();
  Result<void> tool_length();
  Result<void> work_offset();
  Result<void> feed_and_speed();
  Result<void> tool();
  Result<void> switches();
  Result<void> unknown_m();
  Result<void> dwell();
  Result<void> rotary();
  Result<void> move();
  Result<void> high_precision();
  Result<geom::Point3> take_target();
  cl::Pose pose(const geom::Point3& position) const;
  double way_to(const geom::Point3& end) const;
  int rotary_axis(char letter) const;
  Result<void> timed_feed(double length, const Word* word);
  Result<void> straight_move();
  Result<void> arc_move();
  Result<void> reference_return();
  Result<void> machine_coordinates();
  void note_lost(const Word* word);
  Result<void> left_over();
  Result<void> stop();
  bool has_axis_words() const;
  bool has_arc_words() const;

  const InterpretOptions& options_;
  Diagnostics& diagnostics_;
  Sink sink_;
  ModalState state_;
  const Block* block_ = nullptr;
  Grouped words_;
  std::set<std::string> said_;
  std::string name_;
  cl::Rotation rotation_ = cl::Rotation::off;
  cl::Spindle spindle_;
  cl::Beam beam_;
  cl::Coolant coolant_;
  std::optional<int> offset_;
  std::optional<double> times_;            // F of this block under G93, 1/min
  std::array<double, 2> rotary_before_{};  // this block
  bool turned_ = false;                    // this block names a rotary axis
  std::array<bool, 3> lost_{};             // axes at a place of the machine
  std::array<bool, 3> sent_{};             // axes that were sent somewhere
  bool units_known_ = false, moved_ = false, ended_ = false, has_name_ = false, any_record_ = false;
  bool began_with_feed_ = false;
};

/// Drives `read` with the blocks between the first and the second '%' (or of the whole text), until it says
/// that the program has ended.
Result<void> for_each_block(Lexer& lexer, const std::function<Result<bool>(const Block&)>& read);

}  // namespace burin::nc
