// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/ground/ground_state.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/soil.hpp>

#include "base/random.hpp"

/// @file
/// Digs in a row on one site by a built-in simulator, each with the scan after it, even in plan.
/// The truth is that of the simulator: bank, loose soil and density of the ground.

namespace excavplan::test {

/// Where the digs of a series lie to each other.
enum class Layout { apart, beside, behind, trench, inside };
inline constexpr Layout layouts[] = {Layout::apart, Layout::beside, Layout::behind, Layout::trench,
                                     Layout::inside};
const char* name(Layout layout);

struct SeriesSettings {
  Layout layout = Layout::apart;
  double density_percent = 50.0;
  std::uint64_t seed = 1;
  double noise = 0.005;           ///< of every coordinate of a point [m]
  double roughness = 0.008;       ///< of the ground before the first dig, rms [m]
  double points_per_m2 = 2500.0;  ///< of a scan
  double cell = 0.05;             ///< of the simulated ground [m]
  bool heap_in_sight = true;      ///< else the soil goes out of sight
  const char* simulator = "height-map";
};

/// One dig of a series, in the frame of the machine that dug it.
struct SeriesDig {
  DigPath path;
  double bank_cut = 0.0;      ///< undisturbed soil that was cut or slid [m^3]
  double loose_before = 0.0;  ///< all loose soil on the site [m^3]
  double payload_mass = 0.0;  ///< moist [kg]
  Eigen::Vector2d dump_at;    ///< [m]
};

/// A site that is dug again and again.
class DigSeries {
 public:
  explicit DigSeries(const SeriesSettings& settings);

  /// Digs once; no dig where the machine stalls or finds no path.
  std::optional<SeriesDig> dig();
  /// A scan of the ground as it is, in the frame of the machine of the last dig.
  std::shared_ptr<const Cloud> scan();

  const Machine& machine() const { return machine_; }
  const SoilKind& soil() const { return soil_; }
  /// The true ground, in the frame of the machine of the last dig.
  Terrain ground() const;
  /// A state of the site in the frame of the machine of the last dig, and back.
  GroundState in_frame(GroundState state) const;
  GroundState in_site(GroundState state) const;
  /// Where the machine of the last dig stands on the site [m].
  const Eigen::Vector2d& place() const { return place_; }
  /// Stands the machine at the place of the next dig.
  void move();

 private:
  std::optional<DigPath> path_for_next();

  SeriesSettings settings_;
  Machine machine_;
  SoilKind soil_;
  Terrain site_;
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();
  Random random_;
  int digs_ = 0;
};

}  // namespace excavplan::test
