// SPDX-License-Identifier: Apache-2.0
// The meaning of ordinary motion programs: grouped blocks -> modal state -> CL records.
#include <cmath>
#include <set>

#include "burin/base/text.h"
#include "burin/nc/arc.h"
#include "burin/nc/codes.h"
#include "burin/nc/program.h"

namespace burin::nc {
namespace {

constexpr double kMmPerInch = 25.4;
// Coordinates beyond this are no place in a machine; it keeps every later sum and square finite and exact
// enough.
constexpr double kMaxCoordinate_mm = 1e7;
constexpr std::array<char, 3> kAxis = {'X', 'Y', 'Z'};

class Interpreter {
 public:
  Interpreter(const InterpretOptions& options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics) {
    state_.position = options.start;
  }

  Result<cl::Program> run(std::string_view text) {
    Lexer lexer(text, {.file_name = options_.file_name});
    Block block;
    bool begun = false;  // comments may stand before the first '%'
    while (true) {
      auto more = lexer.next(block);
      if (!more) return std::move(more).error();
      if (!*more || (block.percent && begun)) break;
      begun = begun || block.percent || !block.words.empty();
      auto ok = read(block);
      if (!ok) return ok.error();
      if (ended_) break;
    }
    return std::move(program_);
  }

 private:
  // --- helpers
  // ------------------------------------------------------------------------------------------------

  Where where(const Word* word) const {
    return {.file = options_.file_name, .line = block_->line, .column = word ? word->column : 1};
  }
  Error error(ErrorCode code, std::string message, const Word* word) const {
    return {code, std::move(message), where(word)};
  }
  void once(Severity severity, const std::string& code, const std::string& key, std::string message,
            const Word* word) {
    if (said_.insert(code + '/' + key).second)
      diagnostics_.add({severity, code, std::move(message), where(word), std::nullopt});
  }
  void add(cl::Record record) { program_.add(std::move(record), static_cast<std::uint32_t>(block_->line)); }

  /// Takes the word of a letter: what nobody takes is an error in the end.
  const Word* take(char letter) {
    const Word*& slot = words_.values[static_cast<std::size_t>(letter - 'A')];
    return std::exchange(slot, nullptr);
  }
  double scale() const { return state_.inch ? kMmPerInch : 1.0; }

  Result<std::optional<double>> take_length(char letter) {
    const Word* word = take(letter);
    if (!word) return std::optional<double>{};
    const double mm = word->value * scale();
    if (!(std::abs(mm) <= kMaxCoordinate_mm))
      return error(ErrorCode::range,
                   std::string(1, letter) + " beyond " + format_shortest(kMaxCoordinate_mm) + " mm (less)",
                   word);
    return std::optional(mm);
  }

  // --- one block
  // ----------------------------------------------------------------------------------------------

  Result<void> read(const Block& block) {
    block_ = &block;
    auto grouped = group_block(block, options_.file_name);
    if (!grouped) return grouped.error();
    words_ = std::move(*grouped);
    if (block.skip)
      once(Severity::info, "block_skip", "",
           "blocks with '/' are carried out (the control's switch is taken as off)", nullptr);
    for (auto step :
         {&Interpreter::refused, &Interpreter::program_number, &Interpreter::comment, &Interpreter::modes,
          &Interpreter::feed_and_speed, &Interpreter::tool, &Interpreter::switches, &Interpreter::dwell,
          &Interpreter::rotary, &Interpreter::move, &Interpreter::left_over, &Interpreter::stop}) {
      if (auto ok = (this->*step)(); !ok) return ok;
    }
    return {};
  }

  Result<void> refused() {
    for (const Word* word : words_.groups) {
      if (!word) continue;
      const Code* code = find_code(known_codes(word->letter), word->code());
      if (code && code->treat == Treat::refuse)
        return error(ErrorCode::unsupported,
                     code_name(word->letter, code->code) + " (" + std::string(code->what) +
                         ") is not read (plain G0, G1, G2, G3 motion)",
                     word);
    }
    return {};
  }

  Result<void> program_number() {
    const Word* number = take('O');
    if (!number) return {};
    has_name_ = !block_->comment.empty() && program_.name.empty() && program_.records.empty();
    if (has_name_) program_.name = block_->comment;
    return {};
  }

  Result<void> comment() {
    if (!block_->comment.empty() && !std::exchange(has_name_, false)) add(cl::Comment{block_->comment});
    return {};
  }

