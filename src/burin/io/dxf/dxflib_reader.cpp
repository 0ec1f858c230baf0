// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/dxflib_reader.h"

#include <dl_creationadapter.h>
#include <dl_dxf.h>

#include <algorithm>
#include <cstdlib>
#include <istream>
#include <mutex>

#include "burin/base/text.h"
#include "burin/io/dxf/feed.h"
#include "burin/io/dxf/skeleton.h"
#include "burin/io/dxf/text_codes.h"

namespace burin::io::dxf {
namespace {

// Receives what dxflib made of the records. dxflib calls endSection() once for every tag 0 or 9, after it has
// handed over the record before: their count tells which record a call is about.
class Collector : public DL_CreationAdapter {
 public:
  Collector(const Document& document, const FeedBuffer& feed, Skeleton& skeleton)
      : document_(document), feed_(feed), skeleton_(skeleton) {}

  bool out_of_step() const { return out_of_step_; }

  void endSection() override { ++begun_; }

  void setVariableInt(const std::string& key, int value, int) override {
    if (key == "$INSUNITS") skeleton_.model.insunits = value;
    if (key == "$MEASUREMENT") skeleton_.model.measurement = value;
  }

  void addLayer(const DL_LayerData& data) override {
    Layer layer;
    layer.name = decoded(data.name);
    layer.frozen = (data.flags & 1) != 0;
    layer.off = attributes.getColor() < 0;
    layer.color.index = std::abs(std::clamp(attributes.getColor(), -Color::kByLayer, Color::kByLayer));
    layer.color.rgb = attributes.getColor24();
    if (layer.color.index == Color::kByLayer || layer.color.index == Color::kByBlock) layer.color.index = 7;
    skeleton_.model.layers.insert_or_assign(to_lower(layer.name), layer);
  }

  void addBlock(const DL_BlockData& data) override {
    const std::size_t at = current("BLOCK");
    Block* const block = at == Record::kNone ? nullptr : skeleton_.block_of_record[at];
    if (block == nullptr) return;
    block->flags = data.flags;
    block->base = {data.bpx, data.bpy, data.bpz};
  }

  void addLine(const DL_LineData& data) override {
    LineShape line{{data.x1, data.y1, data.z1}, {data.x2, data.y2, data.z2}};
    if (Item* const item = fill("LINE")) item->shape = line;
  }

  void addArc(const DL_ArcData& data) override {
    ArcShape arc{{data.cx, data.cy, data.cz}, data.radius, data.angle1, data.angle2, false};
    if (Item* const item = fill("ARC")) item->shape = arc;
  }

  void addCircle(const DL_CircleData& data) override {
    ArcShape circle{{data.cx, data.cy, data.cz}, data.radius, 0, 360, true};
    if (Item* const item = fill("CIRCLE")) item->shape = circle;
  }

  void addEllipse(const DL_EllipseData& data) override {
    EllipseShape ellipse{
        {data.cx, data.cy, data.cz}, {data.mx, data.my, data.mz}, data.ratio, data.angle1, data.angle2};
    if (Item* const item = fill("ELLIPSE")) item->shape = ellipse;
  }

  void addInsert(const DL_InsertData& data) override {
    InsertShape insert;
    insert.block = decoded(data.name);
    insert.at = {data.ipx, data.ipy, data.ipz};
    insert.scale = {data.sx, data.sy, data.sz};
    insert.angle_deg = data.angle;
    insert.columns = std::max(1, data.cols);
    insert.rows = std::max(1, data.rows);
    insert.column_spacing = data.colSp;
    insert.row_spacing = data.rowSp;
    if (Item* const item = fill("INSERT")) item->shape = insert;
  }

  void addPolyline(const DL_PolylineData& data) override {
    constexpr int kClosed = 1, kSpatial = 8, kPolygonMesh = 16, kPolyfaceMesh = 64;
    const std::size_t at = fed_index();
    if (at == Record::kNone) return;
    Item* const item = fill(document_.records[at].name == "LWPOLYLINE" ? "LWPOLYLINE" : "POLYLINE");
    if (item == nullptr) return;
    if (item->kind == "POLYLINE" && (data.flags & (kPolygonMesh | kPolyfaceMesh)) != 0) {
      item->kind = "POLYLINE mesh";
      return;
    }
    PolylineShape polyline;
    polyline.closed = (data.flags & kClosed) != 0;
    polyline.spatial = item->kind == "POLYLINE" && (data.flags & kSpatial) != 0;
    polyline.elevation = extrusion->getElevation();
    item->shape = polyline;
  }

