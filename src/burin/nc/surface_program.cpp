// SPDX-License-Identifier: Apache-2.0
// The order of things in a surface program: which block belongs to which surface, curve or cycle, and when
// what is machined. See docs/surface-program.md.
#include "burin/nc/surface_program.h"

#include <unordered_map>

#include "burin/base/text.h"
#include "burin/nc/curve_block.h"
#include "burin/nc/modal.h"
#include "burin/nc/place.h"
#include "burin/nc/surface_block.h"
#include "burin/nc/surface_cycle.h"

namespace burin::nc {
namespace {

constexpr int kSurface = 623, kRepeat = 10610, kJoin = 10620, kCurve = 620;
// A curve begins where the tool stands, up to the rounding of both to the decimals of a program.
constexpr double kCurveStart_mm = 0.01;
// More than anybody repeats; bounds memory, since L asks for thousands of repeats in a few characters.
constexpr std::size_t kMaxRepeatedSurfaces = 100'000;

std::string n_word(int number) {
  return "N" + std::to_string(number);
}

class Reader {
 public:
  Reader(std::string_view text, const SurfaceReadOptions& options, Diagnostics& diagnostics)
      : options_(options),
        modal_options_{.file_name = options.file_name, .start = options.start},
        source_{options.file_name},
        lexer_(text, {.file_name = options.file_name}),
        machine_(modal_options_, diagnostics_,
                 [this](cl::Record record, int line) { add(std::move(record), line); }),
        diagnostics_out_(diagnostics) {
    program_.start = options.start;
  }

  Result<SurfaceProgram> run() {
    auto read = for_each_block(lexer_, [this](const Block& block) -> Result<bool> {
      ++program_.nc_blocks;
      last_line_ = block.line;
      if (auto ok = read_block(block); !ok) return ok.error();
      if (auto ok = strict(); !ok) return ok.error();
      return machine_.ended();
    });
    if (read) read = end();
    if (read) read = strict();
    for (const Warning& warning : diagnostics_.warnings()) diagnostics_out_.add(warning);
    if (!read) return read.error();
    program_.name = machine_.name();
    return std::move(program_);
  }

 private:
  /// Where a surface with this N word is looked for.
  struct Numbered {
    int line = 0;
    bool surface = false;
  };
  /// G106.2 whose blocks are being read.
  struct Joining {
    SurfaceCycle cycle;
    std::vector<std::size_t> blocks;
    bool begun = false;
  };
  /// G106.1 and the surface it repeats.
  struct Repeating {
    SurfaceCycle cycle;
    std::optional<MachineGroup> group;
    geom::Point3 defined_at, at;  ///< where the tool stood, is commanded
    int since_move = 0;           ///< surfaces since the last motion block
  };

  void add(cl::Record record, int line) {
    program_.steps.emplace_back(Plain{std::move(record), line, machine_.state().feed});
  }

  Result<void> strict() const {
    if (!options_.strict || diagnostics_.empty()) return {};
    const Warning& first = diagnostics_.warnings().front();
    return Error{ErrorCode::syntax, first.message + " (with --strict: a program without warnings)",
                 first.where};
  }

  // --- which block is whose

  Result<void> read_block(const Block& block) {
    if (auto ok = note_number(block); !ok) return ok;
    const bool trim = is_trim_comment(block);
    if (trim && !block.words.empty())
      return source_.error(ErrorCode::syntax, "BURIN TRIM beside words (a line of its own)",
                           {block.line, block.comment_column});
    if (block.words.empty() && !trim) return ordinary(block);
    if (surface_) {
      auto taken = surface_->take(block, lexer_.remaining());
      if (!taken) return taken.error();
      if (*taken) return {};
      if (auto ok = finish_surface(); !ok) return ok;
    }
    if (curve_) {
      if (auto ok = curve_->take(block); !ok) return ok;
      return curve_->complete() ? finish_curve() : Result<void>{};
    }
    if (trim)
      return source_.error(ErrorCode::syntax,
                           "BURIN TRIM outside of a surface (behind the points and knots of G6.23)",
                           {block.line, block.comment_column});
    auto done = by_code(block);
    after_surface_ = false;
    return done;
  }

