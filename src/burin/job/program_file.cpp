// SPDX-License-Identifier: Apache-2.0
#include "burin/job/program_file.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "burin/base/text.h"
#include "burin/cl/apt.h"
#include "burin/job/file_kind.h"
#include "burin/nc/program.h"

namespace burin::job {
namespace {

// Other dialects show themselves in the first lines.
constexpr std::size_t kHead = 4096;

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
  auto moves = nc::interpret_joints(text, options, diagnostics);
  if (!moves) return moves.error();
  file.program = std::move(moves->program);
  file.unknown = std::move(moves->unknown);
  if (machine) {
    file.joints = std::move(moves->joints);
    file.tip_straight = std::move(moves->tip_straight);
  }
  find_described(text, file);
  return {};
}

}  // namespace

Result<ProgramFile> read_program(std::string_view text, const std::string& file_name,
                                 const kinematics::Kinematics* machine, Diagnostics& diagnostics, bool beam) {
  const Where where{.file = file_name};
  ProgramFile file;
  const FileKind kind = kind_of_file(text, file_name);
  if (kind == FileKind::nc) {
    if (auto ok = read_nc(text, file_name, machine, beam, file, diagnostics); !ok) return ok.error();
  } else if (kind == FileKind::cl) {
    auto program = cl::read_apt(text, {.file_name = file_name}, diagnostics);
    if (!program) return program.error();
    file.program = std::move(*program);
  } else if (text.substr(0, kHead).find("BEGIN PGM") != std::string_view::npos) {
    return Error{ErrorCode::unsupported,
                 "a Heidenhain conversational program is not read (G-code, or APT CL data)", where};
  } else {
    return Error{ErrorCode::syntax,
                 "no tool path but " + std::string(describe(kind)) +
                     " (APT CL data: GOTO/x,y,z; or a part program: G1 X Y Z)",
                 where};
  }
  if (file.program.move_count() == 0)
    return Error{ErrorCode::geometry, "the tool path moves nothing (GOTO/ or G1 blocks)", where};
  return file;
}

}  // namespace burin::job
