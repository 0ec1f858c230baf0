// SPDX-License-Identifier: Apache-2.0
// Options of drawings: what is done with layers, on which side the beam runs, what units and gaps mean.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "burin/io/drawing/drawing.h"
#include "burin/plan/laser/options.h"
#include "cli.h"

namespace burin::cli {

void add_layers(CLI::App& app, std::vector<std::string>& lists);
/// --side, --units, --join.
void add_drawing(CLI::App& app, laser::Side& side, io::Units& units, double& join_mm);
/// Error (usage): an item that is not understood.
Result<std::map<std::string, laser::Treatment>> parse_layers(const std::vector<std::string>& lists);

}  // namespace burin::cli
