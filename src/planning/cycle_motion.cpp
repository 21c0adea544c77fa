// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/cycle_motion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "machine/front_check.hpp"
#include "planning/front_load.hpp"
#include "simulation/terrain_check.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Ours:
constexpr double safe = 0.1;        // above the ground, off the dig [m]
constexpr double deepest = 0.1;     // of the bucket in the ground at the start [m]
constexpr double slack = 0.01;      // of the way off and onto the ground [m]
constexpr double under_link = 0.1;  // of a link's body below its line from pin to pin [m]
constexpr double apart = 0.15;      // between the places of the machine that are looked at [m]
constexpr double step = 0.05;       // of the joints, likewise [rad]
constexpr double rise = 0.1;        // of the boom, by which it tries to pass higher [rad]
constexpr double widest_swing = 2.0 * pi;  // from dig to dump [rad]

/// How far the machine is above the ground, and where that is least.
struct Clearance {
  double height = std::numeric_limits<double>::infinity();  ///< [m]
  Vector3d place = Vector3d::Zero();                        ///< of the ground [m]
};

class Surroundings {
 public:
  Surroundings(const Machine& machine, const Terrain& ground)
      : machine_(machine), surface_(ground.surface()) {}

  Clearance at(const FrontJoints& joints) const {
    const LinkPositions links = link_positions(machine_, joints.head<3>());
    const Vector2d ahead(std::cos(joints[3]), std::sin(joints[3]));
    Clearance least;
    look(machine_.boom_pin, links.arm_pin, under_link, ahead, least);
    look(links.arm_pin, links.bucket_pin, under_link, ahead, least);
    const std::vector<Vector2d>& profile = machine_.bucket.profile;
    for (std::size_t i = 0; i < profile.size(); ++i) {
      const Vector2d from = bucket_point(links, profile[i]);
      const Vector2d to = bucket_point(links, profile[(i + 1) % profile.size()]);
      look(from, to, 0.0, ahead, least);
    }
    return least;
  }

 private:
  /// Along a line of the boom plane and beside it, within the width of the bucket.
  void look(const Vector2d& from, const Vector2d& to, double below, const Vector2d& ahead,
            Clearance& least) const {
    const double parts = std::max(1.0, std::ceil((to - from).norm() / apart));
    for (double i = 0.0; i <= parts; ++i) {
      const Vector2d at = from + i / parts * (to - from);
      for (const double side : {-0.5, 0.0, 0.5}) {
        const double aside = side * machine_.bucket.width_outside;
        const Vector2d place = at.x() * ahead + aside * Vector2d(-ahead.y(), ahead.x());
        const double ground = height_at(place);
        if (at.y() - below - ground >= least.height) continue;
        least = {at.y() - below - ground, {place.x(), place.y(), ground}};
      }
    }
  }

  double height_at(const Vector2d& place) const {
    const Vector2d cell = ((place - surface_.origin) / surface_.cell_size).array().floor();
    const bool inside = cell.x() >= 0.0 && cell.x() < static_cast<double>(surface_.z.cols()) &&
                        cell.y() >= 0.0 && cell.y() < static_cast<double>(surface_.z.rows());
    if (!inside) return 0.0;
    const double z =
        surface_.z(static_cast<Eigen::Index>(cell.y()), static_cast<Eigen::Index>(cell.x()));
    return std::isfinite(z) ? z : 0.0;
  }

  const Machine& machine_;
  HeightMap surface_;
};

/// That hold the front on the way between two places: of each joint that which takes more power.
JointAngles heavier(const FrontLoad& load, const FrontJoints& from, const FrontJoints& to) {
  const JointAngles first = load.torque(from.head<3>()), last = load.torque(to.head<3>());
  const JointAngles move = to.head<3>() - from.head<3>();
  return ((last - first).array() * move.array() > 0.0).select(last, first);
}

/// Adds the parts of a cycle to a way.
class CycleWay {
 public:
  CycleWay(const Machine& machine, const Terrain& ground, double payload)
      : machine_(machine),
        surroundings_(machine, ground),
        empty_(machine),
        loaded_(machine, payload) {}

  void start_at(const FrontJoints& joints) {
    way_.poses.push_back({DigPhase::approach, joints, JointAngles::Zero()});
  }

  /// The way of a dig.
  void add_dig(Way dig) {
    for (std::size_t i = 1; i < dig.poses.size(); ++i) {
      WayPose& pose = dig.poses[i];
      if (pose.phase != DigPhase::approach) break;
      pose.torque = heavier(empty_, dig.poses[i - 1].joints, pose.joints);
    }
    way_.poses.insert(way_.poses.end(), dig.poses.begin(), dig.poses.end());
  }

  /// To these joints, straight or above what is in the way. @return what blocks every such way
  std::optional<BlockedWay> go(DigPhase phase, const FrontJoints& to, bool loaded) {
    const FrontJoints from = way_.poses.back().joints;
    const Clearance first = surroundings_.at(from), last = surroundings_.at(to);
    if (first.height < -deepest) return blocked(phase, first, "where the way begins");
    const bool dumps = phase == DigPhase::swing || phase == DigPhase::dump;
    if (dumps && last.height < 0.0) return blocked(phase, last, "where it dumps");
    const auto straight = obstacle(from, to, safe);
    if (!straight) {
      add(phase, {to}, loaded);
      return std::nullopt;
    }
    for (double up = rise;; up += rise) {
      const FrontJoints over_from = lifted(from, up), over_to = lifted(to, up);
      if (!obstacle(from, over_from, std::min(safe, first.height) - slack) &&
          !obstacle(over_from, over_to, safe) &&
          !obstacle(over_to, to, std::min(safe, last.height) - slack)) {
        add(phase, {over_from, over_to, to}, loaded);
        return std::nullopt;
      }
      const double lowest = machine_.limits[0].lower;
      if (over_from[0] <= lowest && over_to[0] <= lowest) break;
    }
    return blocked(phase, *straight, "with the boom raised first too");
  }

