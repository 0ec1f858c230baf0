// SPDX-License-Identifier: Apache-2.0
#include "burin/nc/codes.h"

#include <algorithm>

namespace burin::nc {
namespace {

using enum Group;

constexpr Code act(int code, Group group) {
  return {code, group, Treat::act, ""};
}
constexpr Code ignore(int code, Group group) {
  return {code, group, Treat::ignore, ""};
}
constexpr Code refuse(int code, Group group, std::string_view what) {
  return {code, group, Treat::refuse, what};
}

constexpr std::string_view kCycle = "canned cycle", kCutter = "cutter compensation", kCurve = "spline",
                           kProbe = "probing", kThread = "threading", kOffset = "moving the part frame",
                           kScale = "scaling", kLathe = "lathe diameter mode", kTurn = "lathe cycle",
                           kCall = "subprogram call", kPerRev = "feed per revolution",
                           kSurface = "constant surface speed",
                           kTool = "changing the tool length in the program", kPolar = "polar coordinates",
                           kRotate = "rotated coordinates", kJog = "circular pocket",
                           kSurfaceCycle = "surface cycle", kCylinder = "cylindrical interpolation";

constexpr std::array kG = std::to_array<Code>({
    act(0, motion),
    act(100, motion),
    act(200, motion),
    act(300, motion),
    act(400, non_modal),
    act(500, non_modal),
    refuse(510, motion, kCurve),
    refuse(520, motion, kCurve),
    refuse(530, motion, kCurve),
    refuse(620, motion, kCurve),
    refuse(623, non_modal, kSurfaceCycle),
    refuse(700, lathe, kLathe),
    refuse(710, non_modal, kCylinder),
    ignore(800, lathe),
    ignore(900, non_modal),
    refuse(1000, non_modal, kOffset),
    refuse(1100, non_modal, kOffset),
    refuse(1200, non_modal, kJog),
    refuse(1210, polar, kPolar),
    refuse(1300, non_modal, kJog),
    ignore(1310, polar),
    ignore(1500, polar),
    refuse(1600, polar, kPolar),
    act(1700, plane),
    act(1800, plane),
    act(1900, plane),
    act(2000, units),
    act(2100, units),
    act(2800, non_modal),
    refuse(2810, non_modal, kOffset),
    act(3000, non_modal),
    refuse(3010, non_modal, kOffset),
    refuse(3200, motion, kThread),
    refuse(3300, motion, kThread),
    refuse(3310, motion, kThread),
    refuse(3820, motion, kProbe),
    refuse(3830, motion, kProbe),
    refuse(3840, motion, kProbe),
    refuse(3850, motion, kProbe),
    ignore(4000, cutter),
    refuse(4100, cutter, kCutter),
    refuse(4110, cutter, kCutter),
    refuse(4200, cutter, kCutter),
    refuse(4210, cutter, kCutter),
    act(4300, tool_length),
    refuse(4310, tool_length, kTool),
    refuse(4320, tool_length, kTool),
    act(4340, tool_length),
    refuse(4350, tool_length, kTool),
    refuse(4400, tool_length, kTool),
    act(4900, tool_length),
    ignore(5000, scaling),
    refuse(5100, scaling, kScale),
    refuse(5200, non_modal, kOffset),
    act(5300, non_modal),
    act(5400, work_offset),
    act(5410, work_offset),
    act(5500, work_offset),
    act(5600, work_offset),
    act(5700, work_offset),
    act(5800, work_offset),
    act(5900, work_offset),
    act(5910, work_offset),
    act(5920, work_offset),
    act(5930, work_offset),
    ignore(6100, path_control),
    ignore(6110, path_control),
    ignore(6400, path_control),
    refuse(6500, non_modal, kCall),
    refuse(6600, non_modal, kCall),
    ignore(6700, non_modal),
    refuse(6800, rotation, kRotate),
    refuse(6820, rotation, kRotate),
    ignore(6900, rotation),
    refuse(7000, non_modal, kTurn),
    refuse(7100, non_modal, kTurn),
    refuse(7110, non_modal, kTurn),
    refuse(7120, non_modal, kTurn),
    refuse(7200, non_modal, kTurn),
    refuse(7210, non_modal, kTurn),
    refuse(7220, non_modal, kTurn),
    refuse(7300, motion, kCycle),
    refuse(7400, motion, kCycle),
    refuse(7500, motion, kCycle),
    refuse(7600, motion, kCycle),
    act(8000, motion),
    refuse(8100, motion, kCycle),
    refuse(8200, motion, kCycle),
    refuse(8300, motion, kCycle),
    refuse(8400, motion, kCycle),
    refuse(8500, motion, kCycle),
    refuse(8600, motion, kCycle),
    refuse(8700, motion, kCycle),
    refuse(8800, motion, kCycle),
    refuse(8900, motion, kCycle),
    act(9000, distance),
    act(9010, arc_distance),
    act(9100, distance),
    act(9110, arc_distance),
    refuse(9200, non_modal, kOffset),
    ignore(9210, non_modal),
    ignore(9220, non_modal),
    refuse(9230, non_modal, kOffset),
    act(9300, feed_mode),
    act(9400, feed_mode),
    refuse(9500, feed_mode, kPerRev),
    refuse(9600, spindle_mode, kSurface),
    ignore(9700, spindle_mode),
    ignore(9800, cycle_return),
    ignore(9900, cycle_return),
    refuse(10610, motion, kSurfaceCycle),
    refuse(10620, non_modal, kSurfaceCycle),
});

constexpr std::array kM = std::to_array<Code>({
    act(0, m_stop),
    act(100, m_stop),
    act(200, m_stop),
    act(300, m_spindle),
    act(400, m_spindle),
    act(500, m_spindle),
    act(600, m_tool),
    act(700, m_mist),
    act(800, m_flood),
    act(900, m_flood),
    act(3000, m_stop),
    ignore(4800, m_override),
    ignore(4900, m_override),
    act(6000, m_stop),
    refuse(7200, m_other, "restoring the modal state"),
    refuse(7300, m_other, "restoring the modal state"),
    refuse(9600, m_other, kCall),
    refuse(9700, m_other, kCall),
    refuse(9800, m_other, kCall),
    refuse(9900, m_other, kCall),
});

constexpr bool sorted(std::span<const Code> codes) {
  for (std::size_t i = 1; i < codes.size(); ++i)
    if (codes[i - 1].code >= codes[i].code) return false;
  return true;
}
static_assert(sorted(kG) && sorted(kM), "find_code searches by halves");

Error error(ErrorCode code, std::string message, const Block& block, const Word& word,
            const std::string& file) {
  return {code, std::move(message), {.file = file, .line = block.line, .column = word.column}};
}

}  // namespace

std::span<const Code> known_codes(char letter) {
  if (letter == 'G') return kG;
  if (letter == 'M') return kM;
  return {};
}

const Code* find_code(std::span<const Code> codes, int code) {
  const auto at = std::lower_bound(codes.begin(), codes.end(), code,
                                   [](const Code& entry, int value) { return entry.code < value; });
  return at != codes.end() && at->code == code ? &*at : nullptr;
}

std::string code_name(char letter, int code) {
  std::string name = letter + std::to_string(code / 100);
  const int fraction = code % 100;
  if (fraction == 0) return name;
  name += '.';
  if (fraction % 10 == 0) return name + std::to_string(fraction / 10);
  return name + (fraction < 10 ? "0" : "") + std::to_string(fraction);
}

Result<Grouped> group_block(const Block& block, const std::string& file_name, bool m_is_value) {
  Grouped grouped;
  for (const Word& word : block.words) {
    if (word.letter != 'G' && (word.letter != 'M' || m_is_value)) {
      const Word*& slot = grouped.values[static_cast<std::size_t>(word.letter - 'A')];
      if (slot)
        return error(ErrorCode::syntax,
                     std::string("the letter ") + word.letter + " twice in one block (once)", block, word,
                     file_name);
      slot = &word;
      continue;
    }
    const int code = word.code();
    const Code* known = find_code(known_codes(word.letter), code);
    if (!known && word.letter == 'M' && code >= 0) {
      grouped.other_m.push_back(&word);
      continue;
    }
    if (!known) {
      const std::string name =
          code >= 0 ? code_name(word.letter, code) : std::string("this ") + word.letter + " word";
      return error(ErrorCode::unsupported,
                   name +
                       " is not known (G0 to G4, G17 to G21, G90, G91, M0 to M9, M30 and "
                       "what does not move the tool)",
                   block, word, file_name);
    }
    const Word*& slot = grouped.groups[static_cast<std::size_t>(known->group)];
    if (slot)
      return error(ErrorCode::syntax,
                   code_name(word.letter, slot->code()) + " and " + code_name(word.letter, code) +
                       " exclude each other in one block (one of them)",
                   block, word, file_name);
    slot = &word;
  }
  return grouped;
}

}  // namespace burin::nc
