// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/files.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/input_file.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;

std::string reason_text(int reason) { return std::generic_category().message(reason); }

[[noreturn]] void fail_to_write(const std::string& path, int reason) {
  throw Error(ErrorKind::bad_file, path + ": cannot be written: " + reason_text(reason));
}

/// Where that goes which is written to a path.
struct Place {
  std::string path;                    ///< behind all links
  bool is_replaced = true;             ///< else written to: a pipe, a device, an open file
  std::optional<int> descriptor = {};  ///< of a file that this process has open
  std::optional<mode_t> mode = {};     ///< of the file that is there
};

bool is_link(const fs::path& path) {
  std::error_code none;
  return fs::is_symlink(fs::symlink_status(path, none));
}

fs::path folder_of(const fs::path& path) {
  std::error_code none;
  return fs::canonical(path.parent_path(), none);
}

/// Whether a link leads to what a process has open, whatever its text.
bool is_of_process(const fs::path& link) {
  return is_link(link) && folder_of(link).string().rfind("/proc/", 0) == 0;
}

/// What is behind all links but those of a process.
fs::path behind_links(const std::string& path) {
  constexpr int most_links = 40;  // as Linux follows
  fs::path target = path;
  for (int links = 0; is_link(target) && !is_of_process(target); ++links) {
    std::error_code error;
    if (links == most_links) fail_to_write(path, ELOOP);
    target = target.parent_path() / fs::read_symlink(target, error);
    if (error) fail_to_write(path, error.value());
  }
  return target;
}

Place place_of(const std::string& path) {
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) fail_to_write(path, errno);
  if (const auto descriptor = open_descriptor(path)) return {path, false, descriptor};
  if (exists && !S_ISREG(status.st_mode)) return {path, false};
  const fs::path target = behind_links(path);
  if (is_of_process(target)) {
    throw Error(ErrorKind::bad_file, path + ": is a file that another process has open");
  }
  Place place{target.string()};
  if (exists) place.mode = status.st_mode & 0777;
  return place;
}

constexpr std::string_view unfinished = ".part-";
constexpr std::size_t random_letters = 8;

bool flush(int descriptor) { return ::fsync(descriptor) == 0 || errno == EINVAL; }

/// So that the name of a new file outlasts a loss of power.
bool flush_folder_of(const std::string& path) {
  const std::string folder = path.substr(0, path.rfind('/') + 1) + ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return true;  // it may be written to, not read
  const bool is_flushed = flush(descriptor);
  const int reason = errno;
  ::close(descriptor);
  errno = reason;
  return is_flushed;
}

