// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/change/dig_volumes.hpp>

#include "scans/scan_pairs.hpp"

/// @file
/// Whether scans can be what they are taken for: units, frame, motion between them, order
/// (docs/methods.md#checks-of-the-scans). Private to the library.

namespace excavplan {

/// Code `outliers`, which does not end trust: points that hold no data were left out.
std::optional<Warning> check_no_data(const ScanOutline& seen, const Scan& scan);

/// Codes `units` (too small, or too wide for so few points) or `frame` (a camera's, or z is not up)
/// of one scan, both of which end trust.
std::optional<Warning> check_outline(const ScanOutline& seen, const Scan& scan);

/// Codes `units` (too small, or one scan in other units than the other), `coarse_heights` (rounded
/// to more than 2 cm) and `frame` (a camera's, or z is not up), all of which end trust.
std::vector<Warning> check_outlines(const OutlinedPair& pair);

/// Code `registration_beyond_prior`: the scan after has moved by more than three standard
/// deviations of the priors. Ends trust where the ground still differs, and where heights are so
/// far apart that they are of two datums or units.
///
/// @param area of the change that was found in the surfaces of `pair`
std::vector<Warning> check_registration(const ScanPair& scans, const RegisteredPair& pair,
                                        const AreaChange& area);

/// Code `tilted`: ground of more than 5 degrees without a frame. Ends trust where walls may
/// overhang.
///
/// @param area of the change that was found in `surfaces`
std::vector<Warning> check_tilt(const ScanPair& scans, const SurfacePair& surfaces,
                                const VolumeChange& change, const AreaChange& area);

/// Of a machine that was taken out of the scans and hid a part of hole or heap.
std::vector<Warning> check_machine(std::uint64_t machine_points, const VolumeChange& change);

/// Of ground that is bent like a ball about the sensor.
std::vector<Warning> check_curvature(const SurfacePair& surfaces, const AreaChange& area);

/// Code `units`: a hole that no bucket digs; ends trust.
/// @param unit  of the coordinates in the scans [m]
std::vector<Warning> check_volumes(const VolumeChange& change, double unit);

/// Code `looks_swapped`: a heap steeper than loose soil stands and a gentle hole, or a heap steeper
/// than the hole and a loss beside it. Ends trust.
/// @param pairs  of each area of the change
std::vector<Warning> check_slopes(const std::vector<const SurfacePair*>& pairs,
                                  const VolumeChange& change);

/// @throws Error (bad_file) naming the scans if they look swapped, or those of the dump area do,
///         alone or with those of the dig area
/// @param unit  as of check_volumes()
void refuse_swapped(const VolumeChange& change, const std::string& names, double unit);

/// Without the warnings that another explains, which go when that is mended: where the coordinates
/// are in another unit all limits of lengths fail, where z is not up those of heights.
std::vector<Warning> causes_of(std::vector<Warning> warnings);

/// Runs `work`; an error in it is told together with the doubts about the scans, which explain it.
template <typename Work>
auto with_doubts(const std::vector<Warning>& doubts, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (doubts.empty()) throw;
    throw Error(error.kind(), error.what() + ("; " + doubts.front().message));
  }
}

}  // namespace excavplan
