// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/dig_survey.hpp"

#include <cmath>
#include <optional>

#include <Eigen/Geometry>

namespace excavplan::test {

const DensityLaw& paper_law() {
  static const DensityLaw paper = load_density_law(find_data_file("laws/paper.json"));
  return paper;
}

Answer answer_to(const DigScans& scans) {
  DensityOptions options;
  options.threads = 1;
  try {
    return {estimate_density(scans, paper_law(), options), ""};
  } catch (const Error& error) {
    return {std::nullopt, error.what()};
  }
}

bool is_trusted_and_wrong(const Answer& answer, const scenes::Dig& dig) {
  if (!answer.trusted()) return false;
  const Measured& k = *answer.estimate->bulking;
  const Measured& hole = answer.estimate->change.excavated;
  return std::abs(k.value - dig.bulking) > 3.0 * k.sd ||
         std::abs(hole.value - dig.pit_volume()) > 4.0 * hole.sd;
}

Affine turned(double angle, const Eigen::Vector3d& axis) {
  return Affine(Eigen::AngleAxisd(angle, axis.normalized()));
}

Eigen::Vector3d level_axis(Random& random) {
  const double heading = random.uniform(0.0, 2.0 * pi);
  return {std::cos(heading), std::sin(heading), 0.0};
}

Affine camera(double pitch, double height) {
  const Eigen::Vector3d forward(0.0, std::cos(pitch), -std::sin(pitch));
  const Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Affine motion = Affine::Identity();
  motion.linear().row(0) = right.transpose();
  motion.linear().row(1) = forward.cross(right).transpose();
  motion.linear().row(2) = forward.transpose();
  const Eigen::Vector3d eye = Eigen::Vector3d(2.5, 0.0, 0.0) - height / std::sin(pitch) * forward;
  return motion * Eigen::Translation3d(-eye);
}

}  // namespace excavplan::test
