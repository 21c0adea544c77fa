// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/soil.hpp>

#include <algorithm>
#include <cmath>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

constexpr double least_overburden_depth = 0.01;  // the stress law ends here: q -> 0 at the surface
constexpr double pascal_per_kilopascal = 1000.0;
constexpr double steepest_face = 80.0 * pi / 180.0;  // of soil, however cohesive; ours

/// A number of a soil: its key in files, and the range that it is accepted in.
struct SoilNumber {
  const char* key;
  double SoilKind::*value;
  double lowest;
  double highest;
};

constexpr SoilNumber soil_numbers[] = {
    {"specific_gravity", &SoilKind::specific_gravity, 0.5, 10.0},
    {"water_content", &SoilKind::water_content, 0.0, 10.0},
    {"void_ratio_max", &SoilKind::void_ratio_max, 0.01, most_void_ratio},
    {"void_ratio_min", &SoilKind::void_ratio_min, 0.01, most_void_ratio},
    {"void_ratio_loose", &SoilKind::void_ratio_loose, 0.01, most_void_ratio},
    {"cohesion_loosest_pa", &SoilKind::cohesion_loosest, 0.0, most_cohesion},
    {"cohesion_growth", &SoilKind::cohesion_growth, 0.0, 10.0},
    {"friction_loosest_rad", &SoilKind::friction_loosest, flattest_friction, steepest_friction},
    {"friction_gain_rad", &SoilKind::friction_gain, -steepest_friction, steepest_friction},
    {"tool_friction_ratio", &SoilKind::tool_friction_ratio, 0.0, 1.0},
    {"adhesion_ratio", &SoilKind::adhesion_ratio, 0.0, 1.0},
    {"angle_of_repose_rad", &SoilKind::angle_of_repose, 0.05, steepest_friction}};

constexpr SoilNumber numbers_by_density[] = {
    {"reference_pa", &SoilKind::cone_index_reference, least_cone_index, most_cone_index},
    {"rate_m3_per_kg", &SoilKind::cone_index_rate, 0.0, 0.1},
    {"reference_density_kg_m3", &SoilKind::cone_index_reference_density, 1.0, 1e4}};

constexpr SoilNumber numbers_by_stress[] = {
    {"reference_pa", &SoilKind::cone_index_reference, least_cone_index, most_cone_index},
    {"rate", &SoilKind::cone_index_rate, 0.0, 20.0},
    {"stress_exponent", &SoilKind::cone_index_stress_exponent, 0.0, 2.0}};

/// Calls visit(number) for the numbers of a law of the cone index.
template <typename Visit>
void for_each_number(ConeIndexLaw law, const Visit& visit) {
  for (const SoilNumber& number :
       law == ConeIndexLaw::bulk_density ? numbers_by_density : numbers_by_stress) {
    visit(number);
  }
}

void read_cone_index(JsonObject law, SoilKind& soil) {
  const std::string name = law.text("law");
  if (name != "bulk_density" && name != "stress") {
    law.fail("law", "is " + in_quotes(name) + ", must be 'bulk_density' or 'stress'");
  }
  soil.cone_index_law = name == "stress" ? ConeIndexLaw::stress : ConeIndexLaw::bulk_density;
  for_each_number(soil.cone_index_law, [&](const SoilNumber& number) {
    soil.*number.value = law.number(number.key, number.lowest, number.highest);
  });
  law.done();
}

/// Rules that concern several numbers. @param fail  called with key and message of what breaks one
template <typename Fail>
void check_consistency(const SoilKind& soil, const Fail& fail) {
  constexpr double rounding = 1e-9;
  const auto e_max = [&] { return number_text(soil.void_ratio_max); };
  const auto e_min = [&] { return number_text(soil.void_ratio_min); };
  if (soil.void_ratio_min >= soil.void_ratio_max) {
    fail("void_ratio_min", "is " + e_min() + ", must be below void_ratio_max (" + e_max() + ")");
  }
  if (soil.void_ratio_loose <= soil.void_ratio_min || soil.void_ratio_loose > soil.void_ratio_max) {
    fail("void_ratio_loose", "is " + number_text(soil.void_ratio_loose) +
                                 ", must be above void_ratio_min (" + e_min() +
                                 ") and not above void_ratio_max (" + e_max() + ")");
  }
  const double saturation = soil.water_content * soil.specific_gravity / soil.void_ratio_min;
  if (saturation > 1.0 + rounding) {
    fail("water_content", "is " + number_text(soil.water_content) +
                              ", which fills the pores of the densest state " +
                              number_text(saturation) + " times over; must not exceed 1");
  }
  const double densest = soil.friction_loosest + soil.friction_gain;
  if (densest < flattest_friction || densest > steepest_friction) {
    fail("friction_gain_rad", "is " + number_text(soil.friction_gain) +
                                  ", which makes the friction angle of the densest state " +
                                  number_text(densest) + " rad; must be in " +
                                  number_text(flattest_friction) + " .. " +
                                  number_text(steepest_friction));
  }
}

