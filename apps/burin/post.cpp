// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "commands.h"

namespace burin::cli {

void add_post(Cli&) {}

}  // namespace burin::cli
