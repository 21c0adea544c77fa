// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "survey/density_of_volumes.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/LU>

#include <excavplan/ground/bulking.hpp>
#include <excavplan/simulation/calibration.hpp>

#include "base/check.hpp"
#include "base/normal_mixture.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double same_path = 1e-3;            // [rad], [m]
constexpr double fallback_tolerance = 0.1;    // of the simulator's fallback; ours
constexpr double least_fallback = 0.0;        // of any path in any soil; ours
constexpr double most_fallback = 0.5;         // likewise
constexpr double largest_disagreement = 2.5;  // of payload and law, in standard deviations

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
  return Warning{"dug_path_doubtful",
                 what + ", but digs along this path leave " + readable(100.0 * least) + " .. " +
                     readable(100.0 * most) +
                     " % filled: the dig stalled or was not along this path, or the scans are not "
                     "in the site frame; the bulking factor is not corrected for fallback",
                 true};
}

Warning law_of_other_path(const DensityLaw& law, bool path_is_known) {
  return {"law_of_other_path", "the law '" + law.name + "' holds for digs along one path, " +
                                   (path_is_known ? "which is not the one that was dug"
                                                  : "and the path that was dug is not known") +
                                   ": soil that falls back differs, by several points of density"};
}

// ---- Bulking factor ---------------------------------------------------------------------------

/// Volume after without the voids between blocks, over the volume before.
Measured without_voids(const VolumeChange& change, const Measured& bulking, const Measured& voids) {
  const double before = change.before.value;
  return {bulking.value - voids.value / before, std::hypot(bulking.sd, voids.sd / before)};
}

/// k = f + (1 - f) k_measured with the errors of both.
Measured freed_of(const Measured& bulking, const Measured& fallback) {
  return {free_of_fallback(bulking.value, fallback.value),
          std::hypot((1.0 - fallback.value) * bulking.sd, (1.0 - bulking.value) * fallback.sd)};
}

/// The bulking factor for the law, if it differs from that of the scans.
std::optional<Measured> corrected(const DensityEstimate& estimate) {
  if (!estimate.blocks.voids && !estimate.fallback) return std::nullopt;
  Measured k = *estimate.bulking;
  if (estimate.blocks.voids) k = without_voids(estimate.change, k, *estimate.blocks.voids);
  if (estimate.fallback) k = freed_of(k, estimate.fallback->fraction);
  return k;
}

// ---- One kind of soil -------------------------------------------------------------------------

/// The density in one kind of soil.
struct Answer {
  RelativeDensity density;
  double sd = 0.0;        ///< of the raw density, without the excess over the range [points]
  double evidence = 1.0;  ///< likelihood of what was measured, up to a factor for all soils
  std::optional<PayloadDensity> payload;
};

/// Finds the density of an estimate by a law, and by the payload if it is known.
class SoilReader {
 public:
  SoilReader(const DensityEstimate& estimate, const DensityOptions& options, const Measured& k)
      : estimate_(estimate), options_(options), k_(k) {}

  Answer answer(DensityLaw law, const SoilKind* soil) const {
    if (estimate_.fallback) law.form = law.freed_form;
    Answer answer;
    answer.density = relative_density(law, k_);
    answer.sd = std::hypot(answer.density.sd_given_law_percent,
                           residual_sd_at(law.form, answer.density.percent));
    answer.evidence = density_slope(law.form, k_.value);
    if (soil && options_.payload_mass && !std::isnan(estimate_.bulking->sd)) {
      add_payload(law, *soil, answer);
    }
    const double raw = answer.density.raw_percent;
    const double sd = std::max(answer.sd, 1e-6);
    answer.evidence *= normal_cdf((100.0 - raw) / sd) - normal_cdf(-raw / sd);
    return answer;
  }

 private:
  /// What the payload says.
  struct Weighed {
    double k_true = 0.0;        ///< by the fallback that was measured, or as the law expects it
    double bulk_density = 0.0;  ///< in place [kg/m^3]
    double density = 0.0;       ///< [%]
    double per_log = 0.0;       ///< change of `density` with ln(bulk_density) [%]
  };

