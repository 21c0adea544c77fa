// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/kit/workspace.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <excavplan/machine/kinematics.hpp>

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "base/text.hpp"
#include "machine/data_sheet_keys.hpp"
#include "machine/machine_mass.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr double gravity = 9.80665;  // [m/s^2]
constexpr int steps = 120;

double at(const JointLimits& limits, int step) {
  return limits.lower + (limits.upper - limits.lower) * step / steps;
}

/// That of a range of directions which points up most.
double most_upright(double from, double to) {
  const double up = 0.5 * pi + 2.0 * pi * std::ceil((from - 0.5 * pi) / (2.0 * pi));
  if (up <= to) return up;
  return std::sin(from) > std::sin(to) ? from : to;
}

/// Boom and tip as one arm: the tip turns about the boom pin.
struct Turning {
  double radius;
  double from, to;  ///< directions of the tip [rad]
};

Turning turning(const Machine& machine, double arm, double bucket) {
  const Vector2d tip = machine.boom_length * Vector2d::UnitX() +
                       machine.arm_length * direction(-arm) +
                       machine.bucket_length * direction(-arm - bucket);
  const double ahead = std::atan2(tip.y(), tip.x());
  return {tip.norm(), ahead - machine.limits[0].upper, ahead - machine.limits[0].lower};
}

void extend(Reach& reach, const Machine& machine, const Turning& tip) {
  const double pin = machine.boom_pin.y();
  const auto place = [&](double turned) -> Vector2d {
    return machine.boom_pin + tip.radius * Vector2d(std::cos(turned), std::sin(turned));
  };
  const Vector2d highest = place(most_upright(tip.from, tip.to));
  const Vector2d deepest = place(-most_upright(-tip.to, -tip.from));
  if (highest.y() > reach.height) {
    reach.height = highest.y();
    reach.highest = highest;
  }
  if (-deepest.y() > reach.depth) {
    reach.depth = -deepest.y();
    reach.deepest = deepest;
  }
  if (tip.radius < std::abs(pin)) return;
  const double to_ground = -std::asin(pin / tip.radius);
  const double turned = tip.from + std::fmod(to_ground - tip.from + 4.0 * pi, 2.0 * pi);
  if (turned > tip.to) return;
  reach.ground = std::max(reach.ground, machine.boom_pin.x() + tip.radius * std::cos(to_ground));
}

/// Weights of the links and the sum of their moments about x = 0.
struct Weighed {
  double force = 0.0;
  double moment = 0.0;
};

Weighed links_of(const Machine& machine, const LinkPositions& links) {
  Weighed all;
  for (const LinkMass& link : machine.links) all.force += gravity * link.mass;
  all.moment = all.force * machine.boom_pin.x() - torque_against_link_weight(machine, links)[0];
  return all;
}

double held_in(const Machine& machine, const LinkPositions& links, const Vector2d& force) {
  if (!machine.body) return infinity;
  const Body& body = *machine.body;
  const Weighed front = links_of(machine, links);
  const double weight = gravity * body.mass + front.force;
  const double moment = gravity * body.mass * body.centre.x() + front.moment;
  double held = infinity;
  // Of the force of the soil at 1 N, counter-clockwise about the edges.
  const auto about = [&](double edge) { return cross(links.tip - Vector2d(edge, 0.0), force); };
  if (const double up = about(body.rear_edge); up > 0.0) {
    held = std::min(held, (moment - weight * body.rear_edge) / up);
  }
  if (const double down = -about(body.front_edge); down > 0.0) {
    held = std::min(held, (weight * body.front_edge - moment) / down);
  }
  const double sliding = std::abs(force.x()) + body.track_friction * force.y();
  if (sliding > 0.0) held = std::min(held, body.track_friction * weight / sliding);
  return std::max(held, 0.0);
}

