// SPDX-License-Identifier: Apache-2.0
#include "burin/view/stroke_font.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "burin/base/text.h"
#include "burin/base/utf8.h"

namespace burin::view {
namespace {

using geom::Point2;
using Strokes = std::vector<std::vector<Point2>>;

/// Path: M x y begins a stroke, L x y a line, Q cx cy x y a parabola, A cx cy rx ry from to an arc in degrees
/// that is joined to what comes before, O the same as a stroke of its own.
struct Glyph {
  char32_t code;
  double width;
  const char* path;
};

constexpr std::array kGlyphs{
    Glyph{U'A', 10.6, "M0 0 L5.3 14 L10.6 0 M1.9 4.8 L8.7 4.8"},
    Glyph{U'B', 9,
          "M5 7.3 L0 7.3 M0 0 L0 14 L4.8 14 A4.8 10.65 3.5 3.35 90 -90 A5.2 3.65 3.8 3.65 90 -90 L0 0"},
    Glyph{U'C', 10.4, "O6 7 6 7.2 48 312"},
    Glyph{U'D', 10.2, "M0 0 L0 14 L3.8 14 A3.8 7 6.4 7 90 -90 L0 0"},
    Glyph{U'E', 7.8, "M7.8 14 L0 14 L0 0 L7.8 0 M0 7.3 L7 7.3"},
    Glyph{U'F', 7.4, "M7.4 14 L0 14 L0 0 M0 7.1 L6.6 7.1"},
    Glyph{U'G', 11, "O6 7 6 7.2 48 320 L10.8 6.6 L6.6 6.6"},
    Glyph{U'H', 9.8, "M0 0 L0 14 M9.8 0 L9.8 14 M0 7.3 L9.8 7.3"},
    Glyph{U'I', 0, "M0 0 L0 14"},
    Glyph{U'J', 5.8, "M5.8 14 L5.8 4 A2.9 4 2.9 4.2 0 -165"},
    Glyph{U'K', 9, "M0 0 L0 14 M8.6 14 L0 5.4 M3.1 8.4 L9 0"},
    Glyph{U'L', 7.2, "M0 14 L0 0 L7.2 0"},
    Glyph{U'M', 12, "M0 0 L0 14 L6 3.4 L12 14 L12 0"},
    Glyph{U'N', 9.8, "M0 0 L0 14 L9.8 0 L9.8 14"},
    Glyph{U'O', 12, "O6 7 6 7.2 0 360"},
    Glyph{U'P', 8.6, "M0 0 L0 14 L4.7 14 A4.7 10.2 3.9 3.8 90 -90 L0 6.4"},
    Glyph{U'Q', 12, "O6 7 6 7.2 0 360 M7.4 3.4 L11.6 -1.2"},
    Glyph{U'R', 9, "M0 0 L0 14 L4.7 14 A4.7 10.3 3.9 3.7 90 -90 L0 6.6 M4.9 6.6 L9 0"},
    Glyph{U'S', 8.7, "O4.3 10.55 3.8 3.65 32 270 A4.3 3.4 4.3 3.55 90 -152"},
    Glyph{U'T', 9.6, "M0 14 L9.6 14 M4.8 14 L4.8 0"},
    Glyph{U'U', 9.8, "M0 14 L0 5 A4.9 5 4.9 5.2 180 360 L9.8 14"},
    Glyph{U'V', 10.2, "M0 14 L5.1 0 L10.2 14"},
    Glyph{U'W', 14.4, "M0 14 L3.6 0 L7.2 13 L10.8 0 L14.4 14"},
    Glyph{U'X', 9.6, "M0 14 L9.6 0 M9.6 14 L0 0"},
    Glyph{U'Y', 9.8, "M0 14 L4.9 6.4 L9.8 14 M4.9 6.4 L4.9 0"},
    Glyph{U'Z', 9, "M0.2 14 L8.8 14 L0 0 L9 0"},
    Glyph{U'a', 7.4,
          "M0.7 8.3 A3.9 6.6 3.5 3.55 150 0 L7.4 0 M7.4 5.9 Q0.1 6.1 0.1 2.8 Q0.1 -0.15 3.1 -0.15 Q6 -0.15 "
          "7.4 2.7"},
    Glyph{U'b', 8, "M0 14 L0 0 M0 5 A4 5 4 5.15 180 -180"},
    Glyph{U'c', 7, "O4 5 4 5.15 48 312"},
    Glyph{U'd', 8, "M8 14 L8 0 M8 5 A4 5 4 5.15 0 360"},
    Glyph{U'e', 8, "M0.1 5.2 L8 5.2 A4 5 4 5.15 3 318"},
    Glyph{U'f', 4.6, "M5 13.8 Q1.9 14.6 1.9 11 L1.9 0 M0 10 L4.6 10"},
    Glyph{U'g', 8, "M8 5 A4 5 4 5.15 0 360 M8 10 L8 0 A4 0 4 4.2 0 -152"},
    Glyph{U'h', 7.4, "M0 14 L0 0 M0 6.2 A3.7 6.3 3.7 3.85 180 0 L7.4 0"},
    Glyph{U'i', 0, "M0 10 L0 0 M0 13.5 L0 13.9"},
    Glyph{U'j', 1.6, "M1.6 10 L1.6 -1.6 Q1.6 -4.3 -0.8 -4.1 M1.6 13.5 L1.6 13.9"},
    Glyph{U'k', 7, "M0 14 L0 0 M6.6 10 L0 3.8 M2.5 6.2 L7 0"},
    Glyph{U'l', 0, "M0 14 L0 0"},
    Glyph{U'm', 12.4,
          "M0 10 L0 0 M0 6.8 A3.1 6.9 3.1 3.25 180 0 L6.2 0 M6.2 6.9 A9.3 6.9 3.1 3.25 180 0 L12.4 0"},
    Glyph{U'n', 7.4, "M0 10 L0 0 M0 6.2 A3.7 6.3 3.7 3.85 180 0 L7.4 0"},
    Glyph{U'o', 8.4, "O4.2 5 4.2 5.15 0 360"},
    Glyph{U'p', 8, "M0 10 L0 -4 M0 5 A4 5 4 5.15 180 -180"},
    Glyph{U'q', 8, "M8 10 L8 -4 M8 5 A4 5 4 5.15 0 360"},
    Glyph{U'r', 4.4, "M0 10 L0 0 M0 5.6 Q0.5 10.4 4.5 9.9"},
    Glyph{U's', 6.6, "O3.3 7.5 2.9 2.65 30 270 A3.3 2.4 3.3 2.5 90 -150"},
    Glyph{U't', 4.8, "M1.9 13 L1.9 2.8 Q1.9 -0.5 4.9 0.1 M0 10 L4.7 10"},
    Glyph{U'u', 7.4, "M0 10 L0 3.7 A3.7 3.7 3.7 3.85 180 360 M7.4 10 L7.4 0"},
    Glyph{U'v', 7.8, "M0 10 L3.9 0 L7.8 10"},
    Glyph{U'w', 11.6, "M0 10 L2.9 0 L5.8 9.4 L8.7 0 L11.6 10"},
    Glyph{U'x', 7.2, "M0 10 L7.2 0 M7.2 10 L0 0"},
    Glyph{U'y', 7.8, "M0 10 L3.9 0.2 M7.8 10 L3.3 -2 Q2.5 -4.2 0.3 -4.1"},
    Glyph{U'z', 7, "M0.2 10 L6.8 10 L0 0 L7 0"},
    Glyph{U'0', 8.6, "O4.3 7 4.2 7.2 0 360"},
    Glyph{U'1', 8.6, "M1.4 11.2 L5.2 14.1 L5.2 0"},
    Glyph{U'2', 8.6, "O4.2 10.2 3.9 4 165 -32 L0.3 0 L8.5 0"},
    Glyph{U'3', 8.6, "O4 10.6 3.6 3.6 150 -90 L3 7 M4 7 A4 3.4 4.2 3.6 90 -152"},
    Glyph{U'4', 8.6, "M6.4 0 L6.4 14 L0 4.2 L8.6 4.2"},
    Glyph{U'5', 8.6, "M7.6 14 L1.4 14 L0.9 7.6 Q2.2 9.1 4.2 9.1 A4.2 4.5 4.2 4.6 90 -150"},
    Glyph{U'6', 8.6, "M7 13.9 Q0.1 12.4 0.1 4.6 A4.3 4.4 4.2 4.5 180 540"},
    Glyph{U'7', 8.6, "M0.2 14 L8.4 14 L3.2 0"},
    Glyph{U'8', 8.6, "O4.3 10.6 3.5 3.5 0 360 O4.3 3.5 4.2 3.6 0 360"},
    Glyph{U'9', 8.6, "M1.6 0.1 Q8.5 1.6 8.5 9.4 A4.3 9.6 4.2 4.5 0 360"},
    Glyph{U' ', 2.2, ""},
    Glyph{U'.', 0.4, "M0.2 0 L0.2 0.3"},
    Glyph{U',', 0.6, "M0.5 0.3 L-0.4 -2.6"},
    Glyph{U':', 0.4, "M0.2 0.4 L0.2 0.7 M0.2 7.6 L0.2 7.9"},
    Glyph{U';', 0.6, "M0.5 0.3 L-0.4 -2.6 M0.3 7.6 L0.3 7.9"},
    Glyph{U'!', 0.4, "M0.2 14 L0.2 4.2 M0.2 0 L0.2 0.3"},
    Glyph{U'?', 7.4, "O3.7 10.4 3.6 3.7 165 -60 Q3.6 6 3.6 3.8 M3.6 0 L3.6 0.3"},
    Glyph{U'\'', 0, "M0 14 L0 10"},
    Glyph{U'"', 3.4, "M0 14 L0 10 M3.4 14 L3.4 10"},
    Glyph{U'(', 3.2, "M3.4 15.4 Q0 11.6 0 6 Q0 0.4 3.4 -3.4"},
    Glyph{U')', 3.2, "M-0.2 15.4 Q3.2 11.6 3.2 6 Q3.2 0.4 -0.2 -3.4"},
    Glyph{U'[', 3, "M3 15 L0 15 L0 -3 L3 -3"},
    Glyph{U']', 3, "M0 15 L3 15 L3 -3 L0 -3"},
    Glyph{U'{', 4, "M4 15 Q2 15 2 12 L2 9 Q2 6 0 6 Q2 6 2 3 L2 0 Q2 -3 4 -3"},
    Glyph{U'}', 4, "M0 15 Q2 15 2 12 L2 9 Q2 6 4 6 Q2 6 2 3 L2 0 Q2 -3 0 -3"},
    Glyph{U'-', 5, "M0.2 5.2 L4.8 5.2"},
    Glyph{U'\u2013', 8, "M0 5.2 L8 5.2"},
    Glyph{U'\u2212', 8.6, "M0.4 6 L8.2 6"},
    Glyph{U'+', 8.6, "M0.4 6 L8.2 6 M4.3 9.9 L4.3 2.1"},
    Glyph{U'=', 8.6, "M0.4 8 L8.2 8 M0.4 4 L8.2 4"},
    Glyph{U'<', 8.6, "M8 10.2 L0.6 6 L8 1.8"},
    Glyph{U'>', 8.6, "M0.6 10.2 L8 6 L0.6 1.8"},
    Glyph{U'\u2264', 8.6, "M8 12 L0.6 8 L8 4 M0.6 1 L8 1"},
    Glyph{U'\u2265', 8.6, "M0.6 12 L8 8 L0.6 4 M0.6 1 L8 1"},
    Glyph{U'/', 5.2, "M0 -2 L5.2 15"},
    Glyph{U'\\', 5.2, "M0 15 L5.2 -2"},
    Glyph{U'|', 0, "M0 15.4 L0 -3.4"},
    Glyph{U'_', 8, "M0 -2.6 L8 -2.6"},
    Glyph{U'*', 6, "M3 14 L3 8 M0.4 12.5 L5.6 9.5 M0.4 9.5 L5.6 12.5"},
    Glyph{U'#', 9.6, "M3.4 14 L1.4 0 M8.2 14 L6.2 0 M0.6 9.6 L9.6 9.6 M0 4.4 L9 4.4"},
    Glyph{U'%', 12.6, "O2.6 10.9 2.6 3.2 0 360 O10 3.1 2.6 3.2 0 360 M10.6 14 L2 0"},
    Glyph{U'&', 10.6,
          "M10.4 0 L2.6 9 Q1.2 11 2.4 12.8 Q4 14.8 6 13.4 Q8 11.4 5.6 9 L2.4 6.8 Q-0.8 4 0.6 1.4 Q2.4 -0.8 "
          "5.4 0 Q9 1.2 9.8 6.6"},
    Glyph{U'@', 13,
          "O6.6 5 3.1 3.6 0 360 M9.8 8.8 L9.5 3.6 Q10 1.2 11.6 2 Q13.4 3.2 13.2 6.2 A6.6 5.6 6.6 7.4 5 310"},
    Glyph{U'$', 8.7, "O4.3 10.2 3.7 3.1 32 270 A4.3 3.7 4.2 3.4 90 -152 M4.3 15.4 L4.3 -1.6"},
    Glyph{U'^', 7, "M0 9.4 L3.5 14 L7 9.4"},
    Glyph{U'`', 2, "M0 14 L2 11.6"},
    Glyph{U'~', 8.6, "M0.4 5 Q2.4 8.4 4.3 6 Q6.2 3.6 8.2 7"},
    Glyph{U'\u00b0', 4.6, "O2.3 11.8 2.2 2.3 0 360"},
    Glyph{U'\u00b7', 0.4, "M0.2 5.6 L0.2 5.9"},
    Glyph{U'\u00d7', 7, "M0.4 9 L6.6 2.8 M6.6 9 L0.4 2.8"},
    Glyph{U'\u00b2', 5.2, "O2.6 12.2 2.3 2.2 165 -32 L0.2 6.6 L5.1 6.6"},
    Glyph{U'\u00b5', 7.4, "M0 10 L0 -4 M0 3.7 A3.7 3.7 3.7 3.85 180 360 M7.4 10 L7.4 0"},
    Glyph{U'\u00df', 8, "M0 0 L0 10.6 A3.6 10.6 3.6 3.5 180 -60 L3.8 7.4 A4 3.7 3.9 3.8 80 -120"},
    Glyph{U'\u03b1', 8.8, "M8.8 10 Q6.8 -0.2 3.6 -0.2 Q0 -0.2 0 5 Q0 10.2 3.6 10.2 Q6.6 10.2 9.2 0"},
    Glyph{U'\u03b2', 8, "M0 -4 L0 10.6 A3.6 10.6 3.6 3.5 180 -70 L3 7.4 M4.4 7.3 A4 3.6 4 3.75 85 -180"},
    Glyph{U'\u03c1', 8, "M0 -4 L0 5 A4 5 4 5.15 180 -180"},
};

/// Letters that are another with two dots above.
constexpr std::array<std::array<char32_t, 2>, 6> kDotted{{{U'\u00e4', U'a'},
                                                          {U'\u00f6', U'o'},
                                                          {U'\u00fc', U'u'},
                                                          {U'\u00c4', U'A'},
                                                          {U'\u00d6', U'O'},
                                                          {U'\u00dc', U'U'}}};
constexpr Glyph kMissing{0, 7, "M0 0 L7 0 L7 14 L0 14 L0 0"};
constexpr double kGap = 3.3;  ///< between letters
constexpr int kArcSteps = 48;

const Glyph& glyph_of(char32_t code) {
  const auto found =
      std::find_if(kGlyphs.begin(), kGlyphs.end(), [&](const Glyph& g) { return g.code == code; });
  return found == kGlyphs.end() ? kMissing : *found;
}

/// The numbers behind a command letter.
std::vector<double> numbers(std::string_view path, std::size_t& at) {
  std::vector<double> out;
  while (at < path.size() && (path[at] < 'A' || path[at] > 'Z')) {
    if (path[at] == ' ') {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < path.size() && path[end] != ' ') ++end;
    out.push_back(parse_double(path.substr(at, end - at)).value_or(0));
    at = end;
  }
  return out;
}

void add_arc(std::vector<Point2>& stroke, const std::vector<double>& a) {
  const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(a[5] - a[4]) / 360 * kArcSteps)));
  for (int i = 0; i <= steps; ++i) {
    const double t = (a[4] + (a[5] - a[4]) * i / steps) * geom::kPi / 180;
    stroke.push_back({a[0] + a[2] * std::cos(t), a[1] + a[3] * std::sin(t)});
  }
}

