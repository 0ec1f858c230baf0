// SPDX-License-Identifier: Apache-2.0
#include "burin/io/step/load.h"

#include <IGESControl_Controller.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESGeom_BSplineCurve.hxx>
#include <IGESToBRep_BasicCurve.hxx>
#include <IGESToBRep_CurveAndSurface.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_ReportEntity.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepBasic_Product.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TransferBRep.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <istream>
#include <map>
#include <mutex>
#include <streambuf>

#include "burin/base/text.h"
#include "burin/io/step/scan.h"
#include "burin/io/step/temp_file.h"

namespace burin::io::step {

namespace {

// --- one at a time, quietly --------------------------------------------------------------------------------

/// The readers, the IGES parser and Interface_Static are global in OpenCASCADE.
std::mutex& occt_mutex() {
  static std::mutex mutex;
  return mutex;
}

class Quiet {
 public:
  Quiet() : printers_(Message::DefaultMessenger()->Printers()) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
  }
  ~Quiet() { Message::DefaultMessenger()->ChangePrinters() = printers_; }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  Message_SequenceOfPrinters printers_;
};

/// A stream over bytes that are not copied.
class ByteBuffer : public std::streambuf {
 public:
  explicit ByteBuffer(std::string_view bytes) {
    // The interface of streambuf has no const; nothing is written.
    char* begin = const_cast<char*>(bytes.data());
    setg(begin, begin, begin + bytes.size());
  }
};

// --- names -------------------------------------------------------------------------------------------------

/// Without control characters, at most 200 bytes.
std::string clean(const Handle(TCollection_HAsciiString) & text) {
  std::string out;
  if (text.IsNull()) return out;
  for (int i = 1; i <= text->Length() && out.size() < 200; ++i) {
    const char c = text->Value(i);
    if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) out += c;
  }
  out = std::string(trim(out));
  return to_lower(out) == "none" ? "" : out;
}

std::string face_name(const Handle(Standard_Transient) & entity) {
  if (const auto e = Handle(StepRepr_RepresentationItem)::DownCast(entity); !e.IsNull())
    return clean(e->Name());
  if (const auto e = Handle(IGESData_IGESEntity)::DownCast(entity); !e.IsNull()) {
    if (e->HasName()) return clean(e->NameValue());
    if (e->HasShortLabel()) return clean(e->ShortLabel());
  }
  return "";
}

std::string entity_label(const Handle(Interface_InterfaceModel) & model,
                         const Handle(Standard_Transient) & entity) {
  const Handle(TCollection_HAsciiString) label = model->StringLabel(entity);
  std::string text = label.IsNull() ? "" : label->ToCString();
  if (const auto e = Handle(IGESData_IGESEntity)::DownCast(entity); !e.IsNull())
    return "entity " + std::to_string(e->TypeNumber()) + " " + text;
  return "face " + text;
}

/// What must become a face: nothing else in a file is one.
bool is_face_entity(const Handle(Standard_Transient) & entity) {
  if (entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface))) return true;
  const auto e = Handle(IGESData_IGESEntity)::DownCast(entity);
  if (e.IsNull()) return false;
  return e->TypeNumber() == 143 || e->TypeNumber() == 144 || e->TypeNumber() == 510;
}

/// The entity that each face came from, by the identity of its shape; what came to nothing is reported.
std::map<const TopoDS_TShape*, Handle(Standard_Transient)> origins(const Handle(XSControl_WorkSession) &
                                                                       session,
                                                                   Diagnostics& diagnostics) {
  std::map<const TopoDS_TShape*, Handle(Standard_Transient)> map;  // looked up, never listed
  const Handle(Interface_InterfaceModel) model = session->Model();
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  if (process.IsNull()) return map;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    if (entity.IsNull()) continue;
    const Handle(Transfer_Binder) binder = process->Find(entity);
    const TopoDS_Shape shape = binder.IsNull() ? TopoDS_Shape() : TransferBRep::ShapeResult(binder);
    if (shape.IsNull()) {
      if (is_face_entity(entity))
        diagnostics.left_out("face_left_out", "the face cannot be read",
                             {.entity = entity_label(model, entity)});
      continue;
    }
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
      const TopoDS_TShape* face = it.Current().TShape().get();
      const bool precise = shape.ShapeType() == TopAbs_FACE || is_face_entity(entity);
      if (precise) map[face] = entity;
      if (!precise && !Handle(IGESData_IGESEntity)::DownCast(entity).IsNull()) map.emplace(face, entity);
    }
  }
  return map;
}

