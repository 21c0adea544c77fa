// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/dig_path.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include <excavplan/base/error.hpp>
#include <excavplan/machine/dig_trials.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using Reason = Infeasible::Reason;

constexpr int most_poses = 10000;      // a phase
constexpr int scan_poses = 12;         // a phase, while start points are compared
constexpr double scan_lift = 0.1;      // tip travel between poses of a lift, likewise [m]
constexpr int scan_per_metre = 20;     // start points
constexpr double scan_tie = 1e-9;      // margins closer than this count as equal [rad]
constexpr double fall_over = 0.25;     // to both sides, where the fall of a floor is told; ours [m]
constexpr int bisections = 40;         // of a step of the penetration, to the floor
constexpr double same_posture = 1e-6;  // joints closer than this [rad]
constexpr int ground_intervals = 16;   // where the ground is looked up under the bucket

// ---- messages -----------------------------------------------------------------------------------

std::string metres(double value) { return decimals(value, 3) + " m"; }
std::string degrees(double value) { return decimals(value * 180.0 / pi, 2) + " deg"; }

std::string explain_reach(const Infeasible& stop) {
  const std::string what =
      stop.phase == DigPhase::drag ? "the tip, its bucket angle held," : "the bucket pin";
  return what + " would be " + metres(stop.value) + " from the boom pin, it must be at " +
         (stop.value > stop.limit ? "most " : "least ") + metres(stop.limit);
}

std::string explain_cause(const Infeasible& stop) {
  switch (stop.reason) {
    case Reason::out_of_reach:
      return explain_reach(stop);
    case Reason::joint_limit:
      return std::string("the ") + name(stop.joint) + " would be at " + degrees(stop.value) +
             ", its limit is " + degrees(stop.limit);
    case Reason::heel_contact:
      return "the bucket floor is at " + degrees(stop.value) +
             " to the cut, its heel needs at least " + degrees(stop.limit);
    case Reason::too_deep:
      return "the tip is " + metres(stop.value) + " below the ground at the start, it may go " +
             metres(stop.limit);
    case Reason::too_near_tracks:
      return "the tip is at x = " + metres(stop.value) + ", it must stay beyond " +
             metres(stop.limit);
    case Reason::lift_blocked:
      return std::string("the ") + name(stop.joint) + " is at its limit with the bucket " +
             metres(stop.value) + " above the ground, it must get " + metres(stop.limit) + " above";
    case Reason::unknown_ground:
      return "the height of the ground at the start point, x = " + metres(stop.value) +
             ", is not known";
    case Reason::front_contact:  // not told from a profile
    case Reason::bad_parameter:
      break;
  }
  return "a parameter is out of range";
}

std::string explain(const Infeasible& stop) {
  const std::string distance =
      stop.phase == DigPhase::scoop ? degrees(stop.distance) : metres(stop.distance);
  return std::string(name(stop.phase)) + ", after " + distance + ": " + explain_cause(stop);
}

// ---- rules for the input ------------------------------------------------------------------------

void check(const DigPathOptions& options) {
  require(options.step > 0.0 && std::isfinite(options.step), "DigPathOptions::step", options.step,
          "above 0 m and finite");
  require(options.min_heel_clearance >= 0.0 && options.min_heel_clearance < pi / 2.0,
          "DigPathOptions::min_heel_clearance", options.min_heel_clearance, "in 0 .. pi/2 rad");
  require(options.max_depth > 0.0, "DigPathOptions::max_depth", options.max_depth, "above 0 m");
  require(std::isfinite(options.track_margin), "DigPathOptions::track_margin", options.track_margin,
          "finite");
  require(std::abs(options.drag_grade) <= 1.0, "DigPathOptions::drag_grade", options.drag_grade,
          "in -1 .. 1 rad");
  require(!options.drag_follows_floor || options.floor,
          "DigPathOptions::drag_follows_floor needs DigPathOptions::floor");
  require(options.penetration_clearance >= 0.0 && options.penetration_clearance <= 1.0,
          "DigPathOptions::penetration_clearance", options.penetration_clearance, "in 0 .. 1 rad");
  require(options.lift_clearance >= 0.0 && std::isfinite(options.lift_clearance),
          "DigPathOptions::lift_clearance", options.lift_clearance, "at least 0 m and finite");
}

