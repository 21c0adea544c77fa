// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

/// @file
/// Heights of cells as short texts. Private to the project; data/report/app/cells.js reads them.

namespace excavplan {

/// Base64 of whole numbers row by row, each as LEB128 of its zigzag code (0, -1, 1, -2, ...); after
/// a 0 stands how many more zeros follow.
std::string codes_of(const Eigen::ArrayXXi& numbers);
/// The inverse; nothing of a text that is not of so many cells.
std::optional<Eigen::ArrayXXi> numbers_of(std::string_view codes, Eigen::Index rows,
                                          Eigen::Index cols);

/// Each number less the one before it, row by row: of layers that are alike over many cells their
/// codes are shorter.
Eigen::ArrayXXi steps_of(const Eigen::ArrayXXi& numbers);
/// The inverse.
Eigen::ArrayXXi sums_of(const Eigen::ArrayXXi& steps);

/// Heights in whole millimetres; NaN is unknown_height. Beyond 10^6 m they are cut.
Eigen::ArrayXXi millimetres_of(const Eigen::ArrayXXd& z);
Eigen::ArrayXXd heights_of(const Eigen::ArrayXXi& millimetres);
inline constexpr int unknown_height = -(1 << 30);

}  // namespace excavplan
