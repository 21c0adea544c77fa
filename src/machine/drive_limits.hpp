// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <excavplan/machine/machine.hpp>

namespace excavplan {

/// What the drive of boom, arm and bucket can do, times the speed fraction.
class DriveLimits {
 public:
  DriveLimits(const Machine& machine, double fraction)
      : states_oil_(machine.hydraulics.has_value()) {
    if (machine.engine) per_power_ = 1.0 / (fraction * machine.engine->power);
    for (int i = 0; i < 3; ++i) {
      const auto joint = static_cast<std::size_t>(i);
      acceleration_[i] = fraction * machine.limits[joint].acceleration;
      per_rate_[i] = 1.0 / (fraction * machine.limits[joint].speed);
      if (!states_oil_) continue;
      const Piston& piston = machine.hydraulics->pistons[joint];
      const double share =
          (*machine.cylinders)[joint].count() / (fraction * machine.hydraulics->pump_flow);
      per_piston_speed_[i] = 1.0 / (fraction * piston.speed);
      per_growth_[i] = share * piston.area_filled(1.0);
      per_shrinking_[i] = share * piston.area_filled(-1.0);
    }
  }

  const JointAngles& acceleration() const { return acceleration_; }
  /// One over the highest power [1/W]; 0: it sets no limit.
  double per_power() const { return per_power_; }

  /// Largest ratio of these joint rates to their limits of speed.
  double load(const JointAngles& rates) const {
    return rates.cwiseAbs().cwiseProduct(per_rate_).maxCoeff();
  }

  /// The same of the power for joints that turn this fast under these torques, if the pressures
  /// are not known.
  double power_load(const JointAngles& torque, const JointAngles& rates) const {
    if (states_oil_) return 0.0;
    return per_power_ * torque.cwiseProduct(rates).cwiseMax(0.0).sum();
  }

  /// The highest pressure in the cylinders that drive, over the one at which the power is enough
  /// for the whole flow; 0 if either is not known.
  double pressure(const JointAngles& torque, const JointAngles& slope,
                  const Eigen::Vector3d& levers) const {
    if (!states_oil_) return 0.0;
    double highest = 0.0;
    for (int i = 0; i < 3; ++i) {
      if (!(torque[i] * slope[i] > 0.0) || std::abs(slope[i]) < at_rest) continue;
      const double flow = levers[i] * slope[i] < 0.0 ? per_shrinking_[i] : per_growth_[i];
      highest = std::max(highest, std::abs(torque[i] / levers[i]) / flow);
    }
    return highest * per_power_;
  }

  /// The same of the pump flow alone, for cylinders that grow this fast; 0 if it is not known.
  double flow_load(const Eigen::Vector3d& growth) const {
    double flow = 0.0;
    for (int i = 0; i < 3; ++i) {
      flow += std::abs(growth[i]) * (growth[i] < 0.0 ? per_shrinking_[i] : per_growth_[i]);
    }
    return flow;
  }

  /// The same of cylinder speed and pump flow for cylinders that grow this fast at this pressure();
  /// 0 if neither is known.
  double cylinder_load(const Eigen::Vector3d& growth, double pressure) const {
    if (!states_oil_) return 0.0;
    const double fastest = growth.cwiseAbs().cwiseProduct(per_piston_speed_).maxCoeff();
    return std::max(fastest, flow_load(growth) * std::max(1.0, pressure));
  }

 private:
  /// A joint with a smaller share of the motion moves by rounding.
  static constexpr double at_rest = 1e-9;
  bool states_oil_;
  double per_power_ = 0.0;
  JointAngles acceleration_;
  JointAngles per_rate_;
  Eigen::Vector3d per_piston_speed_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d per_growth_ = Eigen::Vector3d::Zero();  // of the flow
  Eigen::Vector3d per_shrinking_ = Eigen::Vector3d::Zero();
};

}  // namespace excavplan
