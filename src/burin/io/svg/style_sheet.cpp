// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/style_sheet.h"

#include <algorithm>

#include "burin/base/text.h"
#include "burin/io/svg/scanner.h"

namespace burin::io::svg {
namespace {

/// Compound tests that a sheet may ask for: a base, and as many for each element as fifty rules of its name
/// cost.
constexpr std::int64_t kBaseWork = 2'000'000;
constexpr std::int64_t kWorkPerElement = 50;
constexpr std::size_t kMaxCompounds = 16;

struct PropertyName {
  std::string_view name;
  Property property;
};
constexpr PropertyName kProperties[kPropertyCount] = {
    {"color", Property::color},
    {"stroke", Property::stroke},
    {"fill", Property::fill},
    {"display", Property::display},
    {"visibility", Property::visibility},
    {"transform", Property::transform},
    {"transform-origin", Property::transform_origin},
    {"clip-path", Property::clip_path},
    {"mask", Property::mask},
};

std::string without_comments(std::string_view text) {
  std::string out;
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t open = text.find("/*", i);
    out.append(text.substr(i, open == std::string_view::npos ? open : open - i));
    if (open == std::string_view::npos) break;
    const std::size_t close = text.find("*/", open + 2);
    if (close == std::string_view::npos) break;
    out.push_back(' ');
    i = close + 2;
  }
  return out;
}

/// First of `stops` outside quotes and parentheses from `i` on, or the size.
std::size_t find_outside(std::string_view text, std::string_view stops, std::size_t i) {
  char quote = '\0';
  int depth = 0;
  for (; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != '\0') {
      if (c == '\\')
        ++i;
      else if (c == quote)
        quote = '\0';
    } else if (depth <= 0 && stops.find(c) != std::string_view::npos) {
      return i;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '(') {
      ++depth;
    } else if (c == ')') {
      --depth;
    }
  }
  return text.size();
}

/// One past the '}' that closes the '{' at `open`.
std::size_t block_end(std::string_view text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    i = find_outside(text, "{}", i);
    if (i >= text.size()) break;
    depth += text[i] == '{' ? 1 : -1;
    if (depth == 0) return i + 1;
  }
  return text.size();
}

bool is_name_char(char c) {
  return is_letter(c) || is_digit(c) || c == '-' || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

std::string_view name_at(std::string_view text, std::size_t& i) {
  const std::size_t from = i;
  while (i < text.size() && is_name_char(text[i])) ++i;
  return text.substr(from, i - from);
}

bool has_word(std::string_view list, std::string_view word) {
  for (std::size_t i = list.find(word); i != std::string_view::npos; i = list.find(word, i + 1)) {
    const std::size_t end = i + word.size();
    if ((i == 0 || is_blank(list[i - 1])) && (end == list.size() || is_blank(list[end]))) return true;
  }
  return false;
}

}  // namespace

std::optional<Property> property_of(std::string_view name) {
  for (const PropertyName& p : kProperties) {
    if (p.name == name) return p.property;
  }
  return std::nullopt;
}

std::vector<Declaration> parse_declarations(std::string_view text) {
  std::vector<Declaration> declarations;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = find_outside(text, ";", i);
    const std::string_view one = text.substr(i, end - i);
    i = end + 1;
    const std::size_t colon = one.find(':');
    if (colon > 256) continue;  // none (npos), or longer than any property
    const auto property = property_of(to_lower(trim(one.substr(0, colon))));
    if (!property) continue;
    std::string_view value = trim(one.substr(colon + 1));
    bool important = false;
    if (const std::size_t mark = value.rfind('!'); mark != std::string_view::npos) {
      important = to_lower(trim(value.substr(mark + 1))) == "important";
      if (important) value = trim(value.substr(0, mark));
    }
    if (!value.empty()) declarations.push_back({*property, value, important});
  }
  return declarations;
}

void CascadedStyle::apply(const Declaration& declaration, int origin, std::uint32_t specificity) {
  Slot& slot = slots_[static_cast<std::size_t>(declaration.property)];
  const std::uint64_t rank =
      (declaration.important ? 1ull << 40 : 0) + (static_cast<std::uint64_t>(origin) << 32) + specificity + 1;
  if (rank < slot.rank) return;
  slot = {declaration.value, rank};
}

