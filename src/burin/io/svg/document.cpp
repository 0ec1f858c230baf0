// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/document.h"

#include <algorithm>
#include <cstring>
#include <pugixml.hpp>
#include <utility>

#include "burin/io/svg/doctype.h"
#include "burin/io/svg/encoding.h"

namespace burin::io::svg {
namespace {

Namespace namespace_of_uri(std::string_view uri) {
  if (uri == "http://www.w3.org/2000/svg") return Namespace::svg;
  if (uri == "http://www.w3.org/1999/xlink") return Namespace::xlink;
  if (uri == "http://www.inkscape.org/namespaces/inkscape") return Namespace::inkscape;
  if (uri.empty()) return Namespace::svg;  // xmlns="" of hand-written files
  if (uri.find("sodipodi.sourceforge.net") != std::string_view::npos) return Namespace::sodipodi;
  return Namespace::other;
}

/// What a prefix means when nothing declares it: programs that write fragments forget the declarations.
Namespace namespace_of_undeclared(std::string_view prefix) {
  if (prefix.empty() || prefix == "svg") return Namespace::svg;
  if (prefix == "xlink") return Namespace::xlink;
  if (prefix == "inkscape") return Namespace::inkscape;
  if (prefix == "sodipodi") return Namespace::sodipodi;
  if (prefix == "xml") return Namespace::xml;
  return Namespace::other;
}

std::pair<std::string_view, std::string_view> split_name(std::string_view name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos) return {{}, name};
  return {name.substr(0, colon), name.substr(colon + 1)};
}

/// Byte offset -> line and column.
class LineTable {
 public:
  explicit LineTable(std::string_view text) {
    starts_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') starts_.push_back(i + 1);
    }
  }
  int line(std::size_t offset) const {
    return static_cast<int>(std::upper_bound(starts_.begin(), starts_.end(), offset) - starts_.begin());
  }
  int column(std::size_t offset) const {
    return static_cast<int>(offset - starts_[static_cast<std::size_t>(line(offset)) - 1]) + 1;
  }

 private:
  std::vector<std::size_t> starts_;
};

/// Copies the tree of the XML library into the flat list, without recursion: files may nest as deep as they
/// like.
class Converter {
 public:
  Converter(Document& document, std::string_view text, std::string file, Diagnostics& diagnostics)
      : document_(document), lines_(text), file_(std::move(file)), diagnostics_(diagnostics) {}

  Result<void> run(const pugi::xml_document& xml) {
    for (const pugi::xml_node node : xml.children()) {
      if (auto done = top_level(node); !done) return done;
    }
    if (document_.elements.empty()) return fail(0, "no <svg> element (an SVG file is accepted)");
    return {};
  }

  Error fail_at(std::size_t offset, const std::string& message) const {
    return {ErrorCode::syntax, message, {file_, lines_.line(offset), lines_.column(offset), {}}};
  }

 private:
  Error fail(std::ptrdiff_t offset, const std::string& message) const {
    return fail_at(offset > 0 ? static_cast<std::size_t>(offset) : 0, message);
  }

  Result<void> top_level(pugi::xml_node node) {
    switch (node.type()) {
      case pugi::node_comment:
        note_comment(node, true);
        return {};
      case pugi::node_doctype:
        entities_ = InternalEntities::from_doctype(node.value());
        return {};
      case pugi::node_element:
        if (!document_.elements.empty())
          return fail(node.offset_debug(), "a second root element (one <svg> is accepted)");
        return convert(node);
      default:
        return {};
    }
  }

  /// The generator comment counts at the top only: pasted drawings bring theirs along further down.
  void note_comment(pugi::xml_node node, bool at_top) {
    if (at_top && std::strstr(node.value(), "Generator: Adobe Illustrator") != nullptr) {
      document_.made_by_illustrator = true;
    }
    if (std::strstr(node.value(), "--") != nullptr && !warned_comment_) {
      warned_comment_ = true;
      const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
      diagnostics_.info("malformed_xml", "'--' inside a comment is not well-formed XML; read as browsers do",
                        {file_, lines_.line(offset), lines_.column(offset), {}});
    }
  }

