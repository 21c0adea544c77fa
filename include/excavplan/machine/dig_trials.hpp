// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

/// @file
/// One dig from many starts, to compare them (dig_path.hpp).

namespace excavplan {

struct DigParameters;
struct DigPath;
struct DigPathOptions;
struct Machine;

/// Lays out one dig from start after start. Keeps references to all that it is given.
class DigTrials {
 public:
  /// Judges a path that is laid out up to its lift; false gives it up.
  using Judge = std::function<bool(const DigPath&)>;

  /// @throws Error (bad_input) if an option is out of range
  DigTrials(const Machine& machine, const DigParameters& parameters,
            const std::function<double(double)>& ground, const DigPathOptions& options);

  /// The path of make_dig_path(), to the bit; nothing where it cannot be driven or is given up.
  std::optional<DigPath> from(double start_x, const Judge& judge) const;

 private:
  const Machine& machine_;
  const DigParameters& parameters_;
  const std::function<double(double)>& ground_;
  const DigPathOptions& options_;
};

}  // namespace excavplan
