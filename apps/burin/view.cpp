// SPDX-License-Identifier: Apache-2.0
// burin view: one HTML file that shows and plays tool paths and reports.
#include "cli.h"
#include "commands.h"

namespace burin::cli {

void add_view(Cli&) {}

}  // namespace burin::cli