void check(const Machine& machine, const GroundProfile& ground, const DigPathOptions& options) {
  require_machine(machine);
  if (!ground) refuse("dig path: the ground profile is an empty function");
  check(options);
}

Infeasible bad_parameter(DigPhase phase, double value, double limit, const std::string& message) {
  Infeasible stop;
  stop.phase = phase;
  stop.value = value;
  stop.limit = limit;
  stop.message = message;
  return stop;
}

std::optional<Infeasible> find_bad_parameter(const DigParameters& parameters, double start_x) {
  const double angle = parameters.penetration_angle;
  if (!(angle > 0.0 && angle < pi / 2.0)) {
    return bad_parameter(
        DigPhase::penetrate, angle, angle > 0.0 ? pi / 2.0 : 0.0,
        "the penetration angle is " + degrees(angle) + ", must be above 0 and below 90 deg");
  }
  const std::array<std::tuple<DigPhase, const char*, double>, 2> lengths = {{
      {DigPhase::penetrate, "the penetration length is ", parameters.penetration_length},
      {DigPhase::drag, "the drag length is ", parameters.drag_length},
  }};
  for (const auto& [phase, text, length] : lengths) {
    if (length >= 0.0 && std::isfinite(length)) continue;
    return bad_parameter(phase, length, 0.0,
                         text + metres(length) + ", must be at least 0 and finite");
  }
  if (!std::isfinite(start_x)) {
    return bad_parameter(DigPhase::penetrate, start_x, 0.0,
                         "the start point is at x = " + metres(start_x) + ", must be finite");
  }
  return std::nullopt;
}

// ---- the path -----------------------------------------------------------------------------------

/// Which poses are laid out: all; a few in each phase, to compare start points; of these few only
/// the first and last of penetration, drag and scoop. The poses of `ends` are those of `scan` to
/// the bit, so their margin is an upper bound.
enum class Sampling { full, scan, ends };

/// Lays one dig out phase by phase. Every phase adds its poses and returns what stops it, if
/// anything; messages are left to the caller, who may not want them.
class Layout {
 public:
  Layout(const Machine& machine, const DigParameters& parameters, const GroundProfile& ground,
         const DigPathOptions& options, Sampling sampling)
      : machine_(machine),
        ground_(ground),
        options_(options),
        sampling_(sampling),
        beta_(machine.beta()) {
    path_.parameters = parameters;
    path_.drag_grade = options.drag_grade;
  }

  std::optional<Infeasible> lay_out(double start_x) {
    if (auto stopped = dig(start_x)) return stopped;
    return sampling_ == Sampling::ends ? std::nullopt : lift();
  }

  /// All but the lift.
  std::optional<Infeasible> dig(double start_x) {
    begin(start_x);
    if (!std::isfinite(path_.ground_z)) {
      return stop(Reason::unknown_ground, start_x, 0.0, first_phase(), 0.0);
    }
    if (auto stopped = penetrate()) return stopped;
    if (auto stopped = drag()) return stopped;
    return scoop();
  }
  std::optional<Infeasible> lift();

  bool misses_an_end(double start_x);

  std::variant<std::vector<DigPose>, Infeasible> way_up(const DigPath& path);

  const DigPath& path() const { return path_; }
  DigPath take() { return std::move(path_); }

  /// The margin that the choice of the start point maximises [rad].
  double margin() const {
    const double joints = path_.limit_margin.margin;
    if (path_.parameters.drag_length == 0.0) return joints;
    return std::min(joints, path_.heel_clearance - options_.min_heel_clearance);
  }

 private:
  std::optional<Infeasible> penetrate();
  std::optional<Infeasible> drag();
  std::optional<Infeasible> scoop();
  std::optional<Infeasible> raise(DigPose pose);
  std::optional<Infeasible> raise_to_floor(DigPose& pose, double& raised, double turned);

  void begin(double start_x) {
    path_.start_x = start_x;
    path_.ground_z = ground_(start_x);
    path_.poses.clear();
    path_.limit_margin = {std::numeric_limits<double>::infinity(), Joint::boom};
  }

  DigPhase first_phase() const {
    if (path_.parameters.penetration_length > 0.0) return DigPhase::penetrate;
    return path_.parameters.drag_length > 0.0 ? DigPhase::drag : DigPhase::scoop;
  }