double given_by_joints(const Machine& machine, const LinkPositions& links, const Vector2d& force) {
  const JointAngles per_newton = torque_against_force(machine, links, links.tip, force);
  const JointAngles weight = torque_against_link_weight(machine, links);
  double most = infinity;
  for (int i = 0; i < 3; ++i) {
    const double limit = machine.limits[static_cast<std::size_t>(i)].torque;
    const double own = per_newton[i] > 0.0 ? weight[i] : -weight[i];
    most = std::min(most, (limit - own) / std::abs(per_newton[i]));
  }
  return std::max(most, 0.0);
}

void add_reach(const Machine& machine, const Reach& reach, std::vector<Warning>& warnings) {
  if (reach.depth > 0.0 && reach.ground > machine.track_front) return;
  warnings.emplace_back(
      WarningCode::ground_out_of_reach,
      reach.depth > 0.0 ? "the tip reaches the ground up to x = " + readable(reach.ground) +
                              " m only, the tracks end at " + readable(machine.track_front) + " m"
                        : "the lowest point of the tip is " + readable(-reach.depth) +
                              " m above the ground: do the ranges of the joints fit the lengths?");
}

/// A machine lifts its rear at about half the force of its bucket: ours, of the zx120.
void add_stability(const Machine& machine, const Reach& reach, std::vector<Warning>& warnings) {
  constexpr double least = 0.25;  // of the force of the bucket; ours
  constexpr double place = 0.6;   // of the reach on the ground; ours
  if (!machine.body) {
    warnings.emplace_back(WarningCode::no_body,
                          "the file states no body: nothing lifts or drags the machine");
    return;
  }
  const double x = place * reach.ground;
  for (int step = 0; step <= steps; ++step) {
    const auto joints =
        inverse_kinematics_fixed_bucket(machine, x, 0.0, at(machine.limits[2], step));
    if (!std::holds_alternative<JointAngles>(joints)) continue;
    const LinkPositions links = link_positions(machine, std::get<JointAngles>(joints));
    const double held = held_in(machine, links, -Vector2d::UnitY());
    if (held >= least * bucket_force(machine)) return;
    warnings.emplace_back(WarningCode::force_beyond_stability,
                          "at x = " + readable(x) + " m the machine lifts its rear at " +
                              readable(1e-3 * held) + " kN, its bucket can pull up with " +
                              readable(1e-3 * bucket_force(machine)) +
                              " kN: do mass, edges and torques fit?");
    return;
  }
}

void compare(const char* what, std::optional<double> stated, double computed,
             std::vector<Warning>& warnings) {
  constexpr double most = 0.1;  // ours
  if (!stated || std::abs(computed / *stated - 1.0) <= most) return;
  warnings.emplace_back(WarningCode::data_sheet_differs,
                        std::string("the ") + what + " is " + readable(computed) +
                            " by the numbers of the file, " + readable(*stated) +
                            " by its data sheet");
}

bool is_empty(const DataSheet& sheet) {
  const auto& keys = data_sheet_keys();
  return std::none_of(keys.begin(), keys.end(),
                      [&](const DataSheetKey& each) { return (sheet.*each.figure).has_value(); });
}

void add_sheet(const Machine& machine, const Reach& reach, const DataSheet& sheet,
               std::vector<Warning>& warnings) {
  if (machine.body) compare("mass [kg]", sheet.operating_mass, total_mass(machine), warnings);
  compare("heaped capacity of the bucket [m3]", sheet.bucket_capacity, heaped_capacity(machine),
          warnings);
  compare("digging force of the bucket [N]", sheet.bucket_force, bucket_force(machine), warnings);
  compare("digging force of the arm [N]", sheet.arm_force, arm_force(machine), warnings);
  compare("reach on the ground [m]", sheet.ground_reach, reach.ground, warnings);
  compare("digging depth [m]", sheet.depth, reach.depth, warnings);
  compare("height of the tip [m]", sheet.height, reach.height, warnings);
  compare("dump height [m]", sheet.dump_height, sheet.dump_height ? dump_height(machine) : 0.0,
          warnings);
  compare("width of the bucket [m]", sheet.bucket_width, machine.bucket.width_outside, warnings);
  compare("length of the tracks [m]", sheet.track_length, 2.0 * machine.track_front, warnings);
  if (machine.swing) {
    compare("rate of the swing [rad/s]", sheet.swing_rate, machine.swing->speed, warnings);
  }
}

}  // namespace

