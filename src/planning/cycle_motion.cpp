// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/cycle_motion.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/text.hpp"
#include "ground/map_check.hpp"
#include "ground/obstacles.hpp"
#include "ground/terrain.hpp"
#include "machine/front_check.hpp"
#include "planning/front_load.hpp"
#include "planning/surroundings.hpp"

namespace excavplan {
namespace {

// Ours:
constexpr double deepest = 0.1;            // of the bucket in the ground at the start [m]
constexpr double step = 0.05;              // of the joints from pose to pose [rad]
constexpr double rise = 0.1;               // of the boom, by which it tries to pass higher [rad]
constexpr double tips = pi / 18.0;         // of a full bucket, from which it loses soil [rad]
constexpr double beside = 0.1;             // a place, where what stands is told of it [m]
constexpr double widest_swing = 2.0 * pi;  // from dig to dump [rad]

/// That hold the front on the way between two places: of each joint that which takes more power.
JointAngles heavier(const FrontLoad& load, const FrontJoints& from, const FrontJoints& to) {
  const JointAngles first = load.torque(from.head<3>(), from[3]),
                    last = load.torque(to.head<3>(), to[3]);
  const JointAngles move = to.head<3>() - from.head<3>();
  return ((last - first).array() * move.array() > 0.0).select(last, first);
}

/// The full bucket over its dump.
JointAngles over_dump(const Machine& machine, const JointAngles& clear, double height,
                      const std::optional<double>& radius) {
  JointAngles straight = raised(machine, clear, height);
  if (!radius) return straight;
  const Eigen::Vector2d pin = link_positions(machine, clear).bucket_pin;
  BucketPose bucket = forward_kinematics(machine, clear);
  bucket.x += *radius - pin.x();
  bucket.z += height - pin.y();
  const auto there = inverse_kinematics(machine, bucket);
  const auto* joints = std::get_if<JointAngles>(&there);
  return joints != nullptr ? *joints : straight;
}

FrontJoints with_swing(const JointAngles& joints, double swing) {
  FrontJoints all;
  all << joints, swing;
  return all;
}

/// How the bucket holds soil on a way.
enum class Holding {
  nothing,
  level,    ///< it keeps its attitude
  opening,  ///< it may take that of where it goes
};

/// Adds the parts of a cycle to a way.
class CycleWay {
 public:
  CycleWay(const Machine& machine, const Terrain& ground, double carried)
      : machine_(machine), ground_(ground) {
    hold(carried);
  }

  void start_at(const FrontJoints& joints) { add({DigPhase::approach, joints, {0, 0, 0}}); }

  /// The way of a dig and what is in the bucket after it [kg].
  void add_dig(Way dig, double payload) {
    for (std::size_t i = 1; i < dig.poses.size(); ++i) {
      WayPose& pose = dig.poses[i];
      if (pose.phase != DigPhase::approach) break;
      pose.torque = heavier(*held_, dig.poses[i - 1].joints, pose.joints);
    }
    for (const WayPose& pose : dig.poses) {
      if (pose.phase == DigPhase::lift) hold(payload);
      add(pose);
    }
    hold(payload);
  }

  /// From here on the ground is this one, if any.
  void leaves(const HeightMap& ground) {
    if (ground.z.size() > 0) surroundings().replace(ground);
  }

  /// Over the dump, where the bucket opens.
  std::optional<BlockedWay> dump(const CycleWayOptions& options, double ahead) {
    const JointAngles clear = joints().head<3>();
    const double height = std::max(options.cycle.dump_height, pin_height(machine_, clear));
    const JointAngles full = over_dump(machine_, clear, height, options.dump_radius);
    const double swing = ahead + options.cycle.swing;
    if (auto stop = go(DigPhase::swing, with_swing(full, swing), Holding::level)) return stop;
    hold(0.0);
    return go(DigPhase::dump, with_swing(opened(machine_, full), swing), Holding::nothing);
  }

