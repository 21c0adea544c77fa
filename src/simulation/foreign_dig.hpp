// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

#include "earth/ground_window.hpp"

/// @file
/// What a simulator outside of the program is asked and what it answers, however it is reached.

namespace excavplan {

/// What such a simulator digs with and in.
struct ForeignModel {
  /// @throws Error (bad_input) as require_machine(), bank_state()
  ForeignModel(Machine of_machine, SoilKind of_soil, double percent);

  Machine machine;
  SoilKind soil;
  double density_percent;
  SoilState bank;
  SoilState loose;
};

/// What it says of itself.
struct ForeignSimulator {
  std::string name;             ///< with its version
  double mass_tolerance = 0.0;  ///< of the dry mass moved [-]
};
inline constexpr double most_mass_tolerance = 0.2;  ///< ours

/// Why a name is none of a simulator, as the end of "NAME is ..."; nothing if it is one.
std::optional<std::string> fault_of_name(const std::string& name);

/// Load of one step, from one pose to the next.
struct ForeignLoad {
  Eigen::Vector2d force = Eigen::Vector2d::Zero();  ///< of all soil on the bucket (x, z) [N]
  double moment = 0.0;   ///< of that force about the tip, counter-clockwise [N m]
  double carried = 0.0;  ///< moist soil in the bucket [kg]
};

/// The outcome of a dig; any numbers.
struct ForeignAnswer {
  double payload = 0.0;                ///< moist [kg]
  std::vector<ForeignLoad> loads;      ///< empty, or one for each step
  std::optional<EnergyLedger> energy;  ///< total, by_phase, by_joint and lift; the rest is not read
  bool given_up = false;
  Eigen::ArrayXXd bank;   ///< of the window, afterwards [m]
  Eigen::ArrayXXd loose;  ///< likewise
};

/// One dig of such a simulator: the window of the ground that it gets, and the result that its
/// answer makes.
class ForeignDig {
 public:
  /// @throws Error (bad_input) if the ground or the path cannot be dug (SoilSimulator::dig())
  ForeignDig(const ForeignModel& model, const Terrain& terrain, const DigPath& path,
             const DigOptions& options);

  const ForeignModel& model() const { return model_; }
  const DigPath& path() const { return path_; }
  const DigOptions& options() const { return options_; }
  const HeightMap& bank() const { return bank_; }          ///< of the window
  const Eigen::ArrayXXd& loose() const { return loose_; }  ///< likewise
  std::size_t steps() const { return path_.poses.size() - 1; }

  /// @throws Error (bad_input) for what no dig can do
  DigResult result(const ForeignAnswer& answer, double mass_tolerance) const;

 private:
  void check_numbers(const ForeignAnswer& answer) const;
  void check_mass(const ForeignAnswer& answer, double tolerance) const;
  SoilLedger change(const ForeignAnswer& answer, GroundWindow& ground) const;

  const ForeignModel& model_;
  const Terrain& terrain_;
  const DigPath& path_;
  const DigOptions& options_;
  CellBlock cells_;
  HeightMap bank_;
  Eigen::ArrayXXd loose_;
};

}  // namespace excavplan