  Result<void> by_code(const Block& block) {
    const Word* code = nullptr;
    for (const Word& word : block.words) {
      if (word.letter != 'G') continue;
      const int value = word.code();
      if (value != kSurface && value != kRepeat && value != kJoin && value != kCurve) continue;
      if (code)
        return source_.error(
            ErrorCode::syntax,
            word_text(*code) + " and " + word_text(word) + " exclude each other in one block (one of them)",
            place_of(block, word));
      code = &word;
    }
    const int value = code ? code->code() : -1;
    if (auto ok = machine_.open(block, value == kRepeat || value == kJoin); !ok) return ok;
    switch (value) {
      case kSurface:
        return begin_surface(block);
      case kRepeat:
        return begin_repeat(block);
      case kJoin:
        return begin_join(block);
      case kCurve:
        return begin_curve(block);
      default:
        return move_block(block);
    }
  }

  /// Comments, and blocks with nothing but a number.
  Result<void> ordinary(const Block& block) {
    if (auto ok = machine_.open(block); !ok) return ok;
    return machine_.carry_out();
  }

  /// Numbers of surfaces are what P and Q name: they stand for one block.
  Result<void> note_number(const Block& block) {
    if (!block.number) return {};
    const bool surface = std::any_of(block.words.begin(), block.words.end(), [](const Word& word) {
      return word.letter == 'G' && word.code() == kSurface;
    });
    const auto [at, fresh] = numbers_.try_emplace(*block.number, Numbered{block.line, surface});
    if (fresh || (!surface && !at->second.surface)) return {};
    return source_.error(ErrorCode::syntax,
                         n_word(*block.number) + " twice, in line " + std::to_string(at->second.line) +
                             " and here (a number of its own for each block of G6.23)",
                         {block.line, 1});
  }

  // --- surfaces

  Result<void> begin_surface(const Block& block) {
    if (joining_ && !joining_->begun && block.number != joining_->cycle.first)
      return source_.error(ErrorCode::syntax,
                           "a surface before " + n_word(joining_->cycle.first) +
                               ", the first of G106.2 in line " + std::to_string(joining_->cycle.place.line) +
                               " (surfaces of their own before G106.2 or behind its last)",
                           place_of(block));
    if (joining_ && block.number &&
        (*block.number < joining_->cycle.first || *block.number > joining_->cycle.last))
      return source_.error(ErrorCode::syntax,
                           n_word(*block.number) + " among the surfaces of G106.2 in line " +
                               std::to_string(joining_->cycle.place.line) + " (numbers from " +
                               std::to_string(joining_->cycle.first) + " to " +
                               std::to_string(joining_->cycle.last) + ", or none)",
                           place_of(block));
    auto reader = SurfaceReader::begin(source_, block, machine_);
    if (!reader) return reader.error();
    if (auto ok = machine_.carry_out(); !ok) return ok;
    if (auto ok = reader->use(machine_, words_, lexer_.remaining()); !ok) return ok;
    machine_.note_units();
    if (machine_.state().incremental)
      machine_.once(Severity::info, "points_absolute", "",
                    "G91 is in force at G6.23: control points are positions in the part frame all the same",
                    &block.words.front());
    machine_.set_motion(MotionMode::none);
    if (joining_) joining_->begun = true;
    surface_.emplace(*std::move(reader));
    return {};
  }

  Result<void> finish_surface() {
    const Place place = surface_->place();
    auto block = surface_->finish();
    surface_.reset();
    after_surface_ = true;
    if (!block) return block.error();
    program_.blocks.push_back(*std::move(block));
    const std::size_t index = program_.blocks.size() - 1;
    if (joining_) {
      joining_->blocks.push_back(index);
      if (program_.blocks[index].number == joining_->cycle.last) return machine_joined();
      return {};
    }
    auto group = make_group({index}, repeating_ ? &repeating_->cycle : nullptr, place);
    if (!group) return group.error();
    if (repeating_) {
      repeating_->defined_at = repeating_->at = machine_.state().position;
      repeating_->group = *group;
      ++repeating_->since_move;
    }
    machine_group(*std::move(group));
    return {};
  }