double void_ratio(const SoilKind& soil, double density_percent) {
  if (!(density_percent >= 0.0 && density_percent <= 100.0)) {
    throw Error(ErrorKind::bad_input, "relative density is " + number_text(density_percent) +
                                          " %, must be in 0 .. 100 %");
  }
  const double d = density_percent / 100.0;
  return soil.void_ratio_max - d * (soil.void_ratio_max - soil.void_ratio_min);
}

/// The phase relations: everything that follows from the void ratio alone.
SoilState state_of_void_ratio(const SoilKind& soil, double e) {
  SoilState state;
  state.relative_density = (soil.void_ratio_max - e) / (soil.void_ratio_max - soil.void_ratio_min);
  state.void_ratio = e;
  state.dry_density = soil.specific_gravity * water_density / (1.0 + e);
  state.bulk_density = state.dry_density * (1.0 + soil.water_content);
  state.unit_weight = state.bulk_density * gravity;
  state.saturation = soil.water_content * soil.specific_gravity / e;
  return state;
}

void set_strength(const SoilKind& soil, double cohesion, double friction, SoilState& state) {
  state.cohesion = cohesion;
  state.adhesion = soil.adhesion_ratio * cohesion;
  state.friction_angle = friction;
  state.tool_friction_angle = soil.tool_friction_ratio * friction;
}

SoilState state_of_density(const SoilKind& soil, double density_percent) {
  SoilState state = state_of_void_ratio(soil, void_ratio(soil, density_percent));
  const double d = density_percent / 100.0;
  set_strength(soil, soil.cohesion_loosest * std::exp(soil.cohesion_growth * d),
               soil.friction_loosest + soil.friction_gain * d, state);
  return state;
}

}  // namespace

SoilKind read_soil(JsonObject object) {
  SoilKind soil;
  soil.name = object.text("name");
  for (const SoilNumber& number : soil_numbers) {
    soil.*number.value = object.number(number.key, number.lowest, number.highest);
  }
  read_cone_index(object.object("cone_index"), soil);
  object.done();
  check_consistency(soil,
                    [&](const char* key, const std::string& text) { object.fail(key, text); });
  return soil;
}

nlohmann::ordered_json soil_json(const SoilKind& soil) {
  const bool by_stress = soil.cone_index_law == ConeIndexLaw::stress;
  nlohmann::ordered_json json = {{"name", soil.name}};
  for (const SoilNumber& number : soil_numbers) json[number.key] = soil.*number.value;
  nlohmann::ordered_json& law = json["cone_index"];
  law["law"] = by_stress ? "stress" : "bulk_density";
  for_each_number(soil.cone_index_law,
                  [&](const SoilNumber& number) { law[number.key] = soil.*number.value; });
  return json;
}

SoilKind load_soil(const std::string& path) {
  JsonObject file = JsonObject::open(path, "excavplan-soil");
  file.ignore("sources");
  return read_soil(std::move(file));
}

void require_soil(const SoilKind& soil) {
  const auto of = [&](const char* key) { return "soil " + in_quotes(soil.name) + ": " + key; };
  const auto check = [&](const SoilNumber& number) {
    const double value = soil.*number.value;
    if (value >= number.lowest && value <= number.highest) return;
    require_in(of(number.key), value, number.lowest, number.highest);
  };
  for (const SoilNumber& number : soil_numbers) check(number);
  for_each_number(soil.cone_index_law, check);
  check_consistency(
      soil, [&](const char* key, const std::string& text) { refuse(of(key) + " " + text); });
}