  static Infeasible stop(Reason reason, double value, double limit, DigPhase phase,
                         double distance) {
    Infeasible stopped;
    stopped.reason = reason;
    stopped.phase = phase;
    stopped.distance = distance;
    stopped.value = value;
    stopped.limit = limit;
    return stopped;
  }

  static Infeasible stop(DigPhase phase, double distance, const Unreachable& unreachable) {
    const bool by_joint = unreachable.reason == Unreachable::Reason::joint_limit;
    Infeasible stopped = stop(by_joint ? Reason::joint_limit : Reason::out_of_reach,
                              unreachable.value, unreachable.limit, phase, distance);
    stopped.joint = unreachable.joint;
    return stopped;
  }

  std::optional<Infeasible> find_stop(double distance, const DigPose& pose) const;
  std::optional<Infeasible> add(double distance, const DigPose& pose);
  std::optional<Infeasible> solve_penetration(DigPose& pose, const Eigen::Vector2d& onwards,
                                              double s) const;
  double floor_at(double x) const;
  double tip_above_floor(double s) const;
  double length_to_floor(double length) const;
  double missing_height(const LinkPositions& at) const;
  double fall_of_floor(double x) const;
  std::optional<Infeasible> solve_drag(DigPose& pose, const DigPose& start, double s) const;
  std::optional<Infeasible> keep_above_floor(DigPose& pose, const DigPose& start, double s);
  int steps(double tip_travel) const;
  int stride(int count) const { return sampling_ == Sampling::ends ? std::max(1, count) : 1; }
  /// No straight line longer than this stays within reach.
  double longest_line() const { return 2.0 * machine_.full_length(); }
  double height_above_ground(const JointAngles& joints) const;

  const Machine& machine_;
  const GroundProfile& ground_;
  const DigPathOptions& options_;
  Sampling sampling_;
  double beta_;
  double first_z_ = 0.0;  ///< of the tip where the penetration begins [m]
  DigPath path_;
};

int Layout::steps(double tip_travel) const {
  const double needed = std::max(1.0, std::ceil(tip_travel / options_.step));
  if (sampling_ != Sampling::full) return static_cast<int>(std::min<double>(needed, scan_poses));
  require(needed <= most_poses, "DigPathOptions::step", options_.step,
          "so large that no phase has more than 10000 poses");
  return static_cast<int>(needed);
}

std::optional<Infeasible> Layout::find_stop(double distance, const DigPose& pose) const {
  const double depth = path_.ground_z - pose.bucket.z;
  if (depth > options_.max_depth) {
    return stop(Reason::too_deep, depth, options_.max_depth, pose.phase, distance);
  }
  const double foremost = machine_.track_front + options_.track_margin;
  if (pose.bucket.x < foremost) {
    return stop(Reason::too_near_tracks, pose.bucket.x, foremost, pose.phase, distance);
  }
  return std::nullopt;
}

std::optional<Infeasible> Layout::add(double distance, const DigPose& pose) {
  if (auto stopped = find_stop(distance, pose)) return stopped;
  const LimitMargin margin = limit_margin(machine_, pose.joints);
  if (margin.margin < path_.limit_margin.margin) path_.limit_margin = margin;
  path_.poses.push_back(pose);
  return std::nullopt;
}

/// The floor where the bucket has been or will be; -infinity where there is none.
double Layout::floor_at(double x) const {
  constexpr double none = -std::numeric_limits<double>::infinity();
  if (!options_.floor || x > path_.start_x) return none;
  const double floor = options_.floor(x);
  return std::isnan(floor) ? none : floor;
}

/// How far bucket and tip are below the floor, less than 0 if above it.
double Layout::missing_height(const LinkPositions& at) const {
  double missing = floor_at(at.tip.x()) - at.tip.y();
  for (const Eigen::Vector2d& corner : machine_.bucket.profile) {
    const Eigen::Vector2d point = bucket_point(at, corner);
    missing = std::max(missing, floor_at(point.x()) - point.y());
  }
  return missing;
}

/// Of the tip, so far along the line of penetration.
double Layout::tip_above_floor(double s) const {
  const double angle = path_.parameters.penetration_angle;
  return first_z_ - s * std::sin(angle) - floor_at(path_.start_x - s * std::cos(angle));
}

