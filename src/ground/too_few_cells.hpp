// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"

namespace excavplan {

/// The error (bad_input) of surfaces on one grid that share too few cells.
class TooFewCells : public Error {
 public:
  /// @param shared  begins the message: "the maps share 12 known cells"
  TooFewCells(const std::string& shared, std::size_t fewest, double cell_size)
      : Error(ErrorKind::bad_input, found(shared, fewest) +
                                        ": do they overlap, with points enough for cells of " +
                                        readable(cell_size, 2) + " m?"),
        found_(found(shared, fewest)),
        cell_size_(cell_size) {}

  /// The error (bad_file) of scans whose extents overlap.
  Error of_scans(const std::string& names) const {
    return {ErrorKind::bad_file, names + ": " + found_ + ": too few points for cells of " +
                                     readable(cell_size_, 2) +
                                     " m, or the scans show different ground"};
  }

 private:
  static std::string found(const std::string& shared, std::size_t fewest) {
    return shared + ", at least " + std::to_string(fewest) + " are needed";
  }

  std::string found_;
  double cell_size_;
};

}  // namespace excavplan
