// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// A soil simulator of your own, here the rule of thumb that a cubic metre of ground costs a fixed
/// energy to cut. Whatever plans, searches, calibrates or builds a library takes it, as a
/// SimulatorKind. tests/support/soil_simulator_contract.hpp checks such a simulator.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/soil/soil.hpp>

using namespace excavplan;

namespace {

class SpecificEnergySimulator : public SoilSimulator {
 public:
  SpecificEnergySimulator(const Machine& machine, const SoilKind& soil, double density_percent)
      : machine_(machine),
        bank_(bank_state(soil, density_percent)),
        loose_(loose_state(soil)),
        identity_("specific energy 1, machine " + fingerprint(machine) + ", soil " +
                  fingerprint(soil) + " at " + std::to_string(density_percent) + " %") {}

  std::string identity() const override { return identity_; }

  DigResult dig(const Terrain& terrain, const DigPath& path, const DigOptions&) const override {
    DigResult result;
    result.patch.bank = terrain.bank.z;  // all of it: a real one copies only what it changes
    result.patch.loose = terrain.loose;
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
      cut(path.poses[i - 1].bucket, path.poses[i].bucket, terrain.bank, result);
    }
    const double swollen = bank_.dry_density / loose_.dry_density;
    const double lifted = swollen * result.soil.bank_cut + result.soil.loose_cut;
    result.payload_volume = result.soil.payload = std::min(lifted, heaped_capacity(machine_));
    result.payload_mass = result.payload_volume * loose_.bulk_density;
    // Soil that does not fit was cut in vain; pushing the bucket also costs energy.
    result.energy.total = result.energy.soil =
        energy_per_volume_ * result.soil.bank_cut + friction_ * path.parameters.drag_length;
    return result;
  }

 private:
  /// Lowers every cell that the bucket passes between two poses to the lower of both.
  void cut(const BucketPose& from, const BucketPose& to, const HeightMap& map,
           DigResult& result) const {
    const double half = 0.5 * machine_.bucket.width_outside;
    const Rectangle swept = {std::min(from.x, to.x), -half, std::max(from.x, to.x), half};
    const double level = std::min(from.z, to.z);
    const double area = map.cell_size * map.cell_size;
    for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
      for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
        if (!swept.contains(map.x(col), map.y(row))) continue;
        double& bank = result.patch.bank(row, col);
        double& loose = result.patch.loose(row, col);
        const double loose_cut = std::clamp(bank + loose - level, 0.0, loose);
        const double bank_cut = std::max(0.0, bank - level);
        loose -= loose_cut;
        bank -= bank_cut;
        result.soil.loose_cut += loose_cut * area;
        result.soil.bank_cut += bank_cut * area;
      }
    }
  }

  Machine machine_;
  SoilState bank_;
  SoilState loose_;
  std::string identity_;
  double energy_per_volume_ = 60e3;  ///< to cut undisturbed soil [J/m^3]
  double friction_ = 1.5e3;          ///< of the bucket on the ground [N]
};

}  // namespace

int main() {
  const SimulatorKind own = {"specific-energy", "specific energy 1",
                             [](const Machine& machine, const SoilKind& soil, double percent) {
                               return std::make_unique<SpecificEnergySimulator>(machine, soil,
                                                                                percent);
                             }};
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));

  PlanOptions options;
  options.method = PlanMethod::search;
  options.search.stop.evaluations = 60;
  for (const SimulatorKind& kind : {default_simulator(), own}) {
    options.simulator = kind;
    const DigPlan plan = plan_dig(machine, loam, GroundDensity(40.0), options);
    if (!plan.dig) {
      std::printf("%s\n", plan.reason.c_str());
      return 1;
    }
    std::printf("%s: drag %.2f m, lifts %.0f kg for %.1f kJ\n", kind.name.c_str(),
                plan.dig->parameters.drag_length, plan.dig->payload_mass,
                plan.dig->energy / 1000.0);
  }
}
