// SPDX-License-Identifier: Apache-2.0
// What a file is, by its content; its name decides only where the content leaves it open.
#pragma once

#include <string_view>

namespace burin::job {

enum class FileKind { unknown, cl, nc, job, step, iges, stl, dxf, svg, json, csv };

/// `name` may be empty. Only the beginning of the file is looked at.
FileKind kind_of_file(std::string_view bytes, std::string_view name);

/// "CL data", "an NC program", "a STEP file" ...
std::string_view describe(FileKind kind);

}  // namespace burin::job
