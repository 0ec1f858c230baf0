// SPDX-License-Identifier: Apache-2.0
// A private file for a library that reads names only. Inside of this folder only.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "burin/base/result.h"

namespace burin::io::step {

/// Readable by this user alone, in the folder for temporary files; removed with the object.
class TempFile {
 public:
  static Result<TempFile> with(std::string_view content);
  ~TempFile();
  TempFile(TempFile&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TempFile& operator=(TempFile&&) = delete;
  const std::string& path() const { return path_; }

 private:
  explicit TempFile(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

}  // namespace burin::io::step
