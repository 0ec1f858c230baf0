// SPDX-License-Identifier: Apache-2.0
#include "joint_options.h"

namespace burin::cli {

void add_feed_mode(CLI::App& app, JointOptions& options, const std::string& what) {
  add_choice<post::FeedMode>(
      app, "--feed-mode", options.feed,
      {{"inverse-time", post::FeedMode::inverse_time}, {"per-minute", post::FeedMode::per_minute}},
      what + "G93, or G94 with an F that gives the tip its feed");
}

void add_keep_acceleration(CLI::App& app, JointOptions& options) {
  app.add_flag("--keep-acceleration", options.keep_acceleration,
               "slower where a rotary axis would have to change its speed faster than it can");
}

void report_joints(const kinematics::JointPath& path, Session& session) {
  session.report.counts["inserted"] = path.inserted;
  session.report.counts["feed_limited"] = path.feed_limited;
  session.report.counts["acceleration_limited"] = path.acceleration_limited;
  const std::string all = " of " + std::to_string(path.moves.size()) + " moves are slower than the feed: ";
  if (path.feed_limited > 0)
    session.diagnostics.info("feed_limited",
                             std::to_string(path.feed_limited) + all + "an axis is at its speed limit");
  if (path.acceleration_limited > 0)
    session.diagnostics.info("acceleration_limited", std::to_string(path.acceleration_limited) + all +
                                                         "a rotary axis is at its acceleration");
}

Json pieces_json(const std::vector<model::HolderPiece>& pieces) {
  Json out = Json::array();
  for (const model::HolderPiece& piece : pieces)
    out.push_back({{"radius_mm", piece.radius}, {"height_mm", piece.height}});
  return out;
}

}  // namespace burin::cli
