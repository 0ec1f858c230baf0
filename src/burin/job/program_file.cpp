// SPDX-License-Identifier: Apache-2.0
#include "burin/job/program_file.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <utility>

#include "burin/base/text.h"
#include "burin/cl/apt.h"
#include "burin/nc/program.h"

namespace burin::job {
namespace {

// Lines that say what a text is; headers of comments may be long.
constexpr std::size_t kLines = 2000, kTelling = 50;

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// Without comments in parentheses, which both kinds may hold.
std::string bare(std::string_view line) {
  std::string out;
  int depth = 0;
  for (const char c : line) {
    if (c == ';' && depth == 0) break;
    if (c == '(') ++depth;
    if (depth == 0) out += c;
    if (c == ')' && depth > 0) --depth;
  }
  return std::string(trim(out));
}

/// "GOTO/1,2,3", "PARTNO BLADE", "$$ made by": a word of three letters or more, and what APT has behind it.
bool apt_line(std::string_view line) {
  if (line.starts_with("$$")) return true;
  std::size_t end = 0;
  while (end < line.size() && is_letter(line[end])) ++end;
  if (end < 3) return false;
  const std::string_view rest = trim(line.substr(end));
  static constexpr std::string_view kAlone[] = {"PARTNO", "PPRINT", "RAPID", "FINI",   "REMARK",
                                                "MULTAX", "STOP",   "END",   "OPSTOP", "MACHIN"};
  const std::string word = to_lower(line.substr(0, end));
  return rest.starts_with("/") ||
         std::any_of(std::begin(kAlone), std::end(kAlone),
                     [&](std::string_view known) { return to_lower(known) == word; });
}

/// "N10 G1 X5.", "g0x1": letters with numbers from the start.
bool nc_line(std::string_view line) {
  if (line == "%") return true;
  if (line.starts_with("/")) line = trim(line.substr(1));
  if (line.size() < 2 || !is_letter(line[0])) return false;
  const std::string_view rest = trim(line.substr(1));
  return !rest.empty() && (std::isdigit(static_cast<unsigned char>(rest[0])) || rest[0] == '-' ||
                           rest[0] == '+' || rest[0] == '.' || rest[0] == '#' || rest[0] == '[');
}

/// "T1 D=6. CR=3. - ZMIN=-5. - ball end mill", mm or inches as the program.
std::optional<cl::ToolChange> described_tool(std::string_view text) {
  const auto number_after = [&](std::string_view key) -> std::optional<double> {
    const std::size_t at = text.find(key);
    if (at == std::string_view::npos) return {};
    const std::string_view rest = text.substr(at + key.size());
    return parse_double(rest.substr(0, std::min(rest.find_first_of(" \t,;)"), rest.size())));
  };
  if (text.size() < 2 || text[0] != 'T') return {};
  const auto number = number_after("T"), diameter = number_after(" D="), corner = number_after(" CR=");
  if (!number || !diameter || !(*number >= 0 && *number <= 999'999) || !(*diameter > 0)) return {};
  return cl::ToolChange{static_cast<int>(*number), *diameter, corner.value_or(0)};
}

bool in_inches(std::string_view text) {
  const std::string lower = to_lower(text.substr(0, std::min<std::size_t>(text.size(), 1 << 16)));
  const std::size_t inch = lower.find("g20"), mm = lower.find("g21");
  return inch < mm;
}

void find_described(std::string_view text, ProgramFile& file) {
  constexpr double kMmPerInch = 25.4;
  const double scale = in_inches(text) ? kMmPerInch : 1;
  for (const cl::Record& record : file.program.records) {
    const auto* comment = std::get_if<cl::Comment>(&record);
    if (!comment) continue;
    auto tool = described_tool(trim(comment->text));
    if (!tool) continue;
    tool->diameter *= scale;
    tool->corner_radius *= scale;
    file.described.emplace(tool->number, *tool);
  }
}

Result<void> read_nc(std::string_view text, const std::string& name, const kinematics::Kinematics* machine,
                     bool beam, ProgramFile& file, Diagnostics& diagnostics) {
  nc::InterpretOptions options;
  options.beam = beam;
  options.file_name = name;
  options.machine = machine;
  file.is_nc = true;
  if (!machine) {
    auto program = nc::interpret(text, options, diagnostics);
    if (!program) return program.error();
    file.program = std::move(*program);
  } else {
    auto moves = nc::interpret_joints(text, options, diagnostics);
    if (!moves) return moves.error();
    file.program = std::move(moves->program);
    file.joints = std::move(moves->joints);
    file.tip_straight = std::move(moves->tip_straight);
  }
  find_described(text, file);
  return {};
}

}  // namespace

ProgramKind kind_of_program(std::string_view text) {
  std::size_t apt = 0, nc = 0;
  for (std::size_t at = 0, lines = 0; at < text.size() && lines < kLines && apt + nc < kTelling; ++lines) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    const std::string line = bare(text.substr(at, std::min<std::size_t>(end - at, 1000)));
    at = end + 1;
    if (line.find("BEGIN PGM") != std::string::npos) return ProgramKind::heidenhain;
    if (apt_line(line))
      ++apt;
    else if (nc_line(line))
      ++nc;
  }
  if (apt == 0 && nc == 0) return ProgramKind::unknown;
  return apt >= nc ? ProgramKind::cl : ProgramKind::nc;
}

Result<ProgramFile> read_program(std::string_view text, const std::string& file_name,
                                 const kinematics::Kinematics* machine, Diagnostics& diagnostics, bool beam) {
  const Where where{.file = file_name};
  ProgramFile file;
  switch (kind_of_program(text)) {
    case ProgramKind::heidenhain:
      return Error{ErrorCode::unsupported,
                   "a Heidenhain conversational program is not read (G-code, or APT CL data)", where};
    case ProgramKind::unknown:
      return Error{ErrorCode::syntax,
                   "neither APT CL data (GOTO/x,y,z) nor a part program (G1 X Y Z) was found in it", where};
    case ProgramKind::nc:
      if (auto ok = read_nc(text, file_name, machine, beam, file, diagnostics); !ok) return ok.error();
      break;
    case ProgramKind::cl: {
      auto program = cl::read_apt(text, {.file_name = file_name}, diagnostics);
      if (!program) return program.error();
      file.program = std::move(*program);
      break;
    }
  }
  if (file.program.move_count() == 0)
    return Error{ErrorCode::geometry, "the tool path moves nothing (GOTO/ or G1 blocks)", where};
  return file;
}

}  // namespace burin::job
