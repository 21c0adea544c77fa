// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/change/change_options.hpp>
#include <excavplan/change/dig_volumes.hpp>
#include <excavplan/change/known_ground.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/registration.hpp>

#include "change/change_zones.hpp"
#include "change/objects.hpp"
#include "change/zone_parts.hpp"
#include "ground/error_field.hpp"
#include "ground/noise_model.hpp"
#include "ground/sensor_place.hpp"

namespace excavplan {

/// Sums over one zone.
struct ZoneSum {
  double volume = 0.0;   // [m^3]
  double area = 0.0;     // [m^2]
  double noise = 0.0;    // variance of the volume by the noise of single cells [m^6]
  double holes = 0.0;    // and by the filling of unknown ones [m^6]
  double faces = 0.0;    // and by the position of steep faces [m^6]
  double thin = 0.0;     // and by soil that is too thin to tell from noise [m^6]
  double unknown = 0.0;  // area that was filled [m^2]
  double swept = 0.0;    // of that what the path of the bucket tells [m^2]
  double shadow = 0.0;   // and of that in shadows under known sight lines [m^2]
  double loose = 0.0;    // loose soil that it took from ground that is known [m^3]
  double before = 0.0;   // of its variance by noise, what the surface before made [m^6]
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Rectangle extent;
  bool is_cut = false;
  /// What of a rise may lie beyond the edge of the survey [m^3]; infinite where it grows towards
  /// it.
  double beyond_edge = 0.0;

  /// By all that does not touch other zones.
  double variance() const { return noise + holes + faces + thin; }
};

/// One surveyed area and its zones.
struct Area {
  HeightMap grid;  // without heights
  ChangedGround ground;
  ZoneParts parts;
  Eigen::ArrayXXi unknown;  // 1 where a scan saw nothing
  std::vector<ZoneSum> zones;
  std::vector<ZoneKind> kinds;
  ZoneErrors errors;
  Eigen::VectorXd outliers;     // what they leave in each zone, in `errors` too [m^3]
  NoiseModel noise;             // of stable cells
  Eigen::ArrayXXd variance;     // of each cell's difference, without the datum [m^2]
  double systematic_rms = 0.0;  // of stripes and doming that were taken off [m]
  std::vector<Object> objects;
  Eigen::ArrayXXi swept_unseen = {};       // 1 where the path alone tells the floor, if it is told
  bool is_cut_told = false;                // what the bucket cut is known (KnownGround::cut)
  std::optional<SensorPlace> inferred;     // of the scan after, where nothing says it
  std::optional<PlaceDoubt> place_before;  // of the place that is said, of each scan
  std::optional<PlaceDoubt> place_after;
};

/// Surveys one area: corrects for motion, removes objects, finds, fills and sums zones, and
/// subtracts the error that the stable ground predicts. The zones have no kind yet.
///
/// @throws Error (bad_input) if the surfaces are not on one grid or share fewer than 100 known
///         cells
/// @param known  of the ground before; null: nothing
Area survey(const SurfacePair& pair, const ChangeOptions& options,
            const KnownGround* known = nullptr);

}  // namespace excavplan
