// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/joint_motion.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "paths.hpp"
#include "pictures.hpp"
#include "rooms.hpp"
#include "texts.hpp"
#include "words.hpp"

namespace excavplan::python {
namespace {

using py::arg;

void bind_machine_itself(py::module_& module) {
  py::class_<BucketPose>(module, "BucketPose", "Position of the tip and attitude of the bucket.")
      .def(py::init([](double x, double z, double angle) {
             return BucketPose{x, z, angle};
           }),
           arg("x"), arg("z"), arg("floor_angle"))
      .def_readonly("x", &BucketPose::x, "[m]")
      .def_readonly("z", &BucketPose::z, "[m]")
      .def_readonly("floor_angle", &BucketPose::floor_angle, "[rad]");
  py::class_<JointLimits>(module, "JointLimits", "What a joint can do.")
      .def_readonly("lower", &JointLimits::lower, "[rad]")
      .def_readonly("upper", &JointLimits::upper, "[rad]")
      .def_readonly("speed", &JointLimits::speed, "[rad/s]")
      .def_readonly("acceleration", &JointLimits::acceleration, "[rad/s^2]")
      .def_readonly("torque", &JointLimits::torque, "[N m]");
  py::class_<RobotJoint>(module, "RobotJoint", "A joint of a robot: ours = sign * its + zero.")
      .def_readonly("name", &RobotJoint::name, "Empty: the robot has no such joint.")
      .def_readonly("sign", &RobotJoint::sign, "-1 or 1")
      .def_readonly("zero", &RobotJoint::zero, "[rad]")
      .def("to_ours", &RobotJoint::to_ours, arg("its"), "Angles [rad].")
      .def("from_ours", &RobotJoint::from_ours, arg("ours"), "Angles [rad].");
  py::class_<Swing>(module, "Swing", "The drive of the upper structure.")
      .def_readonly("speed", &Swing::speed, "Highest rate [rad/s].")
      .def_readonly("torque", &Swing::torque, "[N m]")
      .def_readonly("inertia", &Swing::inertia, "Of the upper structure without front [kg m^2].")
      .def_readonly("lower", &Swing::lower, "Range, 0 is the plane of the dig; may be -inf [rad].")
      .def_readonly("upper", &Swing::upper, "Likewise, to the left; may be inf [rad].")
      .def_readonly("acceleration", &Swing::acceleration, "Highest; may be inf [rad/s^2].")
      .def("turns_round", &Swing::turns_round, "Whether whole turns make no difference.");
  py::class_<Machine>(
      module, "Machine",
      "An excavator in its boom plane. Joints are boom, arm, bucket; positive turns\n"
      "down and curls in.")
      .def_readonly("name", &Machine::name, "'zx120'")
      .def_readonly("boom_pin", &Machine::boom_pin, "(x, z) [m]")
      .def_readonly("boom_length", &Machine::boom_length, "Boom pin to arm pin [m].")
      .def_readonly("arm_length", &Machine::arm_length, "Arm pin to bucket pin [m].")
      .def_readonly("bucket_length", &Machine::bucket_length, "Bucket pin to tip [m].")
      .def_readonly("track_front", &Machine::track_front, "x of the front of the tracks [m].")
      .def_property_readonly("undercarriage_width", &Machine::undercarriage_width,
                             "Over both tracks [m].")
      .def_readonly("swing", &Machine::swing, "None if its file does not state it.")
      .def_property_readonly(
          "site_from_root",
          [](const Machine& m) { return array(Eigen::Matrix4d(m.site_from_root.matrix())); },
          "Takes points from the root frame of its URDF to the site frame, shape (4, 4).")
      .def_property_readonly(
          "limits",
          [](const Machine& m) {
            return std::vector<JointLimits>(m.limits.begin(), m.limits.end());
          },
          "Of boom, arm, bucket.")
      .def_property_readonly(
          "robot_joints",
          [](const Machine& m) {
            return std::vector<RobotJoint>(m.robot_joints.begin(), m.robot_joints.end());
          },
          "Of boom, arm, bucket and swing, as its controller calls and counts them.")
      .def_property_readonly(
          "bucket_width", [](const Machine& m) { return m.bucket.width_outside; },
          "Outside, which it cuts [m].")
      .def_property_readonly("full_length", &Machine::full_length, "The longest reach [m].")
      .def(
          "struck_capacity", [](const Machine& m) { return struck_capacity(m); }, "[m^3]")
      .def(
          "heaped_capacity",
          [](const Machine& m, double slope) { return heaped_capacity(m, slope); },
          arg("slope") = 0.7853981633974483, "With a heap that falls by `slope` [rad] [m^3].")
      .def(
          "fingerprint", [](const Machine& m) { return fingerprint(m); },
          "16 digits that depend on every number that affects a dig.")
      .def(
          "forward_kinematics",
          [](const Machine& m, const JointAngles& joints) { return forward_kinematics(m, joints); },
          arg("joints"), "Tip and floor angle for joint angles (boom, arm, bucket) [rad].")
      .def(
          "inverse_kinematics",
          [](const Machine& m, const BucketPose& pose) -> std::optional<JointAngles> {
            const auto found = inverse_kinematics(m, pose);
            if (const auto* joints = std::get_if<JointAngles>(&found)) return *joints;
            return std::nullopt;
          },
          arg("pose"), "Joint angles (boom, arm, bucket) of a pose [rad]; None out of reach.")
      .def(
          "plot",
          [](const Machine& m, const std::optional<File>& file) {
            return plotted(file, [&](ImageFormat format) { return reach_image(m, format); });
          },
          arg("file") = py::none(), "A Picture; file: also written to, .svg, .png or .pdf.")
      .def("__repr__", [](const Machine& m) { return "<Machine " + m.name + ">"; });
  module.def(
      "load_machine",
      [](const File& name) { return load_machine(shipped_or_file("machines", name.path)); },
      arg("name_or_file"), "'zx120' or a machine file.");
}

// ---- paths --------------------------------------------------------------------------------------

Array joints_of(const std::vector<DigPose>& poses) {
  return array_of_rows(poses, [](const DigPose& pose) { return pose.joints; });
}

Eigen::Vector3d numbers_of_pose(const BucketPose& pose) {
  return {pose.x, pose.z, pose.floor_angle};
}

Array tips_of(const DigPath& path) {
  return array_of_rows(path.poses,
                       [](const DigPose& pose) { return numbers_of_pose(pose.bucket); });
}

GroundProfile profile_of(const std::optional<HeightMap>& ground, const Machine& machine) {
  if (ground) return start_profile(*ground, machine);
  return [](double) { return 0.0; };
}

void bind_path(py::module_& module) {
  py::class_<DigParameters>(module, "DigParameters", "The three numbers of a dig.")
      .def(py::init([](double angle, double penetration, double drag) {
             return DigParameters{angle, penetration, drag};
           }),
           arg("penetration_angle"), arg("penetration_length"), arg("drag_length"))
      .def_readonly("penetration_angle", &DigParameters::penetration_angle,
                    "Of the line of penetration below the horizontal [rad].")
      .def_readonly("penetration_length", &DigParameters::penetration_length, "[m]")
      .def_readonly("drag_length", &DigParameters::drag_length, "Towards the machine [m].");
  py::class_<DigPath> bound_path(
      module, "DigPath", "A dig that the machine can drive: poses in the order of the visit.");
  bind_numbers(bound_path, "x, z of the tip [m] and floor angle [rad] of each pose, shape (N, 3).",
               &tips_of);
  bound_path.def_readonly("parameters", &DigPath::parameters, "That it was made from.")
      .def_readonly("start_x", &DigPath::start_x, "Where the tip meets the ground [m].")
      .def_readonly("ground_z", &DigPath::ground_z, "Height of the ground there [m].")
      .def_property_readonly(
          "phase",
          [](const DigPath& path) {
            return texts(path.poses, [](const DigPose& pose) { return name(pose.phase); });
          },
          "Of each pose: 'penetrate', 'drag', 'scoop' or 'lift'.")
      .def_property_readonly(
          "joints", [](const DigPath& path) { return joints_of(path.poses); },
          "Boom, arm, bucket, shape (N, 3) [rad].")
      .def_property_readonly("bucket", &tips_of,
                             "x, z of the tip [m] and floor angle [rad], shape (N, 3).")
      .def_property_readonly(
          "approach", [](const DigPath& path) { return joints_of(path.approach); },
          "Joints on the way down, shape (M, 3) [rad]; M is 0 unless planned.")
      .def_readonly("heel_clearance", &DigPath::heel_clearance,
                    "Smallest floor angle during the drag [rad].")
      .def_readonly("overcut", &DigPath::overcut, "Of the scoop below the drag line [m].")
      .def("__len__", [](const DigPath& path) { return path.poses.size(); });
  py::class_<Infeasible>(module, "Infeasible", "Why a dig cannot be driven. It is false.")
      .def_property_readonly(
          "phase", [](const Infeasible& i) { return name(i.phase); }, "In which the path fails.")
      .def_readonly("distance", &Infeasible::distance, "Travelled in that phase [m], scoop [rad].")
      .def_readonly("value", &Infeasible::value, "What was found.")
      .def_readonly("limit", &Infeasible::limit, "What was allowed.")
      .def_readonly("message", &Infeasible::message, "All of this in one sentence.")
      .def("__bool__", [](const Infeasible&) { return false; })
      .def("__repr__", [](const Infeasible& i) { return "<Infeasible: " + i.message + ">"; });
  module.def("paper_fixed_path", &paper_fixed_path, "The paper's: pi/4, 0.35 m, 1.5 m.");
  module.def(
      "make_dig_path",
      [](const Machine& machine, const DigParameters& parameters, std::optional<double> start_x,
         const std::optional<HeightMap>& ground, bool planned) {
        require_machine(machine);
        const GroundProfile profile = profile_of(ground, machine);
        const DigPathOptions rules = planned ? rules_for_planned_path() : DigPathOptions{};
        return call([&] {
          return start_x ? make_dig_path(machine, parameters, *start_x, profile, rules)
                         : make_dig_path_anywhere(machine, parameters, profile, rules);
        });
      },
      arg("machine"), arg("parameters"), arg("start_x") = py::none(), arg("ground") = py::none(),
      py::kw_only(), arg("planned") = false,
      "Lays out penetration, drag, scoop and lift. start_x: where the tip meets the ground [m],\n"
      "else where the margins are largest; ground: its surface, else level at 0; planned: the\n"
      "limits are those for a path planned on another measurement of the ground.");
}

// ---- trajectory ---------------------------------------------------------------------------------

template <typename Row>
Array rows(const Trajectory& trajectory, const Row& row) {
  return array_of_rows(trajectory.points, row);
}

Array columns(const JointMotion& motion, std::vector<double> JointPoint::*values) {
  std::vector<double> numbers;
  for (const JointPoint& point : motion.points) {
    numbers.insert(numbers.end(), (point.*values).begin(), (point.*values).end());
  }
  const auto rows = static_cast<py::ssize_t>(motion.points.size());
  const py::ssize_t count = rows > 0 ? static_cast<py::ssize_t>(numbers.size()) / rows : 0;
  return array(std::move(numbers), {rows, count});
}

void bind_trajectory(py::module_& module) {
  using Point = TrajectoryPoint;
  py::class_<Trajectory> bound_trajectory(module, "Trajectory",
                                          "A timed dig path, or the motion of a plan.");
  bind_numbers(bound_trajectory, "Time [s], boom, arm, bucket and swing [rad], shape (N, 5).",
               [](const Trajectory& t) {
                 return rows(t, [](const Point& p) -> Eigen::Matrix<double, 5, 1> {
                   return (Eigen::Matrix<double, 5, 1>() << p.time, p.joints[0], p.joints[1],
                           p.joints[2], p.swing.angle)
                       .finished();
                 });
               });
  bound_trajectory.def_readonly("machine", &Trajectory::machine, "Its name.")
      .def_readonly("warnings", &Trajectory::warnings, "Of plan_motion().")
      .def_property_readonly("duration", &Trajectory::duration, "Of all points [s].")
      .def_property_readonly("dig_duration", &Trajectory::dig_duration,
                             "Of penetrate, drag and scoop [s].")
      .def_property_readonly(
          "time",
          [](const Trajectory& t) {
            return array_of(t.points, [](const Point& p) { return p.time; });
          },
          "From 0, strictly increasing, shape (N,) [s].")
      .def_property_readonly(
          "phase",
          [](const Trajectory& t) {
            return texts(t.points, [](const Point& p) { return name(p.phase); });
          },
          "That leads to each point: 'approach', 'penetrate', 'drag', 'scoop', 'lift', 'swing',\n"
          "'dump' or 'back'.")
      .def_property_readonly(
          "joints",
          [](const Trajectory& t) { return rows(t, [](const Point& p) { return p.joints; }); },
          "Boom, arm, bucket, shape (N, 3) [rad].")
      .def_property_readonly(
          "rates",
          [](const Trajectory& t) { return rows(t, [](const Point& p) { return p.rates; }); },
          "Likewise [rad/s].")
      .def_property_readonly(
          "accelerations",
          [](const Trajectory& t) {
            return rows(t, [](const Point& p) { return p.accelerations; });
          },
          "Likewise [rad/s^2]; NaN in a trajectory of time_dig_path().")
      .def_property_readonly(
          "swing",
          [](const Trajectory& t) {
            return rows(t, [](const Point& p) {
              return Eigen::Vector3d(p.swing.angle, p.swing.rate, p.swing.acceleration);
            });
          },
          "Angle [rad], rate and acceleration, positive to the left, shape (N, 3).")
      .def_property_readonly(
          "bucket",
          [](const Trajectory& t) {
            return rows(t, [](const Point& p) { return numbers_of_pose(p.bucket); });
          },
          "x, z of the tip [m] and floor angle [rad], shape (N, 3).")
      .def_property_readonly(
          "cylinders",
          [](const Trajectory& t) { return rows(t, [](const Point& p) { return p.cylinders; }); },
          "Lengths, shape (N, 3) [m]; NaN if the machine does not state its cylinders.")
      .def_property_readonly(
          "cylinder_speeds",
          [](const Trajectory& t) {
            return rows(t, [](const Point& p) { return p.cylinder_speeds; });
          },
          "Likewise [m/s].")
      .def(
          "to_csv", [](const Trajectory& t) { return to_csv(t); }, "As plan-path writes it.")
      .def(
          "to_json", [](const Trajectory& t) { return to_json(t); },
          "What load_trajectory() reads back exactly.")
      .def("to_joint_trajectory", &to_joint_trajectory,
           "A message trajectory_msgs/JointTrajectory as YAML.")
      .def("to_joint_commands", &to_joint_commands, "Messages com3_msgs/JointCmd of OPERA as YAML.")
      .def("__len__", [](const Trajectory& t) { return t.points.size(); });
  module.def(
      "time_dig_path",
      [](const Machine& machine, const DigPath& path, double speed_fraction,
         double corner_tolerance, const std::vector<JointAngles>& torques) {
        TrajectoryOptions options;
        options.speed_fraction = speed_fraction;
        options.corner_tolerance = corner_tolerance;
        return call([&] { return time_dig_path(machine, path, options, torques); });
      },
      arg("machine"), arg("path"), py::kw_only(),
      arg("speed_fraction") = TrajectoryOptions{}.speed_fraction,
      arg("corner_tolerance") = TrajectoryOptions{}.corner_tolerance,
      arg("torques") = std::vector<JointAngles>{},
      "Times a path as fast as the machine allows. speed_fraction: of its limits, in (0, 1];\n"
      "corner_tolerance: distance from the path at corners [m]; torques: DigResult.torques [N m].");
  py::class_<JointMotion> bound_motion(
      module, "JointMotion",
      "A trajectory for a controller, in the names and angles of the robot; M joints.");
  bind_numbers(bound_motion, "The positions, shape (N, M) [rad].",
               [](const JointMotion& m) { return columns(m, &JointPoint::positions); });
  bound_motion.def_readonly("names", &JointMotion::names, "Of the joints that have one.")
      .def_property_readonly(
          "time",
          [](const JointMotion& m) {
            return array_of(
                m.points, [](const JointPoint& p) { return static_cast<double>(p.time_ns) / 1e9; });
          },
          "From the start, shape (N,) [s].")
      .def_property_readonly(
          "positions", [](const JointMotion& m) { return columns(m, &JointPoint::positions); },
          "Shape (N, M) [rad].")
      .def_property_readonly(
          "velocities", [](const JointMotion& m) { return columns(m, &JointPoint::velocities); },
          "Shape (N, M) [rad/s].")
      .def_property_readonly(
          "accelerations",
          [](const JointMotion& m) { return columns(m, &JointPoint::accelerations); },
          "Shape (N, M) [rad/s^2]; (N, 0) in a trajectory of time_dig_path().")
      .def("__len__", [](const JointMotion& m) { return m.points.size(); });
  module.def("joint_motion", &joint_motion, arg("trajectory"),
             "A trajectory in the names and angles of the robot.");
  module.def(
      "load_trajectory", [](const File& file) { return load_trajectory(file.path); }, arg("file"),
      "Reads what to_json() writes.");
}

}  // namespace

void bind_machine(py::module_& module) {
  bind_machine_itself(module);
  bind_path(module);
  bind_trajectory(module);
}

}  // namespace excavplan::python
