// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/point_stream.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>

#include <excavplan/base/error.hpp>

namespace excavplan {
namespace {

/// True if every point is three float32 of this machine and nothing else, as most are.
bool are_plain_floats(const Columns& columns, bool swapped) {
  constexpr std::size_t size = sizeof(float);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (columns.type[axis] != ScalarType::float32 || columns.stride[axis] != 3 * size ||
        columns.offset[axis] != columns.offset[0] + axis * size) {
      return false;
    }
  }
  return !swapped;
}

void copy_points(const char* block, const Columns& columns, bool swapped,
                 std::vector<Eigen::Vector3d>& points) {
  if (are_plain_floats(columns, swapped)) {
    std::array<float, 3 * points_at_a_time> raw;
    std::memcpy(raw.data(), block + columns.offset[0], points.size() * 3 * sizeof(float));
    const auto count = static_cast<Eigen::Index>(3 * points.size());
    Eigen::Map<Eigen::ArrayXd>(points.data()->data(), count) =
        Eigen::Map<const Eigen::ArrayXf>(raw.data(), count).cast<double>();
    return;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char* const column = block + columns.offset[axis];
    const std::size_t stride = columns.stride[axis];
    with_type(columns.type[axis], [&](auto value) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        points[i][static_cast<Eigen::Index>(axis)] =
            static_cast<double>(load<decltype(value)>(column + i * stride, swapped));
      }
    });
  }
}

/// Appends the shortest text of a number that reads back the same.
void append_number(std::string& text, double value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

template <typename T>
std::string rows_of(const std::vector<Eigen::Vector3d>& points) {
  std::string rows;
  rows.reserve(points.size() * 3 * sizeof(T));
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Matrix<T, 3, 1>& row = point.cast<T>();
    rows.append(reinterpret_cast<const char*>(row.data()), 3 * sizeof(T));
  }
  return rows;
}

}  // namespace

void refuse_change() { throw Error(ErrorKind::bad_file, "a scan changed while it was read"); }

void visit_parts(const std::vector<Eigen::Vector3d>& points, const PointVisitor& visit) {
  for (auto from = points.begin(); from != points.end();) {
    const auto left = static_cast<std::size_t>(points.end() - from);
    const auto to = from + static_cast<std::ptrdiff_t>(std::min(left, points_at_a_time));
    visit({from, to});
    from = to;
  }
}

double load_scalar(ScalarType type, const char* bytes, bool swapped) {
  return with_type(
      type, [&](auto value) { return static_cast<double>(load<decltype(value)>(bytes, swapped)); });
}

void stream_block(const char* block, std::uint64_t count, const Columns& columns, PointSink& sink) {
  std::vector<Eigen::Vector3d> points;
  Columns part = columns;
  for (std::uint64_t begin = 0; begin < count; begin += points.size()) {
    points.resize(std::min<std::uint64_t>(points_at_a_time, count - begin));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      part.offset[axis] = columns.offset[axis] + begin * columns.stride[axis];
    }
    copy_points(block, part, false, points);
    sink.take(points);
  }
}

void stream_rows(FileStream& file, std::uint64_t count, const Columns& columns, bool swapped,
                 PointSink& sink) {
  std::vector<Eigen::Vector3d> points;
  const std::size_t row = columns.stride[0];
  while (count > 0) {
    points.resize(std::min<std::uint64_t>(points_at_a_time, count));
    copy_points(file.peek(points.size() * row).data(), columns, swapped, points);
    file.skip(points.size() * row);
    sink.take(points);
    count -= points.size();
  }
}

std::string text_rows(const std::vector<Eigen::Vector3d>& points) {
  std::string rows;
  rows.reserve(points.size() * 30);
  for (const Eigen::Vector3d& point : points) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      append_number(rows, point[axis]);
      rows += axis < 2 ? ' ' : '\n';
    }
  }
  return rows;
}

bool needs_double(const std::vector<Eigen::Vector3d>& points) {
  constexpr double farthest = 1e-4;
  return std::any_of(points.begin(), points.end(), [](const Eigen::Vector3d& point) {
    if (!point.allFinite()) return false;
    if (point.cwiseAbs().maxCoeff() > std::numeric_limits<float>::max()) return true;
    const Eigen::Vector3f rounded = point.cast<float>();
    return (point - rounded.cast<double>()).norm() > farthest;
  });
}

std::string binary_rows(const std::vector<Eigen::Vector3d>& points, bool is_double) {
  return is_double ? rows_of<double>(points) : rows_of<float>(points);
}

}  // namespace excavplan
