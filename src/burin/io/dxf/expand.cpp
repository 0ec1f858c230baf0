// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/expand.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>

#include "burin/base/text.h"
#include "burin/io/dxf/colors.h"
#include "burin/io/dxf/curves.h"

namespace burin::io::dxf {
namespace {

// Where the items of a block find themselves.
struct Context {
  Map3 map;                 // block (or model) -> drawing, mm
  std::string layer;        // what layer 0 stands for; "" outside of blocks
  std::uint32_t color = 0;  // what BYBLOCK stands for
  std::string way;          // "INSERT 2F/"
  int depth = 0;

  bool in_block() const { return depth > 0; }
};

class Expander {
 public:
  Expander(const Model& model, double mm_per_unit, const ReadOptions& options, Reporter& reporter)
      : model_(model), options_(options), reporter_(reporter) {
    out_.mm_per_unit = mm_per_unit;
  }

  Result<Drawing> run() {
    for (const auto& [key, layer] : model_.layers) layers_.insert(layer.name);
    Context top;
    top.map = Map3::scale(out_.mm_per_unit, out_.mm_per_unit, out_.mm_per_unit);
    if (auto done = take_all(model_.items, top); !done) return done.error();
    report_height();
    report_ignored();
    out_.layers.assign(layers_.begin(), layers_.end());
    return std::move(out_);
  }

 private:
  Result<void> take_all(const std::vector<Item>& items, const Context& context) {
    for (const Item& item : items) {
      if (auto done = take(item, context); !done) return done;
    }
    return {};
  }

  Result<void> take(const Item& item, const Context& context) {
    if (auto paid = pay(item); !paid) return paid;
    const std::string layer = layer_of(item, context);
    if (std::holds_alternative<std::monostate>(item.shape)) {
      ignore(item.kind, item.unsupported ? Why::unsupported : Why::no_outline);
      return {};
    }
    const auto* const insert = std::get_if<InsertShape>(&item.shape);
    if (hidden(item, layer, insert != nullptr, context)) return {};
    if (insert != nullptr) return take_insert(item, *insert, layer, context);
    add_entity(item, layer, context);
    return {};
  }

  // Every item costs, also one that gives nothing: arrays of arrays must come to an end.
  Result<void> pay(const Item& item) {
    constexpr std::size_t kPointsPerEntity = 4;
    if (++visited_ > options_.max_entities) {
      return limit_error(item, "more than " + std::to_string(options_.max_entities) +
                                   " entities after expanding the blocks");
    }
    std::size_t points = 1;
    if (const auto* const polyline = std::get_if<PolylineShape>(&item.shape))
      points = polyline->vertices.size();
    if (const auto* const spline = std::get_if<SplineShape>(&item.shape)) {
      points = spline->points.size() + spline->fit_points.size() + spline->knots.size();
    }
    points_ += points;
    if (points_ / kPointsPerEntity > options_.max_entities) {
      return limit_error(item, "too many points after expanding the blocks");
    }
    return {};
  }

  Error limit_error(const Item& item, std::string message) const {
    return {
        ErrorCode::range,
        std::move(message) + " (at most " + std::to_string(options_.max_entities) + " entities are accepted)",
        {options_.file_name, item.line, 0, entity_name(item.kind, item.handle, item.line)}};
  }

  static std::string entity_name(const std::string& kind, const std::string& id, int line) {
    Entity entity;
    entity.kind = kind;
    entity.id = id;
    entity.line = line;
    return entity.name();
  }

  static std::string id_of(const Item& item, const Context& context) {
    if (!context.in_block()) return item.handle;
    return context.way + item.kind + (item.handle.empty() ? "" : " " + item.handle);
  }

  // The way into an insertion. Every member carries it, so that deep nesting leaves out the middle.
  static std::string way_to(const Item& item, const Context& context) {
    constexpr std::size_t kLongest = 160;
    const std::string own = item.kind + (item.handle.empty() ? "" : " " + item.handle);
    if (context.way.size() <= kLongest) return context.way + own;
    return context.way.substr(0, context.way.find('/')) + "/.../" + own;
  }

  const Layer* find_layer(const std::string& name) const {
    const auto at = model_.layers.find(to_lower(name));
    return at == model_.layers.end() ? nullptr : &at->second;
  }

