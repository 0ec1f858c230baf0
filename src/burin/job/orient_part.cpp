// SPDX-License-Identifier: Apache-2.0
// The part of an orient job: faces or triangles of the design, and triangles of everything around.
#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "burin/base/text.h"
#include "burin/io/step/read_step.h"
#include "burin/io/stl/stl.h"
#include "burin/job/face_mesh.h"
#include "burin/job/orient_job.h"

namespace burin::job {
namespace {

using geom::Mesh;

/// Share of the gouge tolerance that triangles of obstacles may leave their faces by.
constexpr double kObstacleShare = 1.0 / 4;
/// The tool is tested against all triangles.
constexpr std::size_t kMostObstacles = 500'000;
/// Faces of free form are approximated within this at most when they are no NURBS (mm).
constexpr double kApproximation = 1e-4;
constexpr std::size_t kMostFileTriangles = 20'000'000;

Error in_file(Error error, const std::string& file) {
  if (error.where.file.empty()) error.where.file = file;
  return error;
}

class Loader {
 public:
  Loader(const OrientJobFile& job, std::string folder, const FileSource& read, Diagnostics& diagnostics)
      : job_(job), folder_(std::move(folder)), read_(read), diagnostics_(diagnostics) {}

  Result<orient::Part> load() {
    if (auto ok = std::visit([this](const auto& part) { return add(part); }, job_.part); !ok)
      return ok.error();
    part_.design_triangles = part_.mesh.triangles.size();
    if (part_.design_triangles == 0)
      return Error{ErrorCode::geometry, "the design surface has no triangles (faces with an area)", {}};
    append(part_.mesh, around_);
    for (const std::string& file : job_.obstacles)
      if (auto ok = add_obstacle(file); !ok) return in_file(ok.error(), file);
    for (const auto& t : part_.mesh.triangles)
      for (const std::uint32_t i : t) part_.bounds.add(part_.mesh.vertices[i]);
    return std::move(part_);
  }

 private:
  double design_share() const { return kDesignShare * job_.options.tolerance_mm; }
  double obstacle_share() const { return kObstacleShare * job_.options.tolerance_mm; }

  Result<std::string> bytes(const std::string& file) const {
    return read_((std::filesystem::path(folder_) / file).string());
  }

  void tell(double reached, double wanted, const std::string& what, const std::string& file) {
    // The proven deflection of what was not coarsened is below what was asked for.
    if (reached <= wanted) return;
    diagnostics_.info("coarser_triangles",
                      "the triangles of " + what + " leave it by up to " + format_fixed(reached, 5) +
                          " mm instead of " + format_fixed(wanted, 5) + ": there would be too many",
                      {.file = file});
  }

  Result<std::vector<orient::DesignFace>> cad_faces(const std::string& file) {
    const auto text = bytes(file);
    if (!text) return text.error();
    io::ReadCadOptions options;
    options.file_name = file;
    options.trim_tolerance_mm = design_share();
    options.approximation_mm = std::min(kApproximation, design_share());
    auto model = io::read_cad(*text, options, diagnostics_);
    if (!model) return in_file(model.error(), file);
    std::vector<orient::DesignFace> faces;
    for (io::CadFace& face : model->faces) {
      orient::DesignFace out{std::move(face.surface), face.reversed, {}, face.number};
      for (io::TrimLoop& loop : face.loops) out.trims.push_back(std::move(loop.points));
      faces.push_back(std::move(out));
    }
    return faces;
  }

  Result<void> add(const OrientSurface& surface) {
    auto faces = cad_faces(surface.file);
    if (!faces) return faces.error();
    std::vector<orient::DesignFace> others;
    for (const int wanted : surface.faces) {
      const bool there =
          std::any_of(faces->begin(), faces->end(), [wanted](const auto& f) { return f.number == wanted; });
      if (!there)
        return Error{ErrorCode::usage,
                     "there is no face " + std::to_string(wanted) + " (1 to " +
                         std::to_string(faces->empty() ? 0 : faces->back().number) + ")",
                     {.file = surface.file}};
    }
    for (orient::DesignFace& face : *faces) {
      const auto& list = surface.faces;
      const bool design = list.empty() || std::find(list.begin(), list.end(), face.number) != list.end();
      if (design) face.reversed = face.reversed != surface.flip;
      (design ? part_.faces : others).push_back(std::move(face));
    }
    part_.name = std::filesystem::path(surface.file).filename().string();
    const auto reached = add_faces(part_.faces, design_share(), kMostDesignTriangles, part_.mesh);
    if (!reached) return in_file(reached.error(), surface.file);
    part_.deflection_mm = *reached;
    tell(*reached, design_share(), "the design", surface.file);
    return add_around(others, surface.file);
  }