/// Sets errno if it returns false.
bool write_from(int descriptor, std::uint64_t from, std::string_view text) {
  if (::ftruncate(descriptor, static_cast<off_t>(from)) != 0) return false;
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::pwrite(descriptor, text.data() + done, text.size() - done,
                                   static_cast<off_t>(from + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return flush(descriptor);
}

/// An open file, which is removed at the end unless it was renamed. Its functions set errno if they
/// return false.
class OutputFile {
 public:
  explicit OutputFile(const Place& place)
      : path_(place.is_replaced ? unfinished_name(place.path) : place.path),
        is_removed_(place.is_replaced) {
    constexpr int flags = O_WRONLY | O_CLOEXEC | O_NOCTTY;
    if (!is_removed_) {
      descriptor_ = place.descriptor ? ::fcntl(*place.descriptor, F_DUPFD_CLOEXEC, 0)
                                     : ::open(path_.c_str(), flags);
      return;
    }
    descriptor_ = ::open(path_.c_str(), flags | O_CREAT | O_EXCL, place.mode.value_or(0666));
    is_removed_ = descriptor_ >= 0;
  }
  ~OutputFile() {
    close();
    if (is_removed_) ::unlink(path_.c_str());
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  bool write(std::string_view content) const {
    do {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno != EINTR) return false;
      content.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
    } while (!content.empty());
    return true;
  }
  bool close() {
    const int open = std::exchange(descriptor_, -1);
    return open < 0 || ::close(open) == 0 || errno == EINTR;
  }
  /// Takes the place of the file that is there, with its mode whatever the umask. It is open as
  /// long as it has its own name: a program that ends at a signal finds it by that.
  bool replace(const Place& place, bool is_flushed) {
    if (place.mode) ::fchmod(descriptor_, *place.mode);
    if (is_flushed && !flush(descriptor_)) return false;
    if (std::rename(path_.c_str(), place.path.c_str()) != 0) return false;
    is_removed_ = false;
    return true;
  }

 private:
  std::string path_;
  int descriptor_ = -1;
  bool is_removed_ = false;
};

void write(const Place& place, const std::string& path, const ContentSource& content,
           bool is_flushed) {
  OutputFile file(place);
  if (!file.is_open()) fail_to_write(path, errno);
  content([&](std::string_view part) {
    if (!file.write(part)) fail_to_write(path, errno);
  });
  const bool is_whole = place.is_replaced ? file.replace(place, is_flushed) : file.close();
  if (!is_whole) fail_to_write(path, errno);
  if (!place.is_replaced) return;
  if (file.close() && (!is_flushed || flush_folder_of(place.path))) return;
  throw Error(ErrorKind::bad_file,
              path + ": was written, but a loss of power may undo that: " + reason_text(errno));
}

ContentSource in_one_part(const std::string& content) {
  return [&content](const auto& append) { append(content); };
}

void require_folder_of(const std::string& path) {
  std::error_code error;
  const fs::path folder = fs::absolute(path, error).parent_path();
  if (error) fail_to_write(path, error.value());
  if (fs::is_directory(folder, error)) return;
  throw Error(ErrorKind::bad_file, path + ": there is no folder " + folder.string());
}

bool is_pipe(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
}

std::string content_of(const InputFile& file, std::uint64_t most_bytes) {
  if (file.size() > most_bytes) {
    file.refuse("found " + std::to_string(file.size()) + " bytes, expected at most " +
                std::to_string(most_bytes));
  }
  std::string content(file.size(), '\0');
  file.read(0, content.data(), content.size());
  file.require_end();
  return content;
}

}  // namespace

std::string read_file(const std::string& path, std::uint64_t most_bytes) {
  return content_of(InputFile(path), most_bytes);
}

std::string read_own_file(const std::string& path, std::uint64_t most_bytes) {
  return content_of(InputFile(path, false), most_bytes);
}

void write_journal(const std::string& path, const std::string& content) {
  write(place_of(path), path, in_one_part(content), false);
}

void write_file(const std::string& path, const std::string& content) {
  write(place_of(path), path, in_one_part(content), true);
}

void write_own_file(const std::string& path, const std::string& content) {
  write(Place{path}, path, in_one_part(content), true);
}

void write_own_tail(const std::string& path, std::uint64_t from, std::string_view text) {
  const int descriptor =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC | O_NOCTTY, 0666);
  const bool is_written = descriptor >= 0 && write_from(descriptor, from, text);
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (is_written) return;
  fail_to_write(path, reason);
}

void write_file(const std::string& path, const ContentSource& content) {
  write(place_of(path), path, content, true);
}

std::optional<int> open_descriptor(const std::string& path) {
  const fs::path link = behind_links(path);
  if (!is_of_process(link)) return std::nullopt;
  const fs::path folder = folder_of(link);
  const bool is_own =
      folder == folder_of("/proc/self/fd/0") || folder == folder_of("/proc/thread-self/fd/0");
  const std::string name = link.filename();
  int number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool is_number = error == std::errc{} && end == name.data() + name.size();
  return is_own && is_number ? std::optional(number) : std::nullopt;
}

std::string unfinished_name(const std::string& path) {
  constexpr std::size_t longest = 255;
  char host[65] = {};
  ::gethostname(host, sizeof host - 1);
  std::array<unsigned char, random_letters> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) < 0) fail_to_write(path, errno);
  std::string end = std::string(unfinished).append(host) + '-' + std::to_string(::gettid()) + '-';
  for (const unsigned char byte : bytes) end += static_cast<char>('a' + byte % 26);
  const std::size_t name = path.rfind('/') + 1;
  return path.substr(0, name + std::min(path.size() - name, longest - end.size())) + end;
}

bool is_unfinished(std::string_view path) noexcept {
  const auto drop_end = [&path](auto is_part) {
    const std::size_t size = path.size();
    while (!path.empty() && is_part(path.back())) path.remove_suffix(1);
    return size - path.size();
  };
  const auto drop_dash = [&] {
    const bool is_there = !path.empty() && path.back() == '-';
    if (is_there) path.remove_suffix(1);
    return is_there;
  };
  path.remove_prefix(path.rfind('/') + 1);
  return drop_end([](char c) { return c >= 'a' && c <= 'z'; }) == random_letters && drop_dash() &&
         drop_end([](char c) { return c >= '0' && c <= '9'; }) > 0 && drop_dash() &&
         path.find(unfinished) != path.npos;
}

void require_writable(const std::string& path) {
  require_folder_of(path);
  if (is_pipe(path)) return;  // to open it would wait for its reader
  const OutputFile file(place_of(path));
  if (!file.is_open() || !file.write("")) fail_to_write(path, errno);  // a full device fails
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) return;
  throw Error(ErrorKind::bad_file, path + ": " + (error ? error.message() + "; it " : "") +
                                       "is not a folder and cannot be made");
}

std::string file_name_part(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool good = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '+';
    text += good ? c : '_';
  }
  return text.substr(0, 60);
}

}  // namespace excavplan
