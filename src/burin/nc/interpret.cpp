// SPDX-License-Identifier: Apache-2.0
// Ordinary motion programs: blocks -> CL records.
#include "burin/nc/modal.h"
#include "burin/nc/program.h"

namespace burin::nc {

namespace {

Result<cl::Program> read(std::string_view text, const InterpretOptions& options, Diagnostics& diagnostics,
                         JointProgram* moves) {
  cl::Program program;
  const ModalMachine* reader = nullptr;
  ModalMachine machine(options, diagnostics, [&](cl::Record record, int line) {
    if (moves && cl::is_motion(record)) {
      moves->joints.push_back(reader->joints());
      moves->tip_straight.push_back(reader->state().tool_centre);
      moves->unknown.push_back(std::holds_alternative<cl::Rapid>(record) && !reader->placed());
    }
    program.add(std::move(record), static_cast<std::uint32_t>(line));
  });
  reader = &machine;
  Lexer lexer(text, {.file_name = options.file_name});
  const auto done = for_each_block(lexer, [&machine](const Block& block) -> Result<bool> {
    if (auto ok = machine.open(block); !ok) return ok.error();
    if (auto ok = machine.carry_out(); !ok) return ok.error();
    return machine.ended();
  });
  if (!done) return done.error();
  program.name = machine.name();
  if (machine.began_with_feed()) program.from = cl::Pose{options.start};
  return program;
}

}  // namespace

Result<cl::Program> interpret(std::string_view text, const InterpretOptions& options,
                              Diagnostics& diagnostics) {
  return read(text, options, diagnostics, nullptr);
}

Result<JointProgram> interpret_joints(std::string_view text, const InterpretOptions& options,
                                      Diagnostics& diagnostics) {
  JointProgram result;
  auto program = read(text, options, diagnostics, &result);
  if (!program) return program.error();
  result.program = std::move(*program);
  return result;
}

}  // namespace burin::nc
