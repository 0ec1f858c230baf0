// SPDX-License-Identifier: Apache-2.0
// Pixels: lines by the distance to their middle, areas by coverage on sub-lines.
#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "burin/view/canvas.h"
#include "burin/view/stroke_font.h"

namespace burin::view {
namespace {

using geom::Point2;

constexpr int kMostPixels = 8192;
constexpr double kRegular = 0.085, kBold = 0.125;  ///< width of a text's strokes, of its size
constexpr int kSubLines = 4;                       ///< an area's coverage counts on so many lines a pixel

int pixels(double points, double scale) {
  return static_cast<int>(std::clamp(std::lround(points * scale), 1L, static_cast<long>(kMostPixels)));
}

double distance_to(Point2 p, Point2 a, Point2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y, l = dx * dx + dy * dy;
  const double t = l > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / l, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

void put32(std::string& out, std::uint32_t v) {
  for (const int shift : {24, 16, 8, 0}) out += static_cast<char>((v >> shift) & 0xffu);
}

void put_chunk(std::string& out, const char* type, const std::string& data) {
  put32(out, static_cast<std::uint32_t>(data.size()));
  const std::string body = type + data;
  out += body;
  put32(out, static_cast<std::uint32_t>(
                 crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()))));
}

}  // namespace

std::string encode_png(int width, int height, const std::vector<std::uint8_t>& rgb) {
  // No filter: areas of one colour pack better as they are.
  const std::size_t stride = 3 * static_cast<std::size_t>(width);
  std::vector<std::uint8_t> rows;
  rows.reserve((stride + 1) * static_cast<std::size_t>(height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    rows.push_back(0);
    const auto row = rgb.begin() + static_cast<std::ptrdiff_t>(y * stride);
    rows.insert(rows.end(), row, row + static_cast<std::ptrdiff_t>(stride));
  }
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size, rows.data(), static_cast<uLong>(rows.size()), 6);
  packed.resize(size);
  std::string header;
  put32(header, static_cast<std::uint32_t>(width));
  put32(header, static_cast<std::uint32_t>(height));
  header += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bit, RGB, no interlace
  std::string out = "\x89PNG\r\n\x1a\n";
  put_chunk(out, "IHDR", header);
  put_chunk(out, "IDAT", packed);
  put_chunk(out, "IEND", {});
  return out;
}

PixelCanvas::PixelCanvas(double width, double height, double scale)
    : scale_(scale),
      width_(pixels(width, scale)),
      height_(pixels(height, scale)),
      pixels_(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 255) {}

std::string PixelCanvas::png() const {
  return encode_png(width_, height_, pixels_);
}

/// A window of the picture in pixels; x1, y1 past the end.
struct PixelCanvas::Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  Window(Point2 lo, Point2 hi, int width, int height) {
    const auto pixel = [](double v, int most) {
      return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most)));
    };
    x0 = pixel(std::floor(lo.x), width), x1 = pixel(std::ceil(hi.x) + 1, width);
    y0 = pixel(std::floor(lo.y), height), y1 = pixel(std::ceil(hi.y) + 1, height);
  }
};

/// A window with a coverage of each pixel.
struct PixelCanvas::Cover : PixelCanvas::Window {
  std::vector<float> values;
  Cover(Point2 lo, Point2 hi, int width, int height) : Window(lo, hi, width, height) {
    if (x0 < x1 && y0 < y1)
      values.assign(static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0), 0);
  }
  float& at(int x, int y) {
    return values[static_cast<std::size_t>(x - x0) +
                  static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(x1 - x0)];
  }
};

void PixelCanvas::blend(Cover& cover, const Colour& colour) {
  for (int y = cover.y0; y < cover.y1; ++y)
    for (int x = cover.x0; x < cover.x1; ++x)
      if (cover.at(x, y) > 0) blend(x, y, colour, cover.at(x, y));
}

void PixelCanvas::blend(int x, int y, const Colour& colour, double cover) {
  const double a = std::clamp(cover, 0.0, 1.0) * colour.alpha;
  std::uint8_t* p = &pixels_[3 * (static_cast<std::size_t>(x) +
                                  static_cast<std::size_t>(y) * static_cast<std::size_t>(width_))];
  const std::uint8_t to[3] = {colour.r, colour.g, colour.b};
  for (int k = 0; k < 3; ++k) p[k] = static_cast<std::uint8_t>(std::lround(p[k] + a * (to[k] - p[k])));
}

