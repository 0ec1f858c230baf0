// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "burin/base/embedded.h"
#include "burin/base/text.h"
#include "burin/view/encode.h"
#include "burin/view/picture.h"

namespace burin::embedded {
std::vector<File> pages();
}

namespace burin::view {
namespace {

using geom::Point2;
using geom::Segment;
using laser::MoveKind;

constexpr int kDecimals = 5;
std::string num(double v) {
  return format_fixed(v, kDecimals);
}

/// A move of the program in the plane, with what the pictures need to know of it.
struct PlaneMove {
  Segment segment;
  MoveKind kind = MoveKind::cut;
  std::size_t record = 0;
  bool beam = false;
  std::uint32_t path = cl::Program::kNoSource;
};

std::vector<PlaneMove> plane_moves(const laser::Toolpath& toolpath) {
  std::vector<PlaneMove> moves;
  Point2 here;
  bool known = false, beam = false;
  const auto& records = toolpath.program.records;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (const auto* b = std::get_if<cl::Beam>(&records[i])) beam = b->on;
    const cl::Pose* pose = cl::pose_of(records[i]);
    if (!pose) continue;
    const Point2 to = geom::xy(pose->tip);
    if (!known && std::holds_alternative<cl::Rapid>(records[i]))
      here = to;  // the way to the first point is not ours
    PlaneMove move;
    if (const auto* arc = std::get_if<cl::Arc>(&records[i])) {
      move.segment = {here, to, geom::xy(arc->center), arc->normal.z < 0 ? -arc->radius : arc->radius, 0};
    } else {
      move.segment = geom::make_line(here, to);
    }
    move.kind = i < toolpath.kind.size() ? toolpath.kind[i] : MoveKind::cut;
    if (std::holds_alternative<cl::Rapid>(records[i])) move.kind = MoveKind::rapid;
    move.record = i;
    move.beam = beam && move.kind != MoveKind::rapid;
    move.path = i < toolpath.program.source.size() ? toolpath.program.source[i] : cl::Program::kNoSource;
    moves.push_back(move);
    here = to;
    known = true;
  }
  return moves;
}

geom::Box2 whole_box(const LaserPicture& picture, const std::vector<PlaneMove>& moves) {
  geom::Box2 box;
  for (const laser::Outline& o : picture.profile->outlines) box.add(bounds_of(o.spline));
  for (const PlaneMove& m : moves) box.add(bounds_of(m.segment));
  if (box.empty()) box.add(Point2{});
  return box.grown(0.5 * picture.kerf_mm);
}

// --- SVG
// ------------------------------------------------------------------------------------------------------

std::string arc_command(const Segment& s) {
  if (s.is_line()) return "L" + num(s.b.x) + " " + num(s.b.y);
  const double sweep = sweep_of(s);
  const std::string r = num(std::abs(s.radius));
  // The y axis is turned up by a transform of the group, so positive sweeps stay positive.
  const auto to = [&](Point2 p, bool large) {
    return "A" + r + " " + r + " 0 " + (large ? "1" : "0") + " " + (sweep > 0 ? "1" : "0") + " " + num(p.x) +
           " " + num(p.y);
  };
  // Nearly full turns are ambiguous in SVG: go through the middle.
  if (std::abs(sweep) > 1.5 * geom::kPi) return to(point_on(s, 0.5), false) + to(s.b, false);
  return to(s.b, std::abs(sweep) > geom::kPi);
}

std::string path_data(const geom::ArcSpline& spline) {
  std::string d;
  if (spline.segments.empty()) return d;
  d = "M" + num(spline.segments.front().a.x) + " " + num(spline.segments.front().a.y);
  for (const Segment& s : spline.segments) d += arc_command(s);
  return spline.closed ? d + "Z" : d;
}

template <class Wanted>
std::string moves_data(const std::vector<PlaneMove>& moves, const Wanted& wanted) {
  std::string d;
  bool pen = false;
  for (const PlaneMove& m : moves) {
    if (!wanted(m)) {
      pen = false;
      continue;
    }
    if (!pen) d += "M" + num(m.segment.a.x) + " " + num(m.segment.a.y);
    d += arc_command(m.segment);
    pen = true;
  }
  return d;
}

std::string svg_path(const std::string& id, const std::string& d, const std::string& style) {
  return d.empty() ? "" : "  <path id=\"" + id + "\" d=\"" + d + "\" style=\"" + style + "\"/>\n";
}

// --- HTML
// -----------------------------------------------------------------------------------------------------

int type_of(const Segment& s) {
  return s.is_line() ? 0 : s.radius > 0 ? 1 : 2;
}

/// "type,x0,y0,x1,y1,cx,cy": what the page draws a segment from.
std::string segment_numbers(const Segment& s) {
  std::string t = std::to_string(type_of(s));
  for (const double v : {s.a.x, s.a.y, s.b.x, s.b.y}) t += "," + num(v);
  return t + "," + (s.is_line() ? "0,0" : num(s.center.x) + "," + num(s.center.y));
}

std::string outlines_json(const laser::Profile& profile) {
  std::string t = "[";
  for (const laser::Outline& o : profile.outlines) {
    t += t.size() > 1 ? ",[" : "[";
    for (std::size_t i = 0; i < o.spline.segments.size(); ++i) {
      t += (i ? ",[" : "[") + segment_numbers(o.spline.segments[i]) + "]";
    }
    t += "]";
  }
  return t + "]";
}

/// Segments of the beam paths with what they are (0 drawn, 1 fitted, 2 corner) and the bound of their fit.
std::string paths_json(const laser::Profile& profile) {
  std::string t = "[";
  for (const laser::CutPath& p : profile.paths) {
    t += t.size() > 1 ? ",[" : "[";
    for (std::size_t i = 0; i < p.spline.segments.size(); ++i) {
      const Segment& s = p.spline.segments[i];
      const bool corner = s.source == geom::kCornerSource || s.source >= profile.pieces.size();
      const laser::Piece piece = corner ? laser::Piece{} : profile.pieces[s.source];
      t += (i ? ",[" : "[") + segment_numbers(s) + "," +
           (corner         ? "2"
            : piece.fitted ? "1"
                           : "0") +
           "," + format_fixed(piece.deviation_mm, 7) + "]";
    }
    t += "]";
  }
  return t + "]";
}

std::string moves_json(const std::vector<PlaneMove>& moves, const laser::Profile& profile) {
  std::string t = "[";
  for (const PlaneMove& m : moves) {
    const std::size_t path = m.path < profile.paths.size() ? m.path : 0;
    t += (t.size() > 1 ? ",[" : "[") + segment_numbers(m.segment) + "," +
         std::to_string(static_cast<int>(m.kind)) + "," + std::to_string(m.record) + "," +
         (m.beam ? "1" : "0") + "," + std::to_string(path) + "]";
  }
  return t + "]";
}

nlohmann::json warnings_json(const Diagnostics* diagnostics) {
  nlohmann::json list = nlohmann::json::array();
  if (!diagnostics) return list;
  for (const Warning& w : diagnostics->warnings()) {
    nlohmann::json one = {{"severity", w.severity == Severity::left_out ? "left_out" : "info"},
                          {"code", w.code},
                          {"message", w.message},
                          {"entity", w.where.entity}};
    if (w.position_mm) one["position"] = {(*w.position_mm)[0], (*w.position_mm)[1]};
    list.push_back(std::move(one));
  }
  return list;
}

nlohmann::json summary_json(const LaserPicture& picture) {
  nlohmann::json list = nlohmann::json::array();
  const auto mm = [](double v, int decimals) { return format_fixed(v, decimals) + " mm"; };
  list.push_back({"kerf", mm(picture.kerf_mm, 4)});
  list.push_back({"cut", mm(picture.toolpath->cut_mm, 0)});
  list.push_back({"pierces", std::to_string(picture.toolpath->pierces.size())});
  list.push_back({"about", format_fixed(picture.toolpath->machining_s, 1) + " s"});
  list.push_back({"deviation at most", mm(picture.profile->max_deviation_mm, 5)});
  return list;
}

std::string replace(std::string text, std::string_view key, const std::string& value) {
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + value.size())) {
    text.replace(at, key.size(), value);
  }
  return text;
}

