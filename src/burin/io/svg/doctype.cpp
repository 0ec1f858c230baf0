// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/doctype.h"

#include "burin/io/svg/scanner.h"

namespace burin::io::svg {
namespace {

constexpr int kMaxNesting = 8;
constexpr std::size_t kMaxExpanded = 64 * 1024;
constexpr std::size_t kMaxEntities = 1000;

/// The name of the reference that starts at the '&' at `at`; "" when it is none (a bare '&', a character).
std::string_view reference_at(std::string_view text, std::size_t at) {
  constexpr std::size_t kLongestName = 256;
  const std::size_t end = text.substr(at, kLongestName).find(';');
  if (end == std::string_view::npos || end < 2 || text[at + 1] == '#') return {};
  return text.substr(at + 1, end - 1);
}

std::string_view token(std::string_view text, std::size_t& i) {
  while (i < text.size() && is_blank(text[i])) ++i;
  const std::size_t from = i;
  while (i < text.size() && !is_blank(text[i]) && text[i] != '>' && text[i] != '"' && text[i] != '\'') ++i;
  return text.substr(from, i - from);
}

}  // namespace

InternalEntities InternalEntities::from_doctype(std::string_view doctype) {
  constexpr std::string_view kDeclaration = "<!ENTITY";
  InternalEntities entities;
  std::size_t i = 0;
  while ((i = doctype.find(kDeclaration, i)) != std::string_view::npos &&
         entities.values_.size() < kMaxEntities) {
    i += kDeclaration.size();
    const std::string_view name = token(doctype, i);
    while (i < doctype.size() && is_blank(doctype[i])) ++i;
    // "%" declares a parameter entity, SYSTEM and PUBLIC external ones: neither has its text here.
    if (name.empty() || name == "%" || i >= doctype.size() || (doctype[i] != '"' && doctype[i] != '\''))
      continue;
    const std::size_t end = doctype.find(doctype[i], i + 1);
    if (end == std::string_view::npos) break;
    entities.values_.emplace(name, doctype.substr(i + 1, end - i - 1));  // the first declaration holds
    i = end + 1;
  }
  return entities;
}

Result<std::string> InternalEntities::expand(std::string_view text) const {
  std::string out;
  const auto done = expand_into(text, 0, out);
  if (!done) return done.error();
  return out;
}

Result<void> InternalEntities::expand_into(std::string_view text, int depth, std::string& out) const {
  if (depth > kMaxNesting)
    return Error{ErrorCode::range, "entities nested too deeply (8 levels are accepted)", {}};
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t amp = text.find('&', i);
    out.append(text.substr(i, amp == std::string_view::npos ? amp : amp - i));
    if (amp == std::string_view::npos) break;
    const std::string_view name = reference_at(text, amp);
    const auto value = values_.find(name);
    if (name.empty() || value == values_.end()) {
      out.push_back('&');
      i = amp + 1;
      continue;
    }
    if (auto done = expand_into(value->second, depth + 1, out); !done) return done;
    if (out.size() > kMaxExpanded + text.size()) {
      return Error{
          ErrorCode::range, "entities of the DOCTYPE expand to more than 64 KiB in one attribute", {}};
    }
    i = amp + name.size() + 2;
  }
  return {};
}

bool InternalEntities::refers_to_markup(std::string_view text) const {
  for (std::size_t amp = text.find('&'); amp != std::string_view::npos; amp = text.find('&', amp + 1)) {
    const auto value = values_.find(reference_at(text, amp));
    if (value != values_.end() && value->second.find_first_of("<&") != std::string::npos) return true;
  }
  return false;
}

}  // namespace burin::io::svg
