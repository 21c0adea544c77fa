// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/job/job_motion.hpp>

#include <cmath>
#include <utility>

#include <excavplan/simulation/dig_along.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/angles.hpp"
#include "base/plan_geometry.hpp"
#include "base/text.hpp"
#include "job/job_ground.hpp"
#include "job/job_map.hpp"
#include "planning/motion_load.hpp"
#include "simulation/across_tracks.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr double motion_cell = 0.1;  // of the ground that the front passes over; ours [m]

/// The path of a lane in the plane of the front, which reaches out to it.
std::variant<DigPath, BlockedWay> reaching_out(const Machine& machine, DigPath path, double lane) {
  for (std::vector<DigPose>* poses : {&path.approach, &path.poses}) {
    for (DigPose& pose : *poses) {
      pose.bucket.x = std::hypot(pose.bucket.x, lane);
      const auto joints = inverse_kinematics(machine, pose.bucket);
      if (const auto* found = std::get_if<JointAngles>(&joints)) {
        pose.joints = *found;
        continue;
      }
      BlockedWay stop;
      stop.phase = pose.phase;
      stop.place = {pose.bucket.x, 0.0, pose.bucket.z};
      stop.message = std::string(name(pose.phase)) +
                     ": the front does not reach x = " + readable(pose.bucket.x, 3) +
                     " m, z = " + readable(pose.bucket.z, 3) + " m in its lane";
      return stop;
    }
  }
  return path;
}

/// The ground about a machine that has turned, with what stands on it by the design.
Terrain seen_along(const JobSettings& settings, const Terrain& site, const DigLine& line) {
  const Machine& machine = settings.site.machine;
  Terrain view = GroundAlong(site, line, swing_extent(machine), motion_cell).terrain();
  view.obstacles = Eigen::ArrayXXd::Constant(view.bank.z.rows(), view.bank.z.cols(), std::nan(""));
  const PlanFrame frame(line.origin, line.heading);
  for_each_cell(view.bank.z, [&](Cell at) {
    const Vector2d place = frame.place(view.bank.x(at.col), view.bank.y(at.row));
    double& top = view.obstacles(at.row, at.col);
    const auto cell = cell_at(site.bank, place.x(), place.y());
    if (cell && site.obstacles.size() > 0) top = site.obstacles(cell->row, cell->col) - line.z;
    const double level = cell ? site.bank.z(cell->row, cell->col) - line.z : 0.0;
    const auto stand = [&](double height) {
      top = std::fmax(top, (std::isnan(level) ? 0.0 : level) + height);
    };
    for (const JobObstacle& each : settings.design.obstacles) {
      if (is_near(each.polygon, place, 0.5 * motion_cell)) stand(each.height);
    }
    if (settings.design.truck && is_inside(settings.design.truck->bed, place))
      stand(settings.design.truck->bed_height);
  });
  return view;
}

/// What the dig loads the joints with, and the ground that it leaves, in the frame of the way.
DigLoad load_of(const JobSettings& settings, const Terrain& ground, const JobStep& step,
                const DigLine& line) {
  const DigResult dig = whole_dig(settings, ground, dig_line(step.base, step.swung, step.lane),
                                  step.path, step.swung);
  Terrain after = ground;
  apply(dig.patch, after);
  DigLoad load;
  if (!dig.stall) load.torques = dig.torques;
  load.carried = step.carried ? loose_mass(settings.site.soil, step.carried->volume) : 0.0;
  load.payload_mass = std::max(dig.payload_mass, step.predicted.payload_mass) +
                      (step.dumps_first ? 0.0 : load.carried);
  load.ground_after = GroundAlong(after, line, swing_extent(settings.site.machine), motion_cell)
                          .terrain()
                          .surface();
  return load;
}

CycleWayOptions way_options(const JobStep& step, std::optional<FrontJoints> start) {
  const Vector2d dump = step.dump.head<2>() - Vector2d(step.base.x, step.base.y);
  CycleWayOptions options;
  options.lane = step.lane;
  options.whole_cycle = true;
  options.cycle.swing = wrapped(std::atan2(dump.y(), dump.x()) - step.base.heading - step.swung);
  options.cycle.keeps_load = step.keeps_load;
  options.cycle.dump_height = std::max(0.0, step.dump.z() - step.base.z);
  options.dump_radius = dump.norm();
  options.dumps_first = step.dumps_first;
  if (!start && step.carried) start = step.carried->joints;
  if (start) (*start)[3] -= step.swung;
  options.start = start;
  return options;
}

/// In the frame of the line of the dig.
std::variant<Way, BlockedWay> way_of_step(const JobSettings& settings, const Machine& machine,
                                          const Terrain& ground, const JobStep& step,
                                          const std::optional<FrontJoints>& start) {
  const DigLine line = dig_line(step.base, step.swung);
  const Terrain seen = seen_along(settings, ground, line);
  const CycleWayOptions options = way_options(step, start);
  if (step.path.poses.empty()) {
    const double payload = loose_mass(settings.site.soil, step.carried->volume);
    return way_of_dump(machine, seen, payload, options);
  }
  auto path = reaching_out(machine, step.path, step.lane);
  if (const auto* blocked = std::get_if<BlockedWay>(&path)) return *blocked;
  return way_of_cycle(machine, seen, std::get<DigPath>(path), load_of(settings, ground, step, line),
                      options);
}

}  // namespace

std::variant<Trajectory, BlockedWay> motion_of(const JobSettings& settings, const Terrain& ground,
                                               const JobStep& step, const MotionOptions& options,
                                               const std::optional<FrontJoints>& start) {
  const Machine machine = machine_for_planned_path(settings.site.machine);
  Trajectory motion;
  motion.machine = machine.name;
  motion.robot_joints = machine.robot_joints;
  if (!step.moves_front()) return motion;
  auto laid = way_of_step(settings, looking(machine, step.swung), ground, step, start);
  if (auto* blocked = std::get_if<BlockedWay>(&laid)) return *blocked;
  Way& way = std::get<Way>(laid);
  for (WayPose& pose : way.poses) pose.joints[3] += step.swung;
  motion = time_way(machine, way, options);
  motion.warnings = way.warnings;
  for (Warning& each : load_warnings(machine, way)) {
    motion.warnings.push_back(std::move(each));
  }
  motion.plan = PlanStamp{checksum_text(fingerprint(machine) + to_csv(motion)),
                          step.base.site_from_machine()};
  return motion;
}

}  // namespace excavplan