  Weighed weigh(const DensityLaw& law, const SoilKind& soil, double by_law) const {
    const double k = estimate_.bulking->value;
    Weighed weighed;
    weighed.k_true = estimate_.fallback
                         ? free_of_fallback(k, estimate_.fallback->fraction.value)
                         : bulking_of_density(law.freed_form, std::clamp(by_law, -50.0, 150.0));
    weighed.bulk_density =
        weighed.k_true * options_.payload_mass->value / estimate_.change.dumped.value;
    weighed.density = density_of_bulk_density(soil, weighed.bulk_density);
    weighed.per_log = 100.0 * soil.specific_gravity * water_density * (1.0 + soil.water_content) /
                      weighed.bulk_density / (soil.void_ratio_max - soil.void_ratio_min);
    return weighed;
  }

  /// Covariance of the densities by law and payload from volumes, fallback and mass [points^2].
  Eigen::Matrix2d error_given_law(const DensityLaw& law, const Weighed& weighed) const {
    const VolumeChange& change = estimate_.change;
    const double k = estimate_.bulking->value;
    const double slope = density_slope(law.form, k_.value);
    const double freed_per_k = estimate_.fallback
                                   ? 1.0 - estimate_.fallback->fraction.value
                                   : slope / density_slope(law.freed_form, weighed.k_true);
    const Eigen::RowVector3d k_by_volume =
        Eigen::RowVector3d(-k, 1.0, 1.0) / change.before.value;  // of (hole, spill, heap)
    Eigen::Matrix<double, 2, 3> by_volume;
    by_volume.row(0) = slope * (estimate_.fallback ? freed_per_k : 1.0) * k_by_volume;
    by_volume.row(1) = weighed.per_log * (freed_per_k / weighed.k_true * k_by_volume -
                                          Eigen::RowVector3d(0.0, 0.0, 1.0 / change.dumped.value));
    Eigen::Matrix2d error = by_volume * change.errors.total() * by_volume.transpose();
    if (estimate_.fallback) {
      const Eigen::Vector2d by_fallback = (1.0 - k) * estimate_.fallback->fraction.sd *
                                          Eigen::Vector2d(slope, weighed.per_log / weighed.k_true);
      error += by_fallback * by_fallback.transpose();
    }
    const Measured& mass = *options_.payload_mass;
    error(1, 1) += std::pow(weighed.per_log * mass.sd / mass.value, 2);
    return error;
  }

  /// Joins the density by the law with that by the payload.
  void add_payload(const DensityLaw& law, SoilKind soil, Answer& answer) const {
    SoilScatter scatter = options_.soil.scatter;
    if (const auto& water = options_.soil.water_content) {
      soil.water_content = water->value;
      scatter.water_content = water->value > 0.0 ? water->sd / water->value : 0.0;
    }
    const double by_law = answer.density.raw_percent;
    const Weighed weighed = weigh(law, soil, by_law);
    const Eigen::Matrix2d given_law = error_given_law(law, weighed);
    Eigen::Matrix2d covariance =
        given_law +
        density_scatter(soil, law.freed_form, 0.5 * (by_law + weighed.density), scatter);
    add_path(residual_sd_at(law.form, by_law), covariance,
             weighed.per_log / weighed.k_true / density_slope(law.freed_form, weighed.k_true),
             given_law(0, 0));
    join({by_law, weighed.density}, covariance, given_law, answer);
    answer.evidence *= weighed.per_log;
    const Measured& mass = *options_.payload_mass;
    const double all = estimate_.change.after.value / estimate_.change.dumped.value;
    answer.payload->mass = mass;
    answer.payload->dug_mass = {all * mass.value, all * mass.sd};
    answer.payload->bulk_density = {
        weighed.bulk_density, weighed.bulk_density * std::sqrt(given_law(1, 1)) / weighed.per_log};
  }

  /// Scatter of the law beyond that of the soils: of other paths, where the fallback is the law's,
  /// which then errs in the payload's too.
  void add_path(double law_scatter, Eigen::Matrix2d& covariance, double payload_per_law,
                double given_law) const {
    const double rest = law_scatter * law_scatter - (covariance(0, 0) - given_law);
    if (!(rest > 0.0)) return;
    const double shared = estimate_.fallback ? 0.0 : payload_per_law;
    const Eigen::Vector2d by_path(1.0, shared);
    covariance += rest * by_path * by_path.transpose();
  }

