// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "density/density_of_volumes.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <excavplan/calibration/calibration.hpp>
#include <excavplan/change/bulking.hpp>

#include "base/statistics.hpp"
#include "base/text.hpp"
#include "density/density_in_soil.hpp"
#include "density/joined_density.hpp"

namespace excavplan {
namespace {

constexpr double same_path = 1e-3;          // [rad], [m]
constexpr double fallback_tolerance = 0.1;  // of the simulator's fallback; ours
constexpr double least_fallback = 0.0;      // of any path in any soil; ours
constexpr double most_fallback = 0.5;       // likewise

bool same_numbers(const std::array<double, 3>& path, const DigParameters& dug) {
  return std::abs(path[0] - dug.penetration_angle) < same_path &&
         std::abs(path[1] - dug.penetration_length) < same_path &&
         std::abs(path[2] - dug.drag_length) < same_path;
}

/// What the law's own digs were made with can be dug again.
bool can_be_fitted(const DensityLaw& law) { return law.simulator == default_simulator().name; }

/// Digs along the path that was dug; nothing where path or kind of soil are not known, or it was
/// driven on ground so steep that it cannot be driven on level ground.
std::optional<DensityCalibration> calibrate_dug(const DensityOptions& options) {
  const auto& dug = options.dug_path;
  if (!dug || !options.soil.kind) return std::nullopt;
  try {
    return calibrate_path(dug->machine, *options.soil.kind, dug->parameters, options.threads);
  } catch (const Error& error) {
    if (dug->start_x) return std::nullopt;
    throw Error(error.kind(), std::string("path that was dug: ") + error.what());
  }
}

/// Why a measured fallback cannot be that of a dig along the path; nothing if it can.
std::optional<Warning> doubt_of(const std::optional<Fallback>& found,
                                const std::optional<DensityCalibration>& calibration) {
  if (!found) return std::nullopt;
  double least = least_fallback;
  double most = most_fallback;
  if (calibration) {
    const auto [low, high] = std::minmax_element(
        calibration->samples.begin(), calibration->samples.end(),
        [](const auto& a, const auto& b) { return a.fallback_fraction < b.fallback_fraction; });
    least = low->fallback_fraction;
    most = high->fallback_fraction;
  }
  const double fraction = found->in_pit / found->cut;
  const double tolerance = fallback_tolerance + 3.0 * found->fraction.sd;
  if (fraction >= least - tolerance && fraction <= most + tolerance) return std::nullopt;
  const std::string what =
      fraction < 0.0
          ? "the floor of the hole lies below the path that was dug, by " +
                readable(-100.0 * fraction) + " % of the volume that the bucket swept"
          : readable(100.0 * fraction) + " % of the volume that the bucket swept is filled";
  return Warning{WarningCode::dug_path_doubtful,
                 what + ", but digs along this path leave " + readable(100.0 * least) + " .. " +
                     readable(100.0 * most) +
                     " % filled: the dig stalled or was not along this path, or the scans are not "
                     "in the site frame; the bulking factor is not corrected for fallback"};
}

Warning law_of_other_path(const DensityLaw& law, bool path_is_known) {
  return {WarningCode::law_of_other_path,
          "the law '" + law.name + "' holds for digs along one path, " +
              (path_is_known ? "which is not the one that was dug"
                             : "and the path that was dug is not known") +
              ": soil that falls back differs, by several points of density"};
}

Warning law_of_other_soil(const DensityLaw& law, const SoilKind& soil) {
  return {WarningCode::law_of_other_soil,
          "the law '" + law.name + "' is of " + law.soil + ", the soil is " + soil.name, true};
}

/// Water that even the loosest state cannot hold.
std::optional<Warning> too_wet(const SoilKnowledge& soil) {
  if (!soil.kind || !soil.water_content) return std::nullopt;
  const double water = soil.water_content->value;
  const double saturation = water * soil.kind->specific_gravity / soil.kind->void_ratio_max;
  if (saturation <= 1.0) return std::nullopt;
  return Warning{WarningCode::too_wet,
                 "a water content of " + readable(water) + " fills the pores of the loosest " +
                     soil.kind->name + " " + readable(saturation, 2) +
                     " times over: it must be a share of the dry mass, 12 % is 0.12"};
}

// ---- The answer -------------------------------------------------------------------------------

Warning disagreement_of(const PayloadDensity& payload, bool unknown_soil) {
  return {WarningCode::payload_disagrees,
          "the payload gives a density of " +
              readable(payload.density_percent.value, payload.density_percent.sd) +
              " %, the bulking factor " +
              readable(payload.law_density_percent.value, payload.law_density_percent.sd) + " %, " +
              readable(std::abs(payload.disagreement), 2) + " standard deviations apart" +
              (unknown_soil ? " in the soil that fits best: its mass or water content is not that "
                              "given, the soil is none of those known,"
                            : ": the kind of soil or its water content is not that assumed,") +
              " or a change of the ground does not belong to this dig"};
}

/// The dig as another reading has it: another hole if one of the open changes that fell makes this
/// bulking factor, else another heap with as many voids for its size.
DugVolumes as_read(const Reading& reading, const VolumeChange& change, DugVolumes dig) {
  constexpr double same = 1e-6;
  const double hole = dig.bulking() * dig.volumes(0) / reading.bulking.value;
  const bool is_hole =
      std::find(reading.kinds.begin(), reading.kinds.end(), ChangeKind::water) !=
          reading.kinds.end() ||
      std::any_of(change.attribution.begin(), change.attribution.end(), [&](const auto& open) {
        const double counted = open.counted ? open.volume.value : -open.volume.value;
        return open.volume.value < 0.0 && std::abs(dig.volumes(0) + counted - hole) < same * hole;
      });
  if (is_hole) {
    dig.volumes(0) = hole;
  } else {
    const double share = reading.bulking.value / dig.bulking();
    dig.volumes(2) += (reading.bulking.value - dig.bulking()) * dig.volumes(0);
    if (dig.voids) dig.voids = Measured{share * dig.voids->value, share * dig.voids->sd};
  }
  return dig;
}

/// The interval of the mixture of the likely readings, which move the density of the scans.
/// @param scans  the density by them alone
/// @param share  of that one in the answer
void widen_by_readings(const RelativeDensity& scans, double share, DensityEstimate& estimate) {
  RelativeDensity& density = *estimate.density;
  const double explained =
      variance_by_readings(estimate.change) / std::pow(estimate.bulking->sd, 2);
  const double rest = std::sqrt(std::pow(density.sd_percent, 2) -
                                explained * std::pow(share * scans.sd_given_law_percent, 2));
  std::vector<NormalPart> parts;
  for (const DensityReading& each : estimate.readings) {
    if (is_unseen(each.reading)) continue;
    const double shift = share * (each.density_percent - estimate.readings.front().density_percent);
    parts.push_back({each.reading.weight, std::clamp(density.percent + shift, 0.0, 100.0), rest});
  }
  if (parts.size() < 2 || !(rest > 0.0)) return;
  density.interval_percent = {std::clamp(quantile_of(parts, 0.025), 0.0, 100.0),
                              std::clamp(quantile_of(parts, 0.975), 0.0, 100.0)};
}

// ---- Second densities -------------------------------------------------------------------------

Warning disagreement_of(const LoadsDensity& loads) {
  const std::string much =
      loads.density_percent ? readable(std::abs(loads.disagreement), 2) + " standard deviations " +
                                  (loads.disagreement > 0.0 ? "more" : "less") +
                                  " than expected at the density of the scans, " +
                                  readable(loads.by_scans.percent, loads.by_scans.sd_percent) + " %"
                            : loads.reason;
  return {WarningCode::loads_disagree,
          "the joints did " + readable(loads.work.value / 1000.0, 3) + " kJ, which is " + much +
              ": the log is not that of this dig, the dig was not along the path given, or the "
              "soil is of another kind; the loads are not used"};
}

Warning disagreement_of(const SuccessiveDensity& successive) {
  const PriorDensity& prior = successive.prior;
  const double prior_sd =
      std::hypot(prior.independent_sd_percent, prior.shared_sd_percent, prior.drift_sd_percent);
  return {WarningCode::prior_disagrees,
          "earlier digs give a density of " + readable(prior.raw_percent, prior_sd) +
              " %, this one " +
              readable(successive.this_dig.percent, successive.this_dig.sd_percent) + " %, " +
              readable(std::abs(successive.disagreement), 2) +
              " standard deviations apart: the ground is another here, or a survey is wrong; the "
              "density is that of this dig alone"};
}

/// Joins loads and prior with the density of the scans. Returns the share of the scans.
double join_second(const LawsForDig& laws, const DensityOptions& options,
                   DensityEstimate& estimate) {
  double share = 1.0;
  if (laws.work) {
    estimate.loads = density_by_loads(*laws.work, *options.joint_work, *estimate.density);
    estimate.density = estimate.loads->density;
    share *= 1.0 - estimate.loads->weight;
    if (estimate.loads->disagrees()) estimate.warnings.push_back(disagreement_of(*estimate.loads));
  }
  if (!options.prior) return share;
  if (!options.prior->trustworthy) {
    estimate.warnings.emplace_back(
        WarningCode::prior_not_trustworthy,
        "the density of earlier digs is not trustworthy and is not used: "
        "the density is that of this dig alone");
    return share;
  }
  estimate.successive = combined(*options.prior, *estimate.density);
  estimate.density = estimate.successive->density;
  if (estimate.successive->disagrees()) {
    estimate.warnings.push_back(disagreement_of(*estimate.successive));
  }
  return share * (1.0 - estimate.successive->weight);
}

/// Finds the density of a dig in what is known of the soil.
class DensityReader {
 public:
  DensityReader(const LawsForDig& laws, const DensityOptions& options)
      : laws_(laws), options_(options) {}

