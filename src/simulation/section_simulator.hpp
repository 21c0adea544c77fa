// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// Rises with every change of the simulator that affects the result of a dig.
inline constexpr int section_simulator_version = 3;

struct SectionModel;

/// The same physics in the boom plane alone: a second, independent simulator that is several times
/// faster and checks the first.
///
/// It digs the mean profile of the ground over the width of the bucket. The tip cuts exact areas
/// out of the profile; soil that the bucket cannot hold forms one wedge at the angle of repose
/// ahead of the lip, which sheds windrows to both sides. Heaps have closed forms; there is no
/// relaxation. Soil is taken from the rows of the map under the bucket, each with its own void
/// ratio; forces take the mean over the rows. Soil that is left lies on these rows, windrows beside
/// them. Assumptions and limits: `docs/methods.md#simulation`.
class SectionSimulator : public SoilSimulator {
 public:
  /// For ground of this density [%].
  /// @throws Error (bad_input) unless 0 <= density_percent <= 100
  SectionSimulator(const Machine& machine, const SoilKind& soil, double density_percent);

  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options = {}) const override;
  std::string identity() const override;

  static std::string name();  ///< with its version: "section 1"

 private:
  std::shared_ptr<const SectionModel> model_;
};

}  // namespace excavplan
