// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "density/density_in_soil.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <excavplan/change/bulking.hpp>

#include "base/statistics.hpp"
#include "density/joined_density.hpp"
#include "density/known_site.hpp"

namespace excavplan {
namespace {

constexpr double real_weight = 0.05;  // of a soil that the site may have; ours

struct RawDensity {
  double sd = 0.0;  ///< without the excess over 0 .. 100 %, and without disagreement
  DensityInSoil found;
};

/// Finds the density by the payload and joins it with that by the law.
///
/// Loose soil without the voids between blocks weighs m / (V_heap (1 - v)), with m the mass of the
/// heap and v = V_voids / (V_spill + V_heap): spill, heap and soil that fell back are alike. A
/// volume C in place became k C of it, so the bulk density in place is rho = k m / (V_heap (1 -
/// v)), with k the bulking factor of the whole cut, freed of voids and fallback. Without fallback k
/// = (V_spill + V_heap) (1 - v) / V_hole and v cancels: rho = m (V_spill + V_heap) / (V_heap
/// V_hole), the mass that was dug over the hole.
class PayloadReader {
 public:
  PayloadReader(const DensityLaw& law, const SoilKind& soil, const DugVolumes& dig,
                const DensityOptions& options)
      : law_(law),
        soil_(soil),
        dig_(dig),
        mass_(*options.payload_mass),
        scatter_(options.soil.scatter),
        water_content_(soil.water_content) {
    if (const auto& water = options.soil.water_content) {
      water_content_ = water->value;
      // More water than the densest state holds: the ground is looser, its scatter that of a full
      // one.
      soil_.water_content = std::min(water_content_, soil_.void_ratio_min / soil_.specific_gravity);
      scatter_.water_content =
          water_content_ > 0.0 ? std::min(1.0, water->sd / water_content_) : 0.0;
    }
  }

  void join(RawDensity& answer) {
    const double by_law = answer.found.density.raw_percent;
    weigh(by_law);
    TwoDensities both{{by_law, density_}, error_by_scans()};
    both.by_measurement = both.covariance;
    both.covariance += density_scatter(soil_, law_.freed_form, 0.5 * (by_law + density_), scatter_);
    add_path(residual_sd_at(law_.form, by_law), both);
    state(both, answer.found);
    join(both, answer);
    answer.found.evidence *= per_log_;
  }

 private:
  double after() const { return dig_.volumes(1) + dig_.volumes(2); }
  double void_share() const { return dig_.voids ? dig_.voids->value / after() : 0.0; }

  /// Where the fallback was not measured, k of the whole cut is the one that the law expects.
  void weigh(double by_law) {
    const double k = dig_.corrected().value;
    k_ = k;
    if (!dig_.fallback) {
      const double d = std::clamp(by_law, 0.0, 100.0);
      const double expected = bulking_of_density(law_.form, d);
      const double freed = bulking_of_density(law_.freed_form, d);
      k_per_measured_ = density_slope(law_.form, expected) / density_slope(law_.freed_form, freed);
      k_ = freed + k_per_measured_ * (k - expected);
    } else {
      k_per_measured_ = 1.0 - dig_.fallback->value;
    }
    bulk_density_ = k_ * mass_.value / (dig_.volumes(2) * (1.0 - void_share()));
    const double as_wet = (1.0 + soil_.water_content) / (1.0 + water_content_);
    density_ = density_of_bulk_density(soil_, as_wet * bulk_density_);
    per_log_ = 100.0 * soil_.specific_gravity * water_density * (1.0 + water_content_) /
               bulk_density_ / (soil_.void_ratio_max - soil_.void_ratio_min);
  }

