// SPDX-License-Identifier: Apache-2.0
#include "burin/view/page.h"

#include <algorithm>

#include "burin/base/embedded.h"
#include "burin/view/encode.h"

namespace burin::embedded {
std::vector<File> report_pages();
}

namespace burin::view {
namespace {

using nlohmann::json;

constexpr std::size_t kProgramBytes = 500'000;
constexpr std::size_t kWarnings = 2'000;

std::string_view page_file(std::string_view name) {
  for (const embedded::File& file : embedded::report_pages())
    if (file.name == name) return file.text;
  return {};
}

json warnings_json(const Diagnostics* diagnostics) {
  json list = json::array();
  if (!diagnostics) return list;
  for (const Warning& w : diagnostics->warnings()) {
    if (list.size() >= kWarnings) break;
    json one = {{"severity", w.severity == Severity::left_out ? "left_out" : "info"},
                {"code", w.code},
                {"message", w.message},
                {"entity", w.where.entity}};
    if (w.position_mm) one["position"] = {(*w.position_mm)[0], (*w.position_mm)[1], (*w.position_mm)[2]};
    list.push_back(std::move(one));
  }
  return list;
}

std::string shortened(const std::string& program) {
  if (program.size() <= kProgramBytes) return program;
  const std::size_t end = program.rfind('\n', kProgramBytes);
  return program.substr(0, end == std::string::npos ? kProgramBytes : end + 1);
}

long part_of_one(double v, double steps) {
  return std::lround(std::clamp(std::isfinite(v) ? v : 0.0, -1.0, 1.0) * steps);
}

}  // namespace

json number_or_null(double v) {
  return std::isfinite(v) ? json(v) : json(nullptr);
}
float single(double v) {
  return std::isfinite(v) ? static_cast<float>(v) : 0.0f;
}
std::uint16_t scaled(double v, double lo, double size) {
  if (!(size > 0) || !std::isfinite(v)) return 0;
  return static_cast<std::uint16_t>(std::lround(std::clamp((v - lo) / size, 0.0, 1.0) * kSteps16));
}
std::int16_t signed16(double v) {
  return static_cast<std::int16_t>(part_of_one(v, kSteps15));
}
std::int8_t signed8(double v) {
  return static_cast<std::int8_t>(part_of_one(v, kSteps7));
}

json shape_json(const Shape& shape, std::size_t of) {
  geom::Box3 box;
  for (const geom::Point3 p : shape.points) box.add(p);
  if (box.empty()) box.add(geom::Point3{});
  const geom::Vec3 size = box.hi - box.lo;
  std::vector<std::uint16_t> points;
  std::vector<std::int8_t> normals;
  for (const geom::Point3 p : shape.points) {
    points.push_back(scaled(p.x, box.lo.x, size.x));
    points.push_back(scaled(p.y, box.lo.y, size.y));
    points.push_back(scaled(p.z, box.lo.z, size.z));
  }
  for (const geom::Vec3 n : shape.normals)
    for (const double c : {n.x, n.y, n.z}) normals.push_back(signed8(c));
  return {{"triangles", shape.points.size() / 3},
          {"of", of},
          {"lo", {box.lo.x, box.lo.y, box.lo.z}},
          {"hi", {box.hi.x, box.hi.y, box.hi.z}},
          {"p", base64(points)},
          {"n", base64(normals)}};
}

void put_texts(json& data, const std::string& title, const std::string& command_line,
               const Diagnostics* diagnostics, const std::string& nc_text) {
  data["title"] = title;
  data["command"] = command_line;
  data["warnings"] = warnings_json(diagnostics);
  data["warningCount"] = diagnostics ? diagnostics->warnings().size() : 0;
  data["nc"] = shortened(nc_text);
  data["ncLines"] = std::count(nc_text.begin(), nc_text.end(), '\n');
}

std::string make_page(std::string_view file, const std::string& title, const json& data) {
  // Text from files may hold damaged UTF-8: replaced rather than thrown at.
  const std::string text = script_safe(data.dump(-1, ' ', false, json::error_handler_t::replace));
  const std::string name = html_text(title);
  return fill_template(page_file(file), {{"@TITLE@", name},
                                         {"@STYLE@", page_file("common.css")},
                                         {"@SCRIPT@", page_file("common.js")},
                                         {"@DATA@", text}});
}

}  // namespace burin::view
