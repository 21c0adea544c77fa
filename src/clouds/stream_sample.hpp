// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/random.hpp"

/// @file A random choice of values that stream by. Private to the library.

namespace excavplan {

/// All values of a stream that is shorter than `capacity`, else at least half as many, an even
/// random choice: one of every so many successive ones. The same for the same stream, however it is
/// parted. Random, as rows of a scan would beat with a regular choice.
template <typename T>
class StreamSample {
 public:
  /// `capacity` is even.
  explicit StreamSample(std::size_t capacity) : capacity_(capacity), random_(1) {}

  void add(const T& value) {
    if (count_++ == chosen_) keep(value);
  }
  void add(const std::vector<T>& values) {
    for (; chosen_ < count_ + values.size();) keep(values[chosen_ - count_]);
    count_ += values.size();
  }

  const std::vector<T>& values() const { return values_; }

 private:
  void keep(const T& value) {
    values_.push_back(value);
    if (values_.size() == capacity_) thin();
    chosen_ = values_.size() * stride_ + random_.index(stride_);
  }

  /// Leaves one of every two at random.
  void thin() {
    for (std::size_t i = 0; i < capacity_ / 2; ++i) values_[i] = values_[2 * i + random_.index(2)];
    values_.resize(capacity_ / 2);
    stride_ *= 2;
  }

  std::size_t capacity_;
  Random random_;
  std::vector<T> values_;
  std::uint64_t count_ = 0;
  std::uint64_t stride_ = 1;  ///< every stretch of so many values gives one
  std::uint64_t chosen_ = 0;  ///< of the stretch that runs or comes
};

}  // namespace excavplan