  // The name as the layer table spells it; layer 0 of a block stands for the layer of the insertion.
  std::string layer_of(const Item& item, const Context& context) {
    if (context.in_block() && item.layer == "0") return context.layer;
    const Layer* const layer = find_layer(item.layer);
    std::string name = layer != nullptr ? layer->name : undeclared(item.layer);
    return name;
  }
  // Names do not tell case apart: the first spelling stands for all.
  std::string undeclared(const std::string& name) {
    const auto& spelled = undeclared_.try_emplace(to_lower(name), name).first->second;
    layers_.insert(spelled);
    return spelled;
  }

  bool hidden(const Item& item, const std::string& layer_name, bool insert, const Context& context) {
    if (item.invisible) return ignore(item.kind + " invisible", Why::hidden);
    if (item.paper_space && !context.in_block()) return ignore(item.kind + " in paper space", Why::hidden);
    const Layer* const layer = find_layer(layer_name);
    if (layer != nullptr && layer->frozen) {
      return ignore(item.kind + " on frozen layer " + layer_name, Why::hidden);
    }
    if (insert) return false;  // off hides what lies on the layer itself, not the other layers of the block
    if (layer != nullptr && layer->off) return ignore(item.kind + " on off layer " + layer_name, Why::hidden);
    if (to_lower(layer_name) == "defpoints")
      return ignore(item.kind + " on layer " + layer_name, Why::hidden);
    return false;
  }

  enum class Why { no_outline, unsupported, hidden };
  bool ignore(const std::string& what, Why why) {
    ++out_.ignored[what];
    why_.try_emplace(what, why);
    return true;
  }

  std::uint32_t color_of(const Color& color, const std::string& layer_name, const Context& context) const {
    constexpr std::uint32_t kRgb = 0xFFFFFF;
    if (color.rgb >= 0) return static_cast<std::uint32_t>(color.rgb) & kRgb;
    if (color.index == Color::kByBlock) return context.color;
    const int index = std::abs(std::clamp(color.index, -Color::kByLayer, Color::kByLayer));
    if (index < Color::kByLayer) return indexed_color(index);
    const Layer* const layer = find_layer(layer_name);
    if (layer == nullptr) return indexed_color(7);
    return layer->color.rgb >= 0 ? static_cast<std::uint32_t>(layer->color.rgb) & kRgb
                                 : indexed_color(layer->color.index);
  }

  void report(Severity severity, const std::string& code, const std::string& message, const Item& item,
              const Context& context, geom::Point3 at) {
    reporter_.add(severity, code, item.kind + " " + message,
                  entity_name(item.kind, id_of(item, context), item.line), item.line, xy(at));
  }

  Result<void> take_insert(const Item& item, const InsertShape& insert, const std::string& layer,
                           const Context& context) {
    const Map3 placed = context.map * entity_system(item.extrusion);
    const geom::Point3 at = placed(insert.at);
    const auto found = model_.blocks.find(to_lower(insert.block));
    if (found == model_.blocks.end()) {
      report(Severity::left_out, "unknown_block", "of the block '" + insert.block + "', which is not there",
             item, context, at);
      return {};
    }
    const Block& block = found->second;
    if (block.external() && block.items.empty()) {
      report(Severity::left_out, "external_reference", "refers to another file: '" + block.name + "'", item,
             context, at);
      return {};
    }
    if (insert.scale.x == 0 || insert.scale.y == 0) {
      report(Severity::left_out, "bad_geometry", "has scale 0 and is left out", item, context, at);
      return {};
    }
    if (auto allowed = check_nesting(item, block, context); !allowed) return allowed;
    open_.push_back(&block);
    auto done = place_instances(item, insert, block, placed, layer, context);
    open_.pop_back();
    return done;
  }

  Result<void> check_nesting(const Item& item, const Block& block, const Context& context) const {
    const Where where{options_.file_name, item.line, 0,
                      entity_name(item.kind, id_of(item, context), item.line)};
    if (std::find(open_.begin(), open_.end(), &block) != open_.end()) {
      return Error{ErrorCode::syntax, "the block '" + block.name + "' contains itself", where};
    }
    if (context.depth >= options_.max_depth) {
      return Error{ErrorCode::range,
                   "blocks are nested deeper than " + std::to_string(options_.max_depth) +
                       " levels (at most " + std::to_string(options_.max_depth) + " are accepted)",
                   where};
    }
    return {};
  }

