// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include <excavplan/base/error.hpp>

namespace excavplan {
namespace {

/// As ::pread(), but never interrupted.
ssize_t read_at(int descriptor, char* to, std::size_t count, std::uint64_t offset) {
  ssize_t got = 0;
  do {
    got = ::pread(descriptor, to, count, static_cast<off_t>(offset));
  } while (got < 0 && errno == EINTR);
  return got;
}

}  // namespace

InputFile::InputFile(std::string path, bool follows)
    : path_(std::move(path)),
      descriptor_(
          ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | (follows ? 0 : O_NOFOLLOW))) {
  if (descriptor_ < 0) refuse_for("cannot be opened");
  struct stat status {};
  const bool is_known = ::fstat(descriptor_, &status) == 0;
  if (is_known && S_ISREG(status.st_mode)) {
    size_ = static_cast<std::uint64_t>(status.st_size);
    return;
  }
  ::close(descriptor_);
  refuse(is_known ? "is not a regular file" : "cannot be examined");
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::read(std::uint64_t offset, char* to, std::size_t count) const {
  for (std::size_t filled = 0; filled < count;) {
    const ssize_t got = read_at(descriptor_, to + filled, count - filled, offset + filled);
    if (got < 0) refuse_for("cannot be read");
    if (got == 0) refuse("became shorter while it was read");
    filled += static_cast<std::size_t>(got);
  }
}

void InputFile::require_end() const {
  char more = 0;
  const ssize_t got = read_at(descriptor_, &more, 1, size_);
  if (got < 0) refuse_for("cannot be read");
  if (got > 0) refuse("became longer while it was read");
}

void InputFile::refuse(const std::string& why) const {
  throw Error(ErrorKind::bad_file, path_ + ": " + why);
}

void InputFile::refuse_for(const char* what) const {
  const int reason = errno;
  refuse(what + (": " + std::generic_category().message(reason)));
}

}  // namespace excavplan