  Result<void> convert(pugi::xml_node root) {
    pugi::xml_node node = root;
    int parent = -1;
    last_child_.clear();
    while (node) {
      int index = -1;
      if (node.type() == pugi::node_element) {
        auto added = add_element(node, parent);
        if (!added) return added.error();
        index = *added;
      } else if (auto done = other_node(node, parent); !done) {
        return done;
      }
      if (index >= 0 && node.first_child()) {
        parent = index;
        node = node.first_child();
        continue;
      }
      if (index >= 0) leave(index);
      while (node != root && !node.next_sibling()) {
        node = node.parent();
        leave(parent);
        parent = document_.elements[static_cast<std::size_t>(parent)].parent;
      }
      if (node == root) break;
      node = node.next_sibling();
    }
    if (!document_.elements[0].is("svg")) {
      return fail(root.offset_debug(),
                  "the root element is <" + std::string(root.name()) + "> (an <svg> is accepted)");
    }
    return {};
  }

  Result<void> other_node(pugi::xml_node node, int parent) {
    if (node.type() == pugi::node_comment) note_comment(node, parent == 0);
    if (node.type() != pugi::node_pcdata && node.type() != pugi::node_cdata) return {};
    const Element& element = document_.elements[static_cast<std::size_t>(parent)];
    if (element.is("style")) {
      style_of(parent).append(node.value());
    } else if (!entities_.empty() && entities_.refers_to_markup(node.value())) {
      return Error{ErrorCode::unsupported,
                   "an entity of the DOCTYPE holds elements (entities are taken in attributes only)",
                   {file_, element.line, 0, element.label()}};
    }
    return {};
  }

  std::string& style_of(int element) {
    if (style_element_ != element) document_.style_texts.emplace_back();
    style_element_ = element;
    return document_.style_texts.back();
  }

  Result<int> add_element(pugi::xml_node node, int parent) {
    const int index = static_cast<int>(document_.elements.size());
    Element element;
    element.parent = parent;
    const std::ptrdiff_t offset = node.offset_debug();
    element.line = offset >= 0 ? lines_.line(static_cast<std::size_t>(offset)) : 0;
    for (const pugi::xml_attribute attribute : node.attributes()) {
      auto value = expanded(attribute.value());
      if (!value) return Error{value.error().code, value.error().message, {file_, element.line, 0, {}}};
      element.attributes.push_back({Namespace::none, attribute.name(), *value});
      element.attribute_bytes += element.attributes.back().name.size() + value->size();
    }
    declare_namespaces(element, index);
    resolve_names(element, node.name());
    if (auto twice = duplicate(element); !twice.empty()) {
      return fail(offset,
                  "attribute '" + std::string(twice) + "' twice in <" + std::string(element.name) + ">");
    }
    link(element, index);
    document_.elements.push_back(std::move(element));
    return index;
  }

  Result<std::string_view> expanded(const char* value) {
    const std::string_view text(value);
    if (entities_.empty() || text.find('&') == std::string_view::npos) return text;
    auto done = entities_.expand(text);
    if (!done) return done.error();
    if (*done == text) return text;
    document_.expanded.push_back(std::move(*done));
    return std::string_view(document_.expanded.back());
  }

  void declare_namespaces(const Element& element, int index) {
    for (const Attribute& attribute : element.attributes) {
      const auto [prefix, name] = split_name(attribute.name);
      const bool default_one = prefix.empty() && name == "xmlns";
      if (prefix != "xmlns" && !default_one) continue;
      const std::string_view bound = default_one ? std::string_view{} : name;
      bindings_[bound].push_back({index, namespace_of_uri(attribute.value)});
      declared_.push_back({index, bound});
      if (attribute.value.starts_with("http://ns.adobe.com/AdobeIllustrator/"))
        document_.made_by_illustrator = true;
    }
  }

  Namespace lookup(std::string_view prefix) const {
    const auto found = bindings_.find(prefix);
    if (found == bindings_.end() || found->second.empty()) return namespace_of_undeclared(prefix);
    return found->second.back().second;
  }

  void resolve_names(Element& element, std::string_view full_name) {
    const auto [prefix, name] = split_name(full_name);
    element.ns = lookup(prefix);
    element.name = name;
    for (Attribute& attribute : element.attributes) {
      const auto [attribute_prefix, attribute_name] = split_name(attribute.name);
      if (attribute_prefix.empty()) continue;
      attribute.ns = attribute_prefix == "xmlns" ? Namespace::other : lookup(attribute_prefix);
      // svg:d on an SVG element is no attribute of SVG.
      if (attribute.ns == Namespace::svg) attribute.ns = Namespace::other;
      if (attribute.ns != Namespace::other) attribute.name = attribute_name;
    }
  }

