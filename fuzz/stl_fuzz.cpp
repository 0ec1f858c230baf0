// SPDX-License-Identifier: Apache-2.0
// STL: reading never fails badly; what was read is a mesh, and survives writing and reading (single
// precision: triangles may lose a corner, never gain).
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "burin/geom/mesh/check.h"
#include "burin/io/stl/stl.h"

namespace {

void require(bool ok) {
  if (!ok) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burin;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics;
  const auto mesh = io::read_stl(bytes, {.file_name = "fuzz.stl", .max_triangles = 10'000}, diagnostics);
  if (!mesh) return 0;
  require(!mesh->triangles.empty());
  for (const auto& t : mesh->triangles) {
    for (const std::uint32_t i : t) {
      require(i < mesh->vertices.size());
      const geom::Point3 p = mesh->vertices[i];
      require(std::abs(p.x) <= 1e7 && std::abs(p.y) <= 1e7 && std::abs(p.z) <= 1e7);
    }
  }
  Diagnostics again;
  const auto back = io::read_stl(io::write_stl(*mesh), {.file_name = "back.stl"}, again);
  require(back.ok() ? back->triangles.size() <= mesh->triangles.size()
                    : back.error().message == "holds no triangles");
  // What follows the reader takes any mesh.
  (void)geom::examine(*mesh);
  geom::Mesh whole = geom::welded(*mesh, 1e-3);
  (void)geom::orient(whole);
  (void)geom::corner_normals(whole, 0.5);
  return 0;
}
