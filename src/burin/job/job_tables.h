// SPDX-License-Identifier: Apache-2.0
// The tables that job files share, read from TOML with every key checked. Internal to job.
#pragma once

#include <string>
#include <vector>

#include "burin/job/orient_job.h"
#include "burin/job/rotary_job.h"
#include "burin/model/toml_reader.h"

namespace burin::job {

/// [part] of `burin rotary`.
RotaryPartSource read_rotary_part(model::TomlReader& reader, const toml::table& table);
/// [part] of `burin orient` into `job`; `contacts`: triangles need them.
void read_orient_part(model::TomlReader& reader, const toml::table& table, bool contacts, OrientJobFile& job);
/// [tool]; `besides`: keys that somebody else reads.
model::BallTool read_ball_tool(model::TomlReader& reader, const toml::table& table,
                               const std::vector<std::string>& besides = {});
model::Mill read_mill(model::TomlReader& reader, const toml::table& table,
                      const std::vector<std::string>& besides = {});
/// [machine]: a preset, a file or "none".
std::string read_machine(model::TomlReader& reader, const toml::table& table);

}  // namespace burin::job
