// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/site_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <regex>
#include <system_error>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/input_file.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_stored_bytes = std::uint64_t{1} << 32;  // ours

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw Error(ErrorKind::bad_file,
              path + ": " + what + ": " + std::generic_category().message(errno));
}

bool is_stored_name(const std::string& name) {
  static const std::regex form("(ground|first|belief|site)-[0-9]{1,18}\\.(tif|json)");
  return std::regex_match(name, form);
}

/// Who holds the lock, as it wrote itself.
std::string holder(int lock) {
  std::array<char, 100> text{};
  const ssize_t got = ::pread(lock, text.data(), text.size(), 0);
  return got > 0 ? safe_text({text.data(), static_cast<std::size_t>(got)}, text.size())
                 : "another process";
}

void sign(int lock) {
  std::array<char, 65> host{};
  ::gethostname(host.data(), host.size() - 1);
  const std::string text = "process " + std::to_string(::getpid()) + " on " + host.data();
  const bool is_signed =
      ::ftruncate(lock, 0) == 0 && ::pwrite(lock, text.data(), text.size(), 0) > 0;
  static_cast<void>(is_signed);  // the lock holds without
}

}  // namespace

std::string stored_name(const char* kind, long long generation, const char* ending) {
  return std::string(kind) + '-' + std::to_string(generation) + ending;
}

SiteFolder::SiteFolder(std::string path, bool locked, const char* lock_file)
    : path_(std::move(path)) {
  if (locked) lock(lock_file);
}

void SiteFolder::lock(const char* name) {
  make_folder(path_);
  const std::string file = path_of(name);
  constexpr int flags = O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK;
  lock_ = ::open(file.c_str(), flags, 0666);
  if (lock_ < 0) fail(file, "cannot be opened");
  // A file system without locks is used without.
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    const std::string who = holder(lock_);
    ::close(std::exchange(lock_, -1));
    throw Error(ErrorKind::bad_file,
                path_ + ": the site is in use by " + who + "; one process changes it at a time");
  }
  sign(lock_);
}

SiteFolder::~SiteFolder() {
  if (lock_ >= 0) ::close(lock_);
}

SiteFolder::SiteFolder(SiteFolder&& other) noexcept
    : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}

bool SiteFolder::has(const std::string& name) const {
  struct stat status {};
  return ::lstat(path_of(name).c_str(), &status) == 0;
}

std::string SiteFolder::read(const std::string& name) const {
  return read_own_file(path_of(name), most_stored_bytes);
}

void SiteFolder::require_name(const StoredFile& file) const {
  if (is_stored_name(file.name)) return;
  throw Error(ErrorKind::bad_file, path_of(site_manifest) + ": names " + in_quotes(file.name) +
                                       ", which is no file of a site");
}

void SiteFolder::require_same(const StoredFile& file, const std::string& digest) const {
  if (digest == file.digest) return;
  throw Error(ErrorKind::bad_file,
              path_of(file.name) + ": is damaged: its checksum is not that in " + site_manifest);
}

std::string SiteFolder::read(const StoredFile& file) const {
  require_name(file);
  std::string content = read(file.name);
  require_same(file, checksum_text(content));
  return content;
}

void SiteFolder::require_stored(const StoredFile& file) const {
  require_name(file);
  require_same(file, stored(file.name).digest);
}

StoredFile SiteFolder::write(const std::string& name, const std::string& content) const {
  write_own_file(path_of(name), content);
  return {name, checksum_text(content)};
}

void SiteFolder::clear(const std::string& name) const {
  if (::unlink(path_of(name).c_str()) != 0 && errno != ENOENT) {
    fail(path_of(name), "cannot be removed");
  }
}

StoredFile SiteFolder::stored(const std::string& name) const {
  constexpr std::uint64_t most = std::uint64_t{1} << 20;
  const InputFile file(path_of(name), false);
  std::string head(std::min(file.size(), most), '\0');
  file.read(0, head.data(), head.size());
  return {name, checksum_text(head)};
}

void SiteFolder::rename(const std::string& from, const std::string& to) const {
  if (std::rename(path_of(from).c_str(), path_of(to).c_str()) != 0) {
    fail(path_of(to), "cannot be replaced");
  }
}

void SiteFolder::keep_only(const std::vector<std::string>& names) const {
  std::error_code error;
  std::vector<fs::path> leftovers;
  for (fs::directory_iterator at(path_, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename();
    const bool is_of_site = is_stored_name(name) || is_unfinished(name);
    const bool is_kept = std::find(names.begin(), names.end(), name) != names.end();
    if (is_of_site && !is_kept) leftovers.push_back(at->path());
  }
  for (const fs::path& each : leftovers) fs::remove(each, error);  // else at the next open
}

}  // namespace excavplan
