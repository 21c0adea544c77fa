// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>

#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "fuzz/fuzz_target.hpp"
#include "support/energy_bound.hpp"

namespace excavplan::test {
namespace {

using nlohmann::json;

/// A shipped file with up to four of its numbers changed, read as a file: what its rules let
/// through must work.
std::string changed_file(const std::string& shipped, NumbersOfBytes& numbers) {
  static const std::string path = "/dev/shm/excavplan-fuzz-json-" + std::to_string(::getpid());
  json flat = json::parse(std::ifstream(find_data_file(shipped))).flatten();
  std::vector<std::string> keys;
  for (const auto& [key, value] : flat.items()) {
    if (value.is_number()) keys.push_back(key);
  }
  for (std::size_t changes = numbers.index(5); changes > 0; --changes) {
    json& number = flat[keys[numbers.index(keys.size())]];
    number = number.get<double>() * numbers.odd(0.3, 3.0);
    if (!std::isfinite(number.get<double>())) number = 1e300;
  }
  std::ofstream(path) << flat.unflatten();
  return path;
}

template <typename Load>
auto loaded(const Load& load, const std::string& shipped, NumbersOfBytes& numbers) {
  const std::string path = changed_file(shipped, numbers);
  std::optional<decltype(load(path))> result;
  try {
    result = load(path);
  } catch (const Error&) {
    // what the rules refuse
  }
  ::unlink(path.c_str());
  return result;
}

/// Nowhere above 0.
Terrain ground_of(const Machine& machine, NumbersOfBytes& numbers) {
  Terrain ground =
      sloped_planning_ground(machine, numbers.between(-0.6, 0.6), numbers.between(0.06, 0.3));
  const double roughness = numbers.between(0.0, 0.2);
  for (int bumps = 0; bumps < 12 && !numbers.at_end(); ++bumps) {
    const auto row = static_cast<Eigen::Index>(numbers.between(0.0, 1.0) *
                                               static_cast<double>(ground.bank.z.rows() - 1));
    const auto col = static_cast<Eigen::Index>(numbers.between(0.0, 1.0) *
                                               static_cast<double>(ground.bank.z.cols() - 1));
    const double height = numbers.odd(-5.0 * roughness, 5.0 * roughness);
    ground.bank.z(row, col) = std::isfinite(height) ? std::clamp(height, -50.0, 0.0) : std::nan("");
    ground.loose(row, col) = numbers.between(0.0, roughness);
  }
  const Eigen::ArrayXXd known = ground.surface().z.isNaN().select(-1e9, ground.surface().z);
  ground.bank.z -= known.maxCoeff();
  return ground;
}

void require_sound(const DigResult& result) {
  for (const double figure :
       {result.payload_mass, result.payload_volume, result.energy.total, result.energy.soil,
        result.peak_force, result.soil.bank_cut, result.soil.solids_before, result.soil.fallen_back,
        result.soil.spilled}) {
    require_that(std::isfinite(figure) && figure >= 0.0, "a figure of " + std::to_string(figure));
  }
  const double most = std::max(1.0, result.soil.solids_before);
  require_that(std::abs(result.soil.solids_after - result.soil.solids_before) <= 1e-9 * most,
               "mass balance: " + std::to_string(result.soil.solids_before) + " kg became " +
                   std::to_string(result.soil.solids_after));
}

}  // namespace

void fuzz_dig(std::string_view bytes) {
  constexpr double longest_machine = 20.0;  // [m]; larger ones only take longer
  NumbersOfBytes numbers(bytes);
  const auto machine = loaded(load_machine, "machines/zx120.json", numbers);
  const std::array<const char*, 4> soils = {"loam", "sand", "clay", "gravel"};
  const std::string kind = soils[numbers.index(soils.size())];
  const auto soil = loaded(load_soil, "soils/" + kind + ".json", numbers);
  if (!machine || !soil || machine->full_length() > longest_machine) return;
  try {
    const Terrain ground = ground_of(*machine, numbers);
    const DigParameters parameters = {numbers.odd(0.1, 1.5), numbers.odd(0.05, 1.2),
                                      numbers.odd(0.0, 3.5)};
    const auto path = make_dig_path_anywhere(*machine, parameters, boom_plane_profile(ground));
    if (!std::holds_alternative<DigPath>(path)) return;
    const HeightMapSimulator simulator(*machine, *soil, numbers.odd(0.0, 100.0));
    const DigResult result = simulator.dig(ground, std::get<DigPath>(path));
    require_sound(result);
    if (result.stall || result.payload_mass == 0.0) return;
    const double share = share_of_lifting(*machine, std::get<DigPath>(path), result);
    require_that(share <= 1.0, "lifting takes " + std::to_string(share) + " of the energy");
  } catch (const Error&) {
    // refused
  }
}

}  // namespace excavplan::test
