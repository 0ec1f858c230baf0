// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>

#include "burin/base/text.h"
#include "burin/io/stl/stl.h"
#include "burin/io/stl/stl_builder.h"
#include "burin/io/stl/stl_text.h"

namespace burin::io {

namespace {

constexpr std::size_t kHeader = 84, kRecord = 50;

std::uint32_t little_endian(const char* p) {
  std::uint32_t out = 0;
  for (unsigned i = 0; i < 4; ++i) out |= std::uint32_t{static_cast<unsigned char>(p[i])} << (8 * i);
  return out;
}
double single(const char* p) {
  const std::uint32_t bits = little_endian(p);
  float f = 0;
  std::memcpy(&f, &bits, sizeof f);
  return f;
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// "solid" at the start and no control characters in what follows: binary files may begin with the word, but
/// not go on as text up to the number of triangles. An exact length settles it before.
bool looks_like_text(std::string_view bytes) {
  if (bytes.size() >= kHeader &&
      bytes.size() - kHeader == std::uint64_t{little_endian(bytes.data() + 80)} * kRecord)
    return false;
  std::size_t start = 0;
  while (start < bytes.size() && is_blank(bytes[start])) ++start;
  if (to_lower(bytes.substr(start, 5)) != "solid") return false;
  constexpr std::size_t kLook = 512;
  const std::string_view head = bytes.substr(start, kLook);
  for (const char c : head) {
    if (static_cast<unsigned char>(c) < ' ' && !is_blank(c) && c != '\f' && c != '\v') return false;
  }
  return true;
}

/// Returns how many bytes are left over.
Result<std::size_t> read_binary(std::string_view bytes, const ReadStlOptions& options,
                                stl::Builder& builder) {
  if (bytes.size() < kHeader) {
    return Error{ErrorCode::syntax,
                 "is no STL file: " + std::to_string(bytes.size()) +
                     " bytes (text that begins with solid, or binary of 84 bytes and 50 for each triangle)",
                 {}};
  }
  const std::uint64_t count = little_endian(bytes.data() + 80), room = (bytes.size() - kHeader) / kRecord;
  if (count > room) {
    return Error{ErrorCode::syntax,
                 "says that it holds " + std::to_string(count) + " triangles and is long enough for " +
                     std::to_string(room) + " (truncated, or no STL file)",
                 {}};
  }
  if (count > options.max_triangles) return stl::too_many(options.max_triangles);
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* at = bytes.data() + kHeader + i * kRecord + 12;  // after the normal
    std::array<std::array<double, 3>, 3> corners{};
    for (auto& corner : corners) {
      for (double& v : corner) v = single(at), at += 4;
    }
    if (auto added = builder.add(corners); !added) {
      Error error = added.error();
      error.where.entity = "triangle " + std::to_string(i + 1);
      return error;
    }
  }
  return bytes.size() - kHeader - static_cast<std::size_t>(count) * kRecord;
}

void report(const stl::Builder& builder, std::size_t solids, std::size_t left_over,
            const ReadStlOptions& options, Diagnostics& diagnostics) {
  const Where where{.file = options.file_name};
  if (builder.degenerate() > 0) {
    diagnostics.info("degenerate_triangles",
                     std::to_string(builder.degenerate()) + " triangles with a corner twice are left out",
                     where);
  }
  if (solids > 1)
    diagnostics.info("several_solids", std::to_string(solids) + " solids are taken as one mesh", where);
  if (left_over >= kRecord) {
    diagnostics.left_out(
        "trailing_data",
        std::to_string(left_over) + " bytes after the number of triangles it says are not read", where);
  } else if (left_over > 0) {
    diagnostics.info("trailing_data", std::to_string(left_over) + " bytes at the end are not read", where);
  }
}

Result<geom::Mesh> read(std::string_view bytes, const ReadStlOptions& options, Diagnostics& diagnostics) {
  if (!(options.scale > 0) || !std::isfinite(options.scale))
    return Error{ErrorCode::usage, "the scale of the mesh is not above 0 (mm per unit of the file)", {}};
  if (bytes.empty()) return Error{ErrorCode::syntax, "is empty (an STL file)", {}};
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  const bool marked = bytes.substr(0, kMark.size()) == kMark;
  const std::string_view content = marked ? bytes.substr(kMark.size()) : bytes;
  stl::Builder builder(options.scale, options.max_triangles);
  std::size_t solids = 1, left_over = 0;
  if (looks_like_text(content)) {
    auto done = stl::read_text(content, builder);
    if (!done) return done.error();
    solids = *done;
  } else {
    auto done = read_binary(bytes, options, builder);
    if (!done) return done.error();
    left_over = *done;
  }
  report(builder, solids, left_over, options, diagnostics);
  geom::Mesh mesh = std::move(builder).mesh();
  if (mesh.triangles.empty()) return Error{ErrorCode::syntax, "holds no triangles", {}};
  return mesh;
}

}  // namespace

Result<geom::Mesh> read_stl(std::string_view bytes, const ReadStlOptions& options, Diagnostics& diagnostics) {
  auto mesh = read(bytes, options, diagnostics);
  if (mesh) return mesh;
  Error error = mesh.error();
  error.where.file = options.file_name;
  return error;
}

}  // namespace burin::io