StyleSheet::StyleSheet(const Document& document) : document_(document), work_left_(kBaseWork) {
  work_left_ += kWorkPerElement * static_cast<std::int64_t>(document.elements.size());
  texts_.reserve(document.style_texts.size());  // the rules hold views into the texts
  for (const std::string& text : document.style_texts) {
    texts_.push_back(without_comments(text));
    parse(texts_.back());
  }
  for (std::size_t i = 0; i < selectors_.size(); ++i) index_selector(static_cast<int>(i));
}

void StyleSheet::parse(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    while (i < text.size() && (is_blank(text[i]) || text[i] == '}')) ++i;
    if (text.substr(i).starts_with("<!--") || text.substr(i).starts_with("-->")) {
      i += text[i] == '<' ? 4 : 3;
      continue;
    }
    if (i >= text.size()) break;
    if (text[i] == '@') {
      ++skipped_;
      const std::size_t stop = find_outside(text, ";{", i);
      i = stop < text.size() && text[stop] == '{' ? block_end(text, stop) : stop + 1;
      continue;
    }
    const std::size_t open = find_outside(text, "{", i);
    if (open >= text.size()) break;
    const std::size_t end = block_end(text, open);
    const std::size_t inner = end > open + 1 ? end - open - 2 : 0;
    add_rule(text.substr(i, open - i), text.substr(open + 1, text[end - 1] == '}' ? inner : inner + 1));
    i = end;
  }
}

void StyleSheet::add_rule(std::string_view selectors, std::string_view body) {
  auto declarations = parse_declarations(body);
  if (declarations.empty()) return;
  const int rule = static_cast<int>(rules_.size());
  rules_.push_back(std::move(declarations));
  for (std::size_t i = 0; i <= selectors.size();) {
    const std::size_t end = find_outside(selectors, ",", i);
    Selector selector;
    selector.rule = rule;
    selector.order = static_cast<int>(selectors_.size());
    if (parse_selector(trim(selectors.substr(i, end - i)), selector)) {
      selectors_.push_back(std::move(selector));
    } else {
      ++skipped_;
    }
    i = end + 1;
  }
}

bool StyleSheet::parse_selector(std::string_view text, Selector& selector) const {
  bool child = false;
  for (std::size_t i = 0; i < text.size();) {
    if (is_blank(text[i])) {
      ++i;
      continue;
    }
    if (text[i] == '>') {
      if (child || selector.compounds.empty()) return false;
      child = true;
      ++i;
      continue;
    }
    const std::size_t from = i;
    bool in_brackets = false;
    while (i < text.size() && (in_brackets || (!is_blank(text[i]) && text[i] != '>'))) {
      if (text[i] == '[') in_brackets = true;
      if (text[i] == ']') in_brackets = false;
      ++i;
    }
    Compound compound;
    compound.child_of_previous = child;
    child = false;
    if (selector.compounds.size() >= kMaxCompounds) return false;
    if (!parse_compound(text.substr(from, i - from), compound, selector.specificity)) return false;
    selector.compounds.push_back(std::move(compound));
  }
  return !child && !selector.compounds.empty();
}

/// Specificity as CSS counts it: ids, then classes and attributes, then elements, a byte each.
bool StyleSheet::parse_compound(std::string_view text, Compound& compound, std::uint32_t& specificity) {
  std::size_t i = 0;
  if (text.starts_with('*')) {
    ++i;
  } else if (const std::string_view name = name_at(text, i); !name.empty()) {
    compound.element = name;
    specificity += 1;
  }
  while (i < text.size()) {
    const char kind = text[i++];
    if (kind == '[') {
      const std::size_t end = text.find(']', i);
      if (end == std::string_view::npos) return false;
      const std::string_view test = text.substr(i, end - i);
      const std::size_t equals = test.find('=');
      AttributeTest attribute{trim(test.substr(0, equals)), std::nullopt};
      if (equals != std::string_view::npos) {
        std::string_view value = trim(test.substr(equals + 1));
        if (value.size() >= 2 && (value[0] == '"' || value[0] == '\''))
          value = value.substr(1, value.size() - 2);
        attribute.value = value;
      }
      // ~=, |=, ^=, $= and *= leave their sign at the end of the name.
      if (attribute.name.empty() || !is_name_char(attribute.name.back())) return false;
      compound.attributes.push_back(attribute);
      specificity += 1u << 8;
      i = end + 1;
      continue;
    }
    if (kind != '.' && kind != '#') return false;
    const std::string_view name = name_at(text, i);
    if (name.empty()) return false;
    (kind == '.' ? compound.classes : compound.ids).push_back(name);
    specificity += kind == '.' ? 1u << 8 : 1u << 16;
  }
  return true;
}