  /// Covariance of both densities from volumes, voids, fallback and mass [points^2].
  Eigen::Matrix2d error_by_scans() const {
    const double hole = dig_.volumes(0);
    const double share = void_share();
    const double measured = dig_.bulking() * (1.0 - share);
    const double slope = density_slope(law_.form, dig_.corrected().value);
    const double law_per_k = slope * (dig_.fallback ? k_per_measured_ : 1.0);
    const double log_per_k = k_per_measured_ / k_;
    const Eigen::RowVector3d k_by_volume = Eigen::RowVector3d(-measured, 1.0, 1.0) / hole;
    const Eigen::RowVector3d by_after(0.0, 1.0 / after(), 1.0 / after());
    Eigen::Matrix<double, 2, 3> by_volume;
    by_volume.row(0) = law_per_k * k_by_volume;
    by_volume.row(1) = per_log_ * (log_per_k * k_by_volume - share / (1.0 - share) * by_after -
                                   Eigen::RowVector3d(0.0, 0.0, 1.0 / dig_.volumes(2)));
    Eigen::Matrix2d error = by_volume * dig_.covariance * by_volume.transpose();
    const auto add = [&error](const Eigen::Vector2d& by_cause) {
      error += by_cause * by_cause.transpose();
    };
    if (dig_.voids) {
      add(dig_.voids->sd *
          Eigen::Vector2d(-law_per_k / hole,
                          per_log_ * (1.0 / after() / (1.0 - share) - log_per_k / hole)));
    }
    if (dig_.fallback) {
      add((1.0 - measured) * dig_.fallback->sd * Eigen::Vector2d(slope, per_log_ / k_));
    }
    add({0.0, per_log_ * mass_.sd / mass_.value});
    return error;
  }

  /// Scatter of the law beyond that of the soils: of other paths, where the fallback is the law's,
  /// which then errs in the payload's density too.
  void add_path(double law_scatter, TwoDensities& both) const {
    const double of_soils = both.covariance(0, 0) - both.by_measurement(0, 0);
    const double rest = law_scatter * law_scatter - of_soils;
    if (!(rest > 0.0)) return;
    const double shared = dig_.fallback ? 0.0 : per_log_ / k_ / density_slope(law_.freed_form, k_);
    const Eigen::Vector2d by_path(1.0, shared);
    both.covariance += rest * by_path * by_path.transpose();
  }

  void state(const TwoDensities& both, DensityInSoil& found) const {
    PayloadDensity& payload = found.payload.emplace();
    const double dug = after() / dig_.volumes(2);
    payload.mass = mass_;
    payload.dug_mass = {dug * mass_.value, dug * mass_.sd};
    payload.bulk_density = {bulk_density_,
                            bulk_density_ * std::sqrt(both.by_measurement(1, 1)) / per_log_};
    payload.law_density_percent = {both.percent(0), std::sqrt(both.covariance(0, 0))};
    payload.density_percent = {both.percent(1), std::sqrt(both.covariance(1, 1))};
  }

  /// The mean of least variance. Where the two differ by more than their errors explain, these are
  /// too small: the deviation is multiplied by the Birge ratio, the root of chi^2 per degree of
  /// freedom (Birge 1932, Phys. Rev. 40, 207), of which there is one.
  static void join(const TwoDensities& both, RawDensity& answer) {
    const JoinedDensity mean = joined(both);
    RelativeDensity& density = answer.found.density;
    density.raw_percent = mean.percent;
    density.percent = std::clamp(mean.percent, 0.0, 100.0);
    density.sd_given_law_percent = mean.measurement_sd;
    answer.sd = mean.sd;
    set_error(density, mean.sd * std::max(1.0, std::abs(mean.disagreement)));
    answer.found.payload->disagreement = mean.disagreement;
    answer.found.evidence *=
        std::exp(-0.5 * mean.disagreement * mean.disagreement) / mean.difference_sd;
  }

  const DensityLaw& law_;
  SoilKind soil_;
  const DugVolumes& dig_;
  Measured mass_;
  SoilScatter scatter_;
  double water_content_;         ///< measured, or the soil's
  double k_ = 0.0;               ///< of the whole cut
  double k_per_measured_ = 0.0;  ///< its change with the one without the voids
  double bulk_density_ = 0.0;    ///< in place [kg/m^3]
  double density_ = 0.0;         ///< [%]
  double per_log_ = 0.0;         ///< its change with ln(bulk_density_) [%]
};

/// Finds the density by the solids of a dig whose heap is out of sight. The bank B that was cut
/// weighs as much as the mass m that was carried away and what rose in sight on the whole, R of
/// loose soil: rho = (m + rho_loose R) / B. Where the floor of the cut is not known, soil F that
/// the law expects on it belongs to both.
class SolidsReader {
 public:
  SolidsReader(const DensityLaw& law, const SoilKind& soil, const VolumeChange& change,
               const DensityOptions& options)
      : law_(law), soil_(soil), change_(change), options_(options) {
    if (const auto& water = options.soil.water_content) water_ = water->value;
  }

