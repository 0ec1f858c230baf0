// SPDX-License-Identifier: Apache-2.0
#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Static.hxx>
#include <Precision.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopoDS_Compound.hxx>
#include <XSControl_WorkSession.hxx>
#include <sstream>

#include "burin/io/step/convert.h"
#include "burin/io/step/load.h"
#include "burin/io/step/read_step.h"

namespace burin::io {

namespace {

/// Printable ASCII only: other characters would need the escapes of ISO 10303-21.
std::string plain(const std::string& name) {
  std::string out;
  for (const char c : name) out += c >= 0x20 && c < 0x7f ? c : '_';
  return out.empty() ? "part" : out.substr(0, 200);
}

Result<TopoDS_Shape> as_shape(const std::vector<geom::NurbsSurface>& surfaces) {
  const BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const auto bad = [&](const std::string& why) {
      return Error{
          ErrorCode::geometry, "surface " + std::to_string(i + 1) + " cannot be written: " + why, {}};
    };
    if (auto valid = geom::validate(surfaces[i]); !valid) return bad(valid.error().message);
    if (std::string wrong = step::what_is_wrong(surfaces[i]); !wrong.empty()) return bad(wrong);
    if (!(geom::bounds(surfaces[i]).diagonal() > Precision::Confusion())) return bad("it is a point");
    BRepBuilderAPI_MakeFace face(step::to_occt(surfaces[i]), Precision::Confusion());
    if (!face.IsDone()) return bad("it has no area or is broken");
    builder.Add(compound, face.Face());
  }
  return TopoDS_Shape(compound);
}

/// The same surfaces give the same bytes: no time of writing, no counter in names.
void set_header(const Handle(StepData_StepModel) & model, const std::string& name) {
  const auto text = [](const char* s) { return new TCollection_HAsciiString(s); };
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text(name.c_str()));
  header.SetTimeStamp(text("1970-01-01T00:00:00"));
  header.SetAuthorValue(1, text(""));
  header.SetOrganizationValue(1, text(""));
  header.SetOriginatingSystem(text("burin"));
  header.SetPreprocessorVersion(text("burin"));
  header.Apply(model);
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto product = Handle(StepBasic_Product)::DownCast(model->Value(i));
    if (product.IsNull()) continue;
    product->SetName(text(name.c_str()));
    product->SetId(text(name.c_str()));
  }
}

Result<std::string> written(const TopoDS_Shape& shape, const std::string& name) {
  STEPControl_Writer writer;
  if (writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone)
    return Error{ErrorCode::internal, "OpenCASCADE cannot write the surfaces as STEP", {}};
  const Handle(StepData_StepModel) model = writer.Model();
  set_header(model, name);
  StepData_StepWriter text(model);
  text.SendModel(Handle(StepData_Protocol)::DownCast(writer.WS()->Protocol()));
  std::ostringstream out;
  if (!text.Print(out)) return Error{ErrorCode::internal, "OpenCASCADE cannot write the STEP text", {}};
  return out.str();
}

}  // namespace

Result<std::string> write_step(const std::vector<geom::NurbsSurface>& surfaces, const std::string& name) {
  if (surfaces.empty()) return Error{ErrorCode::geometry, "there are no surfaces to be written", {}};
  std::string text;
  const auto done = step::with_occt({}, [&]() -> Result<void> {
    STEPControl_Controller::Init();
    step::set_statics();
    auto shape = as_shape(surfaces);
    if (!shape) return shape.error();
    auto result = written(*shape, plain(name));
    if (!result) return result.error();
    text = std::move(*result);
    return {};
  });
  if (!done) return done.error();
  return text;
}

}  // namespace burin::io