  void addVertex(const DL_VertexData& data) override {
    const std::size_t at = fed_index();
    Item* const item = at == Record::kNone ? nullptr : skeleton_.item(at);
    auto* const polyline = item == nullptr ? nullptr : std::get_if<PolylineShape>(&item->shape);
    if (polyline != nullptr) polyline->vertices.push_back({{data.x, data.y, data.z}, data.bulge});
  }

  void addSpline(const DL_SplineData& data) override {
    SplineShape spline;
    spline.degree = static_cast<int>(data.degree);
    spline.flags = data.flags;
    spline.start_tangent = {data.tangentStartX, data.tangentStartY, data.tangentStartZ};
    spline.end_tangent = {data.tangentEndX, data.tangentEndY, data.tangentEndZ};
    if (Item* const item = fill("SPLINE")) item->shape = spline;
  }
  void addControlPoint(const DL_ControlPointData& data) override {
    if (SplineShape* const spline = open_spline()) {
      spline->points.push_back({data.x, data.y, data.z});
      spline->weights.push_back(data.w);
    }
  }
  void addFitPoint(const DL_FitPointData& data) override {
    if (SplineShape* const spline = open_spline()) spline->fit_points.push_back({data.x, data.y, data.z});
  }
  void addKnot(const DL_KnotData& data) override {
    if (SplineShape* const spline = open_spline()) spline->knots.push_back(data.k);
  }

 private:
  std::string decoded(const std::string& bytes) const {
    return decode_text(bytes, skeleton_.model.code_page);
  }

  // The record that dxflib hands over; kNone when it hands over nothing of ours.
  std::size_t fed_index() {
    if (begun_ == 0 || begun_ > feed_.fed().size()) {
      out_of_step_ = true;
      return Record::kNone;
    }
    return feed_.fed()[begun_ - 1];
  }
  std::size_t current(std::string_view name) {
    const std::size_t at = fed_index();
    if (at == Record::kNone) return at;
    if (document_.records[at].name != name) {
      out_of_step_ = true;
      return Record::kNone;
    }
    return at;
  }

  // The item of the current record, with the attributes that all kinds share.
  Item* fill(std::string_view name) {
    const std::size_t at = current(name);
    Item* const item = at == Record::kNone ? nullptr : skeleton_.item(at);
    if (item == nullptr) return nullptr;  // in a block that is not used
    item->color.index = attributes.getColor();
    item->color.rgb = attributes.getColor24();
    const double* const direction = extrusion->getDirection();
    item->extrusion = {direction[0], direction[1], direction[2]};
    return item;
  }

  SplineShape* open_spline() {
    const std::size_t at = fed_index();
    Item* const item = at == Record::kNone ? nullptr : skeleton_.item(at);
    return item == nullptr ? nullptr : std::get_if<SplineShape>(&item->shape);
  }

  const Document& document_;
  const FeedBuffer& feed_;
  Skeleton& skeleton_;
  std::size_t begun_ = 0;
  bool out_of_step_ = false;
};

Error internal_error(const std::string& file, const std::string& what) {
  Where where;
  where.file = file;
  return {ErrorCode::internal, "the DXF library failed: " + what, std::move(where)};
}

// dxflib counts lines in a static variable that nothing reads; the lock keeps that from being a data race.
std::mutex& dxflib_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

Result<Model> read_model(const Document& document, const std::string& file, Diagnostics& diagnostics) {
  Skeleton skeleton = build_skeleton(document, file, diagnostics);
  FeedBuffer feed(document, file);
  Collector collector(document, feed, skeleton);
  {
    std::istream stream(&feed);
    // Without this, an exception inside the feed (out of memory) becomes a state that dxflib waits on for
    // ever.
    stream.exceptions(std::ios_base::badbit);
    const std::lock_guard lock(dxflib_mutex());
    DL_Dxf dxf;
    if (!dxf.in(stream, &collector)) return internal_error(file, "it refuses the stream");
  }
  if (feed.failed()) return feed.error();
  if (collector.out_of_step())
    return internal_error(file, "it hands over other entities than the file holds");
  for (const auto& repair : feed.repairs()) {
    if (Item* const item = skeleton.item(repair.record)) item->repairs.push_back(repair.what);
  }
  return std::move(skeleton.model);
}

}  // namespace burin::io::dxf
