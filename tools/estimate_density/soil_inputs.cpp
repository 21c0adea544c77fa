// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/soil_inputs.hpp"

#include <algorithm>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/kit/kit_files.hpp>

#include "base/text.hpp"
#include "inputs/named_kinds.hpp"

namespace excavplan::tools {
namespace {

constexpr const char* usual_soil = "loam";
constexpr const char* any_soil = "unknown";

const SoilLaw* find(const std::vector<SoilLaw>& laws, const std::string& soil) {
  const auto found = std::find_if(laws.begin(), laws.end(),
                                  [&](const SoilLaw& law) { return law.soil.name == soil; });
  return found == laws.end() ? nullptr : &*found;
}

}  // namespace

void declare_soil(Arguments& arguments, SoilInputs& inputs) {
  arguments.text("soil", "loam|sand|clay|gravel|unknown|FILE", inputs.soil,
                 "soil that was dug: a shipped one, a soil file, or unknown: any of the shipped "
                 "four (default: loam is assumed, with a warning)");
  arguments.option("proctor", inputs.proctor, Quantity::density,
                   "largest dry density of a Proctor test of this soil: the density as compaction "
                   "too, by the void ratios of --soil");
}

void declare_law(Arguments& arguments, SoilInputs& inputs) {
  arguments.text("law", "NAME|FILE", inputs.law,
                 "density law: default (that of the soil by the built-in simulator), paper, or a "
                 "law file");
}

DensityLaw law_named(const std::string& name) {
  return load_density_law(shipped_or_file("laws", name == "default" ? "zx120-loam" : name));
}

DensityLaw law_of(const SoilInputs& inputs, const std::string& machine, DensityOptions& options) {
  SoilKnowledge& soil = options.soil;
  soil.possible = shipped_soil_laws();
  soil.unknown = inputs.soil == any_soil;
  const bool own_law = inputs.law != "default";
  if (soil.unknown && own_law) {
    usage_error("--soil unknown takes the laws of all shipped soils, not --law");
  }
  if (inputs.proctor && (!inputs.soil || soil.unknown)) {
    usage_error("--proctor needs --soil, whose void ratios it compares with");
  }
  if (inputs.soil && !soil.unknown) soil.kind = soil_named(*inputs.soil);
  if (!own_law) {
    soil.assumed = !inputs.soil;
    if (!soil.kind) soil.kind = soil_named(usual_soil);
    const Machine digs = machine_named(machine);
    if (const auto kit = kit_law(machine, digs, soil.kind->name)) return load_density_law(*kit);
    return usual_law(digs, *soil.kind, soil.possible);
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
