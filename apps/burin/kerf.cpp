// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "commands.h"

namespace burin::cli {

void add_kerf(Cli&) {}

}  // namespace burin::cli
