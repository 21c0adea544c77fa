// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "build_path_library/entry_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <excavplan/base/error.hpp>
#include <excavplan/planning/library_build.hpp>

namespace excavplan::tools {
namespace {

/// False if the last user removed the file before this process had its lock.
bool is_at(int file, const std::string& path) {
  struct stat open {};
  struct stat there {};
  return ::fstat(file, &open) == 0 && ::stat(path.c_str(), &there) == 0 &&
         open.st_ino == there.st_ino && open.st_dev == there.st_dev;
}

}  // namespace

EntryFolder::EntryFolder(std::string folder, bool keep)
    : folder_(std::move(folder)), lock_(folder_ + "/in-use") {
  lock();
  if (!keep) clear();
}

void EntryFolder::clear() { remove_library_entries(folder_); }

void EntryFolder::lock() {
  do {
    if (file_ >= 0) ::close(file_);
    std::error_code none;
    std::filesystem::create_directories(folder_, none);
    file_ = ::open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) {
      throw Error(ErrorKind::bad_file, folder_ + ": is not a folder that can be written to: " +
                                           std::generic_category().message(errno));
    }
    // A file system without locks is used without.
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(file_);
      throw Error(ErrorKind::bad_file,
                  folder_ +
                      ": another run with the same --out uses it; with --cells several "
                      "runs can share a folder");
    }
  } while (!is_at(file_, lock_));
}

EntryFolder::~EntryFolder() {
  std::error_code none;
  std::filesystem::remove(lock_, none);
  if (!kept_) std::filesystem::remove(folder_, none);
  ::close(file_);
}

}  // namespace excavplan::tools