void list_faces(Loaded& loaded, const Handle(XSControl_WorkSession) & session, Diagnostics& diagnostics) {
  const auto from = origins(session, diagnostics);
  TopTools_IndexedMapOfShape of_solids;
  for (TopExp_Explorer it(loaded.shape, TopAbs_SOLID); it.More(); it.Next())
    TopExp::MapShapes(it.Current(), TopAbs_FACE, of_solids);
  for (TopExp_Explorer it(loaded.shape, TopAbs_FACE); it.More(); it.Next()) {
    LoadedFace f{TopoDS::Face(it.Current()), "", "", of_solids.Contains(it.Current())};
    if (const auto found = from.find(f.face.TShape().get()); found != from.end()) {
      f.name = face_name(found->second);
      f.entity = entity_label(session->Model(), found->second);
    }
    loaded.faces.push_back(std::move(f));
  }
}

// --- the two readers ---------------------------------------------------------------------------------------

Error damaged(const std::string& what) {
  return {ErrorCode::syntax, what, {}};
}

/// Whether readers go on to geometry through this entity. Others (units with derived values left out, names,
/// notes) are often filled sloppily, which does no harm.
bool carries_shape(const Handle(Standard_Transient) & entity) {
  const std::string_view type = entity->DynamicType()->Name();
  if (type.find("Context") != std::string_view::npos) return false;
  return type.starts_with("StepGeom_") || type.starts_with("StepShape_") || type.starts_with("IGES");
}

/// The first entity of geometry that could not be filled from its values. OpenCASCADE goes on with holes in
/// it, and reads through null pointers later.
Result<void> check_entities(const Handle(Interface_InterfaceModel) & model) {
  if (model.IsNull()) return damaged("holds nothing that can be read (a complete STEP or IGES file)");
  for (int i = 1; i <= model->NbEntities(); ++i) {
    if (!model->IsErrorEntity(i)) continue;
    const Handle(Standard_Transient) entity = model->Value(i);
    if (!carries_shape(entity)) continue;
    const Handle(Interface_Check) check = model->ReportEntity(i)->Check();
    constexpr std::string_view kName = "(name)";
    if (check->NbFails() == 1 && std::string_view(check->CFail(1)).find(kName) != std::string_view::npos)
      continue;
    Error error =
        damaged("is damaged: " + std::string(check->HasFailed() ? check->CFail(1) : "values are missing") +
                " (a complete STEP or IGES file)");
    error.where.entity = entity_label(model, entity) + " " + entity->DynamicType()->Name();
    return error;
  }
  return {};
}

/// Spline curves that OpenCASCADE cannot build (knots that are only nearly equal): boundaries made of them
/// are null pointers to its reader of loops.
Result<void> check_curves(const Handle(IGESData_IGESModel) & model) {
  IGESToBRep_CurveAndSurface session;
  session.SetModel(model);
  session.SetTransferProcess(new Transfer_TransientProcess());
  IGESToBRep_BasicCurve converter(session);
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto curve = Handle(IGESGeom_BSplineCurve)::DownCast(model->Value(i));
    if (curve.IsNull() || !converter.TransferBasicCurve(curve).IsNull()) continue;
    Error error = damaged("is damaged: the knots of a curve do not fit its degree (a complete IGES file)");
    error.where.entity = entity_label(model, curve);
    return error;
  }
  return {};
}

std::string unit_word(std::string name) {
  name = to_lower(trim(name));
  static const std::map<std::string, std::string> kWords{
      {"millimetre", "mm"}, {"millimeter", "mm"}, {"mm", "mm"},         {"centimetre", "cm"},
      {"centimeter", "cm"}, {"cm", "cm"},         {"metre", "m"},       {"meter", "m"},
      {"m", "m"},           {"inch", "inch"},     {"in", "inch"},       {"foot", "ft"},
      {"ft", "ft"},         {"mile", "mile"},     {"mi", "mile"},       {"kilometre", "km"},
      {"km", "km"},         {"mil", "mil"},       {"micrometre", "um"}, {"um", "um"},
      {"cin", "uinch"},     {"uin", "uinch"},     {"inches", "inch"}};
  const auto found = kWords.find(name);
  return found == kWords.end() ? name : found->second;
}

std::string step_name(const Handle(Interface_InterfaceModel) & model) {
  for (int i = 1; i <= model->NbEntities(); ++i) {
    if (const auto product = Handle(StepBasic_Product)::DownCast(model->Value(i)); !product.IsNull())
      return clean(product->Name());
  }
  return "";
}

Result<Loaded> load_step(std::string_view bytes, Diagnostics& diagnostics) {
  STEPControl_Controller::Init();
  set_statics();
  STEPControl_Reader reader;
  ByteBuffer buffer(bytes);
  std::istream stream(&buffer);
  if (reader.ReadStream("part", stream) != IFSelect_RetDone)
    return damaged("cannot be read as STEP (a part in ISO 10303-21: AP203, AP214 or AP242)");
  if (auto fine = check_entities(reader.Model()); !fine) return fine.error();
  reader.TransferRoots();
  Loaded loaded;
  loaded.shape = reader.OneShape();
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  if (!lengths.IsEmpty()) loaded.unit = unit_word(lengths.First().ToCString());
  loaded.name = step_name(reader.Model());
  if (!loaded.shape.IsNull()) list_faces(loaded, reader.WS(), diagnostics);
  return loaded;
}

