// SPDX-License-Identifier: Apache-2.0
#include "burin/job/verify_laser.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <utility>

#include "burin/base/text.h"
#include "burin/geom/curve/fit.h"
#include "burin/io/dxf/read_dxf.h"
#include "burin/io/svg/read_svg.h"
#include "burin/job/program_file.h"
#include "burin/plan/laser/contours.h"
#include "burin/verify/flat.h"

namespace burin::job {
namespace {

using geom::Point2;
using geom::Segment;
using laser::Contour;
using laser::Treatment;
namespace flat = verify::flat;

/// Looks at an arc spline from its curve: so many a segment.
constexpr int kLooks = 3;
/// What a look may find beyond the bound of the fit: rounding, at coordinates up to 1e5 mm.
constexpr double kLookSlack_mm = 1e-9;
/// A contour's level is that of most of so many of its places: where contours touch, a place says nothing.
constexpr std::size_t kVotes = 9;

std::string extension_of(std::string_view file) {
  return to_lower(std::filesystem::path(std::string(file)).extension().string());
}

/// Curves as arcs, and whether they are: each is looked at from places of its curve, by distances alone.
class Outliner {
 public:
  Outliner(const io::Drawing& drawing, const LaserOutlineOptions& options)
      : drawing_(drawing), options_(options) {}

  Result<std::vector<Segment>> run(const Contour& contour) {
    std::vector<Segment> out;
    for (std::size_t i = 0; i < contour.curves.size(); ++i) {
      const Point2 from = contour.joints[i];
      const Point2 to = i + 1 < contour.joints.size() ? contour.joints[i + 1] : contour.joints.front();
      auto run = arcs_of(contour.curves[i]);
      if (!run) {
        Error error = run.error();
        if (contour.entity[i] < drawing_.entities.size())
          error.where.entity = drawing_.entities[contour.entity[i]].name();
        return error;
      }
      move_end(run->front(), from, run->front().b);
      move_end(run->back(), run->back().a, to);
      out.insert(out.end(), run->begin(), run->end());
    }
    std::erase_if(out, [](const Segment& s) { return s.a == s.b; });
    return out;
  }
  double bound_mm() const { return bound_mm_; }

 private:
  Result<std::vector<Segment>> arcs_of(const geom::Curve2& curve) {
    geom::FitOptions fit;
    fit.tolerance_mm = options_.curve_mm;
    auto fitted = geom::fit_arc_spline(curve, fit);
    if (!fitted) return fitted.error();
    bound_mm_ = std::max(bound_mm_, fitted->max_deviation_mm);
    std::vector<Segment> quarters;
    for (const Segment& s : fitted->segments) flat::quarters(s, quarters);
    if (fitted->max_deviation_mm > 0) {
      const flat::Tree tree(quarters);
      const std::size_t looks = kLooks * quarters.size() + kLooks;
      for (std::size_t k = 0; k <= looks; ++k) {
        const Point2 p = point_at(curve, double(k) / double(looks));
        if (!(tree.nearest(p).distance <= fitted->max_deviation_mm + kLookSlack_mm))
          return Error{ErrorCode::internal, "an outline leaves its curve by more than it says", {}};
      }
    }
    return quarters;
  }

  /// Onto the joint with its neighbour; an arc keeps its sweep.
  void move_end(Segment& s, Point2 a, Point2 b) {
    const double gap = std::max(distance(s.a, a), distance(s.b, b));
    if (gap == 0) return;
    bound_mm_ = std::max(bound_mm_, gap);
    s = geom::from_bulge(a, b, geom::bulge_of(s), s.source);
  }

