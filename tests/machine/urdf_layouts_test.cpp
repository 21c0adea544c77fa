// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <Eigen/Geometry>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/kinematics.hpp>
#include <excavplan/machine/machine_file.hpp>
#include <excavplan/machine/trajectory.hpp>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "base/text.hpp"
#include "support/machine_file.hpp"
#include "support/run_program.hpp"
#include "support/urdf_file.hpp"

#ifdef EXCAVPLAN_URDFDOM
#include <urdf_parser/urdf_parser.h>
#endif

/// @file
/// One front laid out in a URDF in all ways: what is ahead, and where the tooth is.

namespace excavplan {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using nlohmann::json;
using test::WrittenJoint;

enum class Limits { none, real, quarter_turn };

/// How a front is laid out.
struct Layout {
  double facing = 0.0;                      ///< at zero of the swing, from x of the root [rad]
  JointAngles zero = JointAngles::Zero();   ///< of a Machine, with the URDF's at zero [rad]
  std::array<double, 3> signs = {1, 1, 1};  ///< of boom, arm, bucket
  Limits limits = Limits::real;
  bool has_swing = true, has_mounts = false, has_tip = true;
  double swing_sign = 1.0;
  Vector3d swing_pin = Vector3d::Zero();  ///< in the frame of the root [m]
  double lateral = 0.0;                   ///< of the boom, to the left [m]
};

struct Written {
  std::string text;
  json beside;
};

std::string text_of(const Vector3d& v) {
  return number_text(v.x()) + " " + number_text(v.y()) + " " + number_text(v.z());
}

/// Writes frames that stand in all ways, with each axis along one of their own.
class Writer {
 public:
  Writer(const Machine& machine, const Layout& layout, Random& random)
      : machine_(machine), layout_(layout), random_(random) {}