Result<Loaded> load_iges(std::string_view bytes, Diagnostics& diagnostics) {
  auto file = TempFile::with(bytes);
  if (!file) return file.error();
  IGESControl_Controller::Init();
  set_statics();
  IGESControl_Reader reader;
  if (reader.ReadFile(file->path().c_str()) != IFSelect_RetDone)
    return damaged("cannot be read as IGES (a file of fixed 80-column lines)");
  if (auto fine = check_entities(reader.Model()); !fine) return fine.error();
  const auto model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
  if (auto fine = check_curves(model); !fine) return fine.error();
  reader.TransferRoots();
  Loaded loaded;
  loaded.shape = reader.OneShape();
  if (!model.IsNull()) {
    const IGESData_GlobalSection& global = model->GlobalSection();
    if (!global.UnitName().IsNull()) loaded.unit = unit_word(global.UnitName()->ToCString());
    loaded.name = clean(global.SendName());
  }
  if (!loaded.shape.IsNull()) list_faces(loaded, reader.WS(), diagnostics);
  return loaded;
}

std::size_t count(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  if (shape.IsNull()) return 0;
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return static_cast<std::size_t>(map.Extent());
}

Error no_faces(const Loaded& loaded) {
  const std::size_t curves = count(loaded.shape, TopAbs_EDGE), points = count(loaded.shape, TopAbs_VERTEX);
  std::string holds = "nothing that can be machined";
  if (curves > 0) {
    holds = "wireframe only, " + std::to_string(curves) + (curves == 1 ? " curve" : " curves");
  } else if (points > 0) {
    holds = "points only, " + std::to_string(points);
  }
  return {ErrorCode::geometry, "has no faces: it holds " + holds + " (a part with surfaces or solids)", {}};
}

}  // namespace

void set_statics() {
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetIVal("read.precision.mode", 0);  // the tolerances of the file
  Interface_Static::SetRVal("read.precision.val", 1e-4);
  Interface_Static::SetIVal("read.maxprecision.mode", 0);
  Interface_Static::SetRVal("read.maxprecision.val", 1);
  Interface_Static::SetIVal("read.stdsameparameter.mode", 0);
  Interface_Static::SetIVal("read.surfacecurve.mode", 0);
  Interface_Static::SetRVal("read.encoderegularity.angle", 0.01);
  Interface_Static::SetIVal("read.iges.bspline.approxd1.mode", 0);
  Interface_Static::SetIVal("read.iges.bspline.continuity", 0);  // surfaces as they are, not broken up
  Interface_Static::SetIVal("read.iges.onlyvisible", 0);
  Interface_Static::SetIVal("read.iges.faulty.entities", 0);
  Interface_Static::SetIVal("read.step.product.mode", 1);
  Interface_Static::SetIVal("read.step.product.context", 1);
  Interface_Static::SetIVal("read.step.shape.repr", 1);
  Interface_Static::SetIVal("read.step.assembly.level", 1);
  Interface_Static::SetIVal("read.step.nonmanifold", 0);
  Interface_Static::SetIVal("read.step.ideas", 0);
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetIVal("write.precision.mode", 0);
  Interface_Static::SetIVal("write.surfacecurve.mode", 1);
  Interface_Static::SetIVal("write.step.assembly", 0);
}

Result<void> with_occt(const ReadCadOptions& options, const std::function<Result<void>()>& work) {
  Where where;
  where.file = options.file_name;
  try {
    const std::lock_guard<std::mutex> lock(occt_mutex());
    const Quiet quiet;
    try {
      auto done = work();
      if (done) return done;
      Error error = done.error();
      if (error.where.file.empty()) error.where.file = options.file_name;
      return error;
    } catch (const Standard_Failure& failure) {
      const char* text = failure.GetMessageString();
      return Error{ErrorCode::syntax,
                   std::string("is damaged: OpenCASCADE gives up") + (text && *text ? ": " : "") +
                       (text ? text : "") + " (a complete STEP or IGES file)",
                   where};
    }
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::range, "needs more memory than there is (a smaller part)", where};
  } catch (const std::exception& e) {
    return Error{ErrorCode::syntax,
                 std::string("is damaged: ") + e.what() + " (a complete STEP or IGES file)", where};
  } catch (...) {
    return Error{ErrorCode::internal, "OpenCASCADE failed without a reason", where};
  }
}

Result<Loaded> load(std::string_view bytes, const ReadCadOptions& options, Diagnostics& diagnostics) {
  auto kind = scan(bytes, options.file_name);
  if (!kind) return kind.error();
  auto loaded = *kind == FileKind::step ? load_step(bytes, diagnostics) : load_iges(bytes, diagnostics);
  if (!loaded) return loaded.error();
  if (loaded->faces.empty()) return no_faces(*loaded);
  return loaded;
}

}  // namespace burin::io::step
