// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "belief/dig_evidence.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "base/check.hpp"

namespace excavplan {
namespace {

constexpr double most_log = 20.0;     // of a logarithm that is read; ours
constexpr double most_percent = 1e4;  // that a density is off; ours

void require_sd(const char* what, double sd) {
  require(sd >= 0.0 && std::isfinite(sd), what, sd, "at least 0 and finite");
}

void require_law(const ResistanceLaw& law) {
  require_in("resistance: density that it was foretold for [%]", law.at_percent, -most_percent,
             most_percent);
  require_in("resistance: rise of the logarithm [1/%]", law.rise_per_percent, -1.0, 1.0);
  require_in("resistance: share that grows with the strength", law.strength_share, 0.0, 1.0);
}

Eigen::Vector3d vector_of(const GroundPlace& place) { return {place.x, place.y, place.depth}; }

double checked_volume(const std::vector<BankPart>& bank) {
  double volume = 0.0;
  for (const BankPart& part : bank) {
    for (const double coordinate : {part.place.x, part.place.y, part.place.depth}) {
      require(std::isfinite(coordinate), "bank: a place", coordinate, "finite");
    }
    require(part.volume >= 0.0 && std::isfinite(part.volume), "bank: a volume [m^3]", part.volume,
            "at least 0 and finite");
    volume += part.volume;
  }
  require(volume > 0.0 && std::isfinite(volume), "bank: the sum of its volumes [m^3]", volume,
          "above 0 and finite");
  return volume;
}

/// Direction of the longer axis in plan of a scatter.
Eigen::Vector3d long_axis(const Eigen::Matrix3d& scatter) {
  const double angle = 0.5 * std::atan2(2.0 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
  return {std::cos(angle), std::sin(angle), 0.0};
}

}  // namespace

void require_readings(const DigEvidence& dig) {
  require_in("dig: share of bank", dig.bank_share, 0.0, 1.0);
  if (dig.survey) {
    require_in("survey: density [%]", dig.survey->raw_percent, -most_percent, most_percent);
    require_sd("survey: its sd [points]", dig.survey->sd_percent);
    for (const ScanError& scan : dig.survey->scans) {
      require_in("survey: effect of a scan [points]", scan.effect_percent, -most_percent,
                 most_percent);
    }
  }
  if (dig.payload_percent) {
    require_in("payload: density [%]", dig.payload_percent->value, -most_percent, most_percent);
    require_sd("payload: its sd [points]", dig.payload_percent->sd);
  }
  for (const ResistanceReading& resistance : dig.resistance) {
    require_in("resistance: ln(measured / foretold)", resistance.log_ratio, -most_log, most_log);
    require_sd("resistance: sd of its logarithm", resistance.sd);
    require_law(resistance.law);
  }
  for (const LimitReading& limit : dig.limits) {
    require_in("limit: ln(foretold / limit)", limit.log_margin, -most_log, most_log);
    require_sd("limit: sd of its logarithm", limit.sd);
    require_law(limit.law);
  }
}

std::vector<BankPart> condensed(const std::vector<BankPart>& bank) {
  const double volume = checked_volume(bank);
  if (bank.size() <= 4) return bank;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const BankPart& part : bank) mean += part.volume / volume * vector_of(part.place);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const BankPart& part : bank) {
    const Eigen::Vector3d off = vector_of(part.place) - mean;
    scatter += part.volume / volume * off * off.transpose();
  }
  const Eigen::Vector3d axis = long_axis(scatter);
  const double along = std::sqrt(std::max(0.0, axis.dot(scatter * axis)));
  const double tilt = along > 0.0 ? axis.dot(scatter.col(2)) / along : 0.0;
  const double over = std::sqrt(std::max(0.0, scatter(2, 2) - tilt * tilt));
  std::vector<BankPart> parts;
  for (const double side : {-1.0, 1.0}) {
    for (const double end : {-1.0, 1.0}) {
      const Eigen::Vector3d at = mean + side * along * axis;
      parts.push_back({{at.x(), at.y(), at.z() + side * tilt + end * over}, 0.25 * volume});
    }
  }
  return parts;
}

Measured density_of_bank(const SoilKind& soil, const Measured& mass, const Measured& volume) {
  require_soil(soil);
  for (const Measured& figure : {mass, volume}) {
    require(figure.value > 0.0 && std::isfinite(figure.value), "mass [kg] or volume [m^3] of bank",
            figure.value, "above 0 and finite");
    require(figure.sd >= 0.0 && std::isfinite(figure.sd), "sd of mass or volume of bank", figure.sd,
            "at least 0 and finite");
  }
  const SoilState densest = bank_state(soil, 100.0);
  const double solid = densest.bulk_density * (1.0 + densest.void_ratio);
  const double specific = solid * volume.value / mass.value;  // 1 + e
  const double range = soil.void_ratio_max - soil.void_ratio_min;
  const double share = std::hypot(mass.sd / mass.value, volume.sd / volume.value);
  return {100.0 * (soil.void_ratio_max + 1.0 - specific) / range, 100.0 * specific / range * share};
}

}  // namespace excavplan
