// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace excavplan {

inline constexpr double gravity = 9.80665;       ///< standard gravity [m/s^2], ISO 80000-3
inline constexpr double water_density = 1000.0;  ///< [kg/m^3]

/// How the penetration resistance of a soil follows from its state.
enum class ConeIndexLaw {
  bulk_density,  ///< q = reference * exp(rate * (bulk density - reference density))
  stress,        ///< q = reference * (vertical stress / kPa)^exponent * exp(rate * d)
};

/// A kind of soil: its numbers that do not depend on its density. `d` is the relative density in
/// 0 .. 1.
struct SoilKind {
  std::string name;                  ///< "loam"
  double specific_gravity = 0.0;     ///< of the grains [-]
  double water_content = 0.0;        ///< water per dry mass [-]
  double void_ratio_max = 0.0;       ///< at d = 0 [-]
  double void_ratio_min = 0.0;       ///< at d = 1 [-]
  double void_ratio_loose = 0.0;     ///< of soil that was dug and dumped [-]
  double cohesion_loosest = 0.0;     ///< c = cohesion_loosest * exp(cohesion_growth * d) [Pa]
  double cohesion_growth = 0.0;      ///< [-]
  double friction_loosest = 0.0;     ///< phi = friction_loosest + friction_gain * d [rad]
  double friction_gain = 0.0;        ///< [rad]
  double tool_friction_ratio = 0.0;  ///< soil-metal friction angle / phi [-]
  double adhesion_ratio = 0.0;       ///< soil-metal adhesion / c [-]
  double angle_of_repose = 0.0;      ///< of loose soil [rad]
  ConeIndexLaw cone_index_law = ConeIndexLaw::bulk_density;  ///< with the four numbers below
  double cone_index_reference = 0.0;                         ///< [Pa]
  double cone_index_rate = 0.0;                              ///< [m^3/kg] or [-]
  double cone_index_reference_density = 0.0;                 ///< bulk_density law only [kg/m^3]
  double cone_index_stress_exponent = 0.0;                   ///< stress law only [-]
};

/// A soil at one relative density. Loose soil (dug, dumped, spilled) is the state `loose()`.
struct SoilState {
  double relative_density = 0.0;     ///< (e_max - e) / (e_max - e_min), 0 .. 1 for the bank [-]
  double void_ratio = 0.0;           ///< [-]
  double dry_density = 0.0;          ///< G_s rho_w / (1 + e) [kg/m^3]
  double bulk_density = 0.0;         ///< dry density (1 + w) [kg/m^3]
  double unit_weight = 0.0;          ///< bulk density g [N/m^3]
  double saturation = 0.0;           ///< w G_s / e [-]
  double cohesion = 0.0;             ///< [Pa]
  double adhesion = 0.0;             ///< [Pa]
  double friction_angle = 0.0;       ///< [rad]
  double tool_friction_angle = 0.0;  ///< [rad]
};

/// Reads a soil file (docs/formats.md); every number in it names its source.
///
/// @throws Error (bad_file) naming file, key, value and rule
SoilKind load_soil(const std::string& path);

/// What whatever computes with a soil asks of it, however it was made: the rules of load_soil().
/// @throws Error (bad_input) naming soil, member, value and rule
void require_soil(const SoilKind& soil);

/// 16 hexadecimal digits that depend on every number of a soil, but not on its name.
std::string fingerprint(const SoilKind& soil);

/// State of undisturbed soil.
/// @throws Error (bad_input) as require_soil(), or unless 0 <= density_percent <= 100
SoilState bank_state(const SoilKind& soil, double density_percent);

/// State of undisturbed soil with this void ratio.
/// @throws Error (bad_input) unless void_ratio_min <= e <= void_ratio_max
SoilState bank_state_of_void_ratio(const SoilKind& soil, double void_ratio);

/// State of dug soil: void_ratio_loose, no cohesion or adhesion, friction of the loosest state.
/// @throws Error (bad_input) as require_soil()
SoilState loose_state(const SoilKind& soil);
/// Moist mass of so much of it [kg, m^3]. @throws Error (bad_input) as loose_state()
double loose_mass(const SoilKind& soil, double volume);

/// Penetration resistance (cone index) at a depth below the surface [Pa].
///
/// The stress law takes the overburden (unit weight times depth, which is at least 1 cm) as the
/// vertical stress, so that the surface resists too. What is not finite in the arguments is not
/// finite in the result.
double cone_index(const SoilKind& soil, const SoilState& state, double depth);

/// Bulking factor if all soil goes from the bank at this density to the loose state:
/// k = (1 + e_loose) / (1 + e) (solids are conserved). @throws Error (bad_input) as bank_state()
double bulking_of_density(const SoilKind& soil, double density_percent);

/// Height at which a vertical wall of undisturbed soil just stands [m]:
/// H_c = 4 c / gamma * tan(45 deg + phi / 2) (Rankine).
/// @throws Error (bad_input) unless the unit weight is positive and finite
double critical_height(const SoilState& state);

/// Steepest angle, in `least` .. 80 deg, at which a face of soil of this height stands [rad]
/// (Culmann 1875: height = 4 c / gamma * sin(angle) cos(phi) / (1 - cos(angle - phi))).
/// @throws Error (bad_input) if an argument is not finite
double stable_slope(const SoilState& soil, double height, double least);

}  // namespace excavplan
