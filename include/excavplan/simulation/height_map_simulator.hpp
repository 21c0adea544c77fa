// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/bucket_cavity.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// Rises with every change of the simulator that affects the result of a dig. What was computed
/// with another version, such as a path library, is refused.
inline constexpr int height_map_simulator_version = 5;

struct HeightMapModel;

/// The built-in simulator: a bank and a loose layer in each cell of a height map, quasi-static.
///
/// The tip cuts an exact volume out of each cell that it passes. Cut soil swells to the loose state
/// and fills the bucket up to its capacity in its attitude; the rest heaps up ahead of the lip, is
/// cut again, and slides aside and back into the pit at its angle of repose. The resistance is that
/// of the fundamental earthmoving equation for each strip of the edge, on the floor or on the soil
/// packed on it, with side planes, penetration of lip and teeth, friction on floor and side plates,
/// and the ground under the heel. Joint torques follow from the forces of the soil and the weights
/// of payload and links. Assumptions and limits: `docs/methods.md#simulation`.
class HeightMapSimulator : public SoilSimulator {
 public:
  /// For ground of this density [%].
  /// @throws Error (bad_input) as require_machine() and bank_state()
  HeightMapSimulator(const Machine& machine, const SoilKind& soil, double density_percent);

  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options = {}) const override;
  std::string identity() const override;

  static std::string name();  ///< with its version: "height-map 1"

  const SoilState& bank() const;   ///< of the undisturbed soil
  const SoilState& loose() const;  ///< of dug soil

 private:
  std::shared_ptr<const HeightMapModel> model_;
};

}  // namespace excavplan