  Result<void> machine_joined() {
    auto group = make_group(std::move(joining_->blocks), &joining_->cycle, joining_->cycle.place);
    if (!group) return group.error();
    joining_.reset();
    machine_group(*std::move(group));
    return {};
  }

  /// The words of the cycle win; else all blocks must say the same.
  Result<double> agreed(const std::vector<std::size_t>& blocks, const std::optional<double>& of_cycle,
                        double SurfaceBlock::*member, char letter, const char* what, Place place) {
    if (of_cycle) return *of_cycle;
    const SurfaceBlock& first = program_.blocks[blocks.front()];
    for (std::size_t index : blocks)
      if (program_.blocks[index].*member != first.*member)
        return source_.error(ErrorCode::syntax,
                             std::string("the surfaces in lines ") + std::to_string(first.line) + " and " +
                                 std::to_string(program_.blocks[index].line) + " differ in " + letter +
                                 " (one " + what + " for surfaces that are joined)",
                             place);
    return first.*member;
  }

  Result<MachineGroup> make_group(std::vector<std::size_t> blocks, const SurfaceCycle* cycle, Place place) {
    const SurfaceCycle none;
    const SurfaceCycle& words = cycle ? *cycle : none;
    MachineGroup group;
    group.line = cycle && cycle->join ? cycle->place.line : place.line;
    group.join = cycle && cycle->join;
    group.grouping = words.grouping;
    group.method = words.method;
    group.side_step = words.side_step;
    const geom::Point3 position = machine_.state().position;
    group.safety_z = cycle ? cycle->safety_z : position.z;
    group.start = position;
    const struct {
      double MachineGroup::*to;
      double SurfaceBlock::*from;
      std::optional<double> of_cycle;
      char letter;
      const char* what;
    } numbers[] = {
        {&MachineGroup::tool_diameter, &SurfaceBlock::tool_diameter, words.tool_diameter, 'D',
         "tool diameter"},
        {&MachineGroup::scallop, &SurfaceBlock::scallop, words.scallop, 'S', "scallop height"},
        {&MachineGroup::feed, &SurfaceBlock::feed, words.feed, 'F', "feed"},
        {&MachineGroup::stock, &SurfaceBlock::stock, std::nullopt, 'L', "stock"},
    };
    for (const auto& number : numbers) {
      auto value = agreed(blocks, number.of_cycle, number.from, number.letter, number.what, place);
      if (!value) return value.error();
      if (!(*value > 0) && number.letter != 'L')
        return source_.error(ErrorCode::syntax,
                             std::string("no ") + number.what + " for this surface (" + number.letter +
                                 " above 0 here or in its cycle)",
                             place);
      group.*number.to = *value;
    }
    if (!(group.scallop < group.tool_diameter / 2))
      return source_.error(ErrorCode::range,
                           "a scallop height of " + format_shortest(group.scallop) +
                               " mm with a ball of radius " + format_shortest(group.tool_diameter / 2) +
                               " mm (less than the radius)",
                           place);
    fill_blocks(blocks, group);
    group.blocks = std::move(blocks);
    return group;
  }

  /// What a block did not say itself it has from its cycle.
  void fill_blocks(const std::vector<std::size_t>& blocks, const MachineGroup& group) {
    for (std::size_t index : blocks) {
      SurfaceBlock& block = program_.blocks[index];
      if (!(block.tool_diameter > 0)) block.tool_diameter = group.tool_diameter;
      if (!(block.scallop > 0)) block.scallop = group.scallop;
      if (!(block.feed > 0)) block.feed = group.feed;
    }
  }

