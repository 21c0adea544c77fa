// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/change/volume_change.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// What a report draws in three dimensions and in charts: ground, machine and digs.

namespace excavplan {

/// One state of the ground.
struct ShownGround {
  std::string name;  ///< "before"
  HeightMap map;
};

/// Ground of one area in its states, the earliest first, on one grid.
struct ReportArea {
  std::vector<ShownGround> states;
  Eigen::ArrayXXi zone = {};  ///< of each cell, index into ReportScene::zones, -1 outside of them
};

/// A dig as it is played.
struct ReportDig {
  std::string name;                  ///< "planned"
  DigPath path;                      ///< as far as the machine came
  Trajectory trajectory;             ///< of that path
  std::vector<ForceSample> history;  ///< one for each step between poses but the lift's, or none
  std::optional<std::size_t> state = {};  ///< of the areas, that it leaves; else the last
};

struct ReportScene {
  std::vector<ReportArea> areas;
  std::vector<ChangeZone> zones;   ///< of all areas
  std::optional<Machine> machine;  ///< where it stands is known
  std::vector<ReportDig> digs;
};

/// The dig along a path, with the trajectory that it takes; one that stalled ends there.
ReportDig played_dig(const std::string& name, const Machine& machine, const DigPath& path,
                     const DigResult& dig);

/// Areas of an estimate: the ground before, and after it what the change makes of it.
std::vector<ReportArea> surveyed_areas(const VolumeChange& change,
                                       const std::vector<HeightMap>& before);

/// For data/report/app. Heights are coded as 16-bit numbers in base64; maps of more than 250000
/// cells are coarsened.
nlohmann::ordered_json to_json(const ReportScene& scene);

}  // namespace excavplan