double largest_deviation(const laser::Profile& profile) {
  double most = 0;
  for (const laser::Piece& piece : profile.pieces) most = std::max(most, piece.deviation_mm);
  return most;
}

}  // namespace

std::string laser_svg(const LaserPicture& picture) {
  const std::vector<PlaneMove> moves = plane_moves(*picture.toolpath);
  const geom::Box2 box = whole_box(picture, moves).grown(2);
  const double w = box.width(), h = box.height(), thin = std::max(w, h) / 1500;
  const auto is = [](MoveKind k) { return [k](const PlaneMove& m) { return m.kind == k; }; };
  const auto stroke = [&](const char* colour, double width, const char* more = "") {
    return std::string("fill:none;stroke:") + colour + ";stroke-width:" + num(width) +
           ";stroke-linejoin:round;stroke-linecap:round" + more;
  };
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
      num(w) + "mm\" height=\"" + num(h) + "mm\" viewBox=\"" + num(box.lo.x) + " " + num(-box.hi.y) + " " +
      num(w) + " " + num(h) + "\">\n<title>" + html_text(picture.title) +
      "</title>\n<g transform=\"scale(1,-1)\">\n";
  if (picture.kerf_mm > 0) {
    out += svg_path("kerf", moves_data(moves, [](const PlaneMove& m) { return m.beam; }),
                    stroke("#f2c9a1", picture.kerf_mm));
  }
  std::string outline;
  for (const laser::Outline& o : picture.profile->outlines) outline += path_data(o.spline);
  out += svg_path("outline", outline, stroke("#1b2430", thin));
  out += svg_path("rapid", moves_data(moves, is(MoveKind::rapid)),
                  stroke("#8a94a3", thin, (";stroke-dasharray:" + num(4 * thin)).c_str()));
  out += svg_path("lead", moves_data(moves, is(MoveKind::lead)), stroke("#00897b", 1.5 * thin));
  out += svg_path("cut", moves_data(moves, is(MoveKind::cut)), stroke("#0b62c4", 1.5 * thin));
  out += svg_path("corner", moves_data(moves, is(MoveKind::corner)), stroke("#b45309", 1.5 * thin));
  out += svg_path("overcut", moves_data(moves, is(MoveKind::overcut)), stroke("#8e44ad", 1.5 * thin));
  out += svg_path("engrave", moves_data(moves, is(MoveKind::engrave)), stroke("#2e7d32", 1.5 * thin));
  for (const Point2 p : picture.toolpath->pierces) {
    out += "  <circle class=\"pierce\" cx=\"" + num(p.x) + "\" cy=\"" + num(p.y) + "\" r=\"" + num(3 * thin) +
           "\" style=\"fill:#c62828\"/>\n";
  }
  return out + "</g>\n</svg>\n";
}

