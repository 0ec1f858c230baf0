// SPDX-License-Identifier: Apache-2.0
#include "burin/io/step/temp_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace burin::io::step {

Result<TempFile> TempFile::with(std::string_view content) {
  std::error_code ignored;
  std::filesystem::path folder = std::filesystem::temp_directory_path(ignored);
  if (folder.empty()) folder = "/tmp";
  std::string path = (folder / "burin-XXXXXX").string();
  const int fd = mkstemp(path.data());  // mode 0600
  const auto failed = [&](int reason) {
    Where where;
    where.file = path;
    return Error{ErrorCode::io,
                 std::string("cannot write the temporary copy: ") + std::strerror(reason) +
                     " (a writable TMPDIR with room for the part)",
                 where};
  };
  if (fd < 0) return failed(errno);
  TempFile file(path);
  while (!content.empty()) {
    const ssize_t n = write(fd, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const int reason = n < 0 ? errno : ENOSPC;
      close(fd);
      return failed(reason);
    }
    content.remove_prefix(static_cast<std::size_t>(n));
  }
  if (close(fd) != 0) return failed(errno);
  return file;
}

TempFile::~TempFile() {
  if (!path_.empty()) unlink(path_.c_str());
}

}  // namespace burin::io::step
