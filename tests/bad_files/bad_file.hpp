// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

/// @file Bad and odd files of every format, made anew each time: nothing is drawn but from seeds.

namespace excavplan::test {

/// What a reader should do with a file.
enum class Expected {
  refused,  ///< an Error that names the file
  same,     ///< reads what the valid file says, or BadFile::said
  either    ///< what matters is that it does not crash, hang or take much
};
inline constexpr Expected refused = Expected::refused;
inline constexpr Expected same = Expected::same;
inline constexpr Expected either = Expected::either;

/// `text` again and again.
inline std::string times(std::size_t count, const std::string& text) {
  std::string all;
  all.reserve(count * text.size());
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

/// A bad or odd file.
struct BadFile {
  std::string name;  ///< what is odd: "WIDTH too large"
  Expected expected = Expected::refused;
  std::string bytes;
  std::string said = {};  ///< what the reader must say, if `same`; empty: as of the valid file
  /// Makes something else than a regular file in a folder. @return its path
  std::function<std::string(const std::string& folder)> make = {};
};
using BadFiles = std::vector<BadFile>;

/// Small files of a format (FileReader::name) that are right, at least one.
std::vector<std::string> valid_files(const std::string& format);

/// The same of job_readers().
std::vector<std::string> valid_job_files(const std::string& format);

/// All bad files of a format.
BadFiles bad_files(const std::string& format);

// By kind of format.
std::vector<std::string> valid_pcd_files();  ///< ascii, binary, compressed
std::vector<std::string> valid_ply_files();  ///< ascii, little and big endian
BadFiles bad_pcd_files();
BadFiles bad_ply_files();
BadFiles bad_xyz_files();
BadFiles bad_las_files();
BadFiles bad_json_files(const std::string& format);
BadFiles bad_tables(const std::string& format);
BadFiles bad_yaml_files(const std::string& format);
BadFiles bad_settings_files();
BadFiles bad_binary_files(const std::string& format);  ///< of recordings, messages and images
/// Pipes, folders, loops of links, nothing at all.
BadFiles things_that_are_no_files();

/// What a file may say after one of its bits was flipped.
enum class Flips {
  none,      ///< it is refused, or says the same: it has a checksum
  one_line,  ///< one number or text may be another: that which the bit is in
  one_row,   ///< the same, or that row may be missing, as nothing counts them
  one_leaf,  ///< the same, of JSON
  any        ///< no format of this kind can tell
};
/// What a file may say that was cut.
enum class Cuts {
  none,     ///< it is refused, or says the same
  last,     ///< the last number may lack digits
  shorter,  ///< the last rows may be missing too, as nothing counts them
  any
};
struct Tolerance {
  Flips flips = Flips::any;
  Cuts cuts = Cuts::any;
};
Tolerance tolerance_of(const std::string& format);

}  // namespace excavplan::test
