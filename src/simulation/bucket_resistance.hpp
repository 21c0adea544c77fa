// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/bucket_cavity.hpp>
#include <excavplan/soil/soil.hpp>

#include "simulation/bucket_cavity.hpp"
#include "simulation/ground_window.hpp"
#include "simulation/soil_wedges.hpp"
#include "simulation/swath.hpp"
#include "soil/cut_soil.hpp"

namespace excavplan {

/// Data of HeightMapSimulator that do not depend on the ground.
struct HeightMapModel {
  HeightMapModel(Machine machine, SoilKind soil, double density_percent);

  Machine machine;
  SoilKind soil;
  double density_percent;
  SoilState bank;
  SoilState loose;
  HoldingSlopes slopes;
  SoilWedges wedges;
};

/// One stretch of the path: the tip goes from `from` to `to` while the joints turn by `turn`.
struct Stretch {
  DigPhase phase = DigPhase::penetrate;
  std::size_t pose = 0;  ///< where it begins, in the path
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  JointAngles joints;  ///< half-way
  JointAngles turn;
  LinkPositions at;  ///< half-way
  double length = 0.0;

  Eigen::Vector2d direction() const { return (to - from) / length; }
};

/// What the soil does to the bucket: a force in the face, one at the lip, one under the heel [N].
struct Resistance {
  Eigen::Vector2d face_force = Eigen::Vector2d::Zero();
  Eigen::Vector2d face_point = Eigen::Vector2d::Zero();
  Eigen::Vector2d lip_force = Eigen::Vector2d::Zero();
  Eigen::Vector2d heel_force = Eigen::Vector2d::Zero();
  Eigen::Vector2d heel_point = Eigen::Vector2d::Zero();
  double borne_weight = 0.0;  ///< of the soil that the wedge carries; the bucket carries the rest
  double wedge_length = 0.0;  ///< of the top of the wedge that is pushed, ahead of the lip [m]
  double edge = 0.0;          ///< part of lip_force that is of lip and teeth, against the motion

  /// Where the heel stands on loose soil that can be compacted.
  struct Pressed {
    Eigen::Index col;
    double pressure;  ///< [Pa]
  };
  std::vector<Pressed> pressed;

  Eigen::Vector2d total() const { return face_force + lip_force + heel_force; }
};

/// The forces of the ground on the bucket at one stretch of a path (docs/methods.md#simulation).
class BucketResistance {
 public:
  BucketResistance(const HeightMapModel& model, const GroundWindow& ground, const Swath& swath,
                   const DigPath& path)
      : model_(model), ground_(ground), swath_(swath), path_(path) {}

  /// `cavity` is turned as the bucket stands, half-way of the stretch, and holds `fill` [m^3].
  Resistance at(const Stretch& stretch, const Cavity& cavity, double fill) const;

  /// Length of the bucket's floor [m].
  double floor_length() const;
  /// Top of the bank in a column, and of what lay on it, mean over the width, before the dig [m].
  double bank_at(Eigen::Index col) const;
  double surface_at(Eigen::Index col) const;

 private:
  struct Place;
  struct Fill;
  struct SlidingFace;
  struct FaceForce;
  struct FaceTerms;
  struct Layers;
  struct Strip;
  /// Of the wedge's side planes, as parts of the resultant on the face [N].
  struct SideForces {
    double bank = 0.0;
    double loose = 0.0;
  };

  Fill fill_in(const Cavity& cavity, double volume) const;
  Resistance drive_in(const Place& place) const;
  Resistance push_wedge(const Place& place, const Fill& fill) const;
  FaceTerms terms_of(const SoilState& soil, const SlidingFace& face, double slope) const;
  FaceForce slide(const SlidingFace& face, const Place& place, const Fill& fill) const;
  void push_strips(const SlidingFace& face, const Place& place, const Layers& mean, double rise,
                   FaceForce& force) const;
  void press_heel(const Stretch& stretch, const Cavity& cavity, Resistance& resistance) const;
  double swept_to(double x, std::size_t& pose) const;
  double surface_between(double x) const;

  Strip strip_at(Eigen::Index row, const Place& place) const;
  double pile_in(Eigen::Index row, const Place& place) const;
  double pile_at(const Place& place) const;
  double pile_on_wedge(Eigen::Index row, const Place& place, const Strip& strip,
                       const Layers& layers) const;
  double passive_of_bank(const Strip& strip, double pile, const Layers& layers) const;
  double passive_of_loose(const Strip& strip, double pile, const FaceTerms& terms) const;
  static double weight_on_face(const Strip& strip, const Layers& layers);
  static SideForces side_forces(const FaceForce& mean, const Layers& layers);
  double shearing_force(const Strip& strip, double rise, const Layers& layers) const;
  CutSoil soil_above(Eigen::Index col, double z) const;
  SoilState mean_bank(Eigen::Index col) const;
  SoilState mean_loose(Eigen::Index col) const;
  double surface_slope(Eigen::Index col) const;
  double penetrating_area(double driven, double depth, const SoilState& soil) const;
  double driving_force(const CutSoil& cut, double driven) const;
  double edge_force(const CutSoil& cut, double climb) const;
  double side_plate_area(double depth, double floor) const;

  const HeightMapModel& model_;
  const GroundWindow& ground_;
  const Swath& swath_;
  const DigPath& path_;
};

}  // namespace excavplan