  Written written() {
    const Matrix3d plane = AngleAxisd(layout_.facing, Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d left = plane * Vector3d::UnitY();
    if (layout_.has_swing) {
      add("turret", layout_.limits == Limits::none ? "continuous" : "revolute", layout_.swing_pin,
          layout_.swing_sign * Vector3d::UnitZ(), "lower=\"-1\" upper=\"1\"");
    }
    const LinkPositions at = link_positions(machine_, layout_.zero);
    const auto in_root = [&](const Eigen::Vector2d& point) -> Vector3d {
      return Vector3d(layout_.swing_pin.x(), layout_.swing_pin.y(), 0.0) +
             plane * Vector3d(point.x(), layout_.lateral, point.y());
    };
    const std::array<Vector3d, 3> pins = {in_root(machine_.boom_pin), in_root(at.arm_pin),
                                          in_root(at.bucket_pin)};
    for (std::size_t i = 0; i < 3; ++i) {
      add(names[i], layout_.limits == Limits::none ? "continuous" : "revolute", pins[i],
          layout_.signs[i] * left, limit(i));
    }
    const Vector3d tip = in_root(at.tip);
    json urdf = {{"swing", nullptr}, {"boom", names[0]}, {"arm", names[1]}, {"bucket", names[2]}};
    if (layout_.has_swing) urdf["swing"] = "turret";
    if (layout_.has_tip) {
      add("tooth", "fixed", tip, left, "");
      urdf["tip"] = "tooth";
    } else {
      const Vector3d its = turn_.transpose() * (tip - at_);
      urdf["tip_m"] = {its.x(), its.y(), its.z()};
    }
    json beside = {{"format", "excavplan-machine"}, {"version", 1}, {"urdf", urdf}};
    for (std::size_t i = 0; i < 3 && layout_.limits != Limits::real; ++i) {
      beside["joints"][std::array{"boom", "arm", "bucket"}[i]] = {
          {"lower_rad", machine_.limits[i].lower}, {"upper_rad", machine_.limits[i].upper}};
    }
    return {test::urdf_of(joints_), beside};
  }

  static constexpr std::array<const char*, 3> names = {"ausleger", "stiel", "loeffel"};

 private:
  std::string limit(std::size_t i) const {
    if (layout_.limits == Limits::quarter_turn) return "lower=\"-1.5707\" upper=\"1.5707\"";
    const double zero = layout_.zero[static_cast<int>(i)];
    const double a = layout_.signs[i] * (machine_.limits[i].lower - zero);
    const double b = layout_.signs[i] * (machine_.limits[i].upper - zero);
    return "lower=\"" + number_text(std::min(a, b)) + "\" upper=\"" + number_text(std::max(a, b)) +
           "\"";
  }

  Matrix3d drawn_turn() {
    return (AngleAxisd(random_.uniform(-3, 3), Vector3d::UnitZ()) *
            AngleAxisd(random_.uniform(-3, 3), Vector3d::UnitX()))
        .toRotationMatrix();
  }

  /// @param at, axis  in the frame of the root
  void add(const std::string& name, const std::string& type, const Vector3d& at,
           const Vector3d& axis, const std::string& limits) {
    if (layout_.has_mounts && type != "fixed") {
      append(WrittenJoint{name + "_mount", "fixed", "", ""}, 0.5 * (at_ + at), drawn_turn());
    }
    Vector3d own = Vector3d::Zero();  // along x, y or z, to either side
    own[static_cast<int>(random_.index(3))] = random_.uniform() < 0.5 ? 1.0 : -1.0;
    const Matrix3d turn = AngleAxisd(random_.uniform(-3, 3), axis).toRotationMatrix() *
                          Eigen::Quaterniond::FromTwoVectors(own, axis).toRotationMatrix();
    WrittenJoint joint = {name, type, "", ""};
    joint.axis = text_of(own);
    if (type == "revolute") joint.limit = limits + " effort=\"1\" velocity=\"1\"";
    append(joint, at, turn);
  }

  void append(WrittenJoint joint, const Vector3d& at, const Matrix3d& turn) {
    joint.parent = joints_.empty() ? "base_link" : joints_.back().child;
    joint.child = joint.name + "_link";
    joint.xyz = text_of(turn_.transpose() * (at - at_));
    const Vector3d yaw_pitch_roll = (turn_.transpose() * turn).eulerAngles(2, 1, 0);
    joint.rpy = text_of(yaw_pitch_roll.reverse());
    joints_.push_back(joint);
    at_ = at;
    turn_ = turn;
  }

  const Machine& machine_;
  const Layout& layout_;
  Random& random_;
  std::vector<WrittenJoint> joints_;
  Vector3d at_ = Vector3d::Zero();        // of the last joint
  Matrix3d turn_ = Matrix3d::Identity();  // of its frame
};

/// The shipped machines, and others in proportions of their own: a long front, a short arm, a
/// boom pin behind the swing axis, a large machine.
std::vector<Machine> fronts() {
  std::vector<Machine> all;
  for (const char* name : {"zx120", "zx200", "generic-20t", "generic-mini"}) {
    all.push_back(load_machine(find_data_file(std::string("machines/") + name + ".json")));
    all.back().cylinders.reset();
    all.back().hydraulics.reset();
  }
  const auto add = [&](const Eigen::Vector2d& pin, double boom, double arm, double bucket) {
    Machine machine = all[1];
    machine.boom_pin = pin;
    machine.boom_length = boom;
    machine.arm_length = arm;
    machine.bucket_length = bucket;
    all.push_back(machine);
  };
  add({0.4, 1.9}, 8.2, 6.3, 1.4);
  add({0.53, 1.37}, 5.715, 2.1, 1.5);
  add({-0.15, 1.2}, 4.3, 2.25, 1.2);
  add({0.2, 2.6}, 7.0, 3.4, 1.9);
  return all;
}

Layout drawn_layout(Random& random) {
  const std::array<JointAngles, 6> zeros = {{{0.0, 0.0, 0.0},          // level, stretched
                                             {-0.6, 0.0, 0.0},         // stretched upwards
                                             {-0.7, 2.3, 2.2},         // curled, tip behind
                                             {-1.45, 0.6, 0.3},        // boom up
                                             {-0.5 * pi, 1.4, 0.5},    // boom upright
                                             {-0.5 * pi, 2.6, 2.4}}};  // folded, tip behind
  Layout layout;
  layout.facing = 0.5 * pi * static_cast<double>(random.index(4));
  if (random.uniform() < 0.2) layout.facing = random.uniform(-3, 3);
  layout.zero = zeros[random.index(zeros.size())];
  for (double& sign : layout.signs) sign = random.uniform() < 0.5 ? 1.0 : -1.0;
  layout.has_swing = random.uniform() < 0.7;
  layout.has_mounts = random.uniform() < 0.5;
  layout.has_tip = random.uniform() < 0.5;
  layout.swing_sign = random.uniform() < 0.5 ? 1.0 : -1.0;
  if (layout.has_swing) {
    layout.swing_pin = {random.uniform(-1, 1), random.uniform(-1, 1), 0.8};
    layout.lateral = random.uniform(-0.3, 0.3);
  }
  return layout;
}

class UrdfLayouts : public testing::Test {
 protected:
  MachineFile read(const Written& written) {
    folder.write("digger.json", written.beside.dump());
    return load_machine_file(folder.write("digger.urdf", written.text));
  }
  std::string complaint(const Written& written) {
    return test::error_about([&] { read(written); }, folder.file("digger.urdf"));
  }
  test::TemporaryFolder folder;
};

Trajectory usual_dig(const Machine& machine) {
  const DigParameters dig = {0.6, 0.3 * machine.bucket_length, 1.2 * machine.bucket_length};
  return time_dig_path(
      machine, std::get<DigPath>(make_dig_path_anywhere(machine, dig, [](double) { return 0.0; })),
      {1.0});
}

#ifdef EXCAVPLAN_URDFDOM
/// A point of a link in the frame of the root, by the poses and axes that urdfdom reads.
Vector3d by_urdfdom(const urdf::ModelInterface& model, const std::map<std::string, double>& angles,
                    const std::string& of, Vector3d point) {
  for (auto link = model.getLink(of); link->parent_joint; link = link->getParent()) {
    const urdf::Joint& joint = *link->parent_joint;
    const auto& pose = joint.parent_to_joint_origin_transform;
    const auto& turn = pose.rotation;
    const auto angle = angles.find(joint.name);
    if (angle != angles.end()) {
      const Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
      point = AngleAxisd(angle->second, axis.normalized()) * point;
    }
    point = Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z) * point +
            Vector3d(pose.position.x, pose.position.y, pose.position.z);
  }
  return point;
}

/// How far the tooth of a dig is from where the URDF puts it [m]: with the swing at rest in the
/// plane that the layout faces, and turned by `swung` in the site frame.
double furthest(const Written& written, const Layout& layout, const MachineFile& file,
                const Trajectory& dig, double swung) {
  const auto model = urdf::parseURDF(written.text);
  const json& names = written.beside.at("urdf");
  const bool by_link = names.contains("tip");
  const Vector3d tip = by_link ? Vector3d::Zero()
                               : Vector3d(names["tip_m"][0], names["tip_m"][1], names["tip_m"][2]);
  const auto tooth = [&](const JointAngles& joints, double swing) {
    std::map<std::string, double> angles;
    for (std::size_t i = 0; i < 3; ++i) {
      const RobotJoint& joint = dig.robot_joints[i];
      angles[joint.name] = joint.from_ours(joints[static_cast<int>(i)]);
    }
    if (layout.has_swing) {
      angles[dig.robot_joints[3].name] = dig.robot_joints[3].from_ours(swing);
    }
    return by_urdfdom(*model, angles, by_link ? "tooth_link" : "loeffel_link", tip);
  };
  const Matrix3d plane = AngleAxisd(-layout.facing, Vector3d::UnitZ()).toRotationMatrix();
  const Vector3d axis(layout.swing_pin.x(), layout.swing_pin.y(), 0.0);
  double most = 0.0;
  for (const TrajectoryPoint& point : dig.points) {
    const Vector3d said(point.bucket.x, layout.lateral, point.bucket.z);
    most = std::max(most, (plane * (tooth(point.joints, 0.0) - axis) - said).norm());
    if (!layout.has_swing) continue;
    const Vector3d in_site = file.machine.site_from_root * tooth(point.joints, swung);
    most = std::max(most, (AngleAxisd(-swung, Vector3d::UnitZ()) * in_site - said).norm());
  }
  return most;
}
#endif

TEST_F(UrdfLayouts, TheToothDigsWhereUrdfdomPutsIt) {
#ifndef EXCAVPLAN_URDFDOM
  GTEST_SKIP() << "built without urdfdom";
#else
  Random random(7);
  for (const Machine& front : fronts()) {
    for (const Limits limits : {Limits::none, Limits::real, Limits::quarter_turn}) {
      std::optional<Trajectory> dig;
      for (int each = 0; each < 12; ++each) {
        Layout layout = drawn_layout(random);
        layout.limits = limits;
        const Written written = Writer(front, layout, random).written();
        const MachineFile file = read(written);
        const Machine& machine = file.machine;
        EXPECT_LT((machine.boom_pin - front.boom_pin).norm(), 1e-9) << written.text;
        EXPECT_NEAR(machine.boom_length, front.boom_length, 1e-9);
        EXPECT_NEAR(machine.arm_length, front.arm_length, 1e-9);
        EXPECT_NEAR(machine.bucket_length, front.bucket_length, 1e-9);
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_NEAR(machine.limits[i].lower, front.limits[i].lower, 1e-9) << written.text;
          EXPECT_NEAR(machine.limits[i].upper, front.limits[i].upper, 1e-9);
        }
        if (!dig) dig = usual_dig(machine);
        dig->robot_joints = machine.robot_joints;
        EXPECT_LT(furthest(written, layout, file, *dig, random.uniform(-1, 1)), 1e-6)
            << written.text << written.beside;
      }
    }
  }
#endif
}