  /// The tool ends over the place where it stood, or where the surface was moved to, at the safety height.
  void machine_group(MachineGroup group) {
    geom::Point3 end = machine_.state().position;
    if (repeating_) end = repeating_->at;
    end.z = group.safety_z;
    away_line_ = group.line;
    program_.steps.emplace_back(std::move(group));
    machine_.move_to(end);
  }

  // --- cycles

  Result<void> begin_join(const Block& block) {
    if (joining_) return not_yet_joined(place_of(block));
    if (repeating_)
      return source_.error(ErrorCode::syntax, "G106.2 inside G106.1 (G80 before it)", place_of(block));
    auto cycle = read_cycle(source_, block, machine_);
    if (!cycle) return cycle.error();
    if (const auto at = numbers_.find(cycle->first); at != numbers_.end() && at->second.surface)
      return source_.error(ErrorCode::syntax,
                           n_word(cycle->first) + " stands in line " + std::to_string(at->second.line) +
                               ", before G106.2 (G106.2 before the surfaces it consumes)",
                           cycle->first_place);
    joining_.emplace(Joining{*std::move(cycle), {}, false});
    return {};
  }

  Error not_yet_joined(Place place) const {
    const SurfaceCycle& cycle = joining_->cycle;
    return source_.error(ErrorCode::syntax,
                         "G106.2 in line " + std::to_string(cycle.place.line) + " still waits for " +
                             n_word(joining_->begun ? cycle.last : cycle.first) +
                             " (only blocks of G6.23 up to " + n_word(cycle.last) +
                             ", then what comes after)",
                         place);
  }

  Result<void> begin_repeat(const Block& block) {
    if (joining_) return not_yet_joined(place_of(block));
    auto cycle = read_cycle(source_, block, machine_);
    if (!cycle) return cycle.error();
    repeating_.emplace(Repeating{*std::move(cycle), std::nullopt, {}, {}, 0});
    machine_.set_motion(MotionMode::none);
    return {};
  }

  /// A motion block between G106.1 and G80: the surface again, elsewhere.
  Result<void> repeat(const Block& block) {
    const Word* motion = machine_.words().in(Group::motion);
    if (motion && motion->code() != 0 && motion->code() != 100)
      return source_.error(ErrorCode::unsupported,
                           word_text(*motion) + " inside G106.1 (straight moves, or G80 before)",
                           place_of(block, *motion));
    if (const Word* special = machine_.words().in(Group::non_modal))
      return source_.error(ErrorCode::unsupported,
                           word_text(*special) + " with coordinates inside G106.1 (G80 before)",
                           place_of(block, *special));
    const std::array<const Word*, 3> axes = {machine_.take('X'), machine_.take('Y'), machine_.take('Z')};
    if (after_surface_ && axes[0] && axes[1] && axes[2] && block.words.size() == 3)
      return one_point_more(block);
    const Word* axis = axes[0] ? axes[0] : axes[1] ? axes[1] : axes[2];
    const Word* times = machine_.take('L');
    if (!repeating_->group)
      return source_.error(ErrorCode::syntax,
                           "a move inside G106.1 before its surface (G6.23 first, or G80 before the move)",
                           place_of(block, *axis));
    if (auto ok = machine_.carry_out(); !ok) return ok;
    int count = repeating_->cycle.repeats;
    if (times) {
      auto value = integer_word(source_, block, *times, 1, kMaxRepeats, "a number of repeats");
      if (!value) return value.error();
      count = *value;
    }
    say_what_repeats(count, axis);
    if (machine_.state().incremental) incremental_line_ = block.line;
    for (int i = 0; i < count; ++i) {
      if (++repeats_ > kMaxRepeatedSurfaces)
        return source_.error(
            ErrorCode::range,
            "more than " + std::to_string(kMaxRepeatedSurfaces) + " repeats of surfaces (fewer)",
            place_of(block, *axis));
      auto at = machine_.target(axes, repeating_->at);
      if (!at) return at.error();
      repeating_->at = *at;
      MachineGroup group = *repeating_->group;
      group.line = block.line;
      group.repeat = true;
      group.displacement = *at - repeating_->defined_at;
      group.start = machine_.state().position;
      machine_group(std::move(group));
    }
    repeating_->since_move = 0;
    return {};
  }

