// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/read_dxf.h"

#include <exception>

#include "burin/io/dxf/document.h"
#include "burin/io/dxf/dxflib_reader.h"
#include "burin/io/dxf/expand.h"
#include "burin/io/dxf/reporter.h"
#include "burin/io/dxf/tags.h"
#include "burin/io/dxf/units.h"

namespace burin::io {
namespace {

Result<Drawing> read(std::string_view bytes, const ReadOptions& options, Diagnostics& diagnostics) {
  auto tags = dxf::scan_tags(bytes, options.file_name, diagnostics);
  if (!tags) return tags.error();
  const auto document = dxf::build_document(std::move(*tags), options.file_name);
  if (!document) return document.error();
  const auto model = dxf::read_model(*document, options.file_name, diagnostics);
  if (!model) return model.error();
  dxf::Reporter reporter(diagnostics, options.file_name);
  auto units = dxf::choose_units(*model, options.units);
  if (!units.warning.empty())
    reporter.add_for_file(Severity::info, "units_assumed", std::move(units.warning));
  auto drawing = dxf::expand(*model, units.mm_per_unit, options, reporter);
  reporter.finish();
  if (drawing) drawing->units_reason = std::move(units.reason);
  return drawing;
}

Error internal_error(const ReadOptions& options, const std::string& what) {
  Where where;
  where.file = options.file_name;
  return {ErrorCode::internal, "reading the DXF failed: " + what, std::move(where)};
}

}  // namespace

bool dxf_supported() {
  return true;
}

Result<Drawing> read_dxf(std::string_view bytes, const ReadOptions& options, Diagnostics& diagnostics) {
  try {
    return read(bytes, options, diagnostics);
  } catch (const std::exception& exception) {
    return internal_error(options, exception.what());
  } catch (...) {
    return internal_error(options, "an unknown exception");
  }
}

}  // namespace burin::io