  /// The mean of least variance of two densities.
  static void join(const Eigen::Vector2d& densities, const Eigen::Matrix2d& covariance,
                   const Eigen::Matrix2d& given_law, Answer& answer) {
    const double difference_variance = covariance(0, 0) + covariance(1, 1) - 2.0 * covariance(0, 1);
    const double by_mass =
        std::clamp((covariance(0, 0) - covariance(0, 1)) / difference_variance, 0.0, 1.0);
    const Eigen::Vector2d share(1.0 - by_mass, by_mass);
    RelativeDensity& density = answer.density;
    density.raw_percent = share.dot(densities);
    density.percent = std::clamp(density.raw_percent, 0.0, 100.0);
    density.sd_given_law_percent = std::sqrt(share.dot(given_law * share));
    answer.sd = std::sqrt(share.dot(covariance * share));
    set_error(density, answer.sd);
    PayloadDensity& payload = answer.payload.emplace();
    payload.law_density_percent = {densities(0), std::sqrt(covariance(0, 0))};
    payload.density_percent = {densities(1), std::sqrt(covariance(1, 1))};
    payload.disagreement = (densities(1) - densities(0)) / std::sqrt(difference_variance);
    answer.evidence *=
        std::exp(-0.5 * std::pow(payload.disagreement, 2)) / std::sqrt(difference_variance);
  }

  const DensityEstimate& estimate_;
  const DensityOptions& options_;
  Measured k_;  ///< for the law
};

// ---- Any kind of soil -------------------------------------------------------------------------

/// Mixture of normal distributions that are cut off at 0 and 100 %, on a grid.
RelativeDensity mixture_of(const std::vector<SoilAnswer>& soils) {
  constexpr int cells = 4000;
  constexpr double width = 100.0 / cells;
  Eigen::ArrayXd shares = Eigen::ArrayXd::Zero(cells);
  const Eigen::ArrayXd middle = Eigen::ArrayXd::LinSpaced(cells, 0.5 * width, 100.0 - 0.5 * width);
  RelativeDensity any;
  any.trustworthy = false;
  for (const SoilAnswer& soil : soils) {
    const double sd = std::max(soil.density.sd_percent, width);
    Eigen::ArrayXd own(cells);
    for (int i = 0; i < cells; ++i) {
      const double z = (i * width - soil.density.percent) / sd;
      own(i) = normal_cdf(z + width / sd) - normal_cdf(z);
    }
    shares += soil.weight * own / own.sum();
    any.sd_given_law_percent += soil.weight * std::pow(soil.density.sd_given_law_percent, 2);
    any.trustworthy = any.trustworthy || soil.density.trustworthy;
  }
  any.sd_given_law_percent = std::sqrt(any.sd_given_law_percent);
  any.percent = any.raw_percent = (shares * middle).sum();
  any.sd_percent = std::sqrt((shares * (middle - any.percent).square()).sum());
  const auto quantile = [&](double share) {
    double sum = 0.0;
    int i = 0;
    while (i < cells - 1 && sum + shares(i) < share) sum += shares(i++);
    return width * (i + std::clamp((share - sum) / shares(i), 0.0, 1.0));
  };
  any.interval_percent = {quantile(0.025), quantile(0.975)};
  if (!any.trustworthy) any.warnings = soils.front().density.warnings;
  return any;
}

void add_soils(const SoilReader& reader, const LawsForDig& laws, DensityEstimate& estimate) {
  if (laws.possible.empty()) return;
  double sum = 0.0;
  for (const SoilLaw& possible : laws.possible) {
    const Answer answer = reader.answer(possible.law, &possible.soil);
    estimate.soils.push_back(
        {possible.soil.name, possible.weight * answer.evidence, answer.density});
    sum += estimate.soils.back().weight;
  }
  for (std::size_t i = 0; i < estimate.soils.size(); ++i) {
    double& weight = estimate.soils[i].weight;
    weight = sum > 0.0 ? weight / sum : laws.possible[i].weight;
  }
  estimate.any_soil = mixture_of(estimate.soils);
}

