// SPDX-License-Identifier: Apache-2.0
// Stands in for the reader in builds without dxflib (-DBURIN_DXF=OFF).
#include "burin/io/dxf/read_dxf.h"

namespace burin::io {

bool dxf_supported() {
  return false;
}

Result<Drawing> read_dxf(std::string_view, const ReadOptions& options, Diagnostics&) {
  Where where;
  where.file = options.file_name;
  return Error{ErrorCode::unsupported,
               "this burin was built without DXF (SVG is accepted; build with -DBURIN_DXF=ON for DXF)",
               std::move(where)};
}

}  // namespace burin::io
