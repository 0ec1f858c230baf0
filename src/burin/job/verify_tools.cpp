// SPDX-License-Identifier: Apache-2.0
#include "burin/job/verify_tools.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "burin/base/text.h"
#include "burin/job/orient_check.h"

namespace burin::job {
namespace {

using verify::CheckedMill;

// Sizes of CUTTER/ and of the job that differ by less are the same: files keep four decimals.
constexpr double kSameSize_mm = 1e-3;

bool is_ball(const CheckedMill& mill) {
  return mill.corner_radius == mill.radius;
}

std::string text_of(double radius, double corner) {
  return "diameter " + format_shortest(2 * radius) + ", corner radius " + format_shortest(corner);
}

}  // namespace

CheckedMill checked_mill(const model::BallTool& tool) {
  CheckedMill mill{tool.radius, tool.radius, tool.radius, {}};
  double at = tool.radius;  // heights of BallTool count from the ball's centre
  mill.cylinders.push_back({tool.shank_radius, at, at + tool.shank_length, false});
  at += tool.shank_length;
  for (const model::HolderPiece& piece : tool.holder) {
    mill.cylinders.push_back({piece.radius, at, at + piece.height, true});
    at += piece.height;
  }
  return mill;
}

ToolFinder::ToolFinder(std::vector<JobTool> job, ToolSizes sizes, std::map<int, cl::ToolChange> described,
                       double longest_mm, Diagnostics& diagnostics)
    : job_(std::move(job)),
      sizes_(sizes),
      described_(std::move(described)),
      longest_(longest_mm),
      diagnostics_(diagnostics) {}

void ToolFinder::program(const cl::Program& program) {
  std::vector<cl::ToolChange> changes;
  for (const cl::Record& record : program.records)
    if (const auto* change = std::get_if<cl::ToolChange>(&record))
      if (std::find(changes.begin(), changes.end(), *change) == changes.end()) changes.push_back(*change);
  different_ = std::max<std::size_t>(changes.size(), 1);
}

/// The entry of that number; else the one without a number, when the program has one tool, or loads one of
/// just that size.
const JobTool* ToolFinder::of_job(const cl::ToolChange& change) const {
  const JobTool* any = nullptr;
  for (const JobTool& tool : job_) {
    if (tool.number == change.number) return &tool;
    if (!tool.number) any = &tool;
  }
  if (!any) return job_.size() == 1 && different_ == 1 ? &job_.front() : nullptr;
  if (different_ == 1 || change.diameter == 0) return different_ == 1 ? any : nullptr;
  const CheckedMill mill = std::visit([](const auto& shape) { return checked_mill(shape); }, any->shape);
  const bool same = std::abs(2 * mill.radius - change.diameter) <= kSameSize_mm &&
                    std::abs(mill.corner_radius - change.corner_radius) <= kSameSize_mm;
  return same ? any : nullptr;
}

std::optional<CheckedMill> ToolFinder::plain(const cl::ToolChange& change) const {
  cl::ToolChange tool = change;
  if (tool.diameter == 0 && !described_.empty()) {
    auto it = described_.find(change.number);
    if (it == described_.end() && described_.size() == 1 && different_ == 1) it = described_.begin();
    if (it != described_.end()) tool = it->second;
  }
  if (sizes_.diameter) tool.diameter = *sizes_.diameter;
  if (sizes_.corner) tool.corner_radius = *sizes_.corner;
  if (!(tool.diameter > 0)) return {};
  // Corners beyond the radius are no shape; some systems round them up.
  const double radius = tool.diameter / 2;
  const double corner =
      tool.corner_radius <= radius + kSameSize_mm ? std::min(radius, tool.corner_radius) : tool.corner_radius;
  return CheckedMill{radius, corner, sizes_.length.value_or(std::max(longest_, 2 * tool.diameter)), {}};
}

/// The job's tool with other sizes: shank and holder stay where the cutter ends.
CheckedMill ToolFinder::sized(CheckedMill mill) const {
  const bool ball = is_ball(mill) && !sizes_.corner;
  const double old_radius = mill.radius, old_length = mill.length;
  if (sizes_.diameter) mill.radius = *sizes_.diameter / 2;
  if (sizes_.corner) mill.corner_radius = *sizes_.corner;
  if (ball) mill.corner_radius = mill.radius;
  if (ball && old_length == old_radius) mill.length = mill.radius;
  if (sizes_.length) mill.length = *sizes_.length;
  mill.length = std::max(mill.length, mill.corner_radius);
  for (verify::ToolCylinder& c : mill.cylinders) {
    c.from += mill.length - old_length;
    c.to += mill.length - old_length;
    if (!c.holder && c.radius == old_radius) c.radius = mill.radius;
  }
  return mill;
}

void ToolFinder::compare(const CheckedMill& job, const cl::ToolChange& change) {
  if (change.diameter == 0 || !compared_.insert(change.number).second) return;
  if (std::abs(2 * job.radius - change.diameter) <= kSameSize_mm &&
      std::abs(job.corner_radius - change.corner_radius) <= kSameSize_mm)
    return;
  diagnostics_.info("tool_differs", "the program says CUTTER/ with " +
                                        text_of(change.diameter / 2, change.corner_radius) +
                                        ", the job says " + text_of(job.radius, job.corner_radius) +
                                        ": the job's tool is taken");
}

void ToolFinder::tell_length(int number) {
  if (sizes_.length || !told_.insert(number).second) return;
  diagnostics_.info("tool_length_assumed",
                    "nothing says how long the cutter of tool " + std::to_string(number) +
                        " is: it is taken as longer than the part is high, without shank and holder");
}

Result<CheckedMill> ToolFinder::operator()(const cl::ToolChange& change) {
  CheckedMill mill;
  if (const JobTool* tool = of_job(change)) {
    mill = std::visit([](const auto& shape) { return checked_mill(shape); }, tool->shape);
    compare(mill, change);
    mill = sized(std::move(mill));
  } else if (auto simple = plain(change)) {
    mill = *simple;
    tell_length(change.number);
  } else {
    const std::string which =
        change.number > 0 ? "tool " + std::to_string(change.number) : std::string("the tool");
    return Error{
        ErrorCode::usage,
        "nothing says what " + which +
            (job_.empty() ? " is" : " is: the job does not describe it, or only one of several tools") +
            " (--tool-diameter with --tool-corner, [tool] or [[tools]] with number in a job file, "
            "CUTTER/d,r in CL data)",
        {}};
  }
  if (!(mill.corner_radius <= mill.radius) || !(mill.length >= mill.corner_radius))
    return Error{ErrorCode::range,
                 "tool " + std::to_string(change.number) + ": " + text_of(mill.radius, mill.corner_radius) +
                     ", length " + format_shortest(mill.length) +
                     " (a corner of at most the radius and the length)",
                 {}};
  return mill;
}

}  // namespace burin::job
