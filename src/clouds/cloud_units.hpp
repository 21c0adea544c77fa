// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/warning.hpp>
#include <excavplan/ground/height_map.hpp>

/// @file
/// Units of the coordinates of clouds, and whether a cloud can be in the one it is taken for.
/// Private to the library.

namespace excavplan {

struct CloudUnit {
  std::string word;  ///< of --unit
  double length;     ///< [m]
};

const std::vector<CloudUnit>& cloud_units();

/// The unit that brings a volume, measured with coordinates in units of `unit` [m], nearest to
/// `usual`.
const CloudUnit& likely_unit(double volume, double unit, double usual);

/// Code `units`, which ends trust: a volume from more than 1000 m^3, or below 1 litre, is none of a
/// bucket.
/// @param unit  that was taken for that of the coordinates [m]
std::optional<Warning> doubt_of_volume(double volume, const std::string& what, double unit);

/// Code `units`: a cloud that is narrower than any bucket, or wide with less than a point per
/// square metre, which no sensor leaves. Named are a likely unit, or degrees on the Earth.
/// @param unit  that was taken for that of the coordinates [m]
std::optional<Warning> doubt_of_extent(const Rectangle& extent, double density, double unit);

}  // namespace excavplan
