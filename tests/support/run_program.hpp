// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

/// @file
/// Runs the built programs as a user does, each in its own process.

namespace excavplan::test {

/// A folder of its own for the files of a test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "excavplan-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(file(name), std::ios::binary) << content;
    return file(name);
  }

 private:
  std::filesystem::path path_;
};

std::string content_of(const std::string& path);
bool contains(const std::string& text, const std::string& part);

struct ProgramResult {
  int code = -1;  ///< exit code; 128 + signal if a signal ended it
  std::string out;
  std::string err;
};

int exit_code(int status);

/// Starts the program `name` of the folder EXCAVPLAN_BIN. No shell is in between: the arguments
/// arrive as they are.
/// @param redirect  gives the child its streams
pid_t started(const std::string& name, std::vector<std::string> arguments,
              const std::function<void()>& redirect);

/// Runs a program to its end, with a file, or by default nothing, on its standard input.
ProgramResult run_program(const std::string& name, const std::vector<std::string>& arguments = {},
                          const std::string& input = "/dev/null");

/// Runs a program on a terminal and interrupts it once it has shown `sign`.
ProgramResult interrupted(const std::string& name, const std::vector<std::string>& words,
                          const std::string& sign);

}  // namespace excavplan::test