  /// To these joints, straight or above what is in the way. @return what blocks every such way
  std::optional<BlockedWay> go(DigPhase phase, const FrontJoints& to, Holding holding) {
    const FrontJoints from = joints();
    const bool loaded = holding != Holding::nothing;
    const Clearance first = surroundings().standing(from);
    if (first.height < -deepest) return blocked(phase, first, "where the way begins");
    if (const auto tail = surroundings().tail_obstacle(from, to)) {
      return blocked(phase, *tail, "with its tail");
    }
    const bool dumps = phase == DigPhase::swing || phase == DigPhase::dump;
    const Clearance last = surroundings().standing(to);
    if (dumps && last.height < 0.0) return blocked(phase, last, "where it dumps");
    const auto straight = surroundings().obstacle(from, to);
    if (!straight) {
      add(phase, {to}, holding);
      return std::nullopt;
    }
    for (double up = rise;; up += rise) {
      const FrontJoints over_from = lifted(from, up, loaded), over_to = lifted(to, up, loaded);
      if (!surroundings().obstacle(over_from, over_to) &&
          !surroundings().obstacle_leaving(from, over_from) &&
          !surroundings().obstacle_leaving(to, over_to)) {
        add(phase, {over_from, over_to, to}, holding);
        return std::nullopt;
      }
      const double lowest = machine_.limits[0].lower;
      if (over_from[0] <= lowest && over_to[0] <= lowest) break;
    }
    return blocked(phase, *straight, "with the boom raised first too");
  }

  const FrontJoints& joints() const { return way_.poses.back().joints; }
  bool is_empty() const { return !(payload_ > 0.0); }
  /// All so far is the way to the dig.
  void end_approach() {
    for (WayPose& pose : way_.poses) pose.phase = DigPhase::approach;
  }

  Way take() {
    if (unseen_.area > 0.0) {
      way_.warnings.emplace_back(
          WarningCode::unseen_way,
          readable(unseen_.area, 2) +
              " m2 of the ground that the front passes over off the dig were not seen, first "
              "at x = " +
              readable(unseen_.first.x(), 2) + " m, y = " + readable(unseen_.first.y(), 2) +
              " m; it is taken to lie as high as the tracks");
    }
    if (tipped_ > tips) {
      way_.warnings.emplace_back(WarningCode::payload_tips,
                                 "the bucket cannot keep its load level off the dig: it tips by " +
                                     readable(tipped_ * 180.0 / pi, 2) +
                                     " degrees, as its joint ends, and loses soil");
    }
    return std::move(way_);
  }

 private:
  /// With the boom higher; a full bucket keeps its attitude as far as its joint can.
  FrontJoints lifted(FrontJoints joints, double up, bool loaded) const {
    const double boom = std::max(joints[0] - up, std::min(joints[0], machine_.limits[0].lower));
    const double level = joints[2] + joints[0] - boom;
    if (loaded) joints[2] = std::min(level, std::max(joints[2], machine_.limits[2].upper));
    joints[0] = boom;
    return joints;
  }

  void add(DigPhase phase, const std::vector<FrontJoints>& places, Holding holding) {
    const double attitude = joints().head<3>().sum();
    const double last = holding == Holding::opening ? places.back().head<3>().sum() : attitude;
    for (const FrontJoints& to : places) {
      const FrontJoints from = joints();
      surroundings().pass(from, to, unseen_);
      const double now = to.head<3>().sum();
      if (holding != Holding::nothing)
        tipped_ =
            std::max({tipped_, std::min(attitude, last) - now, now - std::max(attitude, last)});
      const double parts = std::ceil((to - from).norm() / step);
      for (double i = 1.0; i <= parts; ++i) {
        const FrontJoints at = from + i / parts * (to - from);
        add({phase, at, heavier(*held_, joints(), at)});
      }
    }
  }

  void add(WayPose pose) {
    pose.payload = payload_;
    way_.poses.push_back(pose);
  }

  void hold(double payload) {
    payload_ = payload;
    held_.emplace(machine_, payload);
  }

  /// Made when it is needed: a way that is the dig alone passes over nothing else.
  Surroundings& surroundings() {
    if (!surroundings_) surroundings_.emplace(machine_, ground_);
    return *surroundings_;
  }