  /// Name of an attribute that stands twice, "" when none does.
  static std::string_view duplicate(const Element& element) {
    std::vector<std::pair<Namespace, std::string_view>> names;
    names.reserve(element.attributes.size());
    for (const Attribute& attribute : element.attributes) names.emplace_back(attribute.ns, attribute.name);
    std::sort(names.begin(), names.end());
    const auto twice = std::adjacent_find(names.begin(), names.end());
    return twice == names.end() ? std::string_view{} : twice->second;
  }

  void link(const Element& element, int index) {
    if (element.parent >= 0) {
      Element& parent = document_.elements[static_cast<std::size_t>(element.parent)];
      int& last = last_child_[static_cast<std::size_t>(element.parent)];
      if (last < 0) {
        parent.first_child = index;
      } else {
        document_.elements[static_cast<std::size_t>(last)].next_sibling = index;
      }
      last = index;
    }
    last_child_.push_back(-1);
    if (!element.id().empty()) document_.by_id.emplace(element.id(), index);
  }

  /// Ends the scope of the namespaces that the element declared.
  void leave(int index) {
    while (!declared_.empty() && declared_.back().first == index) {
      bindings_[declared_.back().second].pop_back();
      declared_.pop_back();
    }
  }

  Document& document_;
  LineTable lines_;
  std::string file_;
  Diagnostics& diagnostics_;
  InternalEntities entities_;
  std::vector<int> last_child_;  // by element
  std::unordered_map<std::string_view, std::vector<std::pair<int, Namespace>>> bindings_;
  std::vector<std::pair<int, std::string_view>> declared_;
  int style_element_ = -1;
  bool warned_comment_ = false;
};

/// Bounds the XML tree before it is built, by the characters that every node and every attribute needs.
Result<void> check_size(std::string_view text, std::size_t max_entities) {
  constexpr std::size_t kTagsPerEntity = 4;  // start and end of the element, and as much beside it
  constexpr std::size_t kAttributesPerEntity = 20;
  constexpr std::size_t kFree = 10'000;  // metadata and definitions of a small drawing
  const auto tags = static_cast<std::size_t>(std::count(text.begin(), text.end(), '<'));
  const auto attributes = static_cast<std::size_t>(std::count(text.begin(), text.end(), '='));
  if (tags > kFree + kTagsPerEntity * max_entities ||
      attributes > kFree + kAttributesPerEntity * max_entities) {
    return Error{
        ErrorCode::range,
        "more elements or attributes than the limit of " + std::to_string(max_entities) + " entities allows",
        {}};
  }
  return {};
}

}  // namespace

std::string_view Element::get(std::string_view attribute, Namespace ns_of) const {
  for (const Attribute& a : attributes) {
    if (a.ns == ns_of && a.name == attribute) return a.value;
  }
  return {};
}

bool Element::has(std::string_view attribute, Namespace ns_of) const {
  return std::any_of(attributes.begin(), attributes.end(),
                     [&](const Attribute& a) { return a.ns == ns_of && a.name == attribute; });
}

std::string_view Element::href() const {
  const std::string_view plain = get("href");
  return plain.empty() ? get("href", Namespace::xlink) : plain;
}

std::string Element::label() const {
  return id().empty() ? std::string(name) : std::string(name) + "#" + std::string(id());
}

int Document::find(std::string_view id) const {
  const auto found = by_id.find(id);
  return found == by_id.end() ? -1 : found->second;
}

Result<Document> parse_document(std::string_view bytes, const ReadOptions& options,
                                Diagnostics& diagnostics) {
  auto text = to_utf8(bytes);
  if (!text) {
    Error error = std::move(text).error();
    error.where.file = options.file_name;
    return error;
  }
  if (auto small = check_size(*text, options.max_entities); !small) {
    return Error{small.error().code, small.error().message, {options.file_name, 0, 0, {}}};
  }
  Document document;
  document.byte_count = text->size();
  auto xml = std::make_shared<pugi::xml_document>();
  constexpr unsigned kFlags = pugi::parse_default | pugi::parse_comments | pugi::parse_doctype;
  const pugi::xml_parse_result parsed =
      xml->load_buffer(text->data(), text->size(), kFlags, pugi::encoding_utf8);
  Converter converter(document, *text, options.file_name, diagnostics);
  if (!parsed) {
    const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0));
    return converter.fail_at(std::min(offset, text->size()),
                             std::string("not well-formed XML: ") + parsed.description());
  }
  if (auto done = converter.run(*xml); !done) return done.error();
  document.xml = std::move(xml);
  return document;
}

}  // namespace burin::io::svg