  const FrontJoints& joints() const { return way_.poses.back().joints; }

  Way take(double payload) {
    for (WayPose& pose : way_.poses) {
      const bool full = pose.phase == DigPhase::lift || pose.phase == DigPhase::swing;
      pose.payload = full ? payload : 0.0;
    }
    return std::move(way_);
  }

 private:
  FrontJoints lifted(FrontJoints joints, double up) const {
    joints[0] = std::max(joints[0] - up, std::min(joints[0], machine_.limits[0].lower));
    return joints;
  }

  /// Where the machine comes nearer to the ground than this on a straight way.
  std::optional<Clearance> obstacle(const FrontJoints& from, const FrontJoints& to,
                                    double least) const {
    const double parts = std::max(1.0, std::ceil((to - from).norm() / step));
    for (double i = 0.0; i <= parts; ++i) {
      const Clearance there = surroundings_.at(from + i / parts * (to - from));
      if (there.height < least) return there;
    }
    return std::nullopt;
  }

  void add(DigPhase phase, const std::vector<FrontJoints>& places, bool loaded) {
    const FrontLoad& load = loaded ? loaded_ : empty_;
    for (const FrontJoints& to : places) {
      const FrontJoints from = joints();
      const double parts = std::ceil((to - from).norm() / step);
      for (double i = 1.0; i <= parts; ++i) {
        const FrontJoints at = from + i / parts * (to - from);
        way_.poses.push_back({phase, at, heavier(load, joints(), at)});
      }
    }
  }

  static BlockedWay blocked(DigPhase phase, const Clearance& at, const std::string& when) {
    BlockedWay stop;
    stop.phase = phase;
    stop.place = at.place;
    stop.clearance = at.height;
    const std::string where = " at x = " + readable(at.place.x(), 2) +
                              " m, y = " + readable(at.place.y(), 2) + " m, where it is " +
                              readable(at.place.z(), 2) + " m high";
    stop.message = std::string(name(phase)) + ": the machine would be " +
                   (at.height < 0.0 ? readable(-at.height, 2) + " m in the ground"
                                    : "only " + readable(at.height, 2) + " m above the ground") +
                   where + ", " + when;
    return stop;
  }

  const Machine& machine_;
  Surroundings surroundings_;
  FrontLoad empty_, loaded_;
  Way way_;
};

/// Whole turns of a machine that turns round and round, to the plane of the dig nearest to where it
/// stands [rad].
double turns_to(const Machine& machine, const CycleWayOptions& options) {
  if (!options.start || !machine.swing || !machine.swing->turns_round()) return 0.0;
  return 2.0 * pi * std::round((*options.start)[3] / (2.0 * pi));
}

FrontJoints with_swing(const JointAngles& joints, double swing) {
  FrontJoints all;
  all << joints, swing;
  return all;
}

}  // namespace

void check(const Machine& machine, const CycleWayOptions& options) {
  if (options.start) check_joints(machine, *options.start, "joints at the start");
  if (options.whole_cycle) {
    const Swing swing = machine.swing.value_or(Swing{});
    require_in("cycle: swing [rad]", options.cycle.swing, std::max(-widest_swing, swing.lower),
               std::min(widest_swing, swing.upper));
    require_in("cycle: dump_height [m]", options.cycle.dump_height, 0.0, 1e9);
  }
  const bool swings = options.whole_cycle || (options.start && (*options.start)[3] != 0.0);
  require(!swings || machine.swing.has_value(),
          "the file of machine " + machine.name + " has no swing, which the way needs");
}

std::variant<Way, BlockedWay> way_of_cycle(const Machine& machine, const Terrain& ground,
                                           const DigPath& path, const DigLoad& load,
                                           const CycleWayOptions& options) {
  require_machine(machine);
  require_terrain(ground, "ground of the motion");
  check(machine, options);
  require_in("payload_mass of the dig [kg]", load.payload_mass, 0.0, 1e9);
  Way dig = way_of(path, load.torques);
  const double ahead = turns_to(machine, options);
  for (WayPose& pose : dig.poses) pose.joints[3] = ahead;
  CycleWay way(machine, ground, load.payload_mass);
  if (options.start) {
    way.start_at(*options.start);
    if (auto stop = way.go(DigPhase::approach, dig.poses.front().joints, false)) return *stop;
  }
  way.add_dig(dig);
  if (options.whole_cycle) {
    const JointAngles clear = way.joints().head<3>();
    const double height = std::max(options.cycle.dump_height, pin_height(machine, clear));
    const JointAngles full = raised(machine, clear, height), open = opened(machine, full);
    const double swing = ahead + options.cycle.swing;
    if (auto stop = way.go(DigPhase::swing, with_swing(full, swing), true)) return *stop;
    if (auto stop = way.go(DigPhase::dump, with_swing(open, swing), false)) return *stop;
    if (auto stop = way.go(DigPhase::back, dig.poses.front().joints, false)) return *stop;
  }
  return way.take(load.payload_mass);
}

}  // namespace excavplan
