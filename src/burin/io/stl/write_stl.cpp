// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "burin/io/stl/stl.h"

namespace burin::io {

namespace {

void put(std::string& out, std::uint32_t bits) {
  for (unsigned i = 0; i < 4; ++i) out += static_cast<char>(bits >> (8 * i) & 0xffU);
}
void put(std::string& out, double v) {
  const auto f = static_cast<float>(v);
  std::uint32_t bits = 0;
  std::memcpy(&bits, &f, sizeof bits);
  put(out, bits);
}

}  // namespace

std::string write_stl(const geom::Mesh& mesh) {
  std::string out = "burin";  // must not begin with "solid"
  out.reserve(84 + 50 * mesh.triangles.size());
  out.resize(80, ' ');
  put(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    const geom::Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const geom::Vec3 n = unit(cross(b - a, c - a));
    for (const double v : {n.x, n.y, n.z, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}) put(out, v);
    out.append(2, '\0');
  }
  return out;
}

}  // namespace burin::io
