// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/read_svg.h"

#include <exception>
#include <new>

#include "burin/io/svg/document.h"
#include "burin/io/svg/page.h"
#include "burin/io/svg/walker.h"

namespace burin::io {
namespace {

Result<Drawing> read(std::string_view bytes, const ReadOptions& options, Diagnostics& diagnostics) {
  auto document = svg::parse_document(bytes, options, diagnostics);
  if (!document) return document.error();
  auto page = svg::page_of(*document, options);
  if (!page) return page.error();
  return svg::Walker(*document, *page, options, diagnostics).run();
}

}  // namespace

Result<Drawing> read_svg(std::string_view bytes, const ReadOptions& options, Diagnostics& diagnostics) {
  try {
    return read(bytes, options, diagnostics);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::range, "the drawing is too large for the memory", {options.file_name, 0, 0, {}}};
  } catch (const std::exception& e) {
    return Error{
        ErrorCode::internal, std::string("reading the SVG: ") + e.what(), {options.file_name, 0, 0, {}}};
  }
}

}  // namespace burin::io
