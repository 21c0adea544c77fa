// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Core>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

#include "earth/ground_window.hpp"

/// @file
/// Checks and bookkeeping that the simulators share. How soil is cut, held and heaped, and how it
/// resists, is each simulator's own: they check each other.

namespace excavplan {

/// @throws Error (bad_input) if the map is empty, its cell size is not positive, a layer has
///         another size than the map, or the path has fewer than 2 poses or one that is not finite
void check_dig(const Terrain& terrain, const DigPath& path);

/// SoilSimulator::identity() of a simulator that depends on nothing else.
std::string simulator_identity(const std::string& name, const Machine& machine,
                               const SoilKind& soil, double density_percent);

/// One step of a dig and the torque that it takes, by cause.
struct DigStep {
  DigPhase phase = DigPhase::penetrate;
  double length = 0.0;                           ///< tip travel [m]
  JointAngles joints = JointAngles::Zero();      ///< half-way [rad]
  JointAngles turn = JointAngles::Zero();        ///< [rad]
  JointAngles by_soil = JointAngles::Zero();     ///< [N m]
  JointAngles by_edge = JointAngles::Zero();     ///< of by_soil: lip and teeth [N m]
  JointAngles by_payload = JointAngles::Zero();  ///< [N m]
  JointAngles by_links = JointAngles::Zero();    ///< [N m]
  /// Of soil and payload on the bucket (x, z) [N].
  Eigen::Vector2d force = Eigen::Vector2d::Zero();

  JointAngles torque() const { return by_soil + by_payload + by_links; }
};

/// Collects the result of one dig: forces, energy and stall step by step, at the end the payload
/// and the balance of solids.
class DigAccount {
 public:
  DigAccount(const Machine& machine, const DigPath& path, const DigOptions& options);

  /// Force of the soil on the bucket and loose volume in it, half-way of a step.
  void note_force(const DigStep& step, const Eigen::Vector2d& force, double fill);

  /// Notes a stall if a joint that drives lacks torque (one that only holds back may take more), or
  /// if the step would lift or drag the machine.
  bool stalls(const DigStep& step);

  /// Adds the work of a step to the energy; where a joint stalls, that of the joints before it.
  /// Notes the torques of a step that the machine makes.
  void book(const DigStep& step);

  /// The tip has moved on.
  void travel(double length) { travelled_ += length; }

  /// Enters the payload, pours it where the options say, and weighs the ground. The ground is at
  /// rest and the volumes of the soil ledger are complete.
  ///
  /// @param fill of the bucket, loose [m^3]
  /// @param repose slope of the heap, as a tangent
  void close(GroundWindow& ground, double fill, double repose);

  DigResult result;

 private:
  const Machine& machine_;
  const DigPath& path_;
  const DigOptions& options_;
  double travelled_ = 0.0;
};

}  // namespace excavplan
