// SPDX-License-Identifier: Apache-2.0
// Stands in for the reader in builds without OpenCASCADE (-DBURIN_STEP=OFF).
#include "burin/io/step/read_step.h"

namespace burin::io {

namespace {

Error left_out(const std::string& file_name) {
  Where where;
  where.file = file_name;
  return {ErrorCode::unsupported,
          "this burin was built without STEP and IGES (build with -DBURIN_STEP=ON for them)",
          std::move(where)};
}

}  // namespace

Result<CadModel> read_cad(std::string_view, const ReadCadOptions& options, Diagnostics&) {
  return left_out(options.file_name);
}

Result<CadMesh> mesh_cad(std::string_view, const ReadCadOptions& options, double, double, Diagnostics&) {
  return left_out(options.file_name);
}

Result<std::string> write_step(const std::vector<geom::NurbsSurface>&, const std::string&) {
  return left_out("");
}

}  // namespace burin::io
