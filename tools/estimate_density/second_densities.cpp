// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/second_densities.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/results/stated_density.hpp>

#include "base/text.hpp"

namespace excavplan::tools {
namespace {

constexpr double usual_mass_error = 0.01;      // of a machine's scale, as a share
constexpr double usual_moisture_error = 0.01;  // of a measured water content; ours
constexpr double most_moisture = 2.0;          // ours: only peat holds more

/// "VALUE" or "VALUE,SD". @throws Error (bad_input)
Measured measured_of(const std::string& option, const std::string& text, Quantity quantity) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.empty() || parts.size() > 2) usage_error(option + ": '" + text + "' is not VALUE,SD");
  Measured measured{parse_quantity(option, parts[0], quantity), -1.0};
  if (parts.size() == 2) {
    measured.sd = parse_quantity(option, parts[1], quantity);
    if (measured.sd < 0.0) usage_error(option + ": the standard deviation must be at least 0");
  }
  return measured;
}

Measured mass_of(const std::string& text) {
  Measured mass = measured_of("--payload-mass", text, Quantity::mass);
  constexpr double least = 1.0;  // ours: of a bucket of soil [kg]
  if (!(mass.value > 0.0)) usage_error("--payload-mass: must be above 0");
  if (mass.value < least) {
    usage_error("--payload-mass: " + number_text(mass.value) +
                " kg is no bucket of soil: is it in kg, not t?");
  }
  if (mass.sd < 0.0) mass.sd = usual_mass_error * mass.value;
  return mass;
}

Measured moisture_of(const std::string& text) {
  Measured water = measured_of("--moisture", text, Quantity::ratio);
  if (!(water.value >= 0.0 && water.value <= most_moisture)) {
    usage_error("--moisture: must be in 0 .. " + number_text(most_moisture) + " (12 % is 0.12)");
  }
  if (water.sd < 0.0) water.sd = usual_moisture_error;
  return water;
}

/// The work of the joints in the log of a dig.
Measured work_of(const SecondDensities& inputs, const DensityOptions& options) {
  if (!options.dug_path || !options.dug_path->start_x) {
    usage_error("--loads needs --dug-path and --dug-start: the dig is simulated");
  }
  if (!options.soil.kind || options.soil.assumed || options.soil.unknown) {
    usage_error("--loads needs the kind of the soil: --soil");
  }
  DigLogSource source;
  source.file = *inputs.loads;
  source.from = inputs.from;
  source.to = inputs.to;
  source.prefix = "--";
  inputs.log.apply_to(source);
  source.pistons = piston_areas(options.dug_path->machine);
  OptionNames names = log_options;
  names.push_back({"state from when to when", "give --from and --to"});
  return naming_options(names,
                        [&] { return joint_work(read_dig_log(source), inputs.log.meter_share()); });
}

[[noreturn]] void refuse_prior(const SecondDensities& inputs, const std::string& why) {
  throw Error(ErrorKind::bad_file, *inputs.prior + ": " + why);
}

/// Densities in different soils, or in one that was told and in any, have no common law.
void require_same_soil(const SecondDensities& inputs, const StatedDensity& stated,
                       const SoilKnowledge& soil, const DensityLaw& law) {
  const auto name = [](bool is_any, const std::string& known) {
    if (is_any) return std::string("any soil (--soil unknown)");
    return known.empty() ? "a soil that it does not name" : known;
  };
  const std::string its = name(stated.of_any_soil, stated.density.soil);
  const std::string here = name(soil.unknown, soil.kind ? soil.kind->name : law.soil);
  const bool are_known = its != name(false, "") && here != name(false, "");
  if (stated.of_any_soil == soil.unknown && (!are_known || its == here)) return;
  refuse_prior(inputs,
               "its density is of " + its + ", this dig is in " + here + "; must be the same soil");
}

