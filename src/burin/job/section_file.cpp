// SPDX-License-Identifier: Apache-2.0
#include "burin/job/section_file.h"

#include <cmath>
#include <filesystem>
#include <optional>

#include "burin/base/text.h"
#include "burin/io/dxf/read_dxf.h"
#include "burin/io/svg/read_svg.h"
#include "burin/plan/laser/profile.h"

namespace burin::job {
namespace {

Result<io::Drawing> read_drawing(std::string_view bytes, const std::string& file_name,
                                 Diagnostics& diagnostics) {
  io::ReadOptions options;
  options.file_name = file_name;
  const std::string ending = to_lower(std::filesystem::path(file_name).extension().string());
  if (ending == ".dxf") return io::read_dxf(bytes, options, diagnostics);
  if (ending == ".svg") return io::read_svg(bytes, options, diagnostics);
  return Error{ErrorCode::usage, "a section of no known kind (a .dxf or .svg file)", {.file = file_name}};
}

std::string place_text(const Warning& warning) {
  if (!warning.position_mm) return {};
  return " at " + format_fixed((*warning.position_mm)[0], 3) + ", " +
         format_fixed((*warning.position_mm)[1], 3);
}

/// What the contours' own checks found that no section may have. Open pieces beside a good section are none
/// of its business.
std::optional<Error> refused(const Diagnostics& found, bool any_closed, const std::string& file_name) {
  for (const Warning& warning : found.warnings()) {
    Where where = warning.where;
    where.file = file_name;
    if (warning.code == "self_crossing" || warning.code == "contours_cross")
      return Error{
          ErrorCode::geometry,
          "the section crosses itself" + place_text(warning) + " (one closed curve without crossings)",
          where};
    if (warning.code == "open_chain" && !any_closed)
      return Error{
          ErrorCode::geometry,
          "the section is open" + place_text(warning) + ": " + warning.message + " (one closed curve)",
          where};
  }
  return {};
}

}  // namespace

Result<geom::ArcSpline> read_section(std::string_view bytes, const std::string& file_name,
                                     double tolerance_mm, Diagnostics& diagnostics) {
  auto drawing = read_drawing(bytes, file_name, diagnostics);
  if (!drawing) return drawing.error();
  laser::LaserOptions options;
  options.tolerance.path_mm = tolerance_mm;
  Diagnostics found;
  auto contours = laser::join_contours(*drawing, options, found);
  if (!contours) return contours.error();
  bool any_closed = false;
  for (const laser::Contour& contour : *contours) any_closed = any_closed || contour.closed;
  if (auto error = refused(found, any_closed, file_name)) return *error;
  if (!any_closed)
    return Error{
        ErrorCode::geometry, "no closed curve in it (one closed curve, the section)", {.file = file_name}};
  auto profile = laser::make_profile(*contours, *drawing, options, found);
  if (auto error = refused(found, any_closed, file_name)) return *error;
  if (!profile) return profile.error();

  const laser::Outline* section = nullptr;
  std::size_t ignored = 0;
  for (const laser::Outline& outline : profile->outlines) {
    const bool takes_part = outline.spline.closed && outline.role == laser::Role::outer &&
                            outline.depth == 0 && winding_number(outline.spline, {0, 0}) != 0;
    if (takes_part && section == nullptr)
      section = &outline;
    else
      ++ignored;
  }
  if (section == nullptr)
    return Error{
        ErrorCode::geometry,
        "no closed curve goes round the origin, which is the rotary axis (a section with 0, 0 inside)",
        {.file = file_name}};
  if (ignored > 0)
    diagnostics.info("contours_ignored",
                     std::to_string(ignored) + " other contours of the drawing are not part of the section",
                     {.file = file_name});
  geom::ArcSpline spline = section->spline;
  return signed_area(spline) < 0 ? reversed(spline) : spline;
}

}  // namespace burin::job
