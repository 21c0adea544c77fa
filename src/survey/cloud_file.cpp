// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <limits>

#include <Eigen/LU>

#include <excavplan/error.hpp>
#include <excavplan/survey/cloud.hpp>

#include "cloud_format.hpp"
#include "json_file.hpp"

namespace excavplan {
namespace {

/// The ending of a file name in small letters, with its dot.
std::string ending_of(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  if (dot == path.npos || path[dot] == '/') return "";
  std::string ending = path.substr(dot);
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

bool looks_like_ply(std::string_view text) {
  return text.substr(0, 4) == "ply\n" || text.substr(0, 5) == "ply\r\n";
}

/// A file that is neither text nor one of ours is named, where people are likely to try it.
void require_text(const FileBytes& file) {
  struct Signature {
    std::string_view bytes;
    const char* name;
  };
  constexpr Signature known[] = {{"LASF", "a LAS or LAZ file"},
                                 {"SQLite format 3", "a database, such as a ROS 2 bag"},
                                 {"#ROSBAG", "a ROS bag"},
                                 {"\x89PNG", "a PNG image"}};
  const std::string expected = "a cloud as PCD, PLY or XYZ text";
  for (const Signature& signature : known) {
    if (file.text().substr(0, signature.bytes.size()) == signature.bytes) {
      file.fail("byte 0", signature.name, expected);
    }
  }
  const std::string_view start = file.text().substr(0, longest_line);
  const auto odd = std::find_if(start.begin(), start.end(), [](char c) {
    return static_cast<unsigned char>(c) < 32 && c != '\t' && c != '\n' && c != '\r';
  });
  if (odd != start.end()) {
    file.fail("byte " + std::to_string(odd - start.begin()),
              "the byte " + std::to_string(static_cast<unsigned char>(*odd)), expected);
  }
}

/// Appends the shortest text of a number that reads back the same.
void append_number(std::string& text, double value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

std::string text_rows(const Cloud& cloud) {
  std::string rows;
  rows.reserve(cloud.points.size() * 30);
  for (const Eigen::Vector3d& point : cloud.points) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      append_number(rows, point[axis]);
      rows += axis < 2 ? ' ' : '\n';
    }
  }
  return rows;
}

/// True if float32 would move a point by more than 0.1 mm.
bool needs_double(const Cloud& cloud) {
  constexpr double farthest = 1e-4;
  return std::any_of(cloud.points.begin(), cloud.points.end(), [](const Eigen::Vector3d& point) {
    if (!point.allFinite()) return false;
    if (point.cwiseAbs().maxCoeff() > std::numeric_limits<float>::max()) return true;
    return (point - point.cast<float>().cast<double>()).norm() > farthest;
  });
}

template <typename T>
std::string binary_rows(const Cloud& cloud) {
  std::string rows;
  rows.reserve(cloud.points.size() * 3 * sizeof(T));
  for (const Eigen::Vector3d& point : cloud.points) {
    const Eigen::Matrix<T, 3, 1> row = point.cast<T>();
    rows.append(reinterpret_cast<const char*>(row.data()), 3 * sizeof(T));
  }
  return rows;
}

std::string pcd_header(const Cloud& cloud, bool is_double, const std::string& encoding) {
  const std::string size = is_double ? "8" : "4";
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE " + size +
         " " + size + " " + size + "\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
         std::to_string(cloud.width) + "\nHEIGHT " + std::to_string(cloud.height) +
         "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(cloud.points.size()) + "\nDATA " +
         encoding + "\n";
}

std::string ply_header(const Cloud& cloud, bool is_double, const std::string& encoding) {
  const std::string type = is_double ? "double" : "float";
  return "ply\nformat " + encoding + " 1.0\nelement vertex " + std::to_string(cloud.points.size()) +
         "\nproperty " + type + " x\nproperty " + type + " y\nproperty " + type +
         " z\nend_header\n";
}

std::string content_of(const Cloud& cloud, CloudFormat format) {
  switch (format) {
    case CloudFormat::pcd_ascii:
      return pcd_header(cloud, true, "ascii") + text_rows(cloud);
    case CloudFormat::ply_ascii:
      return ply_header(cloud, true, "ascii") + text_rows(cloud);
    case CloudFormat::xyz:
      return "# x y z [m]\n" + text_rows(cloud);
    case CloudFormat::pcd_binary:
    case CloudFormat::ply_binary:
      break;
  }
  const bool is_double = needs_double(cloud);
  return (format == CloudFormat::pcd_binary
              ? pcd_header(cloud, is_double, "binary")
              : ply_header(cloud, is_double, "binary_little_endian")) +
         (is_double ? binary_rows<double>(cloud) : binary_rows<float>(cloud));
}

}  // namespace

Cloud read_cloud(const std::string& path, std::uint64_t memory_limit) {
  const FileBytes file(path, memory_limit);
  if (looks_like_ply(file.text())) return read_ply(file);
  if (looks_like_pcd(file)) return read_pcd(file);
  require_text(file);
  return read_xyz(file);
}

void write_cloud(const std::string& path, const Cloud& cloud, CloudFormat format) {
  if (cloud.width * cloud.height != cloud.points.size()) {
    throw Error(ErrorKind::bad_input, path + ": a cloud of " + std::to_string(cloud.points.size()) +
                                          " points must be width x height, is " +
                                          std::to_string(cloud.width) + " x " +
                                          std::to_string(cloud.height));
  }
  write_file(path, content_of(cloud, format));
}

CloudFormat cloud_format_of_name(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending == ".pcd") return CloudFormat::pcd_binary;
  if (ending == ".ply") return CloudFormat::ply_binary;
  if (ending == ".xyz" || ending == ".txt" || ending == ".asc") return CloudFormat::xyz;
  throw Error(ErrorKind::bad_input,
              path + ": the name of a cloud must end in .pcd, .ply, .xyz, .txt or .asc");
}

Eigen::Matrix4d read_frame(const std::string& path) {
  constexpr std::uint64_t memory_limit = 1 << 20;
  constexpr double tolerance = 1e-4;
  const FileBytes file(path, memory_limit);
  LineReader lines(file);
  std::vector<double> numbers;
  while (lines.next_filled()) {
    for (const auto word : words_of(lines.line().substr(0, lines.line().find('#')))) {
      numbers.push_back(number_of(word, lines));
    }
  }
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    file.fail("a frame", found, expected);
  };
  if (numbers.size() != 16) refuse(std::to_string(numbers.size()) + " numbers", "4 rows of 4");
  const Eigen::Matrix4d frame =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  if (!frame.allFinite()) refuse("a number that is not finite", "finite numbers");
  if (frame.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    refuse("another last row", "0 0 0 1");
  }
  const Eigen::Matrix3d rotation = frame.topLeftCorner<3, 3>();
  const double error =
      (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > tolerance) {
    refuse("a matrix R with an entry " + number_text(error) + " off in R'R - 1",
           "a rotation to " + number_text(tolerance));
  }
  if (rotation.determinant() < 0.0) refuse("a mirroring (determinant -1)", "a rotation");
  return frame;
}

}  // namespace excavplan