std::string fingerprint(const SoilKind& soil) {
  std::string numbers;
  for (const double number :
       {soil.specific_gravity, soil.water_content, soil.void_ratio_max, soil.void_ratio_min,
        soil.void_ratio_loose, soil.cohesion_loosest, soil.cohesion_growth, soil.friction_loosest,
        soil.friction_gain, soil.tool_friction_ratio, soil.adhesion_ratio, soil.angle_of_repose,
        static_cast<double>(soil.cone_index_law), soil.cone_index_reference, soil.cone_index_rate,
        soil.cone_index_reference_density, soil.cone_index_stress_exponent}) {
    numbers += number_text(number) + ' ';
  }
  return checksum_text(numbers);
}

SoilState checked_bank_state(const SoilKind& soil, double void_ratio) {
  const double span = soil.void_ratio_max - soil.void_ratio_min;
  return state_of_density(soil,
                          100.0 * std::clamp((soil.void_ratio_max - void_ratio) / span, 0.0, 1.0));
}

SoilState checked_loose_state(const SoilKind& soil, double void_ratio) {
  const double e = std::clamp(void_ratio, soil.void_ratio_min, soil.void_ratio_loose);
  const double compacted =
      (soil.void_ratio_loose - e) / (soil.void_ratio_loose - soil.void_ratio_min);
  SoilState state = state_of_void_ratio(soil, e);
  set_strength(soil, soil.cohesion_loosest * std::expm1(soil.cohesion_growth * compacted),
               soil.friction_loosest + soil.friction_gain * compacted, state);
  return state;
}

SoilState bank_state(const SoilKind& soil, double density_percent) {
  require_soil(soil);
  return state_of_density(soil, density_percent);
}

SoilState bank_state_of_void_ratio(const SoilKind& soil, double void_ratio) {
  require_soil(soil);
  if (!(void_ratio >= soil.void_ratio_min && void_ratio <= soil.void_ratio_max)) {
    throw Error(ErrorKind::bad_input,
                "void ratio of " + soil.name + " is " + number_text(void_ratio) + ", must be in " +
                    number_text(soil.void_ratio_min) + " .. " + number_text(soil.void_ratio_max));
  }
  return checked_bank_state(soil, void_ratio);
}

SoilState loose_state(const SoilKind& soil) {
  require_soil(soil);
  return checked_loose_state(soil, soil.void_ratio_loose);
}

double loose_mass(const SoilKind& soil, double volume) {
  return volume * loose_state(soil).unit_weight / gravity;
}

double cone_index(const SoilKind& soil, const SoilState& state, double depth) {
  if (soil.cone_index_law == ConeIndexLaw::bulk_density) {
    return soil.cone_index_reference *
           std::exp(soil.cone_index_rate *
                    (state.bulk_density - soil.cone_index_reference_density));
  }
  const double vertical_stress = state.unit_weight * std::max(depth, least_overburden_depth);
  return soil.cone_index_reference *
         std::pow(vertical_stress / pascal_per_kilopascal, soil.cone_index_stress_exponent) *
         std::exp(soil.cone_index_rate * state.relative_density);
}

double bulking_of_density(const SoilKind& soil, double density_percent) {
  require_soil(soil);
  return (1.0 + soil.void_ratio_loose) / (1.0 + void_ratio(soil, density_percent));
}

double critical_height(const SoilState& state) {
  require(state.unit_weight > 0.0 && std::isfinite(state.unit_weight), "unit weight of a soil",
          state.unit_weight, "above 0 N/m^3 and finite");
  return 4.0 * state.cohesion / state.unit_weight *
         std::tan(0.25 * pi + 0.5 * state.friction_angle);
}

double stable_slope(const SoilState& soil, double height, double least) {
  for (const double number :
       {soil.friction_angle, soil.cohesion, soil.unit_weight, height, least}) {
    require(std::isfinite(number), "stable slope: an argument", number, "finite");
  }
  const double phi = soil.friction_angle;
  const auto stands = [&](double angle) {
    return 4.0 * soil.cohesion * std::sin(angle) * std::cos(phi) >=
           soil.unit_weight * height * (1.0 - std::cos(angle - phi));
  };
  double low = least;
  double high = steepest_face;
  if (high <= low || stands(high)) return std::max(low, high);
  if (!stands(low)) return low;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (stands(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace excavplan