  Result<void> modes() {
    const int units = words_.code(Group::units);
    if (units >= 0) {
      const bool inch = units == 2000;
      if (inch != state_.inch && state_.feed > 0 && !words_.value('F'))
        once(Severity::info, "feed_before_units", "",
             "the unit changes after F was given: the feed stays as it was, " + format_fixed(state_.feed, 3) +
                 " mm/min",
             words_.in(Group::units));
      state_.inch = inch;
      units_known_ = true;
    }
    switch (words_.code(Group::plane)) {
      case 1700:
        state_.plane = Plane::xy;
        break;
      case 1800:
        state_.plane = Plane::zx;
        break;
      case 1900:
        state_.plane = Plane::yz;
        break;
      default:
        break;
    }
    if (const int code = words_.code(Group::distance); code >= 0) state_.incremental = code == 9100;
    if (const int code = words_.code(Group::arc_distance); code >= 0)
      state_.arc_centers_absolute = code == 9010;
    return work_offset();
  }

  /// The first work offset is the part frame; another one would need its distance from the first.
  Result<void> work_offset() {
    const Word* word = words_.in(Group::work_offset);
    if (!word) return {};
    if (word->code() == 5410)
      return error(ErrorCode::unsupported, "G54.1 (extended work offsets) is not read (G54 to G59)", word);
    const int before = offset_ ? *offset_ : program_.records.empty() || !moved_ ? word->code() : 5400;
    if (before != word->code())
      return error(ErrorCode::unsupported,
                   "a second work offset, " + code_name('G', word->code()) + " after " +
                       code_name('G', before) + " (one part frame in a program)",
                   word);
    offset_ = before;
    return {};
  }

  Result<void> feed_and_speed() {
    if (const Word* word = take('F')) {
      if (!(word->value >= 0) || word->value * scale() > kMaxCoordinate_mm)
        return error(ErrorCode::range, "a feed of " + format_shortest(word->value) + " (above 0)", word);
      const double feed = word->value * scale();
      if (feed > 0 && feed != state_.feed) add(cl::FeedRate{feed});
      state_.feed = feed;
    }
    if (const Word* word = take('S')) {
      if (!(word->value >= 0) || word->value > 1e9)
        return error(ErrorCode::range, "S" + format_shortest(word->value) + " (0 or more)", word);
      state_.spindle_or_power = word->value;
    }
    return {};
  }