/// Filed under the rarest key of the last compound, so that an element meets only the rules that may concern
/// it.
void StyleSheet::index_selector(int selector) {
  const Compound& last = selectors_[static_cast<std::size_t>(selector)].compounds.back();
  if (!last.ids.empty()) {
    by_id_[last.ids[0]].push_back(selector);
  } else if (!last.classes.empty()) {
    by_class_[last.classes[0]].push_back(selector);
  } else if (!last.element.empty()) {
    by_element_[last.element].push_back(selector);
  } else {
    universal_.push_back(selector);
  }
}

void StyleSheet::collect(const std::unordered_map<std::string_view, std::vector<int>>& index,
                         std::string_view key, std::vector<int>& out) const {
  const auto found = index.find(key);
  if (found != index.end()) out.insert(out.end(), found->second.begin(), found->second.end());
}

Result<void> StyleSheet::apply(int element, CascadedStyle& style) {
  std::vector<int> candidates = universal_;
  collect(by_element_, at(element).name, candidates);
  if (!at(element).id().empty()) collect(by_id_, at(element).id(), candidates);
  const std::string_view classes = at(element).get("class");
  for (std::size_t i = 0; i < classes.size();) {
    while (i < classes.size() && is_blank(classes[i])) ++i;
    const std::size_t from = i;
    while (i < classes.size() && !is_blank(classes[i])) ++i;
    if (i > from) collect(by_class_, classes.substr(from, i - from), candidates);
    if (candidates.size() > 1'000'000) work_left_ = 0;
  }
  std::sort(candidates.begin(), candidates.end());  // order of the file, which decides between equals
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  for (const int index : candidates) {
    const Selector& selector = selectors_[static_cast<std::size_t>(index)];
    if (!matches(selector, selector.compounds.size() - 1, element)) continue;
    for (const Declaration& declaration : rules_[static_cast<std::size_t>(selector.rule)]) {
      style.apply(declaration, 1, std::min<std::uint32_t>(selector.specificity, 0xFFFFFF));
    }
    work_left_ -= static_cast<std::int64_t>(rules_[static_cast<std::size_t>(selector.rule)].size());
  }
  if (work_left_ <= 0)
    return Error{
        ErrorCode::range, "the style sheet is too costly to match (simpler selectors are accepted)", {}};
  return {};
}

bool StyleSheet::matches(const Selector& selector, std::size_t compound, int element) {
  const Compound& part = selector.compounds[compound];
  if (!compound_matches(part, element)) return false;
  if (compound == 0) return true;
  for (int above = at(element).parent; above >= 0 && work_left_ > 0; above = at(above).parent) {
    if (matches(selector, compound - 1, above)) return true;
    if (part.child_of_previous) return false;
  }
  return false;
}

bool StyleSheet::compound_matches(const Compound& compound, int element) {
  const Element& e = at(element);
  work_left_ -= 1 + static_cast<std::int64_t>(compound.classes.size() + compound.attributes.size()) *
                        static_cast<std::int64_t>(1 + e.attribute_bytes / 64);
  if (!compound.element.empty() && compound.element != e.name) return false;
  const auto is_id = [&](std::string_view id) { return e.id() == id; };
  if (!std::all_of(compound.ids.begin(), compound.ids.end(), is_id)) return false;
  const std::string_view classes = e.get("class");
  const auto in_classes = [&](std::string_view name) { return has_word(classes, name); };
  if (!std::all_of(compound.classes.begin(), compound.classes.end(), in_classes)) return false;
  return std::all_of(compound.attributes.begin(), compound.attributes.end(), [&](const AttributeTest& test) {
    return test.value ? e.has(test.name) && e.get(test.name) == *test.value : e.has(test.name);
  });
}

}  // namespace burin::io::svg
