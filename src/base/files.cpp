// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/files.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <excavplan/error.hpp>

namespace excavplan {

void write_file(const std::string& path, const std::string& content) {
  struct stat status {};
  const bool stays = ::lstat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
  char host[65] = {};  // a folder may be shared by machines
  ::gethostname(host, sizeof host - 1);
  std::ostringstream name;
  name << path << ".part-" << host << '-' << ::getpid() << '-' << std::this_thread::get_id();
  const std::string beside = name.str();
  const std::string& written = stays ? path : beside;
  std::ofstream out(written, std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out || (!stays && std::rename(beside.c_str(), path.c_str()) != 0)) {
    if (!stays) std::remove(beside.c_str());
    throw Error(ErrorKind::bad_file, path + ": cannot be written");
  }
}

void require_folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  if (std::filesystem::is_directory(folder)) return;
  throw Error(ErrorKind::bad_file, path + ": there is no folder " + folder.string());
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

}  // namespace excavplan
