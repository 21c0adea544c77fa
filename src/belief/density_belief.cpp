// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/belief/density_belief.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.hpp"
#include "belief/belief_refit.hpp"
#include "belief/belief_settings.hpp"
#include "belief/dig_evidence.hpp"
#include "belief/dual_form.hpp"

namespace excavplan {
namespace {

DigEvidence checked(const DigEvidence& dig) {
  require_readings(dig);
  DigEvidence result = dig;
  if (!dig.bank.empty()) result.bank = condensed(dig.bank);
  return result;
}

}  // namespace

class DensityBelief::Dual : public DualForm {
  using DualForm::DualForm;
};

DensityBelief::DensityBelief(const BeliefSettings& settings, const std::vector<DigEvidence>& digs,
                             std::optional<DigEvidence> forgotten)
    : settings_(settings) {
  require_settings(settings);
  require(digs.size() <= most_digs, "belief: digs", static_cast<double>(digs.size()),
          "at most " + std::to_string(most_digs));
  if (forgotten) forgotten_ = checked(*forgotten);
  for (const DigEvidence& dig : digs) digs_.push_back(checked(dig));
  rebuild();
}

DensityBelief::DensityBelief(const DensityBelief& other)
    : settings_(other.settings_),
      digs_(other.digs_),
      forgotten_(other.forgotten_),
      dual_(std::make_unique<Dual>(*other.dual_)) {}
DensityBelief::DensityBelief(DensityBelief&& other) noexcept = default;
DensityBelief& DensityBelief::operator=(DensityBelief other) noexcept {
  std::swap(settings_, other.settings_);
  std::swap(digs_, other.digs_);
  std::swap(forgotten_, other.forgotten_);
  std::swap(dual_, other.dual_);
  return *this;
}
DensityBelief::~DensityBelief() = default;

void DensityBelief::rebuild() {
  dual_ = std::make_unique<Dual>(settings_);
  for (const DigEvidence& dig : digs_) dual_->add(dig);
}

void DensityBelief::add(const DigEvidence& dig) {
  digs_.push_back(checked(dig));
  forgotten_.reset();
  if (digs_.size() <= most_digs) {
    dual_->add(digs_.back());
    return;
  }
  forgotten_ = std::move(digs_.front());
  digs_.erase(digs_.begin());
  rebuild();
}

bool DensityBelief::drop_last() {
  if (digs_.empty()) return false;
  digs_.pop_back();
  if (forgotten_) digs_.insert(digs_.begin(), std::move(*forgotten_));
  forgotten_.reset();
  rebuild();
  return true;
}

void DensityBelief::refit() {
  settings_ = refitted(settings_, digs_);
  rebuild();
}

BelievedDensity DensityBelief::at(const std::vector<GroundPlace>& places) const {
  for (const GroundPlace& place : places) {
    for (const double coordinate : {place.x, place.y, place.depth}) {
      require(std::isfinite(coordinate), "a place of the ground [m]", coordinate, "finite");
    }
  }
  return dual_->at(FieldPoints(places));
}

BelievedMeans DensityBelief::means_of(const std::vector<std::vector<BankPart>>& parts) const {
  std::vector<FieldPart> of_field;
  of_field.reserve(parts.size());
  for (const std::vector<BankPart>& part : parts) of_field.push_back(field_part(condensed(part)));
  return dual_->means_of(of_field);
}

GroundDensity DensityBelief::ground_density(const std::vector<BankPart>& part) const {
  const BelievedMeans mean = means_of({part});
  GroundDensity density(std::clamp(mean.raw_percent(0), 0.0, 100.0),
                        std::sqrt(mean.covariance(0, 0)));
  density.trustworthy = !dual_->is_empty();
  return density;
}

CommonStates DensityBelief::common_states() const { return dual_->common_states(); }
std::vector<double> DensityBelief::innovations() const { return dual_->innovations(); }
double DensityBelief::log_likelihood() const { return dual_->log_likelihood(); }

LayeredMap belief_map(const DensityBelief& belief, const HeightMap& grid, double depth) {
  std::vector<GroundPlace> places;
  for (Eigen::Index col = 0; col < grid.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < grid.z.rows(); ++row) {
      places.push_back({grid.x(col), grid.y(row), depth});
    }
  }
  const BelievedDensity density = belief.at(places);
  const auto layer = [&](const Eigen::ArrayXd& values) {
    return Eigen::ArrayXXd(
        Eigen::Map<const Eigen::ArrayXXd>(values.data(), grid.z.rows(), grid.z.cols()));
  };
  return {grid,
          {{"density_percent", "believed relative density", layer(density.percent())},
           {"density_sd_percent", "its standard deviation", layer(density.sd_percent)}}};
}

}  // namespace excavplan
