// SPDX-License-Identifier: Apache-2.0
// What goes to standard error: errors, warnings, the progress bar. Colours only on a terminal and without
// NO_COLOR.
#pragma once

#include <memory>
#include <string>

#include "burin/base/diagnostics.h"

namespace burin::cli {

/// True when standard error is a terminal that can move its cursor.
bool stderr_is_terminal();

void print_error(const std::string& text);

/// Warnings, and unless `quiet` the notes; of a code with many entries the first five and how many more there
/// are.
void print_warnings(const Diagnostics& diagnostics, bool quiet);

/// Draws nothing in the first second, nothing at all when `enabled` is false; the destructor removes the bar.
std::unique_ptr<ProgressSink> make_progress_bar(bool enabled);

}  // namespace burin::cli
