// SPDX-License-Identifier: Apache-2.0
// Which tool a program moves: what the command line says, else the job, else CUTTER/ of the CL data, else
// what the comments of the program say. Internal to job. mm.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/job/verify_tables.h"
#include "burin/verify/mill_check.h"

namespace burin::job {

struct ToolSizes {
  std::optional<double> diameter, corner, length;
};

/// As the check takes them; heights from the tip. The hemisphere of a ball cuts, what is above it is shank.
verify::CheckedMill checked_mill(const model::BallTool& tool);

class ToolFinder {
 public:
  /// `longest_mm`: cutters whose length nobody says are taken that long (and twice their diameter at least).
  ToolFinder(std::vector<JobTool> job, ToolSizes sizes, std::map<int, cl::ToolChange> described,
             double longest_mm, Diagnostics& diagnostics);
  /// How many different tools the program loads: one tool without number in the job is all of one.
  void program(const cl::Program& program);

  Result<verify::CheckedMill> operator()(const cl::ToolChange& change);

 private:
  const JobTool* of_job(const cl::ToolChange& change) const;
  std::optional<verify::CheckedMill> plain(const cl::ToolChange& change) const;
  verify::CheckedMill sized(verify::CheckedMill mill) const;
  void compare(const verify::CheckedMill& job, const cl::ToolChange& change);
  void tell_length(int number);

  std::vector<JobTool> job_;
  ToolSizes sizes_;
  std::map<int, cl::ToolChange> described_;
  double longest_ = 0;
  Diagnostics& diagnostics_;
  std::size_t different_ = 1;
  std::set<int> compared_, told_;
};

}  // namespace burin::job
