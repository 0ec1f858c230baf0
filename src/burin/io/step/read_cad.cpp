// SPDX-License-Identifier: Apache-2.0
#include <Standard_Failure.hxx>
#include <algorithm>

#include "burin/io/step/face.h"
#include "burin/io/step/load.h"
#include "burin/io/step/read_step.h"

namespace burin::io {

using step::Loaded;
using step::LoadedFace;

namespace {

/// Ascending, without repetitions, all of them there; all faces when nothing was asked for.
Result<std::vector<int>> wanted_faces(const std::vector<int>& asked, std::size_t there) {
  std::vector<int> list = asked;
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  for (const int number : list) {
    if (number < 1 || static_cast<std::size_t>(number) > there) {
      return Error{ErrorCode::usage,
                   "has no face " + std::to_string(number) + " (faces 1 to " + std::to_string(there) + ")",
                   {}};
    }
  }
  if (list.empty()) {
    for (std::size_t i = 1; i <= there; ++i) list.push_back(static_cast<int>(i));
  }
  return list;
}

/// One face; what OpenCASCADE throws costs this face only.
Result<CadFace> face_or_reason(const LoadedFace& loaded, const ReadCadOptions& options) {
  try {
    return step::convert_face(loaded.face, options);
  } catch (const Standard_Failure& failure) {
    const char* text = failure.GetMessageString();
    return Error{
        ErrorCode::geometry,
        std::string("OpenCASCADE cannot convert it") + (text && *text ? ": " : "") + (text ? text : ""),
        {}};
  }
}

Result<CadModel> convert(const Loaded& loaded, const ReadCadOptions& options, Diagnostics& diagnostics) {
  auto wanted = wanted_faces(options.faces, loaded.faces.size());
  if (!wanted) return wanted.error();
  CadModel model;
  model.name = loaded.name;
  model.unit = loaded.unit;
  for (const int number : *wanted) {
    const LoadedFace& from = loaded.faces[static_cast<std::size_t>(number) - 1];
    auto face = face_or_reason(from, options);
    if (!face && face.error().code == ErrorCode::range) {
      diagnostics.info("sliver_face",
                       "face " + std::to_string(number) + " is not taken: " + face.error().message,
                       {.file = options.file_name, .entity = from.entity});
      continue;
    }
    if (!face) {
      diagnostics.left_out("face_left_out",
                           "face " + std::to_string(number) + " is left out: " + face.error().message,
                           {.file = options.file_name, .entity = from.entity});
      continue;
    }
    face->number = number;
    face->name = from.name;
    face->of_solid = from.of_solid;
    model.bounds.add(face->box);
    model.faces.push_back(std::move(*face));
  }
  if (model.faces.empty()) {
    return Error{ErrorCode::geometry,
                 "none of its " + std::to_string(wanted->size()) +
                     " faces can be converted, the first because " +
                     (diagnostics.empty() ? "of damage" : diagnostics.warnings().back().message),
                 {}};
  }
  return model;
}

}  // namespace

Result<CadModel> read_cad(std::string_view bytes, const ReadCadOptions& options, Diagnostics& diagnostics) {
  Result<CadModel> model = Error{};
  const auto done = step::with_occt(options, [&]() -> Result<void> {
    auto loaded = step::load(bytes, options, diagnostics);
    if (!loaded) return loaded.error();
    model = convert(*loaded, options, diagnostics);
    if (!model) return model.error();
    return {};
  });
  if (!done) return done.error();
  return model;
}

}  // namespace burin::io
