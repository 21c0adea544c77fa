// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/standard_input.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <excavplan/base/error.hpp>

namespace excavplan::tools {
namespace {

constexpr const char* its_name = "standard input";

[[noreturn]] void refuse(const char* what) {
  throw Error(ErrorKind::bad_file,
              std::string(its_name) + ": " + what + ": " + std::generic_category().message(errno));
}

int temporary_file() {
  const char* const named = std::getenv("TMPDIR");
  if (named != nullptr && *named == '\0') ::unsetenv("TMPDIR");
  std::error_code wrong;
  const auto folder = std::filesystem::temp_directory_path(wrong);
  if (wrong) {
    errno = wrong.value();
    refuse("cannot be copied to a temporary file: TMPDIR");
  }
  std::string name = folder.string() + "/excavplan-XXXXXX";
  const int file = ::mkstemp(name.data());
  if (file < 0) refuse("cannot be copied to a temporary file");
  ::unlink(name.c_str());
  return file;
}

void write_all(int file, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t written = ::write(file, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse("cannot be copied to a temporary file");
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
}

/// SQLite opens a file by its name alone.
void require_not_sqlite(int file) {
  const std::string sign = "SQLite format 3";
  std::string begin(sign.size(), ' ');
  if (::pread(file, begin.data(), begin.size(), 0) < 0 || begin != sign) return;
  throw Error(ErrorKind::bad_file, std::string(its_name) +
                                       ": found an SQLite recording (.db3), expected another "
                                       "format: give this one as a file");
}

}  // namespace

StandardInput::~StandardInput() {
  if (file_ >= 0) ::close(file_);
}

std::string StandardInput::path() {
  if (file_ >= 0) throw Error(ErrorKind::bad_input, "only one input can be - (standard input)");
  file_ = temporary_file();
  path_ = "/dev/fd/" + std::to_string(file_);
  std::array<char, 1 << 16> bytes;
  while (true) {
    const ssize_t got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse("cannot be read");
    if (got == 0) break;
    write_all(file_, bytes.data(), static_cast<std::size_t>(got));
  }
  require_not_sqlite(file_);
  return path_;
}

std::string StandardInput::named(std::string message) const {
  if (path_.empty()) return message;
  for (std::size_t at = 0; (at = message.find(path_, at)) != std::string::npos;) {
    message.replace(at, path_.size(), its_name);
  }
  return message;
}

}  // namespace excavplan::tools
