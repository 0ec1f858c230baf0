// SPDX-License-Identifier: Apache-2.0
// burin verify: what a tool path does to a design, found without the planners.
#include "cli.h"
#include "commands.h"

namespace burin::cli {

void add_verify(Cli&) {}

}  // namespace burin::cli
