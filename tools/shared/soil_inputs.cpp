// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/soil_inputs.hpp"

#include <algorithm>

#include <excavplan/data_files.hpp>
#include <excavplan/simulation/calibration.hpp>

#include "base/text.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

constexpr const char* usual_soil = "loam";
constexpr const char* any_soil = "unknown";
constexpr double usual_mass_error = 0.01;      // of a machine's scale, as a share
constexpr double usual_moisture_error = 0.01;  // of a measured water content; ours
constexpr double most_moisture = 2.0;          // ours: only peat holds more

/// "VALUE" or "VALUE,SD". @throws Error (bad_input)
Measured parse_measured(const std::string& option, const std::string& text, Quantity quantity) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.empty() || parts.size() > 2) usage_error(option + ": '" + text + "' is not VALUE,SD");
  Measured measured{parse_quantity(option, parts[0], quantity), -1.0};
  if (parts.size() == 2) {
    measured.sd = parse_quantity(option, parts[1], quantity);
    if (measured.sd < 0.0) usage_error(option + ": the standard deviation must be at least 0");
  }
  return measured;
}

void set_payload(const std::string& text, DensityOptions& options) {
  Measured mass = parse_measured("--payload-mass", text, Quantity::mass);
  if (!(mass.value > 0.0)) usage_error("--payload-mass: must be above 0");
  if (mass.sd < 0.0) mass.sd = usual_mass_error * mass.value;
  options.payload_mass = mass;
}

void set_moisture(const std::string& text, DensityOptions& options) {
  Measured water = parse_measured("--moisture", text, Quantity::ratio);
  if (!(water.value >= 0.0 && water.value <= most_moisture)) {
    usage_error("--moisture: must be in 0 .. " + number_text(most_moisture) + " (12 % is 0.12)");
  }
  if (water.sd < 0.0) water.sd = usual_moisture_error;
  options.soil.water_content = water;
}

const SoilLaw* find(const std::vector<SoilLaw>& laws, const std::string& soil) {
  const auto found = std::find_if(laws.begin(), laws.end(),
                                  [&](const SoilLaw& law) { return law.soil.name == soil; });
  return found == laws.end() ? nullptr : &*found;
}

/// The law of a kind of soil: the shipped one, or one of digs in the simulator.
DensityLaw default_law(const SoilKind& soil, const std::string& machine,
                       const std::vector<SoilLaw>& shipped) {
  const SoilLaw* known = find(shipped, soil.name);
  if (known && fingerprint(known->soil) == fingerprint(soil)) return known->law;
  return law_of(calibrate_density(machine_named(machine), soil));
}

}  // namespace

void declare_soil(Arguments& arguments, SoilInputs& inputs) {
  arguments.text("soil", "NAME|FILE|unknown", inputs.soil,
                 "soil that was dug: loam, sand, clay, gravel, a soil file, or unknown: any of the "
                 "four (default: loam is assumed, with a warning)");
}

void declare_law(Arguments& arguments, SoilInputs& inputs) {
  arguments.text("law", "NAME|FILE", inputs.law,
                 "density law: default (that of the soil by the built-in simulator), paper, or a "
                 "law file");
}

void declare_payload(Arguments& arguments, SoilInputs& inputs) {
  arguments.text("payload-mass", "MASS[,SD]", inputs.payload_mass,
                 "mass of the soil that was dumped, weighed by the machine [kg]: a second density "
                 "by weight (default SD: 1 %)");
  arguments.text("moisture", "NUMBER[,SD]", inputs.moisture,
                 "water per dry mass of the soil, for --payload-mass (default: that of the soil; "
                 "default SD: 0.01)");
}

DensityLaw law_named(const std::string& name) {
  return load_density_law(shipped_or_file("laws", name == "default" ? "zx120-loam" : name));
}

DensityLaw law_of(const SoilInputs& inputs, const std::string& machine, DensityOptions& options) {
  if (inputs.moisture && !inputs.payload_mass) usage_error("--moisture needs --payload-mass");
  if (inputs.payload_mass) set_payload(*inputs.payload_mass, options);
  if (inputs.moisture) set_moisture(*inputs.moisture, options);
  SoilKnowledge& soil = options.soil;
  soil.possible = shipped_soil_laws();
  soil.unknown = inputs.soil == any_soil;
  const bool own_law = inputs.law != "default";
  if (soil.unknown && own_law) {
    usage_error("--soil unknown takes the laws of all shipped soils, not --law");
  }
  if (inputs.soil && !soil.unknown) soil.kind = soil_named(*inputs.soil);
  if (!own_law) {
    soil.assumed = !inputs.soil;
    if (!soil.kind) soil.kind = soil_named(usual_soil);
    return default_law(*soil.kind, machine, soil.possible);
  }
  DensityLaw law = law_named(inputs.law);
  if (soil.kind && !law.soil.empty() && law.soil != soil.kind->name) {
    usage_error("--law is for " + law.soil + ", --soil is " + soil.kind->name);
  }
  const SoilLaw* shipped = find(soil.possible, law.soil);
  if (!soil.kind && shipped) soil.kind = shipped->soil;
  return law;
}

}  // namespace excavplan::tools
