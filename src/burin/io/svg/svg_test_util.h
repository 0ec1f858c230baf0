// SPDX-License-Identifier: Apache-2.0
// Short ways to read an SVG text in tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "burin/io/svg/read_svg.h"

namespace burin::io::svg_test {

inline Result<Drawing> try_read(const std::string& text, Diagnostics& diagnostics, ReadOptions options = {}) {
  options.file_name = "test.svg";
  return read_svg(text, options, diagnostics);
}

inline Drawing read(const std::string& text, const ReadOptions& options = {}) {
  Diagnostics diagnostics;
  auto drawing = try_read(text, diagnostics, options);
  EXPECT_TRUE(drawing.ok()) << (drawing.ok() ? "" : drawing.error().to_string()) << "\n" << text;
  return drawing.ok() ? *drawing : Drawing{};
}

inline Error error_of(const std::string& text, const ReadOptions& options = {}) {
  Diagnostics diagnostics;
  auto drawing = try_read(text, diagnostics, options);
  EXPECT_FALSE(drawing.ok()) << text;
  return drawing.ok() ? Error{} : drawing.error();
}

/// A page whose user unit is 1 mm and whose y = 0 lies on y = 0 of the drawing: (x, y) is read as (x, -y).
inline std::string page(const std::string& content) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
         "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"100mm\" height=\"100mm\" "
         "viewBox=\"0 -100 100 100\">" +
         content + "</svg>";
}

inline std::string path(const std::string& data, const std::string& more = "") {
  return "<path id=\"p\" d=\"" + data + "\" " + more + "/>";
}

inline void expect_point(geom::Point2 actual, double x, double y, double within = 1e-9) {
  EXPECT_NEAR(actual.x, x, within);
  EXPECT_NEAR(actual.y, y, within);
}

/// The same curves, point by point.
inline void expect_same(const std::vector<Path>& a, const std::vector<Path>& b, double within) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].closed, b[i].closed);
    ASSERT_EQ(a[i].curves.size(), b[i].curves.size());
    for (std::size_t k = 0; k < a[i].curves.size(); ++k) {
      for (const double t : {0.0, 0.2, 0.5, 0.9, 1.0}) {
        const geom::Point2 p = geom::point_at(b[i].curves[k], t);
        expect_point(geom::point_at(a[i].curves[k], t), p.x, p.y, within);
      }
    }
  }
}

}  // namespace burin::io::svg_test
