// SPDX-License-Identifier: Apache-2.0
// The subcommands, one file each.
#pragma once

namespace burin::cli {

class Cli;

void add_laser(Cli& cli);
void add_kerf(Cli& cli);
void add_cycle(Cli& cli);
void add_rotary(Cli& cli);
void add_orient(Cli& cli);
void add_cspace(Cli& cli);
void add_post(Cli& cli);
void add_verify(Cli& cli);
void add_view(Cli& cli);
void add_surfaces(Cli& cli);

}  // namespace burin::cli