PriorDensity prior_of(const SecondDensities& inputs, const SoilKnowledge& soil,
                      const DensityLaw& law) {
  const StatedDensity stated = stated_density(*inputs.prior);
  if (!stated.is_whole) {
    refuse_prior(inputs, "tool: is missing, expected a result of estimate-density --json");
  }
  const double sd = stated.density.sd_percent;
  if (!(sd > 0.0)) refuse_prior(inputs, "density_sd_percent: is 0, must be above 0");
  require_same_soil(inputs, stated, soil, law);
  const double excess = stated.raw_percent - stated.density.percent;
  const double shared = sd * sd - excess * excess - std::pow(stated.independent_sd, 2);
  return {stated.raw_percent, stated.independent_sd, std::sqrt(std::max(0.0, shared)),
          inputs.drift.value_or(usual_drift_percent), stated.density.trustworthy};
}

/// Scans are never so alike: their noise differs.
bool is_same_dig(const StatedDensity& stated, const VolumeChange& change) {
  constexpr double same = 1e-9;
  const std::vector<double> here = {change.excavated.value, change.spilled.value,
                                    change.dumped.value};
  return std::equal(
      here.begin(), here.end(), stated.volumes.begin(), stated.volumes.end(),
      [](double a, double b) { return std::abs(a - b) <= same * (std::abs(a) + std::abs(b)); });
}

}  // namespace

void SecondDensities::declare(Arguments& arguments) {
  arguments.text("payload-mass", "MASS[,SD]", payload_mass,
                 "mass of the soil that was dumped, weighed by the machine [kg]: a second density "
                 "by weight (default SD: 1 %)");
  arguments.text("moisture", "NUMBER[,SD]", moisture,
                 "water per dry mass of the soil, for --payload-mass (default: that of the soil; "
                 "default SD: 0.01)");
  arguments.file("prior", prior,
                 "result of estimate-density --json for the dig before this one, in the same soil: "
                 "its density is combined with that of this dig");
  arguments.only_if({[this] { return prior.has_value(); }, "there is no --prior"}, [&] {
    arguments.option("prior-drift", drift, Quantity::percent,
                     "standard deviation of the density from that dig to this one (default: " +
                         number_text(usual_drift_percent) + ")");
  });
  arguments.file("loads", loads,
                 "log of the joints in this dig, CSV: torques and rates, pressures and piston "
                 "speeds, or powers, also as of simulate-dig --history: a second density by the "
                 "work; needs --dug-path, --dug-start and --soil");
  arguments.only_if({[this] { return loads.has_value(); }, "there is no --loads"}, [&] {
    arguments.option("from", from, Quantity::time,
                     "time at which the dig starts in the log (default: the log's first)");
    arguments.option("to", to, Quantity::time, "time at which it ends (default: the log's last)");
    log.declare(arguments);
  });
}

void SecondDensities::apply_to(const DensityLaw& law, DensityOptions& options) const {
  if (moisture && !payload_mass) usage_error("--moisture needs --payload-mass");
  if (payload_mass) options.payload_mass = mass_of(*payload_mass);
  if (moisture) options.soil.water_content = moisture_of(*moisture);
  if (drift && !(*drift >= 0.0 && *drift <= most_density_sd)) {
    usage_error("--prior-drift: " + number_text(*drift) + " % is outside 0 .. " +
                number_text(most_density_sd));
  }
  if (loads) options.joint_work = work_of(*this, options);
  if (prior) options.prior = prior_of(*this, options.soil, law);
}

void SecondDensities::check(const DensityEstimate& estimate, Outcome& outcome) const {
  if (!estimate.successive) return;
  const StatedDensity stated = stated_density(*prior);
  if (is_same_dig(stated, estimate.change)) {
    refuse_prior(*this, "volume: is that of this dig; must be the result of a dig before it");
  }
  const auto& zones = estimate.change.zones;
  const auto hole = std::find_if(zones.begin(), zones.end(),
                                 [](const ChangeZone& zone) { return zone.kind == ZoneKind::dig; });
  if (hole == zones.end()) return;
  if (const auto far = elsewhere(stated, *prior, hole->extent)) outcome.warnings.push_back(*far);
}

}  // namespace excavplan::tools