  Result<void> add_around(const std::vector<orient::DesignFace>& faces, const std::string& file) {
    const auto reached = add_faces(faces, obstacle_share(), kMostObstacles, around_);
    if (!reached) return in_file(reached.error(), file);
    tell(*reached, obstacle_share(), "what is not milled", file);
    return {};
  }

  Result<Mesh> stl(const std::string& file) {
    const auto text = bytes(file);
    if (!text) return text.error();
    io::ReadStlOptions options;
    options.file_name = file;
    options.max_triangles = kMostFileTriangles;
    auto mesh = io::read_stl(*text, options, diagnostics_);
    if (!mesh) return in_file(mesh.error(), file);
    return mesh;
  }

  Result<void> add(const OrientMesh& design) {
    auto mesh = stl(design.file);
    if (!mesh) return mesh.error();
    if (design.flip)
      for (auto& t : mesh->triangles) std::swap(t[1], t[2]);
    part_.mesh = *std::move(mesh);
    part_.name = std::filesystem::path(design.file).filename().string();
    return {};
  }

  Result<void> add(const model::PropellerData& data) {
    auto propeller = model::make_propeller(data);
    if (!propeller) return propeller.error();
    part_.name = "propeller";
    part_.faces.push_back({propeller->side, propeller->reversed, {}, 1});
    const auto reached = add_faces(part_.faces, design_share(), kMostDesignTriangles, part_.mesh);
    if (!reached) return reached.error();
    part_.deflection_mm = *reached;
    tell(*reached, design_share(), "the design", "");
    // The number of triangles falls with the deflection: a coarse try says how far down one may go.
    const auto make = [&](double deflection) {
      around_ = model::blade_back(data, *propeller, deflection);
      append(around_, model::neighbour_blades(data, *propeller, deflection));
      append(around_, model::hub_mesh(data, *propeller, deflection));
    };
    constexpr double kTry = 8;
    make(kTry * obstacle_share());
    const double expected = kTry * double(around_.triangles.size()) / double(kMostObstacles);
    double deflection = obstacle_share() * std::max(1.0, std::exp2(std::ceil(std::log2(expected))));
    for (make(deflection); around_.triangles.size() > kMostObstacles; make(deflection)) deflection *= 2;
    tell(deflection, obstacle_share(), "what is not milled", "");
    return {};
  }

  Result<void> add_obstacle(const std::string& file) {
    const std::string extension = to_lower(std::filesystem::path(file).extension().string());
    if (extension == ".stl") {
      const auto mesh = stl(file);
      if (!mesh) return mesh.error();
      append(part_.mesh, *mesh);
      return {};
    }
    const auto faces = cad_faces(file);
    if (!faces) return faces.error();
    const auto reached = add_faces(*faces, obstacle_share(), kMostObstacles, part_.mesh);
    if (!reached) return reached.error();
    tell(*reached, obstacle_share(), "what is not milled", file);
    return {};
  }

  const OrientJobFile& job_;
  std::string folder_;
  const FileSource& read_;
  Diagnostics& diagnostics_;
  orient::Part part_;
  Mesh around_;
};

}  // namespace

Result<orient::Part> load_orient_part(const OrientJobFile& job, const std::string& folder,
                                      const FileSource& read, Diagnostics& diagnostics) {
  if (!(job.options.tolerance_mm > 0))
    return Error{ErrorCode::range, "the tolerance is not positive (mm above 0)", {}};
  try {
    return Loader(job, folder, read, diagnostics).load();
  } catch (const std::exception& problem) {
    return Error{ErrorCode::internal, std::string("the part could not be loaded: ") + problem.what(), {}};
  }
}

}  // namespace burin::job
