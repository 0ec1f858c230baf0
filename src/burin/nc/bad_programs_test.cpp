// SPDX-License-Identifier: Apache-2.0
// tests/bad_programs/*.nc: the first line of each is a comment that says where the error is and what its
// message holds: "; expect LINE:COLUMN part of the message".
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "burin/nc/surface_program.h"

namespace burin::nc {
namespace {

std::vector<std::filesystem::path> bad_programs() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(BURIN_SOURCE_DIR) + "/tests/bad_programs"))
    if (entry.path().extension() == ".nc") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(BadPrograms, EachIsRefusedWhereItIsWrong) {
  const auto files = bad_programs();
  EXPECT_GE(files.size(), 60u);
  for (const auto& path : files) {
    const std::string text = content(path), name = path.filename().string();
    std::istringstream first(text.substr(0, text.find('\n')));
    std::string semicolon, expect, message;
    int line = 0, column = 0;
    char colon = 0;
    first >> semicolon >> expect >> line >> colon >> column >> std::ws;
    std::getline(first, message);
    ASSERT_TRUE(semicolon == ";" && expect == "expect" && colon == ':' && !message.empty()) << name;
    Diagnostics diagnostics;
    const auto program = read_surface_program(text, {.file_name = name}, diagnostics);
    ASSERT_FALSE(program) << name << ": read without error";
    const Error& error = program.error();
    EXPECT_EQ(error.where.line, line) << error.to_string();
    EXPECT_EQ(error.where.column, column) << error.to_string();
    EXPECT_EQ(error.where.file, name);
    EXPECT_NE(error.message.find(message), std::string::npos)
        << error.to_string() << "\nexpected: " << message;
    EXPECT_NE(error.message.find('('), std::string::npos) << error.to_string() << ": says what is accepted";
  }
}

}  // namespace
}  // namespace burin::nc