// ---- The answer -------------------------------------------------------------------------------

Warning disagreement_of(const PayloadDensity& payload) {
  return {"payload_disagrees",
          "the payload gives a density of " +
              readable(payload.density_percent.value, payload.density_percent.sd) +
              " %, the bulking factor " +
              readable(payload.law_density_percent.value, payload.law_density_percent.sd) + " %, " +
              readable(std::abs(payload.disagreement), 2) +
              " standard deviations apart: the kind of soil or its water content is not that "
              "assumed, or a change of the ground does not belong to this dig",
          true};
}

/// The density of the scene read differently, by the law.
void add_readings(const DensityLaw& law, const Measured& k, DensityEstimate& estimate) {
  const DensityForm& form = estimate.fallback ? law.freed_form : law.form;
  for (const Reading& reading : estimate.change.readings) {
    const double shift = reading.bulking.value - estimate.bulking->value;
    estimate.readings.push_back({reading, density_of_bulking(form, k.value + shift)});
  }
}

/// The interval of the mixture of the likely readings.
void widen_by_readings(DensityEstimate& estimate) {
  RelativeDensity& density = *estimate.density;
  const double explained =
      variance_by_readings(estimate.change) / std::pow(estimate.bulking->sd, 2);
  const double rest = std::sqrt(std::pow(density.sd_percent, 2) -
                                explained * std::pow(density.sd_given_law_percent, 2));
  std::vector<NormalPart> parts;
  for (const DensityReading& each : estimate.readings) {
    if (is_unseen(each.reading)) continue;
    const double shift = each.density_percent - estimate.readings.front().density_percent;
    parts.push_back({each.reading.weight, std::clamp(density.percent + shift, 0.0, 100.0), rest});
  }
  if (parts.size() < 2 || !(rest > 0.0)) return;
  density.interval_percent = {std::clamp(quantile_of(parts, 0.025), 0.0, 100.0),
                              std::clamp(quantile_of(parts, 0.975), 0.0, 100.0)};
}

void take_any_soil(DensityEstimate& estimate) {
  estimate.density = estimate.any_soil;
  estimate.law.name = "any soil";
  estimate.law.soil.clear();
  estimate.payload.reset();
}

}  // namespace

LawsForDig laws_for_dig(const DensityLaw& law, const DensityOptions& options,
                        std::optional<Fallback>& fallback) {
  LawsForDig laws = {law, options.soil.possible, {}};
  const auto& dug = options.dug_path;
  if (options.soil.assumed) {
    laws.warnings.push_back({"soil_assumed", "the soil is assumed to be " + law.soil +
                                                 ": --soil says which it is; `soils` has the "
                                                 "density in others"});
  }
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
  estimate.corrected = corrected(estimate);
  Measured k = estimate.corrected.value_or(*estimate.bulking);
  const bool known_error = !std::isnan(k.sd);
  if (!known_error) {
    k.sd = 0.0;
    estimate.warnings.push_back(
        {"volume_error_unknown",
         "this method gives no error of its volumes: the density interval contains only the "
         "scatter of the law"});
  }
  const SoilReader reader(estimate, options, k);
  const SoilKind* kind = options.soil.kind ? &*options.soil.kind : nullptr;
  const Answer answer = reader.answer(laws.law, kind);
  estimate.density = answer.density;
  estimate.payload = answer.payload;
  add_soils(reader, laws, estimate);
  add_readings(laws.law, k, estimate);
  widen_by_readings(estimate);
  if (options.soil.unknown) take_any_soil(estimate);
  estimate.trustworthy = known_error && estimate.density->trustworthy;
  for (const Warning& warning : estimate.density->warnings) estimate.warnings.push_back(warning);
  if (estimate.payload && std::abs(estimate.payload->disagreement) > largest_disagreement) {
    estimate.warnings.push_back(disagreement_of(*estimate.payload));
    estimate.trustworthy = false;
  }
}

}  // namespace excavplan
