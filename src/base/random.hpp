// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace excavplan {

/// A reproducible stream of random numbers: the same numbers on every compiler and standard
/// library, which std::*_distribution does not promise.
///
/// Streams are cheap. With one for each individual, pixel row or dig the result does not depend on
/// the order in which threads draw. Generator: SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).
class Random {
 public:
  /// The stream of these three keys.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0, std::uint64_t substream = 0)
      : state_(mix(mix(mix(seed) ^ stream) ^ substream)) {}

  /// 64 random bits.
  std::uint64_t bits() { return mix(state_ += 0x9E3779B97F4A7C15ULL); }

  /// In [0, 1), 53 bits.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  /// In [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// In 0 .. count - 1; count > 0. The bias of the multiplication is below count / 2^53.
  std::uint64_t index(std::uint64_t count) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(count));
  }

  /// Standard normal (Box and Muller 1958).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace excavplan