/// The length of penetration at which the tip meets the floor, at most `length`.
double Layout::length_to_floor(double length) const {
  if (!options_.floor) return length;
  double clear = 0.0;
  while (clear < length) {
    const double next = std::min(clear + options_.step, length);
    if (tip_above_floor(next) < 0.0) {
      double low = clear, high = next;
      for (int i = 0; i < bisections; ++i) {
        const double middle = 0.5 * (low + high);
        (tip_above_floor(middle) < 0.0 ? high : low) = middle;
      }
      return low;
    }
    clear = next;
  }
  return length;
}

/// The tip moves down a straight line with the bucket floor along it. An empty line still gives the
/// first pose of the path.
std::optional<Infeasible> Layout::penetrate() {
  const double angle = path_.parameters.penetration_angle;
  first_z_ = std::max(path_.ground_z, floor_at(path_.start_x));
  const double wanted = std::min(path_.parameters.penetration_length, longest_line());
  const double length = length_to_floor(wanted);
  if (length < wanted) {
    path_.parameters.penetration_length = length;
    path_.meets_floor = true;
  }
  const Eigen::Vector2d onwards(-std::cos(angle), -std::sin(angle));
  const int count = length > 0.0 ? steps(length) : 0;
  for (int i = 0; i <= count; i += stride(count)) {
    const double s = count > 0 ? length * i / count : 0.0;
    DigPose pose;
    if (auto stopped = solve_penetration(pose, onwards, s)) return stopped;
    if (auto stopped = add(s, pose)) return stopped;
  }
  return std::nullopt;
}

/// The pose of the penetration so far along its line.
std::optional<Infeasible> Layout::solve_penetration(DigPose& pose, const Eigen::Vector2d& onwards,
                                                    double s) const {
  pose.phase = first_phase();
  pose.bucket = {path_.start_x + s * onwards.x(), first_z_ + s * onwards.y(),
                 path_.parameters.penetration_angle + options_.penetration_clearance};
  const auto joints = inverse_kinematics(machine_, pose.bucket);
  if (const auto* failed = std::get_if<Unreachable>(&joints)) return stop(pose.phase, s, *failed);
  pose.joints = std::get<JointAngles>(joints);
  return std::nullopt;
}

/// Whether dig() stops for the last pose of penetration, drag or scoop: that costs little to find.
/// Without a floor no pose depends on those between.
bool Layout::misses_an_end(double start_x) {
  if (options_.floor) return false;
  begin(start_x);
  if (!std::isfinite(path_.ground_z)) return true;
  first_z_ = path_.ground_z;
  const auto last = [&](double length) { return length * steps(length) / steps(length); };
  const double angle = path_.parameters.penetration_angle;
  const double length = std::min(path_.parameters.penetration_length, longest_line());
  const double down = length > 0.0 ? last(length) : 0.0;
  DigPose pose;
  if (solve_penetration(pose, {-std::cos(angle), -std::sin(angle)}, down)) return true;
  if (find_stop(down, pose)) return true;
  const double dragged = std::min(path_.parameters.drag_length, longest_line());
  if (dragged > 0.0) {
    const DigPose start = pose;
    pose.bucket.x -= last(dragged);
    pose.bucket.z -= last(dragged) * std::tan(options_.drag_grade);
    if (solve_drag(pose, start, dragged) || find_stop(dragged, pose)) return true;
  }
  const double turn = pose.bucket.floor_angle + beta_;
  const int count = steps(turn * machine_.bucket_length);
  return turn * count / count > machine_.limits[2].upper - pose.joints[2];
}

/// Joints and floor angle of a pose of the drag whose tip is given.
std::optional<Infeasible> Layout::solve_drag(DigPose& pose, const DigPose& start, double s) const {
  pose.bucket.floor_angle = start.bucket.floor_angle;
  if (options_.drag_follows_floor)
    pose.bucket.floor_angle += fall_of_floor(pose.bucket.x) - fall_of_floor(start.bucket.x);
  const auto joints = options_.drag_keeps_angle || options_.drag_follows_floor
                          ? inverse_kinematics(machine_, pose.bucket)
                          : inverse_kinematics_fixed_bucket(machine_, pose.bucket.x, pose.bucket.z,
                                                            start.joints[2]);
  if (const auto* failed = std::get_if<Unreachable>(&joints)) return stop(pose.phase, s, *failed);
  pose.joints = std::get<JointAngles>(joints);
  if (!options_.drag_keeps_angle && !options_.drag_follows_floor) {
    pose.bucket.floor_angle += start.joints.sum() - pose.joints.sum();
  }
  return std::nullopt;
}