  Result<void> tool() {
    if (const Word* word = take('T')) {
      if (word->value < 0 || word->value > 999'999 || word->value != std::floor(word->value))
        return error(ErrorCode::range, "T" + format_shortest(word->value) + " (an integer from 0 to 999999)",
                     word);
      state_.tool = static_cast<int>(word->value);
    }
    if (!words_.in(Group::m_tool)) return {};
    take('H');
    add(cl::ToolChange{state_.tool, 0, 0});
    return {};
  }

  /// Spindle or beam, coolant, unknown M codes. Only what changes makes a record.
  Result<void> switches() {
    if (const int code = words_.code(Group::m_spindle); code >= 0)
      rotation_ = code == 300   ? cl::Rotation::clockwise
                  : code == 400 ? cl::Rotation::counter_clockwise
                                : cl::Rotation::off;
    const bool on = rotation_ != cl::Rotation::off;
    if (options_.beam) {
      const cl::Beam beam{on, on ? state_.spindle_or_power * options_.watts_per_s : 0.0};
      if (beam != beam_) add(beam_ = beam);
    } else {
      const cl::Spindle spindle{rotation_, on ? state_.spindle_or_power : 0.0};
      if (spindle != spindle_) add(spindle_ = spindle);
    }
    const int flood = words_.code(Group::m_flood);
    if (flood >= 0 || words_.in(Group::m_mist)) {
      const cl::Coolant coolant{flood != 900};
      if (coolant != coolant_) add(coolant_ = coolant);
    }
    return unknown_m();
  }

  Result<void> unknown_m() {
    for (const Word* word : words_.other_m) {
      const std::string name = code_name('M', word->code());
      std::string text = name;
      for (char letter : {'P', 'Q', 'E', 'L'}) {
        if (const Word* argument = take(letter))
          text += std::string(" ") + letter + format_shortest(argument->value);
      }
      once(Severity::left_out, "unknown_m_code", name,
           name + " is not known: kept as it stands, its effect is not", word);
      add(cl::Unknown{text});
    }
    return {};
  }

  Result<void> dwell() {
    if (words_.code(Group::non_modal) != 400) return {};
    const Word* p = take('P');
    const Word* seconds = p ? nullptr : take('X');
    if (!p && !seconds) seconds = take('U');
    if (!p && !seconds)
      return error(ErrorCode::syntax, "G4 without a time (P or X)", words_.in(Group::non_modal));
    const double value = p && options_.dwell_p_milliseconds ? p->value / 1000 : (p ? p : seconds)->value;
    if (!(value >= 0) || value > 1e7)
      return error(ErrorCode::range, "a dwell of " + format_shortest(value) + " s (0 or more)",
                   p ? p : seconds);
    add(cl::Dwell{value});
    return {};
  }

  /// Axes that a three-axis path does not have: 0 is where they are.
  Result<void> rotary() {
    for (char letter : {'A', 'B', 'C', 'U', 'V', 'W'}) {
      const Word* word = take(letter);
      if (word && word->value != 0)
        return error(ErrorCode::unsupported, std::string("the axis ") + letter + " (X, Y and Z)", word);
    }
    return {};
  }

  // --- motion
  // -------------------------------------------------------------------------------------------------

  bool has_axis_words() const { return words_.value('X') || words_.value('Y') || words_.value('Z'); }
  bool has_arc_words() const {
    return words_.value('I') || words_.value('J') || words_.value('K') || words_.value('R');
  }

  Result<void> move() {
    switch (words_.code(Group::motion)) {
      case 0:
        state_.motion = MotionMode::rapid;
        break;
      case 100:
        state_.motion = MotionMode::feed;
        break;
      case 200:
        state_.motion = MotionMode::arc_cw;
        break;
      case 300:
        state_.motion = MotionMode::arc_ccw;
        break;
      case 8000:
        state_.motion = MotionMode::none;
        break;
      default:
        break;
    }
    switch (words_.code(Group::non_modal)) {
      case 500:
        return high_precision();
      case 2800:
      case 3000:
        return reference_return();
      case 5300:
        return machine_coordinates();
      default:
        break;
    }
    const bool arc = state_.motion == MotionMode::arc_cw || state_.motion == MotionMode::arc_ccw;
    if (!has_axis_words() && !(arc && has_arc_words())) return {};
    if (state_.motion == MotionMode::none) {
      const Word* first = words_.value('X')   ? words_.value('X')
                          : words_.value('Y') ? words_.value('Y')
                                              : words_.value('Z');
      return error(ErrorCode::syntax, "coordinates without a motion code before them (G0, G1, G2 or G3)",
                   first);
    }
    return arc ? arc_move() : straight_move();
  }

  /// G5 P10000 ... G5 P0 switches a control's look-ahead; G5 with coordinates is a cubic spline.
  Result<void> high_precision() {
    const Word* word = words_.in(Group::non_modal);
    if (has_axis_words() || has_arc_words() || !take('P'))
      return error(ErrorCode::unsupported,
                   "G5 (spline) is not read (G5 P10000 and G5 P0 without coordinates)", word);
    return {};
  }

  /// The end of a motion; `lost_` forgets what is commanded again.
  Result<geom::Point3> target() {
    geom::Point3 end = state_.position;
    for (int axis = 0; axis < 3; ++axis) {
      const Word* word = words_.value(kAxis[static_cast<std::size_t>(axis)]);
      auto value = take_length(kAxis[static_cast<std::size_t>(axis)]);
      if (!value) return value.error();
      if (!*value) continue;
      if (state_.incremental && **value == 0) continue;
      if (state_.incremental && lost_[static_cast<std::size_t>(axis)])
        return error(ErrorCode::unsupported, "an increment from the machine's reference position (G90)",
                     word);
      const double to = **value + (state_.incremental ? component(end, axis) : 0.0);
      if (!(std::abs(to) <= kMaxCoordinate_mm))
        return error(ErrorCode::range,
                     "a position beyond " + format_shortest(kMaxCoordinate_mm) + " mm (less)", word);
      set_component(end, axis, to);
      lost_[static_cast<std::size_t>(axis)] = false;
    }
    return end;
  }

  void note_units() {
    if (!units_known_)
      once(Severity::info, "units_assumed", "",
           "no G20 or G21 before the first move: millimetres are assumed", nullptr);
  }

  const Word* motion_word() const { return words_.in(Group::motion); }

  Result<void> may_feed(const Word* word) {
    if (state_.feed <= 0)
      return error(ErrorCode::syntax, "a feed move without a feed (an F word above 0 before it)", word);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (lost_[axis])
        return error(
            ErrorCode::unsupported,
            std::string("a feed move while ") + kAxis[axis] +
                " is at the machine's reference position (a rapid to a place in the part frame before it)",
            word);
    return {};
  }

  void add_motion(cl::Record record, const geom::Point3& end) {
    note_units();
    if (!moved_ && !std::holds_alternative<cl::Rapid>(record)) program_.from = cl::Pose{options_.start};
    moved_ = true;
    state_.position = end;
    add(std::move(record));
  }

  Result<void> straight_move() {
    const Word* word = motion_word();
    auto end = target();
    if (!end) return end.error();
    if (state_.motion == MotionMode::rapid) {
      add_motion(cl::Rapid{cl::Pose{*end}}, *end);
      return {};
    }
    if (auto ok = may_feed(word); !ok) return ok;
    add_motion(cl::Feed{cl::Pose{*end}}, *end);
    return {};
  }

  Result<void> arc_move() {
    const Word* word = motion_word();
    if (!word) word = &block_->words.front();
    ArcWords arc{.start = state_.position,
                 .plane = state_.plane,
                 .clockwise = state_.motion == MotionMode::arc_cw,
                 .center_absolute = state_.arc_centers_absolute,
                 .radius_tolerance_mm = options_.arc_radius_tolerance_mm};
    if (const Word* turns = take('P'); turns && turns->value != 1)
      return error(ErrorCode::unsupported, "an arc of several turns (P1)", turns);
    auto end = target();
    if (!end) return end.error();
    arc.end = *end;
    for (std::size_t i = 0; i < 3; ++i) {
      auto offset = take_length(static_cast<char>('I' + i));
      if (!offset) return offset.error();
      arc.center[i] = *offset;
    }
    auto radius = take_length('R');
    if (!radius) return radius.error();
    arc.radius = *radius;
    if (auto ok = may_feed(word); !ok) return ok;
    auto made = make_arc(arc);
    if (!made) return error(made.error().code, made.error().message, word);
    const geom::Point3 to = made->to.tip;
    add_motion(*std::move(made), to);
    return {};
  }

  /// G28, G30: over the point given to a place only the machine knows.
  Result<void> reference_return() {
    const Word* word = words_.in(Group::non_modal);
    std::array<bool, 3> named{};
    bool any = false;
    for (std::size_t i = 0; i < 3; ++i) any |= named[i] = words_.value(kAxis[i]) != nullptr;
    const geom::Point3 before = state_.position;
    auto via = target();
    if (!via) return via.error();
    if (*via != before) add_motion(cl::Rapid{cl::Pose{*via}}, *via);
    take('P');
    for (std::size_t i = 0; i < 3; ++i) lost_[i] = lost_[i] || !any || named[i];
    note_lost(word);
    return {};
  }

  Result<void> machine_coordinates() {
    const Word* word = words_.in(Group::non_modal);
    if (state_.motion != MotionMode::rapid)
      return error(ErrorCode::unsupported, "G53 with a feed move (G53 G0)", word);
    for (std::size_t i = 0; i < 3; ++i) lost_[i] = lost_[i] || take(kAxis[i]) != nullptr;
    note_lost(word);
    return {};
  }

  void note_lost(const Word* word) {
    once(Severity::left_out, "machine_position", "",
         "moves to places of the machine (G28, G30, G53) are left out: where they are is not known here",
         word);
  }

  // --- the rest
  // -----------------------------------------------------------------------------------------------

  Result<void> left_over() {
    if (words_.in(Group::path_control)) take('P'), take('Q');
    take('H');  // tool length and, without G41 and G42, the cutter's radius: the program says where the tip
                // goes
    take('D');
    for (const Word* word : words_.values) {
      if (!word) continue;
      return error(ErrorCode::unsupported,
                   std::string("the word ") + word->letter + format_shortest(word->value) +
                       " has no meaning in this block (a code that uses it)",
                   word);
    }
    return {};
  }

  Result<void> stop() {
    switch (words_.code(Group::m_stop)) {
      case 0:
      case 6000:
        add(cl::Unknown{"STOP"});
        break;
      case 100:
        add(cl::Unknown{"OPSTOP"});
        break;
      case 200:
      case 3000:
        ended_ = true;
        break;
      default:
        break;
    }
    return {};
  }

  const InterpretOptions& options_;
  Diagnostics& diagnostics_;
  cl::Program program_;
  ModalState state_;
  const Block* block_ = nullptr;
  Grouped words_;
  std::set<std::string> said_;
  cl::Rotation rotation_ = cl::Rotation::off;
  cl::Spindle spindle_;
  cl::Beam beam_;
  cl::Coolant coolant_;
  std::optional<int> offset_;
  std::array<bool, 3> lost_{};  // axes at a place of the machine
  bool units_known_ = false, moved_ = false, ended_ = false, has_name_ = false;
};

}  // namespace

Result<cl::Program> interpret(std::string_view text, const InterpretOptions& options,
                              Diagnostics& diagnostics) {
  return Interpreter(options, diagnostics).run(text);
}

}  // namespace burin::nc
