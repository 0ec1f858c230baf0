// SPDX-License-Identifier: Apache-2.0
// Ordinary motion programs: blocks -> CL records.
#include "burin/nc/modal.h"
#include "burin/nc/program.h"

namespace burin::nc {

Result<cl::Program> interpret(std::string_view text, const InterpretOptions& options,
                              Diagnostics& diagnostics) {
  cl::Program program;
  ModalMachine machine(options, diagnostics, [&program](cl::Record record, int line) {
    program.add(std::move(record), static_cast<std::uint32_t>(line));
  });
  Lexer lexer(text, {.file_name = options.file_name});
  const auto read = for_each_block(lexer, [&machine](const Block& block) -> Result<bool> {
    if (auto ok = machine.open(block); !ok) return ok.error();
    if (auto ok = machine.carry_out(); !ok) return ok.error();
    return machine.ended();
  });
  if (!read) return read.error();
  program.name = machine.name();
  if (machine.began_with_feed()) program.from = cl::Pose{options.start};
  return program;
}

}  // namespace burin::nc
