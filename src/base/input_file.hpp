// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

/// @file The one way in which files are opened and their bytes read. Private to the project.

namespace excavplan {

/// A regular file open for reading.
class InputFile {
 public:
  /// Never waits on a pipe or device.
  /// @param follows  a link that lies at the path; else it is refused
  /// @throws Error (bad_file) if the file is not regular or not readable
  explicit InputFile(std::string path, bool follows = true);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }  ///< when it was opened [byte]
  /// Fills a place with bytes of the file, all of which must be within its size.
  /// @throws Error (bad_file) if that fails, also because the file became shorter
  void read(std::uint64_t offset, char* to, std::size_t count) const;
  /// To be called once the end was read. @throws Error (bad_file) if the file became longer
  void require_end() const;
  /// @throws Error (bad_file): "file: why"
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  [[noreturn]] void refuse_for(const char* what) const;

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace excavplan
