// SPDX-License-Identifier: Apache-2.0
// CL data -> NC text of one dialect, with a map from NC lines to records.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/kinematics/joint_path.h"
#include "burin/post/dialect.h"

namespace burin::post {

struct EmitOptions {
  bool write_z = false;    ///< false: plane work, Z words left out (laser); records must then keep one Z
  int program_number = 1;  ///< O number where the dialect has one
  bool comments = true;
};

struct NcText {
  std::string text;
  /// line_to_record[i]: record index behind line i (from 0), kNoRecord for header, footer and blank lines.
  static constexpr std::uint32_t kNoRecord = 0xffffffffu;
  std::vector<std::uint32_t> line_to_record;
  std::size_t moves = 0;
  std::size_t vanished = 0;       ///< moves shorter than a decimal, left out
  std::size_t arcs_split = 0;     ///< arcs that went out as several arcs
  std::size_t arcs_as_lines = 0;  ///< arcs that went out as one line or more
};

/// Every coordinate is rounded once; I and J are computed from the rounded ends so that start and end radius
/// agree within the dialect's tolerance; an arc for which no representable centre does that is split or goes
/// out as lines. Moves that vanish after rounding are left out; full circles are kept. Modal words are not
/// repeated. Errors (unsupported, range): a tilted axis (needs a machine), an arc in a plane the dialect has
/// no word for, Z changes with write_z false, invalid programs.
Result<NcText> emit(const cl::Program& program, const Dialect& dialect, const EmitOptions& options,
                    Diagnostics& diagnostics);

enum class FeedMode {
  inverse_time,  ///< G93: each block says its time
  per_minute,    ///< G94: an F in each block that gives the tip the feed, as the dialect counts distance
};

struct JointEmitOptions : EmitOptions {
  FeedMode feed = FeedMode::inverse_time;
};

/// The same for joint moves (make_joint_path of the same program): axis letters and travel are the machine's.
/// Errors as above, and (unsupported) a dialect without G93, a feed mode that cannot say a move's time.
Result<NcText> emit_joints(const cl::Program& program, const kinematics::Kinematics& machine,
                           const kinematics::JointPath& path, const Dialect& dialect,
                           const JointEmitOptions& options, Diagnostics& diagnostics);

}  // namespace burin::post
