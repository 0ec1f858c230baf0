// SPDX-License-Identifier: Apache-2.0
// What the commands that write NC for rotary axes share: how the feed is said, what the joint path made of
// it, and the tool in the report.
#pragma once

#include <string>
#include <vector>

#include "burin/kinematics/joint_path.h"
#include "burin/model/tool.h"
#include "burin/post/emit.h"
#include "cli.h"

namespace burin::cli {

struct JointOptions {
  post::FeedMode feed = post::FeedMode::inverse_time;
  bool keep_acceleration = false;
};

/// --feed-mode; `what` begins its description.
void add_feed_mode(CLI::App& app, JointOptions& options, const std::string& what);
/// --keep-acceleration
void add_keep_acceleration(CLI::App& app, JointOptions& options);

/// counts: inserted, feed_limited, acceleration_limited; the message where moves are slower than the feed.
void report_joints(const kinematics::JointPath& path, Session& session);

/// Shank and holder of a tool: [{radius_mm, height_mm}, ...].
Json pieces_json(const std::vector<model::HolderPiece>& pieces);

}  // namespace burin::cli