// The angles sent stay within the ranges of the URDF, and next to its zero where it has none.
TEST_F(UrdfLayouts, AnglesOfTheRobotAreThoseOfItsRanges) {
  Random random(11);
  for (const Machine& front : fronts()) {
    for (const Limits limits : {Limits::none, Limits::real}) {
      Layout layout = drawn_layout(random);
      layout.limits = limits;
      const Machine machine = read(Writer(front, layout, random).written()).machine;
      for (std::size_t i = 0; i < 3; ++i) {
        const double middle = 0.5 * (front.limits[i].lower + front.limits[i].upper);
        const double its = machine.robot_joints[i].from_ours(middle);
        const double expected = layout.signs[i] * (middle - layout.zero[static_cast<int>(i)]);
        EXPECT_NEAR(its, expected, 1e-9);
      }
    }
  }
}

TEST_F(UrdfLayouts, AsksWhatIsAheadOfAFrontThatStandsUpright) {
  Random random(3);
  Machine front = fronts()[0];
  front.boom_pin.x() = 0.0;
  Layout layout;
  layout.facing = 0.5 * pi;
  layout.zero = {-0.5 * pi, 0.0, 0.0};
  layout.limits = Limits::none;
  Written written = Writer(front, layout, random).written();
  EXPECT_NE(complaint(written).find("urdf.forward, 'x', '-x', 'y' or '-y'"), std::string::npos)
      << complaint(written);
  written.beside["urdf"]["forward"] = "y";
  EXPECT_NEAR(read(written).machine.robot_joints[0].zero, -0.5 * pi, 1e-9);
  EXPECT_NEAR(std::abs(Eigen::AngleAxisd(read(written).machine.site_from_root.linear()).angle()),
              0.5 * pi, 1e-9);
  written.beside["urdf"]["forward"] = "x";
  EXPECT_NE(complaint(written).find("another urdf.forward"), std::string::npos);
  layout.limits = Limits::real;  // which it can reach leaning ahead alone
  EXPECT_LT((read(Writer(front, layout, random).written()).machine.site_from_root.linear() *
                 Vector3d::UnitY() -
             Vector3d::UnitX())
                .norm(),
            1e-9);
}

