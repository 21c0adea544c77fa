// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// How steep soil stands in the bucket, as tangents.
struct HoldingSlopes {
  double face = 0.0;  ///< of the face above the lip while the bucket digs
  double heap = 0.0;  ///< of the heap above top edge and side plates
};

/// What the bucket can hold of loose soil with the line from its pin to its tip at angle `phi3`,
/// the soil ahead standing `support` above the tip, 0 if clear of the ground [m^3]
/// (docs/methods.md#bucket).
double bucket_capacity(const Machine& machine, double phi3, double support,
                       const HoldingSlopes& slopes);

/// Steepest angle, from `least` to 80 deg, at which a face of soil of this height stands [rad]
/// (Culmann 1875: height = 4 c / gamma * sin(angle) cos(phi) / (1 - cos(angle - phi))).
double stable_slope(const SoilState& soil, double height, double least);

/// Rises with every change of the simulator that changes the result of a dig: what was computed
/// with an older one, such as a path library, is then refused.
inline constexpr int height_map_simulator_version = 1;

struct HeightMapModel;

/// The built-in soil simulation: a bank and a loose layer per cell of a height map, quasi-static.
///
/// The tip sweeps an exact volume out of every cell it passes; what it cuts swells to the loose
/// state of the soil and fills the bucket up to what the bucket can hold in its attitude; the rest
/// heaps up ahead of the lip, is cut again, and slides aside and back into the pit at its angle of
/// repose. The soil resists by the fundamental earthmoving equation per strip of the edge, on the
/// floor or on the soil packed on it, with side planes, the penetration of lip and teeth, the
/// friction on floor and side plates, and the ground under the heel. Joint torques follow from
/// soil, payload and link weights. Assumptions and limits: docs/methods.md#simulation.
class HeightMapSimulator : public SoilSimulator {
 public:
  /// @throws Error (bad_input) unless 0 <= density_percent <= 100
  HeightMapSimulator(const Machine& machine, const SoilKind& soil, double density_percent);

  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options = {}) const override;
  std::string identity() const override;

  static std::string name();  ///< with its version: "height-map 1"

  const SoilState& bank() const;
  const SoilState& loose() const;

 private:
  std::shared_ptr<const HeightMapModel> model_;
};

}  // namespace excavplan
