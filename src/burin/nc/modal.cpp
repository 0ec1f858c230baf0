// SPDX-License-Identifier: Apache-2.0
#include "burin/nc/modal.h"

#include <cmath>

#include "burin/base/text.h"
#include "burin/geom/point_tools.h"
#include "burin/kinematics/joint_path.h"
#include "burin/nc/arc.h"
#include "burin/nc/place.h"

namespace burin::nc {
namespace {

constexpr double kMmPerInch = 25.4;
constexpr std::array<char, 3> kAxis = {'X', 'Y', 'Z'};
constexpr double kMaxInverseTime = 1e9;  // F of G93: a tenth of a microsecond
constexpr double kMaxRotary = 2e6 * geom::kPi;

}  // namespace

ModalMachine::ModalMachine(const InterpretOptions& options, Diagnostics& diagnostics, Sink sink)
    : options_(options), diagnostics_(diagnostics), sink_(std::move(sink)) {
  state_.position = options.start;
}

Where ModalMachine::where(const Word* word) const {
  return {.file = options_.file_name, .line = block_->line, .column = word ? word->column : 1};
}
Error ModalMachine::error(ErrorCode code, std::string message, const Word* word) const {
  return {code, std::move(message), where(word)};
}
void ModalMachine::once(Severity severity, const std::string& code, const std::string& key,
                        std::string message, const Word* word) {
  if (said_.insert(code + '/' + key).second)
    diagnostics_.add({severity, code, std::move(message), where(word), std::nullopt});
}
void ModalMachine::add(cl::Record record) {
  any_record_ = true;
  sink_(std::move(record), block_->line);
}

/// Takes the word of a letter: what nobody takes is an error in the end.
const Word* ModalMachine::take(char letter) {
  const Word*& slot = words_.values[static_cast<std::size_t>(letter - 'A')];
  return std::exchange(slot, nullptr);
}
const Word* ModalMachine::take_code(Group group) {
  return std::exchange(words_.groups[static_cast<std::size_t>(group)], nullptr);
}
double ModalMachine::scale() const {
  return state_.inch ? kMmPerInch : 1.0;
}

Result<double> ModalMachine::length(const Word& word) const {
  const double mm = word.value * scale();
  if (!(std::abs(mm) <= kMaxCoordinate_mm))
    return error(ErrorCode::range, std::string(1, word.letter) + " beyond " + coordinate_limit() + " (less)",
                 &word);
  return mm;
}

Result<std::optional<double>> ModalMachine::take_length(char letter) {
  const Word* word = take(letter);
  if (!word) return std::optional<double>{};
  auto mm = length(*word);
  if (!mm) return mm.error();
  return std::optional(*mm);
}

Result<void> ModalMachine::open(const Block& block, bool m_is_value) {
  block_ = &block;
  auto grouped = group_block(block, options_.file_name, m_is_value);
  if (!grouped) return grouped.error();
  words_ = std::move(*grouped);
  return {};
}

Result<void> ModalMachine::carry_out() {
  if (block_->skip)
    once(Severity::info, "block_skip", "",
         "blocks with '/' are carried out (the control's switch is taken as off)", nullptr);
  for (auto step : {&ModalMachine::refused, &ModalMachine::program_number, &ModalMachine::comment,
                    &ModalMachine::modes, &ModalMachine::tool_length, &ModalMachine::feed_and_speed,
                    &ModalMachine::tool, &ModalMachine::switches, &ModalMachine::dwell, &ModalMachine::rotary,
                    &ModalMachine::move, &ModalMachine::left_over, &ModalMachine::stop}) {
    if (auto ok = (this->*step)(); !ok) return ok;
  }
  return {};
}

Result<void> ModalMachine::refused() {
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

Result<void> ModalMachine::program_number() {
  const Word* number = take('O');
  if (!number) return {};
  has_name_ = !block_->comment.empty() && name_.empty() && !any_record_;
  if (has_name_) name_ = block_->comment;
  return {};
}

Result<void> ModalMachine::comment() {
  if (!block_->comment.empty() && !std::exchange(has_name_, false)) add(cl::Comment{block_->comment});
  return {};
}

Result<void> ModalMachine::modes() {
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
  // F changes its meaning with the mode: what was in force is in force no more.
  if (const int code = words_.code(Group::feed_mode); code >= 0 && (code == 9300) != state_.inverse_time) {
    state_.inverse_time = code == 9300;
    state_.feed = 0;
  }
  if (const int code = words_.code(Group::distance); code >= 0) state_.incremental = code == 9100;
  if (const int code = words_.code(Group::arc_distance); code >= 0)
    state_.arc_centers_absolute = code == 9010;
  return work_offset();
}

/// The first work offset is the part frame; another one would need its distance from the first.
/// G43.4 and what ends it: the same place in other coordinates.
Result<void> ModalMachine::tool_length() {
  const Word* word = words_.in(Group::tool_length);
  if (!word) return {};
  const bool on = word->code() == 4340;
  if (on && (!options_.machine || options_.machine->rotary_count() == 0))
    return error(ErrorCode::unsupported,
                 "G43.4 (tool-centre-point control) is not read without a machine of rotary axes (G43)",
                 word);
  if (on == state_.tool_centre) return {};
  const kinematics::Joints before = joints();
  state_.tool_centre = on;
  state_.position = on ? options_.machine->forward(before).tip
                       : geom::Point3{before.linear[0], before.linear[1], before.linear[2]};
  return {};
}

Result<void> ModalMachine::work_offset() {
  const Word* word = words_.in(Group::work_offset);
  if (!word) return {};
  if (word->code() == 5410)
    return error(ErrorCode::unsupported, "G54.1 (extended work offsets) is not read (G54 to G59)", word);
  const int before = offset_ ? *offset_ : !moved_ ? word->code() : 5400;
  if (before != word->code())
    return error(ErrorCode::unsupported,
                 "a second work offset, " + code_name('G', word->code()) + " after " +
                     code_name('G', before) + " (one part frame in a program)",
                 word);
  offset_ = before;
  return {};
}

Result<void> ModalMachine::feed_and_speed() {
  times_.reset();
  if (const Word* word = state_.inverse_time ? take('F') : nullptr) {
    if (!(word->value > 0) || word->value > kMaxInverseTime)
      return error(ErrorCode::range, "F" + format_shortest(word->value) + " under G93 (above 0)", word);
    times_ = word->value;
  }
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

Result<void> ModalMachine::tool() {
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
Result<void> ModalMachine::switches() {
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

Result<void> ModalMachine::unknown_m() {
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

Result<void> ModalMachine::dwell() {
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
Result<void> ModalMachine::rotary() {
  turned_ = false;
  rotary_before_ = state_.rotary;
  for (char letter : {'A', 'B', 'C', 'U', 'V', 'W'}) {
    const Word* word = take(letter);
    if (!word) continue;
    const int axis = rotary_axis(letter);
    if (axis < 0) {
      if (word->value != 0)
        return error(ErrorCode::unsupported,
                     std::string("the axis ") + letter +
                         (options_.machine ? " (the axes of machine " + options_.machine->machine().name + ")"
                                           : " (X, Y and Z)"),
                     word);
      continue;
    }
    double& at = state_.rotary[static_cast<std::size_t>(axis)];
    const double to = geom::radians(word->value) + (state_.incremental ? at : 0);
    if (!(std::abs(to) <= kMaxRotary))
      return error(ErrorCode::range, std::string(1, letter) + " beyond a million turns (less)", word);
    at = to;
    turned_ = true;
  }
  return {};
}

int ModalMachine::rotary_axis(char letter) const {
  for (int i = 0; options_.machine && i < options_.machine->rotary_count(); ++i)
    if (options_.machine->rotary_axis(i).letter == letter) return i;
  return -1;
}

bool ModalMachine::has_axis_words() const {
  return turned_ || words_.value('X') || words_.value('Y') || words_.value('Z');
}
bool ModalMachine::has_arc_words() const {
  return words_.value('I') || words_.value('J') || words_.value('K') || words_.value('R');
}

Result<void> ModalMachine::move() {
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
                        : words_.value('Z') ? words_.value('Z')
                                            : &block_->words.front();
    return error(ErrorCode::syntax, "coordinates without a motion code before them (G0, G1, G2 or G3)",
                 first);
  }
  return arc ? arc_move() : straight_move();
}

/// G5 P10000 ... G5 P0 switches a control's look-ahead; G5 with coordinates is a cubic spline.
Result<void> ModalMachine::high_precision() {
  const Word* word = words_.in(Group::non_modal);
  if (has_axis_words() || has_arc_words() || !take('P'))
    return error(ErrorCode::unsupported, "G5 (spline) is not read (G5 P10000 and G5 P0 without coordinates)",
                 word);
  return {};
}

/// The end of a motion; `lost_` forgets what is commanded again.
Result<geom::Point3> ModalMachine::target(const std::array<const Word*, 3>& axes, geom::Point3 from) {
  geom::Point3 end = from;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Word* word = axes[axis];
    if (!word) continue;
    auto value = length(*word);
    if (!value) return value.error();
    if (state_.incremental && *value == 0) continue;
    if (state_.incremental && lost_[axis])
      return error(ErrorCode::unsupported, "an increment from the machine's reference position (G90)", word);
    const double to = *value + (state_.incremental ? component(end, axis) : 0.0);
    if (!(std::abs(to) <= kMaxCoordinate_mm))
      return error(ErrorCode::range, "a position beyond " + coordinate_limit() + " (less)", word);
    set_component(end, axis, to);
    lost_[axis] = false;
    sent_[axis] = true;
  }
  return end;
}

bool ModalMachine::placed() const {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lost_[axis] || !sent_[axis]) return false;
  return true;
}

Result<geom::Point3> ModalMachine::take_target() {
  const std::array<const Word*, 3> axes = {take('X'), take('Y'), take('Z')};
  return target(axes, state_.position);
}

void ModalMachine::note_units() {
  if (!units_known_)
    once(Severity::info, "units_assumed", "", "no G20 or G21 before the first move: millimetres are assumed",
         nullptr);
}

Result<void> ModalMachine::may_feed(const Word* word) const {
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

void ModalMachine::add_motion(cl::Record record, const geom::Point3& end) {
  note_units();
  began_with_feed_ = began_with_feed_ || (!moved_ && !std::holds_alternative<cl::Rapid>(record));
  move_to(end);
  add(std::move(record));
}

void ModalMachine::move_to(const geom::Point3& end) {
  moved_ = true;
  state_.position = end;
}

Result<void> ModalMachine::straight_move() {
  const Word* word = words_.in(Group::motion);
  auto end = take_target();
  if (!end) return end.error();
  if (state_.motion == MotionMode::rapid) {
    add_motion(cl::Rapid{pose(*end)}, *end);
    return {};
  }
  if (state_.inverse_time)
    if (auto ok = timed_feed(way_to(*end), word); !ok) return ok;
  if (auto ok = may_feed(word); !ok) return ok;
  add_motion(cl::Feed{pose(*end)}, *end);
  return {};
}

kinematics::Joints ModalMachine::joints() const {
  if (state_.tool_centre) return options_.machine->with_rotary(state_.position, state_.rotary);
  return {{state_.position.x, state_.position.y, state_.position.z}, state_.rotary};
}

cl::Pose ModalMachine::pose(const geom::Point3& position) const {
  if (!options_.machine) return {position};
  if (state_.tool_centre) return {position, options_.machine->forward({{}, state_.rotary}).axis};
  return options_.machine->forward({{position.x, position.y, position.z}, state_.rotary});
}

/// Length of the tip's way on the part from where the axes stand before this block.
double ModalMachine::way_to(const geom::Point3& end) const {
  if (!options_.machine || state_.tool_centre) return geom::distance(state_.position, end);
  kinematics::Joints from = joints();
  from.rotary = rotary_before_;
  return kinematics::tip_motion(*options_.machine, from, {{end.x, end.y, end.z}, state_.rotary}).length;
}

/// G93: the feed that takes a way of `length` in the time the block says.
Result<void> ModalMachine::timed_feed(double length, const Word* word) {
  if (!times_) return error(ErrorCode::syntax, "a feed move without F under G93 (F in every block)", word);
  // A tip that stands still has no feed of its own: the time of a millimetre then.
  const double feed = *times_ * (length > 0 ? length : 1.0);
  if (feed != state_.feed) add(cl::FeedRate{feed});
  state_.feed = feed;
  return {};
}

Result<void> ModalMachine::arc_move() {
  const Word* word = words_.in(Group::motion);
  if (!word) word = &block_->words.front();
  ArcWords arc{.start = state_.position,
               .plane = state_.plane,
               .clockwise = state_.motion == MotionMode::arc_cw,
               .center_absolute = state_.arc_centers_absolute,
               .radius_tolerance_mm = options_.arc_radius_tolerance_mm};
  if (const Word* turns = take('P'); turns && turns->value != 1)
    return error(ErrorCode::unsupported, "an arc of several turns (P1)", turns);
  auto end = take_target();
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
  if (state_.rotary != std::array<double, 2>{})
    return error(ErrorCode::unsupported, "an arc while a rotary axis is turned (lines, or rotary axes at 0)",
                 word);
  auto made = make_arc(arc);
  if (!made) return error(made.error().code, made.error().message, word);
  if (state_.inverse_time)
    if (auto ok = timed_feed(cl::arc_length(arc.start, *made), word); !ok) return ok;
  if (auto ok = may_feed(word); !ok) return ok;
  const geom::Point3 to = made->to.tip;
  add_motion(*std::move(made), to);
  return {};
}

/// G28, G30: over the point given to a place only the machine knows.
Result<void> ModalMachine::reference_return() {
  const Word* word = words_.in(Group::non_modal);
  std::array<bool, 3> named{};
  bool any = false;
  for (std::size_t i = 0; i < 3; ++i) any |= named[i] = words_.value(kAxis[i]) != nullptr;
  const geom::Point3 before = state_.position;
  auto via = take_target();
  if (!via) return via.error();
  if (*via != before) add_motion(cl::Rapid{pose(*via)}, *via);
  take('P');
  for (std::size_t i = 0; i < 3; ++i) lost_[i] = lost_[i] || !any || named[i];
  note_lost(word);
  return {};
}

Result<void> ModalMachine::machine_coordinates() {
  const Word* word = words_.in(Group::non_modal);
  if (state_.motion != MotionMode::rapid)
    return error(ErrorCode::unsupported, "G53 with a feed move (G53 G0)", word);
  for (std::size_t i = 0; i < 3; ++i) lost_[i] = lost_[i] || take(kAxis[i]) != nullptr;
  note_lost(word);
  return {};
}

void ModalMachine::note_lost(const Word* word) {
  once(Severity::left_out, "machine_position", "",
       "moves to places of the machine (G28, G30, G53) are left out: where they are is not known here", word);
}

Result<void> ModalMachine::left_over() {
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

Result<void> ModalMachine::stop() {
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

Result<void> for_each_block(Lexer& lexer, const std::function<Result<bool>(const Block&)>& read) {
  Block block;
  bool begun = false;  // comments may stand before the first '%'
  while (true) {
    auto more = lexer.next(block);
    if (!more) return std::move(more).error();
    if (!*more || (block.percent && begun)) return {};
    begun = begun || block.percent || !block.words.empty();
    auto ended = read(block);
    if (!ended) return std::move(ended).error();
    if (*ended) return {};
  }
}

}  // namespace burin::nc