TEST_F(UrdfLayouts, NamesAllThatIsMissingAtOnce) {
  Random random(5);
  Layout layout;
  layout.limits = Limits::quarter_turn;
  layout.has_tip = false;
  Written written = Writer(fronts()[0], layout, random).written();
  written.beside = {{"format", "excavplan-machine"}, {"version", 1}};
  written.beside["joints"]["arm"] = {{"lower_rad", 0.5}};
  const std::string said = complaint(written);
  for (const char* part :
       {"urdf.boom, the name of its joint", "urdf.arm, ", "urdf.bucket, ", "urdf.tip_m, [x, y, z]",
        "Its moving joints: turret, ausleger, stiel, loeffel"}) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  }
  written.beside["urdf"] = {{"boom", "ausleger"}, {"arm", "stiel"}, {"bucket", "loeffel"}};
  const std::string then = complaint(written);
  for (const char* part :
       {"urdf.swing, the name of its joint or null", "in the frame of link 'loeffel_link' (",
        "joints.boom.lower_rad, joints.boom.upper_rad, joints.arm.upper_rad, "
        "joints.bucket.lower_rad, joints.bucket.upper_rad, in the angles of excavplan (+-pi/2"}) {
    EXPECT_NE(then.find(part), std::string::npos) << then;
  }
}

TEST_F(UrdfLayouts, NothingTurnsAMachineWhoseBoomHangsOnTheRoot) {
  Random random(9);
  Layout layout;
  layout.has_swing = false;
  layout.has_mounts = true;
  Written written = Writer(fronts()[0], layout, random).written();
  written.beside["urdf"].erase("swing");
  EXPECT_TRUE(read(written).machine.robot_joints[3].name.empty());
}

// One front in four layouts, with real ranges in the URDF or others in the JSON beside it.
TEST_F(UrdfLayouts, ReportedLayoutsAnswerAlike) {
  const std::string shared = EXCAVPLAN_SHARED_DATA "/reported/urdf-layouts/";
  if (!std::filesystem::exists(shared)) GTEST_SKIP() << "no reported layouts in " << shared;
  for (const char* kind : {"continuous", "revolute"}) {
    std::optional<Machine> first;
    for (const char* layout : {"px_p", "mx_p", "my_p", "py_m"}) {
      const Machine machine = load_machine(shared + layout + "_" + kind + ".urdf");
      EXPECT_NEAR(machine.boom_pin.x(), 0.14, 1e-9) << layout << kind;
      if (!first) first = machine;
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(machine.limits[i].lower, first->limits[i].lower, 1e-5) << layout << kind;
        EXPECT_NEAR(machine.robot_joints[i].zero, first->robot_joints[i].zero, 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace excavplan
