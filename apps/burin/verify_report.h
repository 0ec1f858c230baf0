// SPDX-License-Identifier: Apache-2.0
// What `burin verify` says: JSON, CSV, table and messages.
#pragma once

#include <optional>
#include <string>

#include "burin/job/verify_job.h"
#include "session.h"

namespace burin::cli {

/// Largest deviations that are accepted.
struct VerifyLimits {
  std::optional<double> gouge_mm, excess_mm;
};

void fill_verify_report(const job::VerifyOptions& options, const job::VerifyInput& input,
                        const job::VerifyResult& result, Session& session);
/// Collisions, places not machined, deviations beyond the tolerance; limits that are passed.
void judge_verify(const job::VerifyInput& input, const job::VerifyResult& result, const VerifyLimits& limits,
                  Session& session);
/// x,y,z,nx,ny,nz,deviation_mm; without a deviation where nothing cuts.
std::string verify_csv(const job::VerifyResult& result);
/// A few lines for people.
std::string verify_summary(const job::VerifyInput& input, const job::VerifyResult& result);

}  // namespace burin::cli
