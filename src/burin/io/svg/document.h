// SPDX-License-Identifier: Apache-2.0
// An SVG document as a flat list of elements with resolved namespaces, free of the XML library.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/io/drawing/drawing.h"

namespace burin::io::svg {

enum class Namespace { none, svg, xlink, inkscape, sodipodi, xml, other };

struct Attribute {
  Namespace ns = Namespace::none;
  std::string_view name;  ///< without prefix
  std::string_view value;
};

/// Elements stand in document order; -1 means none.
struct Element {
  Namespace ns = Namespace::svg;
  std::string_view name;  ///< without prefix: "path"
  int parent = -1, first_child = -1, next_sibling = -1;
  int line = 0;
  std::vector<Attribute> attributes;
  std::size_t attribute_bytes = 0;  ///< measure of the work that a visit costs

  /// "" when it is not there.
  std::string_view get(std::string_view attribute, Namespace ns_of = Namespace::none) const;
  bool has(std::string_view attribute, Namespace ns_of = Namespace::none) const;
  bool is(std::string_view svg_name) const { return ns == Namespace::svg && name == svg_name; }
  std::string_view id() const { return get("id"); }
  /// href, or xlink:href of SVG 1.1.
  std::string_view href() const;
  /// "path#outline", or "path".
  std::string label() const;
};

struct Document {
  std::vector<Element> elements;  ///< [0] is the root <svg>
  std::unordered_map<std::string_view, int> by_id;
  std::vector<std::string> style_texts;  ///< contents of <style> elements in document order
  bool made_by_illustrator = false;
  std::size_t byte_count = 0;

  /// Element of the id, -1 when there is none.
  int find(std::string_view id) const;

  std::shared_ptr<void> xml;         ///< owns the texts that the views point into
  std::deque<std::string> expanded;  ///< attribute values after the expansion of entities
};

/// Errors: syntax with line and column (not well-formed XML, no <svg> root), unsupported (compressed, drawing
/// parts inside entities), range (entity bombs; more elements than the limits allow: the memory of the XML
/// tree is several times the size of the file).
Result<Document> parse_document(std::string_view bytes, const ReadOptions& options, Diagnostics& diagnostics);

}  // namespace burin::io::svg