  void say_what_repeats(int count, const Word* word) {
    if (repeating_->since_move > 1)
      machine_.once(Severity::info, "repeats_last_surface", std::to_string(word->column),
                    "only the last of the " + std::to_string(repeating_->since_move) +
                        " surfaces before is repeated (one surface for each repeat)",
                    word);
    if (count > 1 && !machine_.state().incremental)
      machine_.once(Severity::info, "repeats_in_place", "",
                    "L with G90 machines the same place again and again (G91 moves on)", word);
  }

  // --- curves and moves

  Result<void> begin_curve(const Block& block) {
    if (joining_) return not_yet_joined(place_of(block));
    if (repeating_)
      return source_.error(ErrorCode::syntax, "G6.2 inside G106.1 (G80 before it)", place_of(block));
    auto reader = CurveReader::begin(source_, block, machine_);
    if (!reader) return reader.error();
    if (auto ok = machine_.carry_out(); !ok) return ok;
    if (auto ok = reader->use(machine_); !ok) return ok;
    machine_.note_units();
    machine_.set_motion(MotionMode::none);
    curve_feed_ = machine_.state().feed;
    curve_.emplace(*std::move(reader));
    return {};
  }

  Result<void> finish_curve() {
    const Place place = curve_->place();
    auto curve = curve_->finish();
    curve_.reset();
    if (!curve) return curve.error();
    return_to_programmed();
    const geom::Point3 first = geom::project(curve->points.front());
    const double gap = distance(first, machine_.state().position);
    if (gap > kCurveStart_mm)
      return source_.error(ErrorCode::geometry,
                           "the curve begins " + format_fixed(gap, 4) +
                               " mm from where the tool stands (its first control point there)",
                           place);
    if (gap > cl::kSamePoint_mm) machine_.add_motion(cl::Feed{cl::Pose{first}}, first);
    machine_.move_to(geom::project(curve->points.back()));
    program_.steps.emplace_back(CurveMove{place.line, *std::move(curve), curve_feed_});
    return {};
  }

  static bool has_axis(const Grouped& words) {
    return words.value('X') || words.value('Y') || words.value('Z');
  }

  Result<void> move_block(const Block& block) {
    const Grouped& words = machine_.words();
    const int special = words.code(Group::non_modal);
    constexpr int kDwell = 400;
    const bool arc = words.value('I') || words.value('J') || words.value('R');
    const bool moves =
        special == kDwell ? false : has_axis(words) || arc || special == 2800 || special == 3000;
    if (words.code(Group::motion) == 8000) {
      if (joining_) return not_yet_joined(place_of(block));
      repeating_.reset();
    }
    if (moves && joining_) return not_yet_joined(place_of(block));
    if (moves && repeating_ && has_axis(words)) return repeat(block);
    if (!moves) return carry_out(block);
    if (!will_go_anywhere(words)) return_to_programmed();
    const geom::Point3 before = machine_.state().position;
    if (auto ok = carry_out(block); !ok) return ok;
    away_line_ = 0;
    warn_incremental(block, before);
    return {};
  }

  Result<void> carry_out(const Block& block) {
    if (block.words.size() == 1 && block.words[0].letter == 'K')
      return source_.error(ErrorCode::syntax, "a knot outside of a surface or curve (G6.23 or G6.2 before)",
                           place_of(block));
    if (after_surface_ && !repeating_ && has_axis(machine_.words()) && !machine_.words().in(Group::motion) &&
        !machine_.words().in(Group::non_modal))
      return one_point_more(block);
    return machine_.carry_out();
  }

