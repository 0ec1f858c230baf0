// SPDX-License-Identifier: Apache-2.0
#include "burin/nc/surface_cycle.h"

namespace burin::nc {
namespace {

constexpr int kMaxNumber = 999'999'999;

/// The words that belong to the cycle, still as they stand.
struct CycleWords {
  const Word *i = nullptr, *e = nullptr, *p = nullptr, *q = nullptr, *w = nullptr, *d = nullptr, *m = nullptr,
             *s = nullptr, *l = nullptr, *f = nullptr;
};

Result<void> numbers(const Source& source, const Block& block, const CycleWords& words, SurfaceCycle& cycle) {
  if (!words.p || !words.q)
    return source.error(ErrorCode::syntax,
                        std::string("G106.2 without ") + (words.p ? "Q" : "P") +
                            " (P and Q, the N numbers of the first and the last G6.23 block)",
                        cycle.place);
  auto first = integer_word(source, block, *words.p, 0, kMaxNumber, "a block number");
  if (!first) return first.error();
  auto last = integer_word(source, block, *words.q, 0, kMaxNumber, "a block number");
  if (!last) return last.error();
  cycle.first = *first;
  cycle.last = *last;
  cycle.first_place = place_of(block, *words.p);
  cycle.last_place = place_of(block, *words.q);
  if (cycle.first > cycle.last)
    return source.error(
        ErrorCode::syntax,
        word_text(*words.p) + " is after " + word_text(*words.q) + " (P at most Q, blocks in rising order)",
        cycle.first_place);
  return {};
}

Result<void> choices(const Source& source, const Block& block, const CycleWords& words, SurfaceCycle& cycle) {
  if (words.i) {
    auto method = integer_word(source, block, *words.i, 1, 2, "a method: 1 iso-parametric, 2 iso-scallop");
    if (!method) return method.error();
    cycle.method = static_cast<PathMethod>(*method);
  }
  if (words.e) {
    auto rule = integer_word(source, block, *words.e, 1, 4,
                             "a grouping: 1 largest, 2 from the first, 3 along u, 4 along v");
    if (!rule) return rule.error();
    cycle.grouping = static_cast<geom::Grouping>(*rule);
  }
  if (words.l) {
    auto repeats = integer_word(source, block, *words.l, 1, kMaxRepeats, "a number of repeats");
    if (!repeats) return repeats.error();
    cycle.repeats = *repeats;
  }
  return {};
}

Result<void> lengths(const Source& source, const Block& block, const CycleWords& words,
                     const ModalMachine& machine, SurfaceCycle& cycle) {
  const auto positive = [&](const Word* word, const char* what, std::optional<double>& out) -> Result<void> {
    if (!word) return {};
    auto value = positive_word(source, block, *word, machine.scale(), what);
    if (!value) return value.error();
    out = *value;
    return {};
  };
  if (auto ok = positive(words.d, "a tool diameter", cycle.tool_diameter); !ok) return ok;
  if (auto ok = positive(words.m, "a largest side step", cycle.side_step); !ok) return ok;
  if (auto ok = positive(words.s, "an allowable scallop height", cycle.scallop); !ok) return ok;
  if (auto ok = positive(words.f, "a feed", cycle.feed); !ok) return ok;
  cycle.safety_z = machine.state().position.z;
  if (words.w && words.w->value != 0) {
    auto height = machine.length(*words.w);
    if (!height) return height.error();
    cycle.safety_z = *height;
  }
  return {};
}

}  // namespace

Result<SurfaceCycle> read_cycle(const Source& source, const Block& block, ModalMachine& machine) {
  SurfaceCycle cycle;
  cycle.join = machine.words().code(Group::non_modal) == 10620;
  cycle.place = place_of(block, *machine.take_code(cycle.join ? Group::non_modal : Group::motion));
  const std::string name = cycle.join ? "G106.2" : "G106.1";
  for (char letter : {'X', 'Y', 'Z'})
    if (const Word* word = machine.words().value(letter))
      return source.error(ErrorCode::syntax,
                          word_text(*word) + " in the block of " + name + " (moves in blocks of their own)",
                          place_of(block, *word));
  CycleWords words;
  words.i = machine.take('I');
  words.w = machine.take('W');
  words.d = machine.take('D');
  words.m = machine.take('M');
  words.s = machine.take('S');
  words.f = machine.words().value('F');  // also the feed in force
  if (cycle.join) {
    words.e = machine.take('E');
    words.p = machine.take('P');
    words.q = machine.take('Q');
    if (auto ok = numbers(source, block, words, cycle); !ok) return ok.error();
  } else {
    words.l = machine.take('L');
    if (!words.w)
      return source.error(ErrorCode::syntax, "G106.1 without W (the safety height, 0 to return)",
                          cycle.place);
  }
  if (auto ok = choices(source, block, words, cycle); !ok) return ok.error();
  if (auto ok = machine.carry_out(); !ok) return ok.error();
  if (auto ok = lengths(source, block, words, machine, cycle); !ok) return ok.error();
  return cycle;
}

}  // namespace burin::nc
