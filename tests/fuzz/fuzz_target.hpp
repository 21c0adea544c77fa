// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

/// @file What the fuzz targets run. Each takes any bytes, and ends the program by an exception
/// where something does not hold.

namespace excavplan::test {

/// A fuzz target: what is run and what is known of it.
struct FuzzTarget {
  std::string name;  ///< of the program fuzz_NAME and of the folder corpus/NAME
  std::function<void(std::string_view bytes)> run;
};

/// Bytes to machine, soil, ground and path to a dig: nothing is NaN, the mass balance holds, and
/// the energy lifts the payload.
void fuzz_dig(std::string_view bytes);
/// Bytes to two height maps and options to volumes, which are finite.
void fuzz_volume_change(std::string_view bytes);
/// Bytes to a line of a simulator's program: refused by an Error whose text is short and printable,
/// or a result that is finite.
void fuzz_simulator_answer(std::string_view bytes);

/// One for every FileReader, and those above. A reader reads or throws an Error that names the file
/// in a line that is short and printable.
std::vector<FuzzTarget> fuzz_targets();
/// @throws std::out_of_range if there is none of that name
FuzzTarget fuzz_target(const std::string& name);

/// @throws std::logic_error
void require_that(bool holds, const std::string& what);

/// Numbers from bytes: zeros where they end.
class NumbersOfBytes {
 public:
  explicit NumbersOfBytes(std::string_view bytes) : bytes_(bytes) {}

  bool at_end() const { return bytes_.empty(); }
  std::size_t index(std::size_t count) { return take<std::uint8_t>() % count; }
  double between(double low, double high) {
    return low + (high - low) * take<std::uint16_t>() / 65535.0;
  }
  /// Mostly in these bounds, else anything.
  double odd(double low, double high) {
    constexpr double huge = std::numeric_limits<double>::infinity();
    const std::array<double, 8> hostile = {0.0,   -1.0,  std::nan(""), huge,
                                           -huge, 1e300, 1e-300,       -0.0};
    const std::size_t kind = index(32);
    if (kind < hostile.size()) return hostile[kind];
    return kind == hostile.size() ? take<double>() : between(low, high);
  }

 private:
  template <typename T>
  T take() {
    T value{};
    const std::size_t count = std::min(sizeof value, bytes_.size());
    std::memcpy(&value, bytes_.data(), count);
    bytes_.remove_prefix(count);
    return value;
  }
  std::string_view bytes_;
};

}  // namespace excavplan::test