Reach reach_of(const Machine& machine) {
  require_machine(machine);
  Reach reach;
  reach.depth = reach.height = -infinity;
  for (int arm = 0; arm <= steps; ++arm) {
    for (int bucket = 0; bucket <= steps; ++bucket) {
      extend(reach, machine,
             turning(machine, at(machine.limits[1], arm), at(machine.limits[2], bucket)));
    }
  }
  return reach;
}

double dump_height(const Machine& machine) {
  require_machine(machine);
  double pin = -infinity;
  for (int boom = 0; boom <= steps; ++boom) {
    for (int arm = 0; arm <= steps; ++arm) {
      const JointAngles joints(at(machine.limits[0], boom), at(machine.limits[1], arm), 0.0);
      pin = std::max(pin, link_positions(machine, joints).bucket_pin.y());
    }
  }
  return pin - machine.bucket_length;
}

std::vector<Vector2d> reach_outline(const Machine& machine) {
  const auto& limits = machine.limits;
  const double straight = std::clamp(0.0, limits[2].lower, limits[2].upper);
  std::vector<Vector2d> outline;
  const auto add = [&](double boom, double arm) {
    outline.push_back(link_positions(machine, {boom, arm, straight}).tip);
  };
  for (int i = 0; i <= steps; ++i) add(at(limits[0], i), limits[1].lower);
  for (int i = 0; i <= steps; ++i) add(limits[0].upper, at(limits[1], i));
  for (int i = steps; i >= 0; --i) add(at(limits[0], i), limits[1].upper);
  for (int i = steps; i >= 0; --i) add(limits[0].lower, at(limits[1], i));
  return outline;
}

DiggingForce digging_force(const Machine& machine, const Vector2d& tip) {
  constexpr double flattest = -10.0 * pi / 180.0, steepest = 60.0 * pi / 180.0;
  DiggingForce best{std::nan(""), std::nan("")};
  for (int step = 0; step <= steps; step += 3) {
    const auto joints =
        inverse_kinematics_fixed_bucket(machine, tip.x(), tip.y(), at(machine.limits[2], step));
    if (!std::holds_alternative<JointAngles>(joints)) continue;
    const auto& angles = std::get<JointAngles>(joints);
    const double floor = forward_kinematics(machine, angles).floor_angle;
    if (floor < flattest || floor > steepest) continue;
    const LinkPositions links = link_positions(machine, angles);
    const DiggingForce here{given_by_joints(machine, links, Vector2d::UnitX()),
                            held_in(machine, links, Vector2d::UnitX())};
    if (!(here.joints <= best.joints)) best = here;
  }
  return best;
}

double bucket_force(const Machine& machine) {
  return machine.limits[2].torque / machine.bucket_length;
}

double arm_force(const Machine& machine) {
  return machine.limits[1].torque / (machine.arm_length + machine.bucket_length);
}

std::vector<Warning> check_data_sheet(const Machine& machine, const DataSheet& sheet) {
  std::vector<Warning> warnings;
  if (!is_empty(sheet)) add_sheet(machine, reach_of(machine), sheet, warnings);
  return warnings;
}

std::vector<Warning> check_machine(const Machine& machine, const DataSheet& sheet) {
  const Reach reach = reach_of(machine);
  std::vector<Warning> warnings;
  add_reach(machine, reach, warnings);
  add_stability(machine, reach, warnings);
  if (!machine.swing || !machine.engine) {
    warnings.emplace_back(WarningCode::no_cycle,
                          "the file states no swing or no engine: energy and time of the "
                          "cycle are unknown, and only the goal energy can be planned");
  }
  add_sheet(machine, reach, sheet, warnings);
  return warnings;
}

}  // namespace excavplan
