// SPDX-License-Identifier: Apache-2.0
// APT CL text (vocabulary of ISO 3592 / ISO 4343): PARTNO, UNITS/MM, TOOLNO/, CUTTER/d,r, LOADTL/, SPINDL/, FEDRAT/, RAPID, GOTO/x,y,z[,i,j,k],
// CIRCLE/cx,cy,cz,i,j,k,r + GOTO, COOLNT/, DELAY/, PPRINT, FINI. The beam of a laser is BEAM/ON,power and BEAM/OFF
// (burin's extension). `$$` starts a comment, `$` at the end of a line continues it.
#pragma once

#include <string>
#include <string_view>

#include "burin/base/result.h"
#include "burin/cl/program.h"

namespace burin::cl {

/// Round trip: read_apt(write_apt(p)) equals p with every number within 1e-6 mm (axes within 1e-9).
std::string write_apt(const Program& program);

struct AptOptions {
  std::string file_name;                    ///< for messages only
  std::size_t max_records = 50'000'000;     ///< limit against hostile files
};
/// `source` of the records is the line (from 1). Statements that are not known become cl::Unknown and are
/// reported in `diagnostics` (code "unknown_statement", once per word). Errors (syntax, range) carry line and column.
Result<Program> read_apt(std::string_view text, const AptOptions& options, Diagnostics& diagnostics);

}  // namespace burin::cl