  /// Coordinates right behind a surface that nobody can tell from one more of its points.
  Error one_point_more(const Block& block) const {
    const SurfaceBlock& last = program_.blocks.back();
    return source_.error(ErrorCode::syntax,
                         "coordinates behind the " + std::to_string(last.surface.points.size()) +
                             " control points of the surface in line " + std::to_string(last.line) +
                             " (U times V points; a move there needs a G word)",
                         place_of(block));
  }

  /// A rapid to X and Y needs no way back to where the cycle began.
  bool will_go_anywhere(const Grouped& words) const {
    const int motion = words.code(Group::motion), distance = words.code(Group::distance);
    const bool rapid = motion == 0 || (motion < 0 && machine_.state().motion == MotionMode::rapid);
    const bool absolute = distance == 9000 || (distance < 0 && !machine_.state().incremental);
    return rapid && absolute && words.value('X') && words.value('Y') && words.code(Group::non_modal) < 0;
  }

  /// After surfaces the tool stands where the last path ended, at the safety height; the program counts from
  /// where it was commanded to.
  void return_to_programmed() {
    const int line = std::exchange(away_line_, 0);
    if (line > 0) add(cl::Rapid{cl::Pose{machine_.state().position}}, line);
  }

  /// G91 given for repeats is modal: what looks like a height afterwards is a step (the paper's Table 2).
  void warn_incremental(const Block& block, const geom::Point3& before) {
    if (incremental_line_ == 0) return;
    const int line = std::exchange(incremental_line_, 0);
    if (!machine_.state().incremental) return;
    const geom::Point3 after = machine_.state().position;
    for (char letter : {'Z', 'Y', 'X'}) {
      const Word* word = block.find(letter);
      if (!word) continue;
      const double from = letter == 'X' ? before.x : letter == 'Y' ? before.y : before.z;
      const double to = letter == 'X' ? after.x : letter == 'Y' ? after.y : after.z;
      machine_.once(Severity::info, "modal_g91", std::to_string(block.line),
                    "G91 of the repeats in line " + std::to_string(line) + " is still in force: " +
                        word_text(*word) + " moves by " + format_fixed(to - from, 6) + " mm, from " +
                        format_fixed(from, 6) + " to " + format_fixed(to, 6) + " (G90 before a position)",
                    word);
      return;
    }
  }

  // --- the end

  Result<void> end() {
    if (surface_) {
      if (auto ok = surface_->end(last_line_); !ok) return ok;
      if (auto ok = finish_surface(); !ok) return ok;
    }
    if (curve_) return curve_->end(last_line_);
    if (!joining_) return {};
    const SurfaceCycle& cycle = joining_->cycle;
    return source_.error(
        ErrorCode::syntax,
        n_word(joining_->begun ? cycle.last : cycle.first) +
            " is not the number of a surface behind G106.2 (a block of G6.23 with that N word)",
        joining_->begun ? cycle.last_place : cycle.first_place);
  }

  const SurfaceReadOptions& options_;
  const InterpretOptions modal_options_;
  const Source source_;
  Lexer lexer_;
  Diagnostics diagnostics_;
  ModalMachine machine_;
  Diagnostics& diagnostics_out_;
  SurfaceProgram program_;
  SurfaceWords words_;
  std::unordered_map<int, Numbered> numbers_;  // looked up, never listed
  std::optional<SurfaceReader> surface_;
  std::optional<CurveReader> curve_;
  std::optional<Joining> joining_;
  std::optional<Repeating> repeating_;
  double curve_feed_ = 0;
  std::size_t repeats_ = 0;
  bool after_surface_ = false;  // the block before was the last of a surface
  int last_line_ = 1;
  int away_line_ = 0;         // line of the group after which the tool was not yet placed anew; 0: none
  int incremental_line_ = 0;  // last line with repeats by G91
};

}  // namespace

Result<SurfaceProgram> read_surface_program(std::string_view text, const SurfaceReadOptions& options,
                                            Diagnostics& diagnostics) {
  return Reader(text, options, diagnostics).run();
}

}  // namespace burin::nc