/// Of the floor around a place of the drag, away from the machine [rad]; 0 where it is not known.
double Layout::fall_of_floor(double x) const {
  const double rise = options_.floor(x + fall_over) - options_.floor(x - fall_over);
  return std::isnan(rise) ? 0.0 : std::atan2(rise, 2.0 * fall_over);
}

/// Brings a pose of the drag onto the floor, or as far over it as the bucket asks for.
std::optional<Infeasible> Layout::keep_above_floor(DigPose& pose, const DigPose& start, double s) {
  const double line = pose.bucket.z;
  const double floor = floor_at(pose.bucket.x);
  const bool follows = options_.drag_follows_floor && std::isfinite(floor);
  pose.bucket.z = follows ? floor : std::max(line, floor);
  if (auto stopped = solve_drag(pose, start, s)) return stopped;
  if (!options_.floor) return std::nullopt;
  const double missing = missing_height(link_positions(machine_, pose.joints));
  path_.meets_floor |= missing > 0.0 || pose.bucket.z > line;
  if (!(missing > 0.0)) return std::nullopt;
  pose.bucket.z += missing;
  return solve_drag(pose, start, s);
}

/// The tip moves along a line or the floor, mostly without a turn of the bucket in the arm; so it
/// turns in the world, and its heel comes down on the ground.
std::optional<Infeasible> Layout::drag() {
  const DigPose start = path_.poses.back();
  const double fall = std::tan(options_.drag_grade);
  path_.heel_clearance = start.bucket.floor_angle;
  const double length = std::min(path_.parameters.drag_length, longest_line());
  const int count = length > 0.0 ? steps(length) : -1;
  DigPose last = start;
  for (int i = 0; i <= count; i += stride(count)) {
    const double s = length * i / count;
    DigPose pose = start;
    pose.phase = DigPhase::drag;
    pose.bucket.x -= s;
    pose.bucket.z -= s * fall;
    if (auto stopped = i == 0 ? solve_drag(pose, start, s) : keep_above_floor(pose, start, s)) {
      return stopped;
    }
    if (i == 0 && (pose.joints - start.joints).norm() > same_posture) {  // arm folded past the tip
      const double nearest =
          std::hypot(pose.bucket.x - machine_.boom_pin.x(), pose.bucket.z - machine_.boom_pin.y());
      return stop(Reason::out_of_reach, nearest, nearest, pose.phase, s);
    }
    const double descent =
        i == 0 ? options_.drag_grade
               : std::atan2(last.bucket.z - pose.bucket.z, last.bucket.x - pose.bucket.x);
    const double clearance = pose.bucket.floor_angle - descent;
    path_.heel_clearance = std::min(path_.heel_clearance, clearance);
    if (clearance < options_.min_heel_clearance) {
      return stop(Reason::heel_contact, clearance, options_.min_heel_clearance, pose.phase, s);
    }
    if (i == 0) continue;  // stored by the penetration
    if (auto stopped = add(s, pose)) return stopped;
    last = pose;
  }
  return std::nullopt;
}

/// The pose with the bucket pin so far above where it is, which the floor asks for.
std::optional<Infeasible> Layout::raise_to_floor(DigPose& pose, double& raised, double turned) {
  const LinkPositions at = link_positions(machine_, pose.joints);
  raised = std::max(raised, missing_height(at));
  if (!(raised > 0.0)) return std::nullopt;
  path_.meets_floor = true;
  pose.bucket.z += raised;
  const auto joints = inverse_kinematics(machine_, pose.bucket);
  if (const auto* failed = std::get_if<Unreachable>(&joints)) {
    return stop(DigPhase::scoop, turned, *failed);
  }
  pose.joints = std::get<JointAngles>(joints);
  return std::nullopt;
}

