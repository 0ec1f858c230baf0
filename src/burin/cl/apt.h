// SPDX-License-Identifier: Apache-2.0
// APT CL text (vocabulary of ISO 3592 / ISO 4343): PARTNO, UNITS/MM, CUTTER/d,r, LOADTL/n, SPINDL/RPM,n,CLW,
// FEDRAT/v,MMPM, RAPID, GOTO/x,y,z[,i,j,k], GODLTA/, FROM/, CIRCLE/cx,cy,cz,i,j,k,r + GOTO, COOLNT/, DELAY/,
// PPRINT, FINI. The beam of a laser is BEAM/ON,power and BEAM/OFF (burin's extension). `$$` starts a comment,
// `$` at the end of a line continues it. What the reader takes, word by word: docs/cl-and-nc.md.
#pragma once

#include <string>
#include <string_view>

#include "burin/base/result.h"
#include "burin/cl/program.h"

namespace burin::cl {

/// Round trip: read_apt(write_apt(p)) equals p with every number within 1e-6 mm (axes within 1e-9).
std::string write_apt(const Program& program);

struct AptOptions {
  std::string file_name;                 ///< for messages only
  std::size_t max_records = 50'000'000;  ///< limit against hostile files
};
/// `source` of the records is the line (from 1). Statements that are not known become cl::Unknown and are
/// reported in `diagnostics` (code "unknown_statement", once per word; left out when the word changes what
/// motion means, such as CYCLE). A text without FINI is read as far as it goes and reported ("no_fini").
/// Errors (syntax, range, unsupported) carry line and column. The result is not validated: validate() says
/// whether arcs and axes fit.
Result<Program> read_apt(std::string_view text, const AptOptions& options, Diagnostics& diagnostics);

}  // namespace burin::cl
