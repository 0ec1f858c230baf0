// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/cell_sheets.h"

namespace burin::removal {
namespace {

constexpr unsigned edge_number(unsigned axis, unsigned p, unsigned q) {
  return 4 * axis + p + 2 * q;
}

/// Corners around a face, and the edge from each to the next.
struct Face {
  std::array<unsigned, 4> corner{}, edge{};
};
Face face_of(unsigned face) {
  const unsigned axis = face / 2, s = face & 1, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto corner = [&](unsigned a, unsigned b) { return s << axis | a << u | b << v; };
  Face f;
  f.corner = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
  // Along u the next axes are v and `axis`, along v they are `axis` and u.
  f.edge = {edge_number(u, 0, s), edge_number(v, s, 1), edge_number(u, 1, s), edge_number(v, s, 0)};
  return f;
}
bool is_set(unsigned corners, unsigned corner) {
  return (corners >> corner & 1) != 0;
}
bool crossed(unsigned corners, unsigned edge) {
  const unsigned lower = corner_of_edge(edge);
  return is_set(corners, lower) != is_set(corners, lower | 1U << edge / 4);
}

}  // namespace

CellSheets cell_sheets(unsigned corners, unsigned joined) {
  CellSheets out;
  std::array<std::uint8_t, 12> label{};
  for (unsigned e = 0; e < 12; ++e) label[e] = static_cast<std::uint8_t>(e);
  const auto link = [&](unsigned a, unsigned b) {
    const std::uint8_t from = label[a], to = label[b];
    for (std::uint8_t& l : label)
      if (l == from) l = to;
  };
  for (unsigned n = 0; n < 6; ++n) {
    const Face f = face_of(n);
    std::array<unsigned, 4> hit{};
    unsigned count = 0;
    for (const unsigned e : f.edge)
      if (crossed(corners, e)) hit[count++] = e;
    if (count == 2) link(hit[0], hit[1]);
    if (count < 4) continue;
    // Around corner c meet the edges before and after it.
    const bool keep_first = is_set(corners, f.corner[0]) != ((joined >> n & 1) != 0);
    for (unsigned c = keep_first ? 0 : 1; c < 4; c += 2) link(f.edge[c], f.edge[(c + 3) % 4]);
  }
  std::array<std::uint8_t, 12> number{};
  number.fill(CellSheets::kNone);
  for (unsigned e = 0; e < 12; ++e) {
    out.of_edge[e] = CellSheets::kNone;
    if (!crossed(corners, e)) continue;
    std::uint8_t& sheet = number[label[e]];
    if (sheet == CellSheets::kNone) sheet = out.count++;
    out.of_edge[e] = sheet;
  }
  return out;
}

bool meets_itself(unsigned corners, unsigned face) {
  const Face f = face_of(face);
  for (const unsigned e : f.edge)
    if (!crossed(corners, e)) return false;
  const CellSheets s = cell_sheets(corners, 0);
  for (const unsigned e : f.edge)
    if (s.of_edge[e] != s.of_edge[f.edge[0]]) return false;
  return true;
}

}  // namespace burin::removal