/// Only the bucket turns, until the line from bucket pin to tip is level; over a floor the pin
/// rises with it.
std::optional<Infeasible> Layout::scoop() {
  const DigPose start = path_.poses.back();
  const LinkPositions at = link_positions(machine_, start.joints);
  const double turn = start.bucket.floor_angle + beta_;
  const double allowed = machine_.limits[2].upper - start.joints[2];
  const int count = steps(turn * machine_.bucket_length);
  double raised = 0.0;
  double deepest = start.bucket.z;
  for (int i = stride(count); i <= count; i += stride(count)) {
    const double turned = std::min(turn * i / count, allowed);
    const double phi3 = start.bucket.floor_angle - turned + beta_ - pi;
    DigPose pose;
    pose.phase = DigPhase::scoop;
    pose.joints = start.joints + JointAngles(0.0, 0.0, turned);
    pose.bucket = {at.bucket_pin.x() + machine_.bucket_length * std::cos(phi3),
                   at.bucket_pin.y() + machine_.bucket_length * std::sin(phi3),
                   start.bucket.floor_angle - turned};
    if (options_.floor) {
      if (auto stopped = raise_to_floor(pose, raised, turned)) return stopped;
      deepest = std::min(deepest, pose.bucket.z);
    }
    if (auto stopped = add(turned, pose)) return stopped;
    if (turn * i / count > allowed) {
      Infeasible stopped = stop(Reason::joint_limit, start.joints[2] + turn,
                                machine_.limits[2].upper, DigPhase::scoop, allowed);
      stopped.joint = Joint::bucket;
      return stopped;
    }
  }
  if (!options_.floor && turn > pi / 2.0) deepest = at.bucket_pin.y() - machine_.bucket_length;
  path_.overcut = start.bucket.z - deepest;
  return std::nullopt;
}

/// Of the lowest corner of the bucket over the highest known ground under it.
double Layout::height_above_ground(const JointAngles& joints) const {
  const LinkPositions at = link_positions(machine_, joints);
  Eigen::Vector2d low = at.tip;
  double right = at.tip.x();
  for (const Eigen::Vector2d& corner : machine_.bucket.profile) {
    const Eigen::Vector2d point = bucket_point(at, corner);
    low = low.cwiseMin(point);
    right = std::max(right, point.x());
  }
  double highest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= ground_intervals; ++i) {
    const double height = ground_(low.x() + (right - low.x()) * i / ground_intervals);
    if (std::isfinite(height)) highest = std::max(highest, height);
  }
  return low.y() - (std::isfinite(highest) ? highest : path_.ground_z);
}

/// The boom rises and the bucket turns back by as much, until it is clear of the ground. Once it is
/// out of the ground the bucket may stay at its limit.
std::optional<Infeasible> Layout::raise(DigPose pose) {
  const double radius =
      (link_positions(machine_, pose.joints).bucket_pin - machine_.boom_pin).norm() +
      machine_.bucket_length;
  const double step =
      sampling_ == Sampling::scan ? std::max(options_.step, scan_lift) : options_.step;
  const double boom_start = pose.joints[0];
  double height = height_above_ground(pose.joints);
  while (height < options_.lift_clearance) {
    const double travelled = (boom_start - pose.joints[0]) * radius;
    require(travelled < most_poses * step, "DigPathOptions::step", options_.step,
            "so large that no phase has more than 10000 poses");
    const double boom = std::max(pose.joints[0] - step / radius, machine_.limits[0].lower);
    const double bucket = pose.joints[2] + pose.joints[0] - boom;
    const bool boom_ends = boom == pose.joints[0];
    const bool bucket_ends = bucket > machine_.limits[2].upper && height <= 0.0;
    if (boom_ends || bucket_ends) {
      Infeasible stopped =
          stop(Reason::lift_blocked, height, options_.lift_clearance, pose.phase, travelled);
      stopped.joint = boom_ends ? Joint::boom : Joint::bucket;
      return stopped;
    }
    pose.joints[0] = boom;
    pose.joints[2] = std::min(bucket, machine_.limits[2].upper);
    pose.bucket = forward_kinematics(machine_, pose.joints);
    if (auto stopped = add((boom_start - boom) * radius, pose)) return stopped;
    height = height_above_ground(pose.joints);
  }
  return std::nullopt;
}

std::optional<Infeasible> Layout::lift() {
  DigPose pose = path_.poses.back();
  pose.phase = DigPhase::lift;
  return raise(pose);
}

