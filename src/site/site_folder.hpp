// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// @file
/// The folder of a site: its lock, its names, and files that are written whole.

namespace excavplan {

inline constexpr const char* site_manifest = "site.json";  ///< names all other files that count

/// A file of the folder and the checksum of its content.
struct StoredFile {
  std::string name = {};    ///< plain: letters of stored_name()
  std::string digest = {};  ///< checksum_text()
};

/// "ground-12.tif": of one state of a site.
std::string stored_name(const char* kind, long long generation, const char* ending);

/// A folder that holds a site or will. No link in it is followed.
class SiteFolder {
 public:
  /// @param locked  against other processes, until this object ends; the folder is then made if
  /// it is not there
  /// @param lock_file  file that is locked
  /// @throws Error (bad_file) if it cannot be made or another process holds it: names that one
  SiteFolder(std::string path, bool locked, const char* lock_file = "site.lock");
  ~SiteFolder();
  SiteFolder(SiteFolder&& other) noexcept;
  SiteFolder& operator=(SiteFolder&& other) = delete;

  const std::string& path() const { return path_; }
  std::string path_of(const std::string& name) const { return path_ + '/' + name; }
  bool has(const std::string& name) const;

  std::string read(const std::string& name) const;
  /// @throws Error (bad_file) also if it is not the content that was stored
  std::string read(const StoredFile& file) const;
  /// The same of a file of stored(), of which only the head is read.
  void require_stored(const StoredFile& file) const;
  StoredFile write(const std::string& name, const std::string& content) const;
  /// Makes way for a file that is written by others.
  void clear(const std::string& name) const;
  /// One that others have written, with the checksum of its first MiB: a ground file has the
  /// checksum of all its numbers there, which load_ground() compares.
  StoredFile stored(const std::string& name) const;
  /// Gives a file the name of another, which it replaces.
  void rename(const std::string& from, const std::string& to) const;
  /// Removes the files of a site that are not these, as a process that was killed leaves them.
  /// What is no file of a site stays.
  void keep_only(const std::vector<std::string>& names) const;

 private:
  void lock(const char* name);
  void require_name(const StoredFile& file) const;
  void require_same(const StoredFile& file, const std::string& digest) const;

  std::string path_;
  int lock_ = -1;  ///< descriptor of the file whose lock this process holds
};

}  // namespace excavplan
