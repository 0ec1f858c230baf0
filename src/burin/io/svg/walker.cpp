// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/walker.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "burin/base/text.h"
#include "burin/io/svg/placing.h"
#include "burin/io/svg/transform_list.h"

namespace burin::io::svg {

using geom::Affine2;

namespace {

/// A visit costs one unit and one more for so many bytes of attributes, so that the whole work is bounded by
/// the size of the file plus max_entities, however often <use> refers to a long element.
constexpr std::size_t kBytesPerUnit = 64;
/// Warnings of one kind that are listed one by one; the rest is counted.
constexpr int kMaxWarnings = 100;

constexpr std::string_view kContainers[] = {"g", "a"};
/// Never drawn where they stand.
constexpr std::string_view kDefinitions[] = {"defs",           "symbol",
                                             "clipPath",       "mask",
                                             "pattern",        "marker",
                                             "metadata",       "title",
                                             "desc",           "style",
                                             "script",         "linearGradient",
                                             "radialGradient", "filter",
                                             "view",           "cursor",
                                             "font",           "font-face",
                                             "animate",        "set",
                                             "animateMotion",  "animateTransform",
                                             "animateColor",   "color-profile",
                                             "stop",           "hatch",
                                             "meshgradient",   "solidcolor",
                                             "glyph",          "discard"};

template <std::size_t N>
bool contains(const std::string_view (&names)[N], std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

bool is_inkscape_layer(const Element& element) {
  return element.is("g") && element.get("groupmode", Namespace::inkscape) == "layer";
}

std::string layer_name(const Element& group) {
  const std::string_view label = group.get("label", Namespace::inkscape);
  return std::string(label.empty() ? group.id() : label);
}

/// Conditions of <switch>: no extension is known here; of the languages English is taken.
bool conditions_met(const Element& element, bool in_switch) {
  if (element.has("requiredExtensions")) return false;
  if (!in_switch || !element.has("systemLanguage")) return true;
  const std::string languages = "," + to_lower(element.get("systemLanguage").substr(0, 1000));
  return languages.find(",en") != std::string::npos || languages.find(", en") != std::string::npos;
}

}  // namespace

Walker::Walker(const Document& document, const Page& page, const ReadOptions& options,
               Diagnostics& diagnostics)
    : document_(document),
      page_(page),
      options_(options),
      diagnostics_(diagnostics),
      styles_(document),
      active_(document.elements.size(), 0) {
  work_left_ = options.max_entities + document.elements.size() + document.byte_count / kBytesPerUnit;
}

Result<Drawing> Walker::run() {
  drawing_.mm_per_unit = page_.mm_per_unit;
  drawing_.units_reason = page_.reason;
  declare_layers();
  Context context;
  context.map = page_.to_mm;
  context.viewport = page_.viewport;
  auto root = enter(0, context);
  if (!root) return root.error();
  root->depth = 0;
  if (auto done = visit_children(0, *root); !done) return done.error();
  report_summary();
  drawing_.layers.assign(layers_.begin(), layers_.end());
  return std::move(drawing_);
}

void Walker::declare_layers() {
  for (const Element& element : document_.elements) {
    if (is_inkscape_layer(element) && !layer_name(element).empty()) layers_.insert(layer_name(element));
  }
}

Error Walker::located(Error error, const Element& element) const {
  if (error.where == Where{}) error.where = where(element);
  return error;
}

Result<void> Walker::charge(const Element& element) {
  const std::size_t cost = 1 + element.attribute_bytes / kBytesPerUnit;
  if (cost > work_left_) {
    return Error{ErrorCode::range,
                 "more elements after the expansion of <use> than the limit of " +
                     std::to_string(options_.max_entities),
                 where(element)};
  }
  work_left_ -= cost;
  return {};
}

Result<Walker::Context> Walker::enter(int index, const Context& outer) {
  const Element& element = at(index);
  auto style = styles_.of(index, outer.style);
  if (!style) return located(std::move(style).error(), element);
  Context context = outer;
  ++context.depth;
  context.style = style->inherited;
  context.hidden = outer.hidden || !style->displayed;
  if (style->clipped && !context.hidden) ++clipped_;
  if (style->transform && !context.hidden) {
    auto map = parse_transform(*style->transform);
    if (!map) return located(std::move(map).error(), element);
    Affine2 local = *map;
    if (style->transform_origin) {
      const auto origin = parse_origin(*style->transform_origin, page_.px_per_inch, outer.viewport);
      if (!origin) {
        return Error{ErrorCode::unsupported, "transform-origin (two lengths or keywords are accepted)",
                     where(element)};
      }
      local = Affine2{1, 0, 0, 1, origin->x, origin->y} * local * Affine2{1, 0, 0, 1, -origin->x, -origin->y};
    }
    context.map = outer.map * local;
  }
  return context;
}

Result<void> Walker::visit(int index, const Context& outer, const UseSize* use_size) {
  const Element& element = at(index);
  if (auto paid = charge(element); !paid) return paid;
  if (element.ns != Namespace::svg || !conditions_met(element, false)) return {};
  const bool as_use_target = use_size != nullptr;
  if (contains(kDefinitions, element.name) && !(as_use_target && element.name == "symbol")) return {};
  if (outer.depth >= options_.max_depth) {
    return Error{ErrorCode::range,
                 "elements nested deeper than the limit of " + std::to_string(options_.max_depth) +
                     " (flatter groups are accepted)",
                 where(element)};
  }
  auto entered = enter(index, outer);
  if (!entered) return entered.error();
  Context context = std::move(*entered);
  if (is_shape(element)) return draw(index, context);
  if (element.name == "use") return visit_use(index, context);
  if (element.name == "switch") return visit_switch(index, context);
  if (element.name == "svg" || element.name == "symbol") {
    if (auto done = enter_viewport(index, context, use_size); !done) return done;
    return visit_children(index, context);
  }
  if (contains(kContainers, element.name)) {
    if (element.name == "g") enter_group(element, context);
    return visit_children(index, context);
  }
  // text, image, foreignObject and whatever else browsers may draw: nothing to cut.
  ignore(element, context.hidden ? "hidden" : nullptr);
  return {};
}

void Walker::enter_group(const Element& element, Context& context) {
  if (is_inkscape_layer(element)) {
    context.layer = layer_name(element);
    context.in_layer = true;
  } else if (!context.in_layer && !context.in_group) {
    context.layer = layer_name(element);
  }
  context.in_group = true;
}

Result<void> Walker::visit_children(int index, const Context& context) {
  for (int child = at(index).first_child; child >= 0; child = at(child).next_sibling) {
    if (auto done = visit(child, context); !done) return done;
  }
  return {};
}

Result<void> Walker::visit_switch(int index, const Context& context) {
  for (int child = at(index).first_child; child >= 0; child = at(child).next_sibling) {
    if (at(child).ns == Namespace::svg && conditions_met(at(child), true)) return visit(child, context);
    if (auto paid = charge(at(child)); !paid) return paid;
  }
  return {};
}

/// A nested <svg>, or a <symbol> drawn by <use>: its own coordinate system in a rectangle of the outer one.
Result<void> Walker::enter_viewport(int index, Context& context, const UseSize* use_size) {
  if (context.hidden) return {};
  const Element& element = at(index);
  const Viewport outer = context.viewport;
  const std::string_view box_text = trim(element.get("viewBox"));
  const auto box = parse_view_box(box_text);
  if (!box_text.empty() && !box) {
    return Error{ErrorCode::syntax, "viewBox (four numbers, width and height above 0, are accepted)",
                 where(element)};
  }
  // The size of <use> goes before the own one. Without any: all of the outer viewport, or the viewBox as it
  // is where that is not known.
  const auto size = [&](std::string_view name, Axis axis, std::string_view given, double whole,
                        double of_box) {
    const bool by_use = !given.empty() && given != "auto";
    return frame(context).read_text(by_use ? given : element.get(name), name, axis,
                                    outer.known ? whole : of_box);
  };
  const UseSize none;
  const UseSize& given = use_size == nullptr ? none : *use_size;
  const auto width = size("width", Axis::x, given.width, outer.width, box ? box->width : 0);
  if (!width) return located(width.error(), element);
  const auto height = size("height", Axis::y, given.height, outer.height, box ? box->height : 0);
  if (!height) return located(height.error(), element);
  double corner[2] = {0, 0};
  if (element.name == "svg") {
    const auto x = frame(context).read(element, "x", Axis::x, 0);
    if (!x) return located(x.error(), element);
    const auto y = frame(context).read(element, "y", Axis::y, 0);
    if (!y) return located(y.error(), element);
    corner[0] = *x;
    corner[1] = *y;
  }
  if (*width < 0 || *height < 0) {
    return Error{ErrorCode::range, "negative width or height (0 or more is accepted)", where(element)};
  }
  if (box) {
    const AspectRatio ratio = parse_aspect_ratio(element.get("preserveAspectRatio"));
    context.map = context.map * view_box_map(*box, corner[0], corner[1], *width, *height, ratio);
    context.viewport = {box->width, box->height, true};
  } else {
    context.map = context.map * Affine2{1, 0, 0, 1, corner[0], corner[1]};
    context.viewport = {*width, *height, *width > 0 && *height > 0};
  }
  return {};
}

Result<void> Walker::visit_use(int index, const Context& context) {
  const Element& element = at(index);
  if (context.hidden) return ignore(element, "hidden"), Result<void>();
  const std::string_view href = trim(element.href());
  const int target = href.starts_with('#') ? document_.find(href.substr(1)) : -1;
  if (target < 0) {
    const bool other_file = !href.empty() && href[0] != '#';
    left_out_limited("missing_reference",
                     "<use> of '" + std::string(href.substr(0, 80)) + "' " +
                         (other_file ? "refers to another file" : "refers to nothing in this file") +
                         "; not drawn",
                     element);
    return {};
  }
  char& active = active_[static_cast<std::size_t>(target)];
  if (active != 0) {
    return Error{
        ErrorCode::syntax,
        "<use> draws itself through '" + std::string(href.substr(0, 80)) + "' (a reference without a circle)",
        where(element)};
  }
  const auto x = frame(context).read(element, "x", Axis::x, 0);
  if (!x) return located(x.error(), element);
  const auto y = frame(context).read(element, "y", Axis::y, 0);
  if (!y) return located(y.error(), element);
  Context inner = context;
  inner.map = context.map * Affine2{1, 0, 0, 1, *x, *y};
  inner.in_group = true;
  inner.id_prefix += std::string(element.id().empty() ? element.name : element.id()) + "/";
  const UseSize size{trim(element.get("width")), trim(element.get("height"))};
  active = 1;
  auto done = visit(target, inner, &size);
  active_[static_cast<std::size_t>(target)] = 0;
  return done;
}

Result<void> Walker::draw(int index, const Context& context) {
  const Element& element = at(index);
  if (context.hidden || !context.style.visible) return ignore(element, "hidden"), Result<void>();
  if (drawing_.entities.size() >= options_.max_entities) {
    return Error{ErrorCode::range, "more entities than the limit of " + std::to_string(options_.max_entities),
                 where(element)};
  }
  if (context.map.determinant() == 0) return ignore(element, "flattened by its transform"), Result<void>();
  // As many curves as entities: both cost the same order of memory.
  auto outline = outline_of(element, frame(context),
                            options_.max_entities - std::min(curve_count_, options_.max_entities));
  if (!outline) return located(std::move(outline).error(), element);
  auto placed = place_outline(context.map, std::move(outline->paths));
  if (!placed) return located(std::move(placed).error(), element);
  if (outline->points_dropped > 0 || placed->dropped) {
    info_limited("zero_length", "a piece without length was left out of " + element.label(), element);
  }
  if (placed->paths.empty()) return {};
  curve_count_ += placed->curve_count;
  if (!context.style.painted()) ++unpainted_;
  Entity entity;
  entity.kind = element.name;
  entity.id = context.id_prefix +
              std::string(context.id_prefix.empty() || !element.id().empty() ? element.id() : element.name);
  entity.line = element.line;
  entity.layer = context.layer;
  entity.color = context.style.entity_color();
  entity.paths = std::move(placed->paths);
  if (!entity.layer.empty()) layers_.insert(entity.layer);
  drawing_.entities.push_back(std::move(entity));
  return {};
}

void Walker::ignore(const Element& element, const char* why) {
  ++drawing_.ignored[std::string(element.name) + (why == nullptr ? "" : std::string(" (") + why + ")")];
}

bool Walker::within_limit(const std::string& code) {
  return ++warned_[code] <= kMaxWarnings;
}

void Walker::info_limited(const std::string& code, const std::string& message, const Element& element) {
  if (within_limit(code)) diagnostics_.info(code, message, where(element));
}

void Walker::left_out_limited(const std::string& code, const std::string& message, const Element& element) {
  if (within_limit(code)) diagnostics_.left_out(code, message, where(element));
}

void Walker::report_summary() {
  const Where file{options_.file_name, 0, 0, {}};
  for (const auto& [code, count] : warned_) {
    if (count > kMaxWarnings) {
      diagnostics_.info(code, std::to_string(count - kMaxWarnings) + " more warnings of this kind", file);
    }
  }
  if (unpainted_ > 0) {
    diagnostics_.info("not_painted",
                      std::to_string(unpainted_) + " elements have neither stroke nor fill; they were read",
                      file);
  }
  if (clipped_ > 0) {
    diagnostics_.info(
        "clip_ignored",
        std::to_string(clipped_) + " clip paths or masks were not applied: their contents were read in full",
        file);
  }
  if (styles_.skipped_rules() > 0) {
    diagnostics_.info("css_skipped",
                      std::to_string(styles_.skipped_rules()) +
                          " rules of the style sheet use selectors or @-rules that are not applied",
                      file);
  }
}

}  // namespace burin::io::svg
