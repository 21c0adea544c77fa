// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/cell_codes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/base64.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::ArrayXXi;
using Eigen::Index;

constexpr double steps_per_metre = 1000.0;
constexpr double highest = 1e9;  // [mm]

void append(std::uint64_t number, std::string& bytes) {
  for (; number >= 128; number >>= 7U) bytes += static_cast<char>(128U | (number & 127U));
  bytes += static_cast<char>(number);
}

/// Differences of numbers of 32 bits need 33.
std::uint64_t zigzag(std::int64_t number) {
  const auto doubled = static_cast<std::uint64_t>(number) << 1U;
  return number < 0 ? ~doubled : doubled;
}

std::int64_t unzigzag(std::uint64_t code) {
  const auto half = static_cast<std::int64_t>(code >> 1U);
  return (code & 1U) != 0 ? -half - 1 : half;
}

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  bool is_at_end() const { return at_ == bytes_.size(); }
  std::optional<std::uint64_t> next() {
    std::uint64_t number = 0;
    for (unsigned shift = 0; shift < 42 && at_ < bytes_.size(); shift += 7) {
      const auto byte = static_cast<unsigned char>(bytes_[at_++]);
      number |= std::uint64_t{byte & 127U} << shift;
      if (byte < 128) return number;
    }
    return std::nullopt;
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

int cut(std::int64_t number) {
  constexpr std::int64_t least = std::numeric_limits<int>::min();
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  return static_cast<int>(std::clamp(number, least, most));
}

}  // namespace

std::string codes_of(const ArrayXXi& numbers) {
  std::string bytes;
  const Index size = numbers.size(), cols = numbers.cols();
  for (Index i = 0; i < size;) {
    const auto at = [&](Index k) { return numbers(k / cols, k % cols); };
    append(zigzag(at(i)), bytes);
    if (at(i++) != 0) continue;
    const Index first = i;
    while (i < size && at(i) == 0) ++i;
    append(static_cast<std::uint64_t>(i - first), bytes);
  }
  return base64_of(bytes);
}

std::optional<ArrayXXi> numbers_of(std::string_view codes, Index rows, Index cols) {
  const auto bytes = read_base64(codes);
  if (!bytes || rows < 0 || cols < 0) return std::nullopt;
  Reader reader(*bytes);
  ArrayXXi numbers = ArrayXXi::Zero(rows, cols);
  const Index size = numbers.size();
  for (Index i = 0; i < size; ++i) {
    const auto code = reader.next();
    if (!code || unzigzag(*code) != cut(unzigzag(*code))) return std::nullopt;
    numbers(i / cols, i % cols) = static_cast<int>(unzigzag(*code));
    if (*code != 0) continue;
    const auto more = reader.next();
    if (!more || *more >= static_cast<std::uint64_t>(size - i)) return std::nullopt;
    i += static_cast<Index>(*more);
  }
  if (!reader.is_at_end()) return std::nullopt;
  return numbers;
}

ArrayXXi steps_of(const ArrayXXi& numbers) {
  ArrayXXi steps = numbers;
  const Index cols = numbers.cols();
  for (Index i = numbers.size(); --i > 0;) {
    steps(i / cols, i % cols) -= numbers((i - 1) / cols, (i - 1) % cols);
  }
  return steps;
}

ArrayXXi sums_of(const ArrayXXi& steps) {
  ArrayXXi sums = steps;
  const Index cols = steps.cols();
  for (Index i = 1; i < sums.size(); ++i) {
    int& sum = sums(i / cols, i % cols);
    sum = cut(std::int64_t{sum} + sums((i - 1) / cols, (i - 1) % cols));
  }
  return sums;
}

ArrayXXi millimetres_of(const ArrayXXd& z) {
  return z.unaryExpr([](double height) {
    if (std::isnan(height)) return unknown_height;
    return static_cast<int>(std::lround(std::clamp(height * steps_per_metre, -highest, highest)));
  });
}

ArrayXXd heights_of(const ArrayXXi& millimetres) {
  return millimetres.unaryExpr([](int height) {
    return height == unknown_height ? std::numeric_limits<double>::quiet_NaN()
                                    : height / steps_per_metre;
  });
}

}  // namespace excavplan
