// SPDX-License-Identifier: Apache-2.0
// Part programs: reading never fails badly; what was read goes out in a dialect, and is read again with the
// same ends.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "burin/nc/program.h"
#include "burin/post/emit.h"

namespace {

using namespace burin;

void require(bool ok) {
  if (!ok) std::abort();
}

const post::Dialect& dialect(std::uint8_t which) {
  static const std::array<post::Dialect, 3> dialects = {
      *post::find_dialect("fanuc"), *post::find_dialect("grbl"), *post::find_dialect("linuxcnc")};
  return dialects[which % 3];
}

const cl::Pose* last_pose(const cl::Program& program) {
  const cl::Pose* last = nullptr;
  for (const cl::Record& record : program.records)
    if (const cl::Pose* pose = cl::pose_of(record)) last = pose;
  return last;
}

/// Arcs of any radius would only measure how fast lines are written.
bool small(const cl::Program& program) {
  for (const cl::Record& record : program.records)
    if (const auto* arc = std::get_if<cl::Arc>(&record); arc && arc->radius > 1000) return false;
  return program.records.size() < 2000;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const post::Dialect& d = dialect(data[0]);
  const bool beam = data[1] & 1;
  const std::string_view text(reinterpret_cast<const char*>(data) + 2, size - 2);
  const nc::InterpretOptions options{.file_name = "fuzz.nc", .beam = beam};
  Diagnostics diagnostics;
  const auto program = nc::interpret(text, options, diagnostics);
  if (!program) {
    require(!program.error().message.empty() && program.error().where.line >= 1);
    return 0;
  }
  require(cl::validate(*program, 0.013).ok());
  if (!small(*program)) return 0;
  const auto nc_text = post::emit(*program, d, {.write_z = true}, diagnostics);
  if (!nc_text) return 0;
  const auto back = nc::interpret(nc_text->text, options, diagnostics);
  require(back.ok());
  const cl::Pose *a = last_pose(*program), *b = last_pose(*back);
  require((a == nullptr) == (b == nullptr));
  // Half a step in each axis, and the rounding of increments.
  if (a) require(distance(a->tip, b->tip) <= 0.87 * std::pow(10.0, -d.decimals) + 1e-6);
  return 0;
}