  const io::Drawing& drawing_;
  const LaserOutlineOptions& options_;
  double bound_mm_ = 0;
};

/// Turns closed outlines so that the part is on their left: by how many others contain them.
void orient(std::vector<verify::Outline>& outlines, laser::Side side) {
  std::vector<Segment> all;
  std::vector<std::uint32_t> first(outlines.size(), 0), end(outlines.size(), 0);
  const auto turn = [](verify::Outline& o) {
    o.segments = reversed(geom::ArcSpline{o.segments, true}).segments;
  };
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    verify::Outline& o = outlines[i];
    if (!o.closed) continue;
    const bool left = signed_area(geom::ArcSpline{o.segments, true}) > 0;
    if (left == (side == laser::Side::inside)) turn(o);
    first[i] = static_cast<std::uint32_t>(all.size());
    for (const Segment& s : o.segments) flat::quarters(s, all);
    end[i] = static_cast<std::uint32_t>(all.size());
  }
  if (side != laser::Side::automatic) return;
  const flat::Tree tree(std::move(all));
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    if (first[i] == end[i]) continue;
    const std::size_t n = end[i] - first[i], step = std::max<std::size_t>(1, n / kVotes);
    std::size_t votes = 0, odd = 0;
    for (std::size_t k = 0; k < n && votes < kVotes; k += step, ++votes) {
      const Segment& s = tree.segments()[first[i] + k];
      odd += std::abs(tree.winding(point_on(s, 0.5), first[i], end[i])) % 2 == 1;
    }
    if (2 * odd > votes) turn(outlines[i]);
  }
}

Result<LaserOutlines> outlines_of(const io::Drawing& drawing, const LaserOutlineOptions& options,
                                  Diagnostics& diagnostics) {
  laser::LaserOptions joining;
  joining.layers = options.layers;
  joining.tolerance.join_mm = options.join_mm;
  auto contours = laser::join_contours(drawing, joining, diagnostics);
  if (!contours) return contours.error();
  LaserOutlines out;
  Outliner outliner(drawing, options);
  for (const Contour& contour : *contours) {
    if (contour.treatment == Treatment::ignore || contour.curves.empty()) continue;
    auto segments = outliner.run(contour);
    if (!segments) return segments.error();
    if (segments->empty()) continue;
    const bool closed =
        contour.closed && contour.treatment == Treatment::cut && options.side != laser::Side::on;
    if (closed && segments->size() < 2) continue;  // there and back along one line
    out.outlines.push_back({std::move(*segments), closed});
    out.names.push_back(drawing.entities[contour.entity.front()].name());
  }
  if (out.outlines.empty()) {
    return Error{ErrorCode::geometry,
                 "nothing to check: the drawing holds no contour (lines, arcs, splines on visible layers)",
                 {}};
  }
  orient(out.outlines, options.side);
  out.bound_mm = outliner.bound_mm();
  return out;
}

}  // namespace

bool is_drawing(std::string_view file) {
  const std::string extension = extension_of(file);
  return extension == ".dxf" || extension == ".svg";
}

Result<io::Drawing> read_drawing(std::string_view bytes, const std::string& file, io::Units units,
                                 Diagnostics& diagnostics) {
  io::ReadOptions options;
  options.file_name = file;
  options.units = units;
  const std::string extension = extension_of(file);
  if (extension == ".dxf") return io::read_dxf(bytes, options, diagnostics);
  if (extension == ".svg") return io::read_svg(bytes, options, diagnostics);
  return Error{ErrorCode::usage, "is of no known kind (a drawing named .dxf or .svg)", {.file = file}};
}

Result<LaserOutlines> make_laser_outlines(const io::Drawing& drawing, const LaserOutlineOptions& options,
                                          Diagnostics& diagnostics) {
  if (!(options.curve_mm > 0) || !(options.join_mm >= 0))
    return Error{
        ErrorCode::usage, "impossible lengths for the outlines (join 0 or more, curves above 0 mm)", {}};
  try {
    return outlines_of(drawing, options, diagnostics);
  } catch (const std::exception& e) {  // memory
    return Error{ErrorCode::range, std::string("the outlines do not fit into memory: ") + e.what(), {}};
  }
}

Result<LaserOutlines> read_laser_outlines(std::string_view bytes, const std::string& file,
                                          const LaserOutlineOptions& options, Diagnostics& diagnostics) {
  auto drawing = read_drawing(bytes, file, options.units, diagnostics);
  if (!drawing) return drawing.error();
  auto outlines = make_laser_outlines(*drawing, options, diagnostics);
  diagnostics.locate(file);
  if (outlines) return outlines;
  Error error = outlines.error();
  if (error.where.file.empty()) error.where.file = file;
  return error;
}

Result<cl::Program> read_laser_program(std::string_view bytes, const std::string& file,
                                       Diagnostics& diagnostics) {
  auto read = read_program(bytes, file, nullptr, diagnostics, true);
  if (!read) return read.error();
  return std::move(read->program);
}

}  // namespace burin::job