  DensityInSoil read() {
    constexpr int rounds = 4;  // of the fallback that the density expects
    double density = 50.0;
    for (int i = 0; i < rounds; ++i) density = density_with(fallback_at(density));
    DensityInSoil found;
    found.density.raw_percent = density;
    found.density.percent = std::clamp(density, 0.0, 100.0);
    const Eigen::Matrix2d of_soil =
        density_scatter(soil_, law_.freed_form, found.density.percent, options_.soil.scatter);
    const double measured = measured_sd();
    found.density.sd_given_law_percent = measured;
    set_error(found.density, std::hypot(measured, std::sqrt(of_soil(1, 1))));
    state(measured, found);
    return found;
  }

 private:
  /// Soil on the floor that the law expects [m^3]; 0 where the floor is known.
  double fallback_at(double density) const {
    if (change_.cut->swept_area > 0.0) return 0.0;
    const double share = expected_fallback(law_, density);
    return share / (1.0 - share) * change_.before.value;
  }

  double density_with(double fallback) {
    fallback_ = fallback;
    bank_ = change_.before.value + fallback;
    loose_density_ =
        soil_.specific_gravity * water_density * (1.0 + water_) / (1.0 + soil_.void_ratio_loose);
    const double mass = options_.payload_mass->value;
    bulk_density_ = (mass + loose_density_ * (change_.after.value + fallback)) / bank_;
    const double as_wet = (1.0 + soil_.water_content) / (1.0 + water_);
    per_log_ = 100.0 * soil_.specific_gravity * water_density * (1.0 + water_) / bulk_density_ /
               (soil_.void_ratio_max - soil_.void_ratio_min);
    return density_of_bulk_density(soil_, as_wet * bulk_density_);
  }

  /// By volumes, path, fallback and mass [points].
  double measured_sd() const {
    constexpr double of_expected = 0.5;  // ours: sd of a fallback that was not measured, as a share
    const Eigen::Vector3d by_volume(-bulk_density_, loose_density_, loose_density_);
    const double both =
        (loose_density_ - bulk_density_) *
        std::hypot(known_tracking_sd * change_.cut->swept_area, of_expected * fallback_);
    const double variance = by_volume.dot(change_.errors.total() * by_volume) + both * both +
                            std::pow(options_.payload_mass->sd, 2);
    return per_log_ * std::sqrt(variance) / (bank_ * bulk_density_);
  }

  void state(double measured, DensityInSoil& found) const {
    PayloadDensity& payload = found.payload.emplace();
    payload.mass = *options_.payload_mass;
    payload.dug_mass = {bulk_density_ * bank_, payload.mass.sd};
    payload.bulk_density = {bulk_density_, bulk_density_ * measured / per_log_};
    payload.density_percent = {found.density.raw_percent, found.density.sd_percent};
    payload.law_density_percent = {std::nan(""), std::nan("")};
  }

