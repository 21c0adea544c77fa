// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/soil_scatter.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.hpp"
#include "base/random.hpp"
#include "soil/density_forms.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

// Of a drawn soil; ours.
constexpr double least_void_ratio = 0.01;
constexpr double least_share = 0.1;              // of the density before the draw
constexpr double least_void_ratio_range = 0.05;  // between its limits
constexpr double least_loosening = 0.01;         // of dug soil above the densest, of that range

}  // namespace

SoilKind drawn_soil(const SoilKind& soil, const SoilScatter& scatter, std::uint64_t seed) {
  require_soil(soil);
  for (const double share : {scatter.water_content, scatter.limit_density, scatter.loose_density}) {
    require_in("soil scatter: a share", share, 0.0, 1.0);
  }
  Random random(seed);
  // Dry density is G_s rho_w / (1 + e).
  const auto scaled = [](double void_ratio, double density) {
    return std::min((1.0 + void_ratio) / std::max(density, least_share) - 1.0, most_void_ratio);
  };
  const double loosest = 1.0 + scatter.limit_density * random.normal();
  const double densest = 1.0 + scatter.limit_density * random.normal();
  const double loose = 1.0 + scatter.loose_density * random.normal();
  const double water = 1.0 + scatter.water_content * random.normal();
  SoilKind drawn = soil;
  drawn.void_ratio_max =
      std::max(scaled(soil.void_ratio_max, loosest), least_void_ratio + least_void_ratio_range);
  drawn.void_ratio_min =
      std::max(least_void_ratio, std::min(scaled(soil.void_ratio_min, densest),
                                          drawn.void_ratio_max - least_void_ratio_range));
  const double least_loose =
      drawn.void_ratio_min + least_loosening * (drawn.void_ratio_max - drawn.void_ratio_min);
  drawn.void_ratio_loose =
      std::clamp(scaled(soil.void_ratio_loose, loosest * loose), least_loose, drawn.void_ratio_max);
  const double full = drawn.void_ratio_min / drawn.specific_gravity;  // of the densest state
  drawn.water_content = std::clamp(soil.water_content * water, 0.0, full);
  return drawn;
}

double density_of_bulk_density(const SoilKind& soil, double bulk_density) {
  require_soil(soil);
  require(bulk_density > 0.0 && std::isfinite(bulk_density), "bulk density", bulk_density,
          "above 0 kg/m^3 and finite");
  const double void_ratio =
      soil.specific_gravity * water_density * (1.0 + soil.water_content) / bulk_density - 1.0;
  return 100.0 * (soil.void_ratio_max - void_ratio) / (soil.void_ratio_max - soil.void_ratio_min);
}

Eigen::Matrix2d density_scatter(const SoilKind& soil, const DensityForm& freed_form,
                                double density_percent, const SoilScatter& scatter) {
  constexpr int draws = 400;
  require_form(freed_form);
  require(!std::isnan(density_percent), "density", density_percent, "a number");
  const double d = std::clamp(density_percent, 0.0, 100.0);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (std::uint64_t i = 0; i < draws; ++i) {
    const SoilKind drawn = drawn_soil(soil, scatter, i);
    const Eigen::Vector2d off(density_of_bulking(freed_form, bulking_of_density(drawn, d)) - d,
                              density_of_bulk_density(soil, bank_state(drawn, d).bulk_density) - d);
    sum += off * off.transpose();
  }
  return sum / draws;
}

std::vector<SoilLaw> shipped_soil_laws(const std::string& data_folder) {
  constexpr std::pair<const char*, double> kinds[] = {
      {"loam", 0.4}, {"sand", 0.2}, {"clay", 0.2}, {"gravel", 0.2}};
  std::vector<SoilLaw> laws;
  for (const auto& [name, weight] : kinds) {
    const std::string file = std::string(name) + ".json";
    laws.push_back({load_soil(find_data_file("soils/" + file, data_folder)),
                    load_density_law(find_data_file("laws/zx120-" + file, data_folder)), weight});
  }
  return laws;
}

}  // namespace excavplan