  DensityInSoil in_kind(const DugVolumes& dig) const {
    const auto& kind = options_.soil.kind;
    return density_in(laws_.law, kind ? &*kind : nullptr, dig, options_);
  }
  DensityInAny in_any(const DugVolumes& dig) const {
    return density_in_any(laws_.possible, dig, options_);
  }
  double percent(const DugVolumes& dig) const {
    return options_.soil.unknown ? in_any(dig).density.raw_percent
                                 : in_kind(dig).density.raw_percent;
  }

 private:
  const LawsForDig& laws_;
  const DensityOptions& options_;
};

void take_any_soil(DensityEstimate& estimate, const std::optional<PayloadDensity>& payload) {
  estimate.density = estimate.any_soil;
  estimate.payload = payload;
  estimate.law.name = "any soil";
  estimate.law.soil.clear();
}

/// Density and payload of an estimate: in the kind of soil, in any, and as read otherwise.
void set_densities(const DensityReader& reader, const DugVolumes& dig, bool unknown_soil,
                   DensityEstimate& estimate) {
  const DensityInSoil in_kind = reader.in_kind(dig);
  estimate.density = in_kind.density;
  estimate.payload = in_kind.payload;
  if (const DensityInAny any = reader.in_any(dig); !any.soils.empty()) {
    estimate.soils = any.soils;
    estimate.any_soil = any.density;
    if (unknown_soil) take_any_soil(estimate, any.payload);
  }
  for (const Reading& reading : estimate.change.readings) {
    estimate.readings.push_back({reading, reader.percent(as_read(reading, estimate.change, dig))});
  }
}

}  // namespace

LawsForDig laws_for_dig(const DensityLaw& law, const DensityOptions& options,
                        std::optional<Fallback>& fallback) {
  LawsForDig laws = {law, options.soil.possible, {}, {}};
  const auto& dug = options.dug_path;
  if (options.soil.assumed) {
    laws.warnings.emplace_back(WarningCode::soil_assumed,
                               "the soil is assumed to be " + law.soil +
                                   ": `soil` says which it is; `soils` has the "
                                   "density in others");
  }
  const auto& kind = options.soil.kind;
  if (kind && !law.soil.empty() && law.soil != kind->name) {
    laws.warnings.push_back(law_of_other_soil(law, *kind));
  }
  if (auto wet = too_wet(options.soil)) laws.warnings.push_back(std::move(*wet));
  if (fallback && options.ground) return laws;  // judged, and of the whole cut
  const auto calibration = calibrate_dug(options);
  if (calibration && can_be_fitted(law)) laws.law = law_of(*calibration);
  if (const auto doubt = doubt_of(fallback, calibration)) {
    laws.warnings.push_back(*doubt);
    fallback.reset();
  }
  if (fallback) return laws;  // it takes the place of that of any path
  const bool fitted = laws.law.path && dug && same_numbers(*laws.law.path, dug->parameters);
  if (laws.law.path && !laws.law.any_path && !fitted) {
    laws.warnings.push_back(law_of_other_path(laws.law, dug.has_value()));
  }
  if (!fitted || !calibration) return laws;
  for (SoilLaw& possible : laws.possible) {
    if (!can_be_fitted(possible.law)) continue;
    possible.law =
        possible.soil.name == laws.law.soil
            ? laws.law
            : law_of(calibrate_path(dug->machine, possible.soil, dug->parameters, options.threads));
  }
  return laws;
}

void set_density(DensityEstimate& estimate, const LawsForDig& laws, const DensityOptions& options) {
  estimate.law = laws.law;
  for (const Warning& warning : laws.warnings) estimate.warnings.push_back(warning);
  estimate.density_without_fallback =
      density_of_bulking(laws.law.freed_form, estimate.bulking->value);
  const DugVolumes dig = volumes_of(estimate);
  if (dig.voids || dig.fallback) estimate.corrected = dig.corrected();
  const bool known_error = !std::isnan(dig.bulking_sd);
  if (!known_error) {
    estimate.warnings.emplace_back(
        WarningCode::volume_error_unknown,
        "this method gives no error of its volumes: the density interval contains only the "
        "scatter of the law");
  }
  set_densities(DensityReader(laws, options), dig, options.soil.unknown, estimate);
  const RelativeDensity scans = *estimate.density;
  const double share = known_error ? join_second(laws, options, estimate) : 1.0;
  if (!options.soil.unknown) widen_by_readings(scans, share, estimate);
  estimate.trustworthy = known_error && estimate.density->trustworthy;
  for (const Warning& warning : estimate.density->warnings) estimate.warnings.push_back(warning);
  if (estimate.payload && std::abs(estimate.payload->disagreement) > largest_disagreement) {
    estimate.warnings.push_back(disagreement_of(*estimate.payload, options.soil.unknown));
    estimate.trustworthy = false;
  }
}

void set_density_by_solids(DensityEstimate& estimate, const LawsForDig& laws,
                           const DensityOptions& options) {
  const VolumeChange& change = estimate.change;
  const auto is_out_of_sight = [](const Warning& warning) {
    return warning.code == WarningCode::no_dumped_soil;
  };
  const auto is_unseen_hole = [](const Warning& warning) {
    return warning.code == WarningCode::zone_unseen;
  };
  const auto& warnings = change.warnings;
  const bool can = change.cut && options.payload_mass && options.soil.kind &&
                   change.before.value > 0.0 &&
                   std::any_of(warnings.begin(), warnings.end(), is_out_of_sight) &&
                   std::none_of(warnings.begin(), warnings.end(), is_unseen_hole);
  if (!can) return;
  for (const Warning& warning : laws.warnings) estimate.warnings.push_back(warning);
  const DensityInSoil found = density_by_solids(laws.law, *options.soil.kind, change, options);
  estimate.law = laws.law;
  estimate.density = found.density;
  estimate.payload = found.payload;
  estimate.trustworthy = found.density.trustworthy;
  for (const Warning& warning : found.density.warnings) estimate.warnings.push_back(warning);
  if (options.prior || laws.work) join_second(laws, options, estimate);
}

}  // namespace excavplan