  const DensityLaw& law_;
  const SoilKind& soil_;
  const VolumeChange& change_;
  const DensityOptions& options_;
  double water_ = soil_.water_content;
  double fallback_ = 0.0;       ///< expected [m^3]
  double bank_ = 0.0;           ///< [m^3]
  double loose_density_ = 0.0;  ///< moist [kg/m^3]
  double bulk_density_ = 0.0;   ///< moist, in place [kg/m^3]
  double per_log_ = 0.0;        ///< change of the density with ln(bulk_density_) [%]
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
    any.trustworthy = any.trustworthy || (soil.density.trustworthy && soil.weight >= real_weight);
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

/// Mean and deviation of a figure over the soils.
Measured mixture_of(const std::vector<SoilAnswer>& soils, Measured PayloadDensity::*figure) {
  Measured mean;
  for (const SoilAnswer& soil : soils) mean.value += soil.weight * ((*soil.payload).*figure).value;
  double variance = 0.0;
  for (const SoilAnswer& soil : soils) {
    const Measured& own = (*soil.payload).*figure;
    variance += soil.weight * (own.sd * own.sd + std::pow(own.value - mean.value, 2));
  }
  mean.sd = std::sqrt(variance);
  return mean;
}

/// Means over the soils, and the disagreement in the soil of real weight where it is least.
PayloadDensity payload_in_any(const std::vector<SoilAnswer>& soils) {
  PayloadDensity any = *soils.front().payload;  // the masses are the same in all
  any.bulk_density = mixture_of(soils, &PayloadDensity::bulk_density);
  any.density_percent = mixture_of(soils, &PayloadDensity::density_percent);
  any.law_density_percent = mixture_of(soils, &PayloadDensity::law_density_percent);
  const auto further = [](const SoilAnswer& a, const SoilAnswer& b) {
    if ((a.weight < real_weight) != (b.weight < real_weight)) return b.weight < real_weight;
    return std::abs(a.payload->disagreement) < std::abs(b.payload->disagreement);
  };
  any.disagreement = std::min_element(soils.begin(), soils.end(), further)->payload->disagreement;
  return any;
}

}  // namespace

Measured DugVolumes::corrected() const {
  Measured k{bulking(), bulking_sd};
  if (voids) {
    k = {k.value - voids->value / volumes(0), std::hypot(k.sd, voids->sd / volumes(0))};
  }
  if (fallback) {
    k = {free_of_fallback(k.value, fallback->value),
         std::hypot((1.0 - fallback->value) * k.sd, (1.0 - k.value) * fallback->sd)};
  }
  return k;
}

DugVolumes volumes_of(const DensityEstimate& estimate) {
  const VolumeChange& change = estimate.change;
  DugVolumes dig;
  dig.volumes = {change.before.value, change.spilled.value, change.dumped.value};
  dig.covariance = change.errors.total();
  dig.bulking_sd = estimate.bulking->sd;
  dig.voids = estimate.blocks.voids;
  if (estimate.fallback) dig.fallback = estimate.fallback->fraction;
  if (change.cut) {
    // The rise on the whole: the heap, and what rose or vanished beside it.
    dig.volumes(1) = change.after.value - dig.volumes(2);
    if (dig.fallback) dig.fallback->value = 0.0;
  }
  return dig;
}

DensityInSoil density_in(const DensityLaw& law, const SoilKind* soil, const DugVolumes& dig,
                         const DensityOptions& options) {
  DensityLaw used = law;
  if (dig.fallback) used.form = used.freed_form;
  Measured k = dig.corrected();
  const bool known_error = !std::isnan(k.sd);
  if (!known_error) k.sd = 0.0;
  RawDensity answer;
  RelativeDensity& density = answer.found.density;
  density = relative_density(used, k);
  answer.sd = std::hypot(density.sd_given_law_percent, residual_sd_at(used.form, density.percent));
  answer.found.evidence = density_slope(used.form, k.value);
  if (!known_error) density.sd_given_law_percent = k.sd = std::nan("");
  if (soil && options.payload_mass && known_error) {
    PayloadReader(used, *soil, dig, options).join(answer);
  }
  const double sd = std::max(answer.sd, 1e-6);
  answer.found.evidence *=
      normal_cdf((100.0 - density.raw_percent) / sd) - normal_cdf(-density.raw_percent / sd);
  return answer.found;
}

double expected_fallback(const DensityLaw& law, double density_percent) {
  constexpr double most = 0.5;  // ours
  const double d = std::clamp(density_percent, 0.0, 100.0);
  const double freed = bulking_of_density(law.freed_form, d);
  const double seen = bulking_of_density(law.form, d);
  const double share = (freed - seen) / (1.0 - seen);
  return std::isfinite(share) ? std::clamp(share, 0.0, most) : 0.0;
}

DensityInSoil density_by_solids(const DensityLaw& law, const SoilKind& soil,
                                const VolumeChange& change, const DensityOptions& options) {
  return SolidsReader(law, soil, change, options).read();
}

DensityInAny density_in_any(const std::vector<SoilLaw>& laws, const DugVolumes& dig,
                            const DensityOptions& options) {
  DensityInAny any;
  if (laws.empty()) return any;
  double sum = 0.0;
  for (const SoilLaw& possible : laws) {
    const DensityInSoil found = density_in(possible.law, &possible.soil, dig, options);
    any.soils.push_back(
        {possible.soil.name, possible.weight * found.evidence, found.density, found.payload});
    sum += any.soils.back().weight;
  }
  for (std::size_t i = 0; i < laws.size(); ++i) {
    double& weight = any.soils[i].weight;
    weight = sum > 0.0 ? weight / sum : laws[i].weight;
  }
  any.density = mixture_of(any.soils);
  if (any.soils.front().payload) any.payload = payload_in_any(any.soils);
  return any;
}

}  // namespace excavplan
