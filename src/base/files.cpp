// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_write(const std::string& path, int reason) {
  throw Error(ErrorKind::bad_file,
              path + ": cannot be written: " + std::generic_category().message(reason));
}

/// True of a link, a pipe, a device: what is opened by its name, not replaced.
bool stays(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}

std::string name_beside(const std::string& path) {
  char host[65] = {};  // a folder may be shared by machines
  ::gethostname(host, sizeof host - 1);
  std::ostringstream name;
  name << path << ".part-" << host << '-' << ::getpid() << '-' << std::this_thread::get_id();
  return name.str();
}

void require_folder_of(const std::string& path) {
  std::error_code error;
  const fs::path folder = fs::absolute(path, error).parent_path();
  if (error) fail_to_write(path, error.value());
  if (fs::is_directory(folder, error)) return;
  throw Error(ErrorKind::bad_file, path + ": there is no folder " + folder.string());
}

}  // namespace

void write_file(const std::string& path, const std::string& content) {
  const bool in_place = stays(path);
  const std::string written = in_place ? path : name_beside(path);
  std::ofstream out(written, std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out || (!in_place && std::rename(written.c_str(), path.c_str()) != 0)) {
    if (!in_place) std::remove(written.c_str());
    throw Error(ErrorKind::bad_file, path + ": cannot be written");
  }
}

void require_writable(const std::string& path) {
  require_folder_of(path);
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISFIFO(status.st_mode)) return;  // to open it would wait for its reader
  const bool in_place = stays(path);
  const std::string written = in_place ? path : name_beside(path);
  const int file = ::open(written.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  const bool writable = file >= 0 && ::write(file, "", 0) == 0;  // fails on a device that is full
  const int reason = errno;
  if (file >= 0) ::close(file);
  std::error_code none;
  if (file >= 0 && !(in_place && exists)) fs::remove(fs::canonical(written, none), none);
  if (!writable) fail_to_write(path, reason);
}

std::string read_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    throw Error(ErrorKind::bad_file, path + ": no such file, or not readable");
  }
  if (!S_ISREG(status.st_mode)) throw Error(ErrorKind::bad_file, path + ": is not a regular file");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  if (!in) throw Error(ErrorKind::bad_file, path + ": cannot be read");
  return content.str();
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
