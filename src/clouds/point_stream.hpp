// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/clouds/cloud.hpp>

#include "base/scalar.hpp"
#include "clouds/file_stream.hpp"

/// @file Points on their way out of files and into them. Private to the library.

namespace excavplan {

/// Gives all points, those that are not finite included, to a visitor; the same on every call.
using PointSource = std::function<void(const PointVisitor&)>;
/// For who finds that they are not. @throws Error (bad_file)
[[noreturn]] void refuse_change();

/// Where a reader puts the points of a file, in their order.
class PointSink {
 public:
  virtual ~PointSink() = default;
  /// Called before the points, where a file says how many there are at most, and before more
  /// than the points at hand is held for them. @throws Error (bad_file) if that is too much
  virtual void require_memory(std::uint64_t points, std::uint64_t more_bytes) = 0;
  virtual void take(const std::vector<Eigen::Vector3d>& points) = 0;
};

constexpr std::size_t points_at_a_time = 2048;  ///< stay in the second cache

/// Calls `visit` with the points of a cloud, some thousand at a time.
void visit_parts(const std::vector<Eigen::Vector3d>& points, const PointVisitor& visit);

/// Passes on points one by one.
class PointBatch {
 public:
  explicit PointBatch(PointSink& sink) : sink_(sink) { points_.reserve(points_at_a_time); }
  void add(const Eigen::Vector3d& point) {
    points_.push_back(point);
    if (points_.size() == points_at_a_time) hand_on();
  }
  /// To be called after the last one.
  void hand_on() {
    if (!points_.empty()) sink_.take(points_);
    points_.clear();
  }

 private:
  PointSink& sink_;
  std::vector<Eigen::Vector3d> points_;
};

/// The number at `bytes`, of the machine's byte order or, with `swapped`, the other one.
double load_scalar(ScalarType type, const char* bytes, bool swapped);

/// Offsets of x, y and z of the points in a block of memory.
struct Columns {
  std::array<ScalarType, 3> type{};
  std::array<std::size_t, 3> offset{};  ///< of the first point [byte]
  std::array<std::size_t, 3> stride{};  ///< from point to point [byte]
};
/// Passes on `count` points that are contiguous in a file.
void stream_rows(FileStream& file, std::uint64_t count, const Columns& columns, bool swapped,
                 PointSink& sink);
/// Passes on points in memory.
void stream_block(const char* block, std::uint64_t count, const Columns& columns, PointSink& sink);

/// One point a line, each number as the shortest text that reads back the same.
std::string text_rows(const std::vector<Eigen::Vector3d>& points);
/// True if float32 would move a point by more than 0.1 mm.
bool needs_double(const std::vector<Eigen::Vector3d>& points);
/// Points in memory, little-endian float64 or float32.
std::string binary_rows(const std::vector<Eigen::Vector3d>& points, bool is_double);

}  // namespace excavplan
