// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <limits>

#include <Eigen/LU>

#include <excavplan/error.hpp>
#include <excavplan/survey/cloud.hpp>

#include "base/files.hpp"
#include "base/text.hpp"
#include "survey/cloud_format.hpp"

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
void require_text(FileStream& file) {
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
    if (file.peek(signature.bytes.size()) == signature.bytes) {
      file.fail("byte 0", signature.name, expected);
    }
  }
  const std::string_view start = file.peek(longest_line);
  const auto odd = std::find_if(start.begin(), start.end(), [](char c) {
    return static_cast<unsigned char>(c) < 32 && c != '\t' && c != '\n' && c != '\r';
  });
  if (odd != start.end()) {
    file.fail("byte " + std::to_string(odd - start.begin()),
              "the byte " + std::to_string(static_cast<unsigned char>(*odd)), expected);
  }
}

CloudShape stream(FileStream& file, PointSink& sink) {
  if (looks_like_ply(file.peek(5))) return stream_ply(file, sink);
  if (looks_like_pcd(file)) return stream_pcd(file, sink);
  require_text(file);
  return stream_xyz(file, sink);
}

std::string gibibytes(std::uint64_t bytes) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, static_cast<double>(bytes) / (1 << 30),
                                 std::chars_format::fixed, 3)
                       .ptr;
  return {text, end};
}

[[noreturn]] void refuse_size(const FileStream& file, std::uint64_t points, std::uint64_t limit) {
  file.refuse("found " + std::to_string(file.size()) + " bytes for " + std::to_string(points) +
              " points, expected what fits into " + gibibytes(limit) + " GiB of memory");
}

/// Keeps all points. The limit counts them and the file.
class Collector : public PointSink {
 public:
  Collector(const FileStream& file, std::uint64_t limit, std::vector<Eigen::Vector3d>& points)
      : file_(file), limit_(limit), points_(points) {}

  void require_memory(std::uint64_t points, std::uint64_t more_bytes) override {
    const std::uint64_t free = limit_ > file_.size() ? limit_ - file_.size() : 0;
    const bool fits = file_.size() <= limit_ && more_bytes <= free &&
                      points <= (free - more_bytes) / sizeof(Eigen::Vector3d);
    if (!fits) refuse_size(file_, points, limit_);
    points_.reserve(points);
  }

  void take(const std::vector<Eigen::Vector3d>& points) override {
    const std::size_t needed = points_.size() + points.size();
    if (needed > points_.capacity()) {
      require_memory(std::max(needed, std::min(2 * points_.capacity(), most_points())), 0);
    }
    points_.insert(points_.end(), points.begin(), points.end());
  }

 private:
  std::size_t most_points() const {
    return (limit_ - std::min(limit_, file_.size())) / sizeof(Eigen::Vector3d);
  }

  const FileStream& file_;
  std::uint64_t limit_;
  std::vector<Eigen::Vector3d>& points_;
};

/// Keeps no point.
class Passage : public PointSink {
 public:
  Passage(const FileStream& file, const PointVisitor& visit) : file_(file), visit_(visit) {}

  void require_memory(std::uint64_t points, std::uint64_t more_bytes) override {
    constexpr std::uint64_t limit = std::uint64_t{4} << 30;
    if (more_bytes > limit) refuse_size(file_, points, limit);
  }
  void take(const std::vector<Eigen::Vector3d>& points) override { visit_(points); }

 private:
  const FileStream& file_;
  const PointVisitor& visit_;
};

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
    const Eigen::Vector3f rounded = point.cast<float>();
    return (point - rounded.cast<double>()).norm() > farthest;
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
  FileStream file(path);
  Cloud cloud;
  Collector collector(file, memory_limit, cloud.points);
  collector.require_memory(0, 0);
  const CloudShape shape = stream(file, collector);
  cloud.width = shape.width;
  cloud.height = shape.height;
  return cloud;
}

void stream_cloud(const std::string& path, const PointVisitor& visit) {
  FileStream file(path);
  Passage passage(file, visit);
  stream(file, passage);
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
  constexpr std::uint64_t largest = 1 << 20;
  constexpr double tolerance = 1e-4;
  FileStream file(path);
  if (file.size() > largest) {
    file.refuse("found " + std::to_string(file.size()) + " bytes, expected at most " +
                std::to_string(largest) + " for a frame");
  }
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
