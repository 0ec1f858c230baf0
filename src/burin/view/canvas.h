// SPDX-License-Identifier: Apache-2.0
// What a picture is drawn on: lines, areas, text. One drawing, two outputs (SVG text, PNG pixels). Units are
// points of the picture, x to the right, y down.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::view {

struct Colour {
  std::uint8_t r = 0, g = 0, b = 0;
  double alpha = 1;
};
struct Pen {
  Colour colour;
  double width = 1;
};
enum class Anchor { start, middle, end };
struct TextStyle {
  double size = 13;  ///< of the em; capitals are 0.72 of it
  Colour colour;
  Anchor anchor = Anchor::start;
  bool bold = false;
  bool upwards = false;  ///< turned by a quarter to the left about the anchor
  double halo = 0;       ///< width of a white border
};

class Canvas {
 public:
  virtual ~Canvas() = default;
  /// Borders without blending: neighbours that share an edge leave no seam.
  virtual void box(double x0, double y0, double x1, double y1, const Colour& fill) = 0;
  virtual void polygon(const std::vector<geom::Point2>& corners, const Colour& fill) = 0;
  /// Round ends and joins.
  virtual void line(const std::vector<geom::Point2>& points, const Pen& pen) = 0;
  /// (x, y): on the base line. UTF-8.
  virtual void text(double x, double y, std::string_view text, const TextStyle& style) = 0;

  void circle(geom::Point2 centre, double radius, const Colour& fill);
  void ring(geom::Point2 centre, double radius, const Pen& pen);
};

/// Width of a text in the built-in font; layout counts with it on either canvas.
double text_width(std::string_view text, double size);

class SvgCanvas final : public Canvas {
 public:
  SvgCanvas(double width, double height) : width_(width), height_(height) {}
  void box(double x0, double y0, double x1, double y1, const Colour& fill) override;
  void polygon(const std::vector<geom::Point2>& corners, const Colour& fill) override;
  void line(const std::vector<geom::Point2>& points, const Pen& pen) override;
  void text(double x, double y, std::string_view text, const TextStyle& style) override;
  std::string svg(std::string_view title) const;

 private:
  double width_, height_;
  std::string body_;
};

/// 8 bit RGB, smoothed by coverage. Begins white.
class PixelCanvas final : public Canvas {
 public:
  /// `scale` pixels a point; both sides at most 8192 pixels.
  PixelCanvas(double width, double height, double scale);
  void box(double x0, double y0, double x1, double y1, const Colour& fill) override;
  void polygon(const std::vector<geom::Point2>& corners, const Colour& fill) override;
  void line(const std::vector<geom::Point2>& points, const Pen& pen) override;
  void text(double x, double y, std::string_view text, const TextStyle& style) override;
  std::string png() const;

 private:
  struct Window;
  struct Cover;
  using Strokes = std::vector<std::vector<geom::Point2>>;
  void strokes(const Strokes& strokes, const Pen& pen);
  void blend(int x, int y, const Colour& colour, double cover);
  void blend(Cover& cover, const Colour& colour);

  double scale_;
  int width_, height_;
  std::vector<std::uint8_t> pixels_;
};

/// PNG of 8 bit RGB rows.
std::string encode_png(int width, int height, const std::vector<std::uint8_t>& rgb);

}  // namespace burin::view