void PixelCanvas::box(double x0, double y0, double x1, double y1, const Colour& fill) {
  const auto edge = [&](double v, int most) {
    return static_cast<int>(std::clamp(std::round(v * scale_), 0.0, static_cast<double>(most)));
  };
  for (int y = edge(y0, height_); y < edge(y1, height_); ++y)
    for (int x = edge(x0, width_); x < edge(x1, width_); ++x) blend(x, y, fill, 1);
}

void PixelCanvas::polygon(const std::vector<Point2>& corners, const Colour& fill) {
  if (corners.size() < 3) return;
  Point2 lo{1e300, 1e300}, hi{-1e300, -1e300};
  std::vector<Point2> q;
  for (const Point2 c : corners) {
    q.push_back({c.x * scale_, c.y * scale_});
    lo = {std::min(lo.x, q.back().x), std::min(lo.y, q.back().y)};
    hi = {std::max(hi.x, q.back().x), std::max(hi.y, q.back().y)};
  }
  Cover w(lo, hi, width_, height_);
  for (int line = w.y0 * kSubLines; line < w.y1 * kSubLines; ++line) {
    const double y = (line + 0.5) / kSubLines;
    std::vector<double> xs;
    for (std::size_t i = 0; i < q.size(); ++i) {
      const Point2 a = q[i], b = q[(i + 1) % q.size()];
      if ((a.y <= y) != (b.y <= y)) xs.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::sort(xs.begin(), xs.end());
    for (std::size_t i = 0; i + 1 < xs.size(); i += 2) {
      for (int x = w.x0; x < w.x1; ++x) {
        const double part = std::min(xs[i + 1], x + 1.0) - std::max(xs[i], static_cast<double>(x));
        if (part > 0) w.at(x, line / kSubLines) += static_cast<float>(part / kSubLines);
      }
    }
  }
  blend(w, fill);
}

/// Strokes that cross or touch count once: their coverage is the greatest of theirs.
void PixelCanvas::strokes(const Strokes& strokes, const Pen& pen) {
  const double half = std::max(pen.width * scale_, 0.1) / 2;
  Point2 lo{1e300, 1e300}, hi{-1e300, -1e300};
  for (const auto& s : strokes) {
    for (const Point2 p : s) {
      lo = {std::min(lo.x, p.x * scale_ - half - 1), std::min(lo.y, p.y * scale_ - half - 1)};
      hi = {std::max(hi.x, p.x * scale_ + half + 1), std::max(hi.y, p.y * scale_ + half + 1)};
    }
  }
  if (lo.x > hi.x) return;
  Cover w(lo, hi, width_, height_);
  for (const auto& s : strokes) {
    for (std::size_t i = 0; i < s.size(); ++i) {
      const Point2 a{s[i ? i - 1 : 0].x * scale_, s[i ? i - 1 : 0].y * scale_},
          b{s[i].x * scale_, s[i].y * scale_};
      const Window part({std::min(a.x, b.x) - half - 1, std::min(a.y, b.y) - half - 1},
                        {std::max(a.x, b.x) + half + 1, std::max(a.y, b.y) + half + 1}, width_, height_);
      for (int y = part.y0; y < part.y1; ++y) {
        for (int x = part.x0; x < part.x1; ++x) {
          const double d = distance_to({x + 0.5, y + 0.5}, a, b);
          const double cover = std::min(half + 0.5 - d, 2 * half);  // thin lines are paler, not gone
          if (cover > w.at(x, y)) w.at(x, y) = static_cast<float>(std::min(1.0, cover));
        }
      }
    }
  }
  blend(w, pen.colour);
}

void PixelCanvas::line(const std::vector<Point2>& points, const Pen& pen) {
  strokes({points}, pen);
}

void PixelCanvas::text(double x, double y, std::string_view text, const TextStyle& style) {
  GlyphRun run = lay_text(text);
  const double k = style.size * kCapitalShare / kCapital;
  const double shift = style.anchor == Anchor::start    ? 0
                       : style.anchor == Anchor::middle ? run.width / 2
                                                        : run.width;
  for (auto& s : run.strokes) {
    for (Point2& p : s) {
      const Point2 q{(p.x - shift) * k, -p.y * k};
      p = style.upwards ? Point2{x + q.y, y - q.x} : Point2{x + q.x, y + q.y};
    }
  }
  const double width = style.size * (style.bold ? kBold : kRegular);
  if (style.halo > 0) strokes(run.strokes, {{255, 255, 255, 0.85}, width + 2 * style.halo});
  strokes(run.strokes, {style.colour, width});
}

}  // namespace burin::view
