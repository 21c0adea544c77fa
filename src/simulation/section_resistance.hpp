// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/bucket_cavity.hpp>
#include <excavplan/soil/soil.hpp>

#include "simulation/section_bucket.hpp"
#include "simulation/soil_section.hpp"
#include "simulation/soil_wedges.hpp"

namespace excavplan {

/// Data of SectionSimulator that do not depend on the ground.
struct SectionModel {
  SectionModel(Machine machine, SoilKind kind, double density_percent);

  Machine machine;
  SoilKind kind;
  double density_percent;
  SoilState bank;
  SoilState loose;
  HoldingSlopes slopes;
  SoilWedges wedges;
  PackedFront packed;
};

/// The soil's forces on the bucket, (x, z): in the face, at the tip and under the heel [N].
struct SectionResistance {
  Eigen::Vector2d face = Eigen::Vector2d::Zero();
  Eigen::Vector2d face_at = Eigen::Vector2d::Zero();
  Eigen::Vector2d tip = Eigen::Vector2d::Zero();
  Eigen::Vector2d tip_at = Eigen::Vector2d::Zero();
  Eigen::Vector2d edge = Eigen::Vector2d::Zero();  ///< part of `tip` that is of lip and teeth
  Eigen::Vector2d heel = Eigen::Vector2d::Zero();
  Eigen::Vector2d heel_at = Eigen::Vector2d::Zero();
  double wedge_length = 0.0;  ///< of the top of the wedge that is pushed, ahead of the lip [m]
  double on_floor = 0.0;      ///< volume of payload whose weight is in the force already [m^3]

  Eigen::Vector2d total() const { return face + tip + heel; }
};

/// One attitude of the bucket in the ground, half-way of a step.
struct Cutting {
  BucketPose tip;
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();  ///< unit vector
  GroundAhead ground;
  SoilState bank;
  SoilState loose;        ///< of the layer on it
  double pile = 0.0;      ///< height of its level top [m]
  double contents = 0.0;  ///< of the bucket, loose [m^3]
};

/// Resistance of the soil to the bucket of SectionSimulator, which is turned to its attitude
/// (docs/methods.md#simulation).
SectionResistance section_resistance(const SectionModel& model, const SoilSection& section,
                                     const Cutting& cut, BucketSection& bucket, DigPhase phase);

}  // namespace excavplan
