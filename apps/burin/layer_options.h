// SPDX-License-Identifier: Apache-2.0
// --layers: what is done with the layers of a drawing.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "burin/plan/laser/options.h"
#include "cli.h"

namespace burin::cli {

void add_layers(CLI::App& app, std::vector<std::string>& lists);
/// Error (usage): an item that is not understood.
Result<std::map<std::string, laser::Treatment>> parse_layers(const std::vector<std::string>& lists);

}  // namespace burin::cli
