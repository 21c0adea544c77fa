// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz/file_readers.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace excavplan::test {

std::vector<FileReader> file_readers() {
  std::vector<FileReader> all;
  for (const auto& some : {cloud_readers(), image_readers(), planning_readers(),
                           recording_readers(), tool_readers()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

FileReader reader_of(const std::string& name) {
  for (const FileReader& reader : file_readers()) {
    if (reader.name == name) return reader;
  }
  throw std::out_of_range("no reader of " + name);
}

std::string points_text(const std::vector<Eigen::Vector3d>& points) {
  constexpr std::size_t most_lines = 3000;
  Said said;
  if (points.size() > most_lines) {
    std::uint64_t sum = 0;
    for (const Eigen::Vector3d& p : points) {
      const std::string_view bytes(reinterpret_cast<const char*>(p.data()), sizeof p);
      sum = 31 * sum + checksum(std::string(bytes));
    }
    return said.add("points", static_cast<double>(points.size()))
        .add("sum", std::to_string(sum))
        .text();
  }
  for (const Eigen::Vector3d& p : points) {
    said.add("point", number_text(p.x()) + ' ' + number_text(p.y()) + ' ' + number_text(p.z()));
  }
  return said.text();
}

std::string content_of_file(const std::string& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

}  // namespace excavplan::test