std::string laser_html(const LaserPicture& picture) {
  const std::vector<PlaneMove> moves = plane_moves(*picture.toolpath);
  const geom::Box2 box = whole_box(picture, moves);
  nlohmann::json data;
  data["title"] = picture.title;
  data["command"] = picture.command_line;
  data["kerf"] = std::round(picture.kerf_mm * 1e4) / 1e4;
  data["box"] = {box.lo.x, box.lo.y, box.hi.x, box.hi.y};
  data["pathCount"] = picture.profile->paths.size();
  // Colours run to the largest bound that occurs, so that small fits are told apart too.
  data["tolerance"] = std::max(1e-6, std::round(largest_deviation(*picture.profile) * 1e6) / 1e6);
  std::vector<std::size_t> rank(std::max<std::size_t>(1, picture.profile->paths.size()), 0);
  for (std::size_t i = 0; i < picture.toolpath->order.size(); ++i) {
    if (picture.toolpath->order[i] < rank.size()) rank[picture.toolpath->order[i]] = i;
  }
  data["rank"] = rank;
  data["summary"] = summary_json(picture);
  data["figures"] = nlohmann::json::array();
  for (const LaserPicture::Figure& f : picture.figures) data["figures"].push_back({f.group, f.name, f.value});
  data["warnings"] = warnings_json(picture.diagnostics);
  data["pierces"] = nlohmann::json::array();
  for (const Point2 p : picture.toolpath->pierces) data["pierces"].push_back({p.x, p.y});
  data["nc"] = picture.nc_text;
  data["ncRecords"] = picture.nc_line_to_record;
  // Text from files may hold damaged UTF-8: replaced rather than thrown at.
  std::string json = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  json.pop_back();
  json += ",\"outlines\":" + outlines_json(*picture.profile) + ",\"paths\":" + paths_json(*picture.profile) +
          ",\"moves\":" + moves_json(moves, *picture.profile) + "}";
  json = replace(std::move(json), "<", "\\u003c");  // no way out of the script element

  std::string page(embedded::pages().front().text);
  page = replace(std::move(page), "@TITLE@", html_text(picture.title));
  return replace(std::move(page), "@DATA@", json);
}

}  // namespace burin::view
