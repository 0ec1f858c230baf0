// SPDX-License-Identifier: Apache-2.0
// What `burin orient` and `burin cspace` begin with: job file, part, contacts, machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burin/job/orient_job.h"
#include "burin/kinematics/kinematics.h"
#include "session.h"

namespace burin::cli {

struct OrientSetup {
  job::OrientJobFile file;
  orient::Part part;
  std::vector<orient::CcPath> contacts;           ///< empty: generated
  std::optional<kinematics::Kinematics> machine;  ///< nothing: "none"

  const kinematics::Kinematics* machine_or_null() const { return machine ? &*machine : nullptr; }
  /// A hundredth of a degree inside the machine's: between poses that stand at a limit the way bulges.
  orient::MachineLimits limits() const;
  orient::Scene scene() const;
};

/// `tolerance`: instead of the job's.
Result<OrientSetup> load_orient(const std::string& job_path, std::optional<double> tolerance,
                                Session& session);

/// The examples of a job file at the end of --help.
extern const char* const kOrientJobHelp;

}  // namespace burin::cli
