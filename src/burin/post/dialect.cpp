// SPDX-License-Identifier: Apache-2.0
#include "burin/post/dialect.h"

#include <toml++/toml.h>

#include <cmath>
#include <functional>
#include <utility>

#include "burin/base/embedded.h"
#include "burin/base/text.h"

namespace burin::embedded {
std::vector<File> dialects();  // made by burin_embed from data/dialects
}

namespace burin::post {
namespace {

/// Fills one field from a value; returns what would be accepted when the value is not that.
using Take = std::function<std::string(const toml::node&, Dialect&)>;
struct Key {
  std::string name;
  Take take;
};

Take text(std::string Dialect::*field, std::vector<std::string> placeholders = {}) {
  return [=](const toml::node& node, Dialect& dialect) -> std::string {
    const auto value = node.value_exact<std::string>();
    if (!value) return "a text";
    for (const char c : *value)
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return "one line of text";
    for (std::size_t open = value->find('{'); open != std::string::npos; open = value->find('{', open + 1)) {
      const std::size_t close = value->find('}', open);
      const std::string name = close == std::string::npos ? "" : value->substr(open + 1, close - open - 1);
      if (std::find(placeholders.begin(), placeholders.end(), name) != placeholders.end()) continue;
      std::string accepted = "no { }";
      for (const std::string& placeholder : placeholders)
        accepted = (&placeholder == &placeholders.front() ? "{" : accepted + " or {") + placeholder + "}";
      return accepted;
    }
    dialect.*field = *value;
    return {};
  };
}

Take lines(std::vector<std::string> Dialect::*field) {
  return [=](const toml::node& node, Dialect& dialect) -> std::string {
    const toml::array* array = node.as_array();
    if (!array || array->size() > 1000) return "a list of texts";
    (dialect.*field).clear();
    for (const toml::node& entry : *array) {
      const auto value = entry.value_exact<std::string>();
      if (!value || value->find_first_of("\n\r") != std::string::npos)
        return "a list of texts of one line each";
      (dialect.*field).push_back(*value);
    }
    return {};
  };
}

Take flag(bool Dialect::*field) {
  return [=](const toml::node& node, Dialect& dialect) -> std::string {
    const auto value = node.value_exact<bool>();
    if (!value) return "true or false";
    dialect.*field = *value;
    return {};
  };
}

template <class Integer>
Take integer(Integer Dialect::*field, int least, int most) {
  return [=](const toml::node& node, Dialect& dialect) -> std::string {
    const auto value = node.value_exact<std::int64_t>();
    if (!value || *value < least || *value > most)
      return "an integer from " + std::to_string(least) + " to " + std::to_string(most);
    dialect.*field = static_cast<Integer>(*value);
    return {};
  };
}

Take number(double Dialect::*field, double least, double most) {
  return [=](const toml::node& node, Dialect& dialect) -> std::string {
    const auto value = node.is_string() ? std::nullopt : node.value<double>();
    if (!value || !(*value >= least && *value <= most))
      return "a number from " + format_shortest(least) + " to " + format_shortest(most);
    dialect.*field = *value;
    return {};
  };
}

std::vector<Key> keys() {
  using D = Dialect;
  return {
      {"name", text(&D::name)},
      {"description", text(&D::description)},
      {"decimals", integer(&D::decimals, 1, 6)},
      {"feed_decimals", integer(&D::feed_decimals, 0, 6)},
      {"power_decimals", integer(&D::power_decimals, 0, 6)},
      {"coordinate_limit_mm", number(&D::coordinate_limit_mm, 1, 1e6)},
      {"header", lines(&D::header)},
      {"footer", lines(&D::footer)},
      {"percent", flag(&D::percent)},
      {"line_numbers", flag(&D::line_numbers)},
      {"line_number_step", integer(&D::line_number_step, 1, 1000)},
      {"line_limit", integer(&D::line_limit, 40, 10000)},
      {"require_point", flag(&D::require_point)},
      {"comment_open", text(&D::comment_open)},
      {"comment_close", text(&D::comment_close)},
      {"comment_limit", integer(&D::comment_limit, 0, 10000)},
      {"comment_forbidden", text(&D::comment_forbidden)},
      {"active_comments", lines(&D::active_comments)},
      {"two_digit_codes", flag(&D::two_digit_codes)},
      {"beam_on", text(&D::beam_on, {"power"})},
      {"beam_on_plain", text(&D::beam_on_plain)},
      {"beam_off", text(&D::beam_off)},
      {"power_scale", number(&D::power_scale, 1e-6, 1e6)},
      {"power_inline", flag(&D::power_inline)},
      {"spindle_cw", text(&D::spindle_cw, {"rpm"})},
      {"spindle_ccw", text(&D::spindle_ccw, {"rpm"})},
      {"spindle_off", text(&D::spindle_off)},
      {"dwell", text(&D::dwell, {"seconds", "milliseconds"})},
      {"tool_change", text(&D::tool_change, {"number"})},
      {"tool_change_supported", flag(&D::tool_change_supported)},
      {"tool_length", text(&D::tool_length, {"number"})},
      {"tcp_on", text(&D::tcp_on, {"number"})},
      {"tcp_off", text(&D::tcp_off)},
      {"coolant_on", text(&D::coolant_on)},
      {"coolant_off", text(&D::coolant_off)},
      {"stop", text(&D::stop)},
      {"optional_stop", text(&D::optional_stop)},
      {"arc_absolute_mm", number(&D::arc_absolute_mm, 0, 1)},
      {"arc_relative", number(&D::arc_relative, 0, 0.1)},
      {"arc_min_radius_mm", number(&D::arc_min_radius_mm, 0, 100)},
      {"arc_max_radius_mm", number(&D::arc_max_radius_mm, 1, 1e6)},
      {"min_arc_sweep_deg", number(&D::min_arc_sweep_deg, 0, 90)},
      {"arc_helix", flag(&D::arc_helix)},
      {"rotary_axes", flag(&D::rotary_axes)},
      {"inverse_time", text(&D::inverse_time)},
      {"per_minute", text(&D::per_minute)},
      {"inverse_time_decimals", integer(&D::inverse_time_decimals, 0, 6)},
      {"feed_of_linear_only", flag(&D::feed_of_linear_only)},
  };
}

Where place(const toml::source_region& source, const std::string& file_name) {
  return {.file = file_name,
          .line = static_cast<int>(source.begin.line),
          .column = static_cast<int>(source.begin.column)};
}

Error unknown_key(const std::string& name, Where where, const std::vector<Key>& known) {
  std::vector<std::string> names;
  for (const Key& key : known) names.push_back(key.name);
  const std::string near = nearest_word(name, names);
  return {ErrorCode::syntax,
          "unknown key '" + name + "' (" + (near.empty() ? "such as decimals, header, beam_on" : near) + ")",
          std::move(where)};
}

Result<Dialect> from_table(const toml::table& table, const std::string& file_name) {
  const std::vector<Key> known = keys();
  Dialect dialect;
  for (const auto& [toml_key, node] : table) {
    const std::string name(toml_key.str());
    const auto key = std::find_if(known.begin(), known.end(), [&](const Key& k) { return k.name == name; });
    if (key == known.end()) return unknown_key(name, place(toml_key.source(), file_name), known);
    if (const std::string accepted = key->take(node, dialect); !accepted.empty())
      return Error{ErrorCode::syntax, "not a value for " + name + " (" + accepted + ")",
                   place(node.source(), file_name)};
  }
  if (dialect.name.empty())
    return Error{ErrorCode::syntax, "a dialect without a name (name = \"...\")", {.file = file_name}};
  if (dialect.beam_on.empty() != dialect.beam_off.empty())
    return Error{ErrorCode::syntax, "only one of beam_on and beam_off (both, or none)", {.file = file_name}};
  if (dialect.tcp_on.empty() != dialect.tcp_off.empty())
    return Error{ErrorCode::syntax, "only one of tcp_on and tcp_off (both, or none)", {.file = file_name}};
  return dialect;
}

}  // namespace

Result<Dialect> parse_dialect(std::string_view toml_text, const std::string& file_name) {
  try {
    return from_table(toml::parse(toml_text, file_name), file_name);
  } catch (const toml::parse_error& error) {
    return Error{ErrorCode::syntax, std::string(error.description()) + " (TOML)",
                 place(error.source(), file_name)};
  } catch (const std::exception& error) {
    return Error{
        ErrorCode::syntax, std::string("not readable: ") + error.what() + " (TOML)", {.file = file_name}};
  }
}

std::vector<std::string> dialect_names() {
  std::vector<std::string> names;
  for (const embedded::File& file : embedded::dialects()) {
    std::string_view name = file.name;
    names.emplace_back(name.substr(0, name.rfind(".toml")));
  }
  return names;
}

Result<Dialect> find_dialect(std::string_view name) {
  for (const embedded::File& file : embedded::dialects())
    if (file.name == std::string(name) + ".toml") return parse_dialect(file.text, std::string(file.name));
  std::string known;
  for (const std::string& candidate : dialect_names()) known += (known.empty() ? "" : ", ") + candidate;
  return Error{ErrorCode::usage, "unknown dialect '" + std::string(name) + "' (" + known + ")", {}};
}

}  // namespace burin::post
