// SPDX-License-Identifier: Apache-2.0
// G and M codes as data: the modal group of each (no two of one group in a block), and what an ordinary
// motion program may do with it. Grouping sorts the words of a block; it gives them no meaning.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/result.h"
#include "burin/nc/program.h"

namespace burin::nc {

enum class Group : std::uint8_t {
  motion,
  plane,
  distance,
  arc_distance,
  feed_mode,
  units,
  cutter,
  tool_length,
  work_offset,
  path_control,
  cycle_return,
  spindle_mode,
  lathe,
  scaling,
  rotation,
  polar,
  non_modal,
  m_stop,
  m_tool,
  m_spindle,
  m_mist,
  m_flood,
  m_override,
  m_other,
  count
};

enum class Treat : std::uint8_t {
  act,     ///< the interpreter does something
  ignore,  ///< does not change where the tool goes
  refuse,  ///< would move the tool in a way that is not understood
};

struct Code {
  int code;  ///< Word::code()
  Group group;
  Treat treat;
  std::string_view what;  ///< for messages
};

/// Sorted by code. G for letter 'G', M for 'M'.
std::span<const Code> known_codes(char letter);
/// nullptr when not known.
const Code* find_code(std::span<const Code> codes, int code);
/// "G6.23", "M30".
std::string code_name(char letter, int code);

/// The words of one block by letter and by modal group; points into the block.
struct Grouped {
  std::array<const Word*, 26> values{};  ///< by letter, without G (and N), M as group_block() was told
  std::array<const Word*, static_cast<std::size_t>(Group::count)> groups{};
  std::vector<const Word*> other_m;  ///< M codes that are not known

  const Word* value(char letter) const { return values[static_cast<std::size_t>(letter - 'A')]; }
  const Word* in(Group group) const { return groups[static_cast<std::size_t>(group)]; }
  /// The code of that group in this block, -1 when there is none.
  int code(Group group) const {
    const Word* word = in(group);
    return word ? word->code() : -1;
  }
};
/// `m_is_value`: M is a number of this block, not a code. Errors: a letter twice, two codes of one group
/// (syntax), an unknown G code (unsupported).
Result<Grouped> group_block(const Block& block, const std::string& file_name, bool m_is_value = false);

}  // namespace burin::nc
