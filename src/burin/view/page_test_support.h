// SPDX-License-Identifier: Apache-2.0
// For tests of pages: data read back, and what every page must keep.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace burin::view::test {

inline std::string decode64(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string::npos) break;
    bits = (bits << 6) | static_cast<std::uint32_t>(digit);
    have += 6;
    if (have >= 8) {
      have -= 8;
      out += static_cast<char>((bits >> have) & 0xffu);
    }
  }
  return out;
}

/// Numbers of a base64 text, on a little-endian machine.
template <class T>
std::vector<T> numbers(const nlohmann::json& text) {
  const std::string raw = decode64(text.get<std::string>());
  EXPECT_EQ(raw.size() % sizeof(T), 0u);
  std::vector<T> out(raw.size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), raw.data(), sizeof(T) * out.size());
  return out;
}

inline nlohmann::json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

/// No address outside; two script elements and one title, whatever stands in the texts. The title of the test
/// holds the place holder "@DATA@" as text: in the title element and in the data.
inline void expect_closed_page(const std::string& page) {
  for (const char* outside :
       {"src=", "http://", "https://", "@import", "url(", "@STYLE@", "@SCRIPT@", "@TITLE@"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  for (const auto& [tag, wanted] :
       {std::pair{"<script", 2u}, {"</script", 2u}, {"<title", 1u}, {"@DATA@", 2u}}) {
    std::size_t n = 0;
    for (std::size_t at = page.find(tag); at != std::string::npos; at = page.find(tag, at + 1)) ++n;
    EXPECT_EQ(n, wanted) << tag;
  }
}

/// Every element of the page is closed in its order; scripts and styles are not looked into.
inline void expect_balanced(const std::string& page) {
  static const std::set<std::string> kVoid{"meta", "input", "link", "br", "hr", "img"};
  std::vector<std::string> open;
  std::size_t at = page.find("<html");
  while ((at = page.find('<', at)) != std::string::npos) {
    const bool closing = page[at + 1] == '/';
    const std::size_t from = at + (closing ? 2 : 1), end = page.find('>', at);
    const std::string name = page.substr(from, page.find_first_of(" >", from) - from);
    at = end;
    if (closing) {
      ASSERT_FALSE(open.empty()) << name;
      ASSERT_EQ(open.back(), name);
      open.pop_back();
    } else if (kVoid.count(name) == 0) {
      open.push_back(name);
      if (name == "script" || name == "style") at = page.find("</" + name, at);
    }
  }
  EXPECT_TRUE(open.empty());
}

}  // namespace burin::view::test