  BlockedWay blocked(DigPhase phase, const Clearance& at, const std::string& when) {
    const bool own = surroundings().on_undercarriage(at.place.x(), at.place.y());
    const bool stands = surroundings().stands_at(at.place.x(), at.place.y());
    const std::string what = own ? "undercarriage" : stands ? "obstacle" : "ground";
    BlockedWay stop;
    stop.phase = phase;
    stop.place = at.place;
    stop.clearance = at.height;
    const double within = beside + ground_.bank.cell_size;
    const auto top = highest_obstacle(ground_, at.place.head<2>(), within);
    const std::string where = " at x = " + readable(at.place.x(), 2) +
                              " m, y = " + readable(at.place.y(), 2) + " m, where it is " +
                              (stands && top ? text(*top) : readable(at.place.z(), 2) + " m high");
    stop.message = std::string(name(phase)) + ": the machine would be " +
                   (at.height < 0.0 ? readable(-at.height, 2) + " m in the " + what
                                    : "only " + readable(at.height, 2) + " m above the " + what) +
                   where + ", " + when;
    return stop;
  }

  const Machine& machine_;
  const Terrain& ground_;
  std::optional<Surroundings> surroundings_;
  UnseenGround unseen_;
  double tipped_ = 0.0;  ///< most of a bucket with soil [rad]
  double payload_ = 0.0;
  std::optional<FrontLoad> held_;
  Way way_;
};

/// Whole turns of a machine that turns round and round, to the plane of the dig nearest to where it
/// stands [rad].
double turns_to(const Machine& machine, const CycleWayOptions& options) {
  if (!options.start || !machine.swing || !machine.swing->turns_round()) return 0.0;
  return 2.0 * pi * std::round((*options.start)[3] / (2.0 * pi));
}

/// The swing follows a path beside the swing axis, out to whose places the front reaches.
Way in_lane(const Machine& machine, Way dig, double lane, double ahead) {
  for (WayPose& pose : dig.poses) {
    const double reach = forward_kinematics(machine, pose.joints.head<3>()).x;
    pose.joints[3] = ahead + std::asin(std::clamp(lane / reach, -1.0, 1.0));
  }
  return dig;
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
  if (options.dump_radius) require_in("cycle: dump radius [m]", *options.dump_radius, 0.0, 100.0);
  require_in("cycle: lane [m]", options.lane, -100.0, 100.0);
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
  require_in("mass carried before the dig [kg]", load.carried, 0.0, 1e9);
  if (load.ground_after.z.size() > 0) require_grid(load.ground_after, "ground after the dig");
  const double ahead = turns_to(machine, options);
  const Way dig = in_lane(machine, way_of(path, load.torques), options.lane, ahead);
  const FrontJoints& begin = dig.poses.front().joints;
  CycleWay way(machine, ground, load.carried);
  if (options.start) {
    way.start_at(*options.start);
    if (options.dumps_first) {
      if (auto stop = way.dump(options, ahead)) return *stop;
    }
    const Holding holding = way.is_empty() ? Holding::nothing : Holding::opening;
    if (auto stop = way.go(DigPhase::approach, begin, holding)) return *stop;
    way.end_approach();
  }
  way.add_dig(dig, load.payload_mass);
  if (options.whole_cycle) {
    way.leaves(load.ground_after);
    if (!options.cycle.keeps_load) {
      if (auto stop = way.dump(options, ahead)) return *stop;
    }
    const Holding holding = way.is_empty() ? Holding::nothing : Holding::opening;
    if (auto stop = way.go(DigPhase::back, begin, holding)) return *stop;
  }
  return way.take();
}

std::variant<Way, BlockedWay> way_of_dump(const Machine& machine, const Terrain& ground,
                                          double payload, const CycleWayOptions& options) {
  require_machine(machine);
  require_terrain(ground, "ground of the motion");
  check(machine, options);
  require(options.start.has_value(), "a way to the dump needs joints to start from");
  require_in("payload_mass in the bucket [kg]", payload, 0.0, 1e9);
  CycleWay way(machine, ground, payload);
  way.start_at(*options.start);
  if (auto stop = way.dump(options, turns_to(machine, options))) return *stop;
  if (auto stop = way.go(DigPhase::back, *options.start, Holding::nothing)) return *stop;
  return way.take();
}

}  // namespace excavplan