void add_parabola(std::vector<Point2>& stroke, const std::vector<double>& q) {
  const Point2 from = stroke.back();
  constexpr int kSteps = 12;
  for (int i = 1; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps, s = 1 - t;
    stroke.push_back(
        {s * s * from.x + 2 * s * t * q[0] + t * t * q[2], s * s * from.y + 2 * s * t * q[1] + t * t * q[3]});
  }
}

Strokes strokes_of(const Glyph& glyph) {
  Strokes out;
  const std::string_view path = glyph.path;
  for (std::size_t at = 0; at < path.size();) {
    const char command = path[at++];
    const std::vector<double> v = numbers(path, at);
    if (command == 'M' || command == 'O') out.emplace_back();
    if (out.empty()) continue;
    if (command == 'M' || command == 'L') out.back().push_back({v[0], v[1]});
    if (command == 'A' || command == 'O') add_arc(out.back(), v);
    if (command == 'Q') add_parabola(out.back(), v);
  }
  return out;
}

void place(GlyphRun& run, const Strokes& strokes) {
  for (std::vector<Point2> s : strokes) {
    for (Point2& p : s) p.x += run.width;
    run.strokes.push_back(std::move(s));
  }
}

}  // namespace

std::vector<char32_t> code_points(std::string_view text) {
  std::vector<char32_t> out;
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i++]);
    int more = c < 0x80 ? 0 : (c >> 5) == 6 ? 1 : (c >> 4) == 14 ? 2 : (c >> 3) == 30 ? 3 : -1;
    char32_t code = more == 0 ? c : more > 0 ? c & (0x3fu >> more) : kReplacementCharacter;
    for (; more > 0; --more) {
      const bool follows = i < text.size() && (static_cast<unsigned char>(text[i]) >> 6) == 2;
      if (!follows) {
        code = kReplacementCharacter;
        break;
      }
      code = (code << 6) | (static_cast<unsigned char>(text[i++]) & 0x3fu);
    }
    out.push_back(code);
  }
  return out;
}

GlyphRun lay_text(std::string_view utf8) {
  GlyphRun run;
  for (const char32_t code : code_points(utf8)) {
    if (!run.strokes.empty() || run.width > 0) run.width += kGap;
    const auto dotted =
        std::find_if(kDotted.begin(), kDotted.end(), [&](const auto& d) { return d[0] == code; });
    const Glyph& glyph = glyph_of(dotted == kDotted.end() ? code : (*dotted)[1]);
    place(run, strokes_of(glyph));
    if (dotted != kDotted.end()) {
      const double up = code < 0xe0 ? 17 : 13.4, mid = glyph.width / 2;
      place(run, {{{mid - 2.2, up}, {mid - 2.2, up + 0.3}}, {{mid + 2.2, up}, {mid + 2.2, up + 0.3}}});
    }
    run.width += glyph.width;
  }
  return run;
}

}  // namespace burin::view
