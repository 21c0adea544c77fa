// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/bucket_cavity.hpp>
#include <excavplan/soil/soil.hpp>

#include "earth/ground_window.hpp"
#include "simulation/bucket_cavity.hpp"
#include "simulation/resistance.hpp"
#include "simulation/soil_wedges.hpp"
#include "simulation/swath.hpp"
#include "simulation/wedge_strips.hpp"
#include "soil/cut_soil.hpp"

namespace excavplan {

/// Data of HeightMapSimulator that do not depend on the ground.
struct HeightMapModel {
  HeightMapModel(Machine machine, SoilKind soil, double density_percent);

  Machine machine;
  SoilKind soil;
  double density_percent;
  LayerSoil bank;
  LayerSoil loose;
  HoldingSlopes slopes;
  SoilWedges wedges;
};

/// The forces of the ground on the bucket at one stretch of a path (docs/methods.md#simulation).
class BucketResistance {
 public:
  BucketResistance(const HeightMapModel& model, const GroundWindow& ground, const Swath& swath,
                   const DigPath& path)
      : model_(model),
        ground_(ground),
        swath_(swath),
        path_(path),
        tilt_(std::atan2(model.machine.up().x(), model.machine.up().y())),
        first_col_(ground.cells().col_begin),
        columns_(static_cast<std::size_t>(ground.cells().cols())),
        strips_(static_cast<std::size_t>(swath.rows())) {}

  /// `cavity` is turned as the bucket stands, half-way of the stretch, and holds `fill` [m^3].
  Resistance at(const Stretch& stretch, const Cavity& cavity, double fill);

  /// Length of the bucket's floor [m].
  double floor_length() const;
  /// Top of the bank in a column, and of what lay on it, mean over the width, before the dig [m].
  double bank_at(Eigen::Index col) { return column(col).bank; }
  double surface_at(Eigen::Index col) { return column(col).surface; }

 private:
  struct Place;
  struct Fill;
  struct SlidingFace;
  struct FaceForce;
  /// Top of the bank in a column, and of what lay on it, mean over the width, before the dig [m].
  struct Column {
    bool seen = false;
    double bank = 0.0;
    double surface = 0.0;
  };
  const Column& column(Eigen::Index col);
  Column look_at(Eigen::Index col) const;
  /// Of the wedge's side planes, as parts of the resultant on the face [N].
  struct SideForces {
    double bank = 0.0;
    double loose = 0.0;
  };

  Fill fill_in(const Cavity& cavity, double volume) const;
  Resistance drive_in(const Place& place);
  Resistance push_wedge(const Place& place, const Fill& fill);
  FaceTerms terms_of(const RestingSoil& soil, const SlidingFace& face, double slope) const;
  LayerTerms terms_in(Eigen::Index row, const SlidingFace& face, const Place& place) const;
  FaceForce slide(const SlidingFace& face, const Place& place, const Fill& fill);
  void push_strips(const SlidingFace& face, const Place& place, const LayerTerms& mean, double rise,
                   FaceForce& force);
  void press_heel(const Stretch& stretch, const Cavity& cavity, Resistance& resistance);
  double swept_to(double x, std::size_t& pose) const;
  double surface_between(double x);

  StripColumn column_at(const Place& place) const;
  double pile_at(const Place& place);
  void add_piles(const Place& place);
  static SideForces side_forces(const FaceForce& mean, const LayerTerms& layers);
  CutSoil soil_above(Eigen::Index col, double z);
  LayerSoil mean_bank(Eigen::Index col) const;
  LayerSoil mean_loose(Eigen::Index col) const;
  double surface_slope(Eigen::Index col, double depth);
  double penetrating_area(double driven, double depth, const LayerSoil& soil) const;
  double driving_force(const CutSoil& cut, double driven) const;
  double edge_force(const CutSoil& cut, double climb) const;
  double side_plate_area(double depth, double floor) const;

  const HeightMapModel& model_;
  const GroundWindow& ground_;
  const Swath& swath_;
  const DigPath& path_;
  double tilt_;  ///< of gravity against the machine, in the boom plane [rad]
  Eigen::Index first_col_;
  std::vector<Column> columns_;  ///< from first_col_ on
  Column beyond_;                ///< one that is not among them
  WedgeStrips strips_;           ///< of the rows of the swath, at the stretch
};

}  // namespace excavplan
