// SPDX-License-Identifier: Apache-2.0
// Goes through the elements that are drawn, with transforms, styles and use expanded.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/io/drawing/drawing.h"
#include "burin/io/svg/document.h"
#include "burin/io/svg/page.h"
#include "burin/io/svg/shapes.h"
#include "burin/io/svg/style.h"

namespace burin::io::svg {

class Walker {
 public:
  Walker(const Document& document, const Page& page, const ReadOptions& options, Diagnostics& diagnostics);
  Result<Drawing> run();

 private:
  /// What an element gets from those around it.
  struct Context {
    geom::Affine2 map;  // user units -> mm
    InheritedStyle style;
    Viewport viewport;
    std::string layer;
    std::string id_prefix;  // ids of the <use> elements on the way
    bool in_layer = false;  // an Inkscape layer has named `layer`
    bool in_group = false;  // a top-level group has been entered
    bool hidden = false;    // below display:none: counted, not drawn
    int depth = 0;
  };
  /// Size that a <use> gives to the <symbol> or <svg> it draws; empty texts mean none.
  struct UseSize {
    std::string_view width, height;
  };

  Result<void> visit(int index, const Context& outer, const UseSize* use_size = nullptr);
  Result<void> visit_children(int index, const Context& context);
  Result<void> visit_switch(int index, const Context& context);
  Result<void> visit_use(int index, const Context& context);
  Result<void> enter_viewport(int index, Context& context, const UseSize* use_size);
  Result<Context> enter(int index, const Context& outer);
  void enter_group(const Element& element, Context& context);
  Result<void> draw(int index, const Context& context);
  Result<void> charge(const Element& element);
  void declare_layers();
  void report_summary();
  void info_limited(const std::string& code, const std::string& message, const Element& element);
  void left_out_limited(const std::string& code, const std::string& message, const Element& element);
  bool within_limit(const std::string& code);
  void ignore(const Element& element, const char* why);

  const Element& at(int index) const { return document_.elements[static_cast<std::size_t>(index)]; }
  Where where(const Element& element) const { return {options_.file_name, element.line, 0, element.label()}; }
  Error located(Error error, const Element& element) const;
  LengthFrame frame(const Context& context) const { return {page_.px_per_inch, context.viewport}; }

  const Document& document_;
  const Page& page_;
  const ReadOptions& options_;
  Diagnostics& diagnostics_;
  Styles styles_;
  Drawing drawing_;
  std::set<std::string> layers_;
  std::vector<char> active_;  // targets of the <use> elements that are being drawn
  std::map<std::string, int> warned_;
  std::size_t curve_count_ = 0;
  std::size_t work_left_ = 0;
  int unpainted_ = 0, clipped_ = 0;
};

}  // namespace burin::io::svg