/// The way up from the first pose, from there on.
std::variant<std::vector<DigPose>, Infeasible> Layout::way_up(const DigPath& path) {
  path_.ground_z = path.ground_z;
  path_.limit_margin = path.limit_margin;
  DigPose pose = path.poses.front();
  pose.phase = DigPhase::approach;
  if (auto stopped = raise(pose)) return *std::move(stopped);
  return std::move(path_.poses);
}

// ---- the start point ----------------------------------------------------------------------------

/// The start points that are compared.
struct StartPoints {
  int first = 0;
  int last = -1;
  static double at(int i) { return static_cast<double>(i) / scan_per_metre; }
};

struct Candidate {
  double start_x = 0.0;
  double margin = 0.0;
};

/// The middle one of equal candidates.
std::size_t middle_of(const std::vector<std::size_t>& equals) { return equals[equals.size() / 2]; }

/// Where no start point can be driven: the one whose dig gets furthest.
double best_failing(Layout layout, const StartPoints& points) {
  using Progress = std::pair<DigPhase, double>;
  std::vector<std::pair<double, Progress>> failing;
  for (int i = points.first; i <= points.last; ++i) {
    const auto stopped = layout.lay_out(points.at(i));
    if (stopped) failing.push_back({points.at(i), {stopped->phase, stopped->distance}});
  }
  Progress furthest(DigPhase::approach, 0.0);
  for (const auto& entry : failing) furthest = std::max(furthest, entry.second);
  std::vector<std::size_t> equals;
  for (std::size_t i = 0; i < failing.size(); ++i) {
    if (failing[i].second == furthest) equals.push_back(i);
  }
  return equals.empty() ? 0.0 : failing[middle_of(equals)].first;
}

/// Start points that can be driven, the one with the largest margin first. Most are never laid
/// out: their upper bound is below the best margin.
class DrivableStarts {
 public:
  DrivableStarts(Layout ends, Layout scan, const StartPoints& points) : layout_(std::move(scan)) {
    for (int i = points.first; i <= points.last; ++i) {
      if (!ends.lay_out(points.at(i))) promising_.push_back({points.at(i), ends.margin()});
    }
    std::sort(promising_.begin(), promising_.end(),
              [](const Candidate& a, const Candidate& b) { return a.margin < b.margin; });
  }

  /// The middle one of those with the largest margin; empty when all are taken.
  std::optional<double> take() {
    find_widest();
    if (drivable_.empty()) return std::nullopt;
    std::vector<std::size_t> equals;
    for (std::size_t i = 0; i < drivable_.size(); ++i) {
      if (drivable_[i].margin >= widest_ - scan_tie) equals.push_back(i);
    }
    std::sort(equals.begin(), equals.end(), [this](std::size_t a, std::size_t b) {
      return drivable_[a].start_x < drivable_[b].start_x;
    });
    const std::size_t chosen = middle_of(equals);
    const double start_x = drivable_[chosen].start_x;
    drivable_.erase(drivable_.begin() + static_cast<std::ptrdiff_t>(chosen));
    return start_x;
  }

 private:
  void find_widest() {
    widest_ = -std::numeric_limits<double>::infinity();
    for (const Candidate& candidate : drivable_) widest_ = std::max(widest_, candidate.margin);
    while (!promising_.empty() && promising_.back().margin >= widest_ - scan_tie) {
      const double start_x = promising_.back().start_x;
      promising_.pop_back();
      if (layout_.lay_out(start_x)) continue;
      drivable_.push_back({start_x, layout_.margin()});
      widest_ = std::max(widest_, layout_.margin());
    }
  }

  Layout layout_;
  std::vector<Candidate> promising_;  // with upper bounds; the largest last
  std::vector<Candidate> drivable_;
  double widest_ = 0.0;
};

constexpr double replanned_angle = 0.01;  // ours [rad]

}  // namespace

DigPathOptions rules_for_planned_path() {
  constexpr double length = 0.02;  // [m]
  DigPathOptions rules;
  rules.min_heel_clearance -= replanned_angle;
  rules.track_margin -= length;
  rules.max_depth += length;
  rules.lift_clearance -= length;
  return rules;
}

Machine machine_for_planned_path(Machine machine) {
  for (JointLimits& joint : machine.limits) {
    joint.lower -= replanned_angle;
    joint.upper += replanned_angle;
  }
  return machine;
}

