// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// Rises with every change of the simulator that changes the result of a dig.
inline constexpr int section_simulator_version = 1;

struct SectionModel;

/// The same physics in the boom plane alone: an independent second engine, several times faster.
///
/// Digs the mean profile of the ground over the bucket's width. The tip cuts exact areas out of it;
/// what the bucket cannot hold is one wedge at the angle of repose ahead of the lip, which sheds
/// windrows to both sides; heaps have closed forms, nothing is relaxed. Soil comes off the rows of
/// the map under the bucket, each with its own void ratio; forces take the mean over them. What is
/// left lies on these rows, windrows beside them. Assumptions and limits:
/// docs/methods.md#simulation.
class SectionSimulator : public SoilSimulator {
 public:
  /// @throws Error (bad_input) unless 0 <= density_percent <= 100
  SectionSimulator(const Machine& machine, const SoilKind& soil, double density_percent);

  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options = {}) const override;
  std::string identity() const override;

  static std::string name();  ///< with its version: "section 1"

 private:
  std::shared_ptr<const SectionModel> model_;
};

/// What the bucket can hold, by clipping its side profile with the slopes of the soil: same
/// arguments and meaning as bucket_capacity(), another method [m^3].
double clipped_capacity(const Machine& machine, double phi3, double support,
                        const HoldingSlopes& slopes);

}  // namespace excavplan
