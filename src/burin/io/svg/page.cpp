// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/page.h"

#include <cmath>
#include <optional>

#include "burin/base/text.h"
#include "burin/io/svg/scanner.h"

namespace burin::io::svg {

using geom::Affine2;

namespace {

constexpr double kMmPerInch = 25.4;

struct Resolution {
  double px_per_inch;
  std::string reason;
};

/// Inkscape drew at 90 px an inch until 0.92 (January 2017). True when the version text names an older one.
bool before_inkscape_092(std::string_view version) {
  Scanner scan(version);
  int part[2] = {0, 0};
  for (int& value : part) {
    if (!is_digit(scan.peek())) return false;
    while (is_digit(scan.peek()) && value < 10000) {
      value = value * 10 + (scan.peek() - '0');
      scan.skip();
    }
    if (scan.peek() == '.') scan.skip();
  }
  return part[0] == 0 && part[1] < 92;
}

Resolution resolution_of(const Document& document) {
  if (document.made_by_illustrator) return {72, "72 dpi (Illustrator)"};
  const Element& root = document.elements[0];
  const std::string_view inkscape = root.get("version", Namespace::inkscape);
  if (before_inkscape_092(inkscape)) {
    return {90, "90 dpi (Inkscape " + std::string(inkscape.substr(0, inkscape.find(' '))) + ")"};
  }
  if (inkscape.empty() && root.has("version", Namespace::sodipodi)) return {90, "90 dpi (Sodipodi)"};
  return {96, "96 dpi"};
}

/// width or height; nothing when it is absent, "auto" or a percentage (of a window that does not exist here).
Result<std::optional<Length>> size_of(const Element& root, std::string_view name, const std::string& file) {
  const std::string_view text = trim(root.get(name));
  if (text.empty() || text == "auto") return std::optional<Length>();
  const auto length = parse_length(text);
  const Where where{file, root.line, 0, root.label()};
  const std::string shown = std::string(name) + "=\"" + std::string(text.substr(0, 40)) + "\"";
  if (!length) return Error{ErrorCode::syntax, shown + " (a length such as 100mm or 400 is accepted)", where};
  if (!(length->value > 0)) return Error{ErrorCode::range, shown + " (a size above 0 is accepted)", where};
  if (length->unit == Unit::percent) return std::optional<Length>();
  return std::optional(*length);
}

struct RootSize {
  std::optional<Length> width, height;
  std::optional<ViewBox> box;
};

Result<RootSize> root_size(const Element& root, const std::string& file) {
  RootSize size;
  auto width = size_of(root, "width", file);
  if (!width) return width.error();
  auto height = size_of(root, "height", file);
  if (!height) return height.error();
  size.width = *width;
  size.height = *height;
  const std::string_view text = trim(root.get("viewBox"));
  if (text.empty() || text == "none") return size;
  size.box = parse_view_box(text);
  if (!size.box) {
    return Error{ErrorCode::syntax,
                 "viewBox=\"" + std::string(text.substr(0, 60)) +
                     "\" (four numbers, width and height above 0, are accepted)",
                 {file, root.line, 0, root.label()}};
  }
  return size;
}

Affine2 flipped(const Affine2& map, double height_mm) {
  return Affine2{1, 0, 0, -1, 0, height_mm} * map;
}

/// --units: the user unit is given, whatever width and viewBox say.
Page page_by_option(const RootSize& size, Units units) {
  const double scale = units == Units::inch ? kMmPerInch : 1.0;
  Page page;
  page.mm_per_unit = scale;
  page.px_per_inch = kMmPerInch / scale;
  page.reason = units == Units::inch ? "--units inch" : "--units mm";
  if (size.box) {
    page.to_mm =
        flipped({scale, 0, 0, scale, -scale * size.box->x, -scale * size.box->y}, scale * size.box->height);
    page.viewport = {size.box->width, size.box->height, true};
    return page;
  }
  const double height = size.height ? length_mm(*size.height, page.px_per_inch) : 0;
  page.to_mm = flipped({scale, 0, 0, scale, 0, 0}, height);
  if (size.width && size.height) {
    page.viewport = {length_mm(*size.width, page.px_per_inch) / scale, height / scale, true};
  }
  return page;
}

Page page_without_box(const RootSize& size, const Resolution& resolution) {
  Page page;
  const double scale = kMmPerInch / resolution.px_per_inch;
  page.px_per_inch = resolution.px_per_inch;
  page.mm_per_unit = scale;
  page.reason = resolution.reason;
  const double height = size.height ? length_mm(*size.height, resolution.px_per_inch) : 0;
  page.to_mm = flipped({scale, 0, 0, scale, 0, 0}, height);
  if (size.width && size.height) {
    page.viewport = {length_mm(*size.width, resolution.px_per_inch) / scale, height / scale, true};
  }
  return page;
}

std::string box_reason(const Element& root, const RootSize& size, const Resolution& resolution) {
  const auto over = [&](std::string_view name, double box) {
    return std::string(name) + " " + std::string(trim(root.get(name))) + " over viewBox " +
           format_shortest(box);
  };
  if (size.width && size.width->physical()) return over("width", size.box->width);
  if (size.height && size.height->physical() && !size.width) return over("height", size.box->height);
  if (size.width && size.width->value != size.box->width)
    return resolution.reason + ", " + over("width", size.box->width);
  if (!size.width && size.height && size.height->value != size.box->height) {
    return resolution.reason + ", " + over("height", size.box->height);
  }
  return resolution.reason;
}

Page page_with_box(const Element& root, const RootSize& size, const Resolution& resolution) {
  const ViewBox& box = *size.box;
  const double px = kMmPerInch / resolution.px_per_inch;
  double width = size.width ? length_mm(*size.width, resolution.px_per_inch) : box.width * px;
  double height = size.height ? length_mm(*size.height, resolution.px_per_inch) : box.height * px;
  // One size alone: the other follows from the proportions of the viewBox.
  if (size.width && !size.height) height = width * box.height / box.width;
  if (size.height && !size.width) width = height * box.width / box.height;
  Page page;
  page.px_per_inch = resolution.px_per_inch;
  page.viewport = {box.width, box.height, true};
  const AspectRatio ratio = parse_aspect_ratio(root.get("preserveAspectRatio"));
  const Affine2 map = view_box_map(box, 0, 0, width, height, ratio);
  page.to_mm = flipped(map, height);
  page.mm_per_unit = map.a == map.d ? map.a : std::sqrt(map.a * map.d);
  page.reason = box_reason(root, size, resolution);
  return page;
}

}  // namespace

Result<Page> page_of(const Document& document, const ReadOptions& options) {
  const Element& root = document.elements[0];
  const auto size = root_size(root, options.file_name);
  if (!size) return size.error();
  if (options.units != Units::from_file) return page_by_option(*size, options.units);
  const Resolution resolution = resolution_of(document);
  return size->box ? page_with_box(root, *size, resolution) : page_without_box(*size, resolution);
}

}  // namespace burin::io::svg
