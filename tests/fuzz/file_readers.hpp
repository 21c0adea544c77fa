// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "base/text.hpp"

/// @file All that excavplan reads, by kind of file, for the fuzz targets and the bad files.

namespace excavplan {
struct JobHistory;
}

namespace excavplan::test {

/// A kind of file and what reads it.
struct FileReader {
  std::string name;  ///< "pcd"
  /// @return what the file says, a line for each number or text
  /// @throws Error (bad_file, bad_input)
  std::string (*read)(const std::string& path);
  /// The file ends in a checksum of what is before it.
  bool sealed = false;
};

std::vector<FileReader> cloud_readers();
std::vector<FileReader> image_readers();  ///< none without excavplan::survey
std::vector<FileReader> planning_readers();
std::vector<FileReader> recording_readers();
std::vector<FileReader> tool_readers();  ///< of what the tools take besides
/// For the fuzz targets alone: tests/design has their bad files.
std::vector<FileReader> design_readers();
std::vector<FileReader> job_readers();  ///< likewise; jobs, sites and beliefs
JobHistory job_on_flat_ground();        ///< that a log is read of

/// All but those of designs and jobs.
std::vector<FileReader> file_readers();
/// @throws std::out_of_range if there is none of that name
FileReader reader_of(const std::string& name);

/// What a file says, line by line.
class Said {
 public:
  Said& add(const std::string& name, double value) { return add(name, number_text(value)); }
  Said& add(const std::string& name, const std::string& value) {
    text_ += name + ' ' + value + '\n';
    return *this;
  }
  template <typename Numbers>
  Said& all(const std::string& name, const Numbers& numbers) {
    for (const double number : numbers) add(name, number);
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Points as text, or, of more than some thousand, their number and checksum.
std::string points_text(const std::vector<Eigen::Vector3d>& points);

/// Of a file of the fuzz targets, which may be of any length.
std::string content_of_file(const std::string& path);

}  // namespace excavplan::test