const char* name(DigPhase phase) {
  switch (phase) {
    case DigPhase::approach:
      return "approach";
    case DigPhase::penetrate:
      return "penetrate";
    case DigPhase::drag:
      return "drag";
    case DigPhase::scoop:
      return "scoop";
    case DigPhase::lift:
      return "lift";
    case DigPhase::swing:
      return "swing";
    case DigPhase::dump:
      return "dump";
    case DigPhase::back:
      return "back";
  }
  return "unknown phase";
}

std::variant<DigPath, Infeasible> make_dig_path(const Machine& machine,
                                                const DigParameters& parameters, double start_x,
                                                const GroundProfile& ground,
                                                const DigPathOptions& options) {
  check(machine, ground, options);
  if (auto bad = find_bad_parameter(parameters, start_x)) return *std::move(bad);
  Layout layout(machine, parameters, ground, options, Sampling::full);
  if (auto stopped = layout.lay_out(start_x)) {
    stopped->message = explain(*stopped);
    return *std::move(stopped);
  }
  return layout.take();
}

DigTrials::DigTrials(const Machine& machine, const DigParameters& parameters,
                     const GroundProfile& ground, const DigPathOptions& options)
    : machine_(machine), parameters_(parameters), ground_(ground), options_(options) {
  check(machine, ground, options);
}

std::optional<DigPath> DigTrials::from(double start_x, const Judge& judge) const {
  if (find_bad_parameter(parameters_, start_x)) return std::nullopt;
  Layout layout(machine_, parameters_, ground_, options_, Sampling::full);
  if (layout.misses_an_end(start_x) || layout.dig(start_x)) return std::nullopt;
  if (!judge(layout.path()) || layout.lift()) return std::nullopt;
  return layout.take();
}

std::variant<DigPath, Infeasible> make_dig_path_anywhere(const Machine& machine,
                                                         const DigParameters& parameters,
                                                         const GroundProfile& ground,
                                                         const DigPathOptions& options) {
  check(machine, ground, options);
  if (auto bad = find_bad_parameter(parameters, 0.0)) return *std::move(bad);
  const double reach = machine.full_length();
  const double nearest =
      std::max(machine.track_front + options.track_margin, machine.boom_pin.x() - reach);
  const double furthest = machine.boom_pin.x() + reach;
  if (nearest > furthest) return make_dig_path(machine, parameters, furthest, ground, options);

  const StartPoints points{static_cast<int>(std::ceil(nearest * scan_per_metre)),
                           static_cast<int>(std::floor(furthest * scan_per_metre))};
  const Layout scan(machine, parameters, ground, options, Sampling::scan);
  DrivableStarts starts(Layout(machine, parameters, ground, options, Sampling::ends), scan, points);
  Sampling told_by = Sampling::scan;
  while (const std::optional<double> start_x = starts.take()) {
    auto path = make_dig_path(machine, parameters, *start_x, ground, options);
    if (std::holds_alternative<DigPath>(path)) return path;
    told_by = Sampling::full;  // the scan missed what stops this one
  }
  const Layout judge(machine, parameters, ground, options, told_by);
  return make_dig_path(machine, parameters, best_failing(judge, points), ground, options);
}

std::variant<std::vector<DigPose>, Infeasible> way_down(const Machine& machine, const DigPath& path,
                                                        const GroundProfile& ground,
                                                        const DigPathOptions& options) {
  check(machine, ground, options);
  if (path.poses.empty()) refuse("the dig path has no pose to approach");
  constexpr double largest_angle = 100.0;  // as for a trajectory [rad]
  if (!(path.poses.front().joints.array().abs() <= largest_angle).all() ||
      !std::isfinite(path.ground_z)) {
    refuse("the dig path has joints of the first pose or a ground_z that are not finite");
  }
  Layout layout(machine, path.parameters, ground, options, Sampling::full);
  auto outcome = layout.way_up(path);
  if (auto* stopped = std::get_if<Infeasible>(&outcome)) {
    stopped->message = explain(*stopped);
    return std::move(*stopped);
  }
  auto& poses = std::get<std::vector<DigPose>>(outcome);
  std::reverse(poses.begin(), poses.end());
  return std::move(poses);
}

}  // namespace excavplan
