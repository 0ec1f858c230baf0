// SPDX-License-Identifier: Apache-2.0
// APT CL text: reading never fails badly, and what was read survives writing and reading: the same records,
// numbers within what the writer promises, and from then on the same bytes.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "burin/cl/apt.h"

namespace {

using namespace burin;

void require(bool ok) {
  if (!ok) std::abort();
}

bool near(geom::Point3 a, geom::Point3 b) {
  return distance(a, b) <= 1e-6;
}
bool near(const cl::Pose& a, const cl::Pose& b) {
  return near(a.tip, b.tip) && norm(a.axis - b.axis) <= 1e-9;
}

bool same(const cl::Record& a, const cl::Record& b) {
  if (a.index() != b.index()) return false;
  const cl::Pose *pa = cl::pose_of(a), *pb = cl::pose_of(b);
  if (pa && !near(*pa, *pb)) return false;
  if (const auto* arc = std::get_if<cl::Arc>(&a)) {
    const auto& other = std::get<cl::Arc>(b);
    return near(arc->center, other.center) && norm(arc->normal - other.normal) <= 1e-9 &&
           std::abs(arc->radius - other.radius) <= 1e-6;
  }
  if (const auto* comment = std::get_if<cl::Comment>(&a)) return *comment == std::get<cl::Comment>(b);
  if (const auto* unknown = std::get_if<cl::Unknown>(&a)) return *unknown == std::get<cl::Unknown>(b);
  return true;
}

/// Sizes that vanish in the writer's decimals may not be read again (a feed above 0, a radius above 0).
bool writable(const cl::Program& program) {
  for (const cl::Record& record : program.records) {
    if (const auto* arc = std::get_if<cl::Arc>(&record); arc && arc->radius < 1e-8) return false;
    if (const auto* feed = std::get_if<cl::FeedRate>(&record); feed && feed->mm_min < 1e-8) return false;
  }
  // Inches put numbers above the limit that the reader sets in mm.
  for (const cl::Record& record : program.records) {
    const cl::Pose* pose = cl::pose_of(record);
    if (pose && norm(pose->tip - geom::Point3{}) > 1e7) return false;
    if (const auto* arc = std::get_if<cl::Arc>(&record);
        arc && (norm(arc->center - geom::Point3{}) > 1e7 || arc->radius > 1e7))
      return false;
    if (const auto* feed = std::get_if<cl::FeedRate>(&record); feed && feed->mm_min > 1e7) return false;
    if (const auto* tool = std::get_if<cl::ToolChange>(&record);
        tool && tool->diameter + tool->corner_radius > 1e7)
      return false;
  }
  return !program.from || norm(program.from->tip - geom::Point3{}) <= 1e7;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics;
  const auto program = cl::read_apt(text, {.file_name = "fuzz.cl", .max_records = 100'000}, diagnostics);
  if (!program) return 0;
  (void)cl::validate(*program);
  (void)cl::totals(*program);
  if (!writable(*program)) return 0;
  const std::string written = cl::write_apt(*program);
  Diagnostics again;
  const auto back = cl::read_apt(written, {.file_name = "back.cl"}, again);
  require(back.ok());
  require(back->name == program->name && back->records.size() == program->records.size());
  require(back->from.has_value() == program->from.has_value());
  for (std::size_t i = 0; i < back->records.size(); ++i) require(same(program->records[i], back->records[i]));
  require(cl::write_apt(*back) == written);
  return 0;
}