  Result<void> place_instances(const Item& item, const InsertShape& insert, const Block& block,
                               const Map3& placed, const std::string& layer, const Context& context) {
    const double sz = insert.scale.z == 0 ? 1 : insert.scale.z;
    const Map3 turned = placed * Map3::shift(insert.at - geom::Point3{}) * Map3::turn_z(insert.angle_deg);
    const Map3 scaled =
        Map3::scale(insert.scale.x, insert.scale.y, sz) * Map3::shift(geom::Point3{} - block.base);
    const bool array = insert.rows > 1 || insert.columns > 1;
    Context inner;
    inner.layer = layer;
    inner.color = color_of(item.color, layer, context);
    inner.depth = context.depth + 1;
    for (int row = 0; row < insert.rows; ++row) {
      for (int column = 0; column < insert.columns; ++column) {
        if ((row > 0 || column > 0) && ++visited_ > options_.max_entities) {
          return limit_error(item, "more than " + std::to_string(options_.max_entities) +
                                       " entities after expanding the blocks");
        }
        const geom::Vec3 offset{column * insert.column_spacing, row * insert.row_spacing, 0};
        inner.map = turned * Map3::shift(offset) * scaled;
        inner.way = way_to(item, context);
        if (array) inner.way += "(" + std::to_string(row + 1) + "," + std::to_string(column + 1) + ")";
        inner.way += '/';
        if (auto done = take_all(block.items, inner); !done) return done;
      }
    }
    return {};
  }

  void add_entity(const Item& item, const std::string& layer, const Context& context) {
    Converted converted = convert(item, context.map);
    for (const Finding& finding : converted.findings) {
      report(finding.severity, finding.code, finding.message, item, context, converted.at);
    }
    if (converted.paths.empty()) return;
    lowest_ = std::min(lowest_, converted.z_lowest);
    highest_ = std::max(highest_, converted.z_highest);
    Entity entity;
    entity.kind = item.kind;
    entity.id = id_of(item, context);
    entity.line = item.line;
    entity.layer = layer;
    entity.color = color_of(item.color, layer, context);
    entity.paths = std::move(converted.paths);
    out_.entities.push_back(std::move(entity));
  }

  void report_height() {
    // Decimals lost in writing are no difference in height.
    constexpr double kSameHeight = 1e-6;
    if (!(highest_ - lowest_ > kSameHeight)) return;
    reporter_.add_for_file(Severity::info, "z_ignored",
                           "Z runs from " + format_fixed(lowest_, 3) + " to " + format_fixed(highest_, 3) +
                               " mm: it is ignored, everything is projected onto the XY plane");
  }

  void report_ignored() {
    for (const auto& [what, count] : out_.ignored) {
      const std::string message = std::to_string(count) + " " + what;
      switch (why_.at(what)) {
        case Why::no_outline:
          reporter_.add_for_file(Severity::info, "ignored_entity", message + " ignored: no outline to cut");
          break;
        case Why::hidden:
          reporter_.add_for_file(Severity::info, "ignored_hidden", message + " ignored");
          break;
        case Why::unsupported:
          reporter_.add_for_file(Severity::left_out, "unsupported_entity",
                                 message + " left out: this kind of entity is not supported");
          break;
      }
    }
  }

  const Model& model_;
  const ReadOptions& options_;
  Reporter& reporter_;
  Drawing out_;
  std::set<std::string> layers_;
  std::map<std::string, std::string> undeclared_;  // lower case -> first spelling
  std::map<std::string, Why> why_;
  std::vector<const Block*> open_;  // blocks being expanded, outermost first
  std::size_t visited_ = 0;
  std::size_t points_ = 0;
  double lowest_ = std::numeric_limits<double>::infinity();
  double highest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

Result<Drawing> expand(const Model& model, double mm_per_unit, const ReadOptions& options,
                       Reporter& reporter) {
  return Expander(model, mm_per_unit, options, reporter).run();
}

}  // namespace burin::io::dxf
