// SPDX-License-Identifier: Apache-2.0
#include "burin/base/file.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace burin {
namespace {

Error io_error(const std::string& path, const std::string& what, int code) {
  return {ErrorCode::io, what + ": " + std::strerror(code), {.file = path}};
}

struct Closer {
  void operator()(std::FILE* f) const { std::fclose(f); }
};

}  // namespace

Result<std::string> read_file(const std::string& path, std::uint64_t max_bytes) {
  std::unique_ptr<std::FILE, Closer> file(std::fopen(path.c_str(), "rb"));
  if (!file) return io_error(path, "cannot be opened", errno);
  struct stat info {};
  if (fstat(fileno(file.get()), &info) != 0) return io_error(path, "cannot be read", errno);
  if (S_ISDIR(info.st_mode)) return Error{ErrorCode::io, "is a folder (a file is wanted)", {.file = path}};
  // The size is only a hint for pipes and /proc, so the limit is checked while reading as well.
  std::string bytes;
  if (info.st_size > 0) {
    if (static_cast<std::uint64_t>(info.st_size) > max_bytes) {
      return Error{ErrorCode::io, "is larger than " + std::to_string(max_bytes) + " bytes", {.file = path}};
    }
    bytes.reserve(static_cast<std::size_t>(info.st_size));
  }
  std::array<char, 65536> buffer;
  for (;;) {
    const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), file.get());
    bytes.append(buffer.data(), got);
    if (bytes.size() > max_bytes) {
      return Error{ErrorCode::io, "is larger than " + std::to_string(max_bytes) + " bytes", {.file = path}};
    }
    if (got < buffer.size()) break;
  }
  if (std::ferror(file.get())) return io_error(path, "cannot be read", errno);
  return bytes;
}

Result<void> write_file(const std::string& path, std::string_view content) {
  // A device or a pipe cannot be renamed onto: write it in place.
  struct stat info {};
  const bool exists = stat(path.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode))
    return Error{ErrorCode::io, "is a folder (a file is wanted)", {.file = path}};
  const bool in_place = exists && !S_ISREG(info.st_mode);
  std::string target = path;
  int fd = -1;
  if (in_place) {
    fd = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    target = path + ".XXXXXX";
    fd = mkostemp(target.data(), O_CLOEXEC);
  }
  if (fd < 0) return io_error(path, "cannot be written", errno);
  int failure = 0;
  std::string_view rest = content;
  while (!rest.empty()) {
    const ssize_t wrote = ::write(fd, rest.data(), rest.size());
    if (wrote < 0) {
      if (errno == EINTR) continue;
      failure = errno;
      break;
    }
    rest.remove_prefix(static_cast<std::size_t>(wrote));
  }
  if (!in_place && failure == 0) {
    const mode_t mask = umask(0);
    umask(mask);
    const mode_t mode = exists ? (info.st_mode & 07777) : (0666 & ~mask);
    if (fchmod(fd, mode) != 0) failure = errno;
  }
  if (close(fd) != 0 && failure == 0) failure = errno;
  if (!in_place && failure == 0 && std::rename(target.c_str(), path.c_str()) != 0) failure = errno;
  if (failure != 0) {
    if (!in_place) unlink(target.c_str());
    return io_error(path, "cannot be written", failure);
  }
  return {};
}

std::string sha256_hex(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr);
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    hex += kDigits[digest[i] >> 4];
    hex += kDigits[digest[i] & 15];
  }
  return hex;
}

}  // namespace burin
