// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>
#include <regex>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <Eigen/Geometry>

#include <excavplan/machine/machine_file.hpp>

#include "support/machine_file.hpp"
#include "support/run_program.hpp"
#include "support/urdf_file.hpp"

namespace excavplan {
namespace {

using nlohmann::json;
using test::urdf_of;
using test::WrittenJoint;
using test::zx120_joints;

class Urdf : public testing::Test {
 protected:
  MachineFile read(const std::string& text, const json& beside = nullptr) {
    if (!beside.is_null()) folder.write("digger.json", beside.dump());
    return load_machine_file(folder.write("digger.urdf", text));
  }
  std::string complaint(const std::string& text) {
    const std::string path = folder.write("digger.urdf", text);
    return test::error_about([&] { load_machine_file(path); }, path);
  }
  test::TemporaryFolder folder;
};

std::set<std::string> codes(const MachineFile& file) {
  std::set<std::string> codes;
  for (const Warning& warning : file.warnings) codes.insert(code_text(warning.code));
  return codes;
}

TEST_F(Urdf, GivesTheGeometryOfThePublicModel) {
  const MachineFile file = read(urdf_of(zx120_joints()));
  const Machine& m = file.machine;
  const Machine& own = test::zx120();
  EXPECT_EQ(m.name, "digger");
  EXPECT_NEAR((m.boom_pin - own.boom_pin).norm(), 0.0, 1e-12);
  EXPECT_NEAR(m.boom_length, own.boom_length, 1e-12);
  EXPECT_NEAR(m.arm_length, own.arm_length, 1e-12);
  EXPECT_NEAR(m.bucket_length, own.bucket_length, 1e-12);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(m.limits[i].lower, own.limits[i].lower, 1e-4);
    EXPECT_NEAR(m.limits[i].upper, own.limits[i].upper, 1e-4);
    EXPECT_EQ(m.limits[i].torque, own.limits[i].torque) << "a placeholder was believed";
    EXPECT_EQ(m.links[i].mass, own.links[i].mass);
    EXPECT_EQ(m.robot_joints[i].name, own.robot_joints[i].name);
    EXPECT_EQ(m.robot_joints[i].sign, 1.0);
    EXPECT_EQ(m.robot_joints[i].zero, 0.0);
  }
  EXPECT_EQ(m.limits[0].speed, own.limits[0].speed) << "6.16 rad/s was believed";
  EXPECT_EQ(m.limits[1].speed, 0.5);
  EXPECT_EQ(codes(file), (std::set<std::string>{"urdf_scaled", "urdf_placeholder"}));
  EXPECT_NEAR(heaped_capacity(m), heaped_capacity(own), 1e-12);
}

// Its text is a machine file that says of each number where it is from.
TEST_F(Urdf, BecomesAMachineFileOfOurs) {
  const MachineFile file = read(urdf_of(zx120_joints()));
  const MachineFile again = load_machine_file(folder.write("again.json", file.text));
  EXPECT_EQ(fingerprint(again.machine), fingerprint(file.machine));
  EXPECT_TRUE(again.warnings.empty());
  const json text = json::parse(file.text);
  EXPECT_EQ(text["geometry"]["sources"]["boom_length_m"], "URDF 'digger'");
  EXPECT_NE(text["links"]["sources"]["boom.mass_kg"].get<std::string>().find("scaled"),
            std::string::npos);
}

// ---- conventions --------------------------------------------------------------------------------

TEST_F(Urdf, SignsAndZerosFollowTheAxes) {
  auto joints = zx120_joints();
  joints[1].axis = "0 -3 0";  // up positive
  joints[1].limit = "lower=\"-0.7679\" upper=\"1.2217\"";
  joints[2].xyz = "3.25 0 3.25";  // zero is 45 deg up
  joints[2].limit = "lower=\"-0.26\" upper=\"1.86\"";
  const MachineFile file = read(urdf_of(joints));
  const RobotJoints& angles = file.machine.robot_joints;
  EXPECT_EQ(angles[0].sign, -1.0);
  EXPECT_NEAR(angles[0].zero, -0.7853981633974483, 1e-12);
  EXPECT_EQ(angles[1].sign, 1.0);
  EXPECT_NEAR(angles[1].zero, 0.7853981633974483, 1e-12);
  EXPECT_NEAR(file.machine.limits[0].lower, -1.2217 - 0.7853981633974483, 1e-12);
  EXPECT_NEAR(file.machine.limits[0].upper, 0.7679 - 0.7853981633974483, 1e-12);
  EXPECT_EQ(codes(file).count("urdf_angles"), 1U);
}

TEST_F(Urdf, LimitsTheSwingToo) {
  auto joints = zx120_joints();
  EXPECT_TRUE(read(urdf_of(joints)).machine.swing->turns_round());
  joints[0].type = "revolute";
  joints[0].limit = "lower=\"-1.2\" upper=\"0.8\" effort=\"34000\" velocity=\"1\"";
  EXPECT_EQ(read(urdf_of(joints)).machine.swing->lower, -1.2);
  EXPECT_EQ(read(urdf_of(joints)).machine.swing->upper, 0.8);
  joints[0].axis = "0 0 -1";
  const MachineFile turned = read(urdf_of(joints));
  EXPECT_EQ(turned.machine.swing->lower, -0.8);
  EXPECT_EQ(turned.machine.swing->upper, 1.2);
  EXPECT_EQ(codes(turned).count("urdf_angles"), 1U);
  for (const Warning& warning : turned.warnings) {
    if (warning.code != WarningCode::urdf_angles) continue;
    EXPECT_NE(warning.message.find("swing = -swing_joint rad"), std::string::npos)
        << warning.message;
  }
  for (const std::string none : {"lower=\"0\" upper=\"0\"", "lower=\"-1000\" upper=\"1000\""}) {
    joints[0].limit = none + " effort=\"34000\" velocity=\"1\"";
    EXPECT_TRUE(read(urdf_of(joints)).machine.swing->turns_round()) << none;
  }
}

// The axis is 0.3 m ahead of the root and 0.1 m to its left, the boom points to the left at zero.
TEST_F(Urdf, KeepsWhereTheRootIs) {
  auto joints = zx120_joints();
  joints[0].xyz = "0.3 0.1 1.5";
  joints[0].rpy = "0 0 1.5707963267948966";
  const json beside = {
      {"format", "excavplan-machine"}, {"version", 1}, {"urdf", {{"ground_z_m", 0.5}}}};
  const MachineFile file = read(urdf_of(joints), beside);
  const Eigen::Vector3d ahead = file.machine.site_from_root * Eigen::Vector3d(0.3, 5.1, 0.5);
  EXPECT_LT((ahead - Eigen::Vector3d(5.0, 0.0, 0.0)).norm(), 1e-12);
  ASSERT_EQ(codes(file).count("urdf_frame"), 1U);
  for (const Warning& warning : file.warnings) {
    if (warning.code != WarningCode::urdf_frame) continue;
    EXPECT_NE(warning.message.find(
                  "at (-0.100000, 0.300000, -0.500000) m, turned about z by -1.57080 rad"),
              std::string::npos)
        << warning.message;
  }
  const MachineFile again = load_machine_file(folder.write("again.json", file.text));
  EXPECT_TRUE(again.machine.site_from_root.isApprox(file.machine.site_from_root, 1e-12));
}

// ---- what it does not hold ----------------------------------------------------------------------

TEST_F(Urdf, TakesTheRestFromTheJsonBesideIt) {
  const json own = json::parse(std::ifstream(test::zx120_path()));
  json beside = own;
  beside.erase("name");
  for (const char* key : {"boom_pin_m", "boom_length_m", "arm_length_m", "bucket_length_m"}) {
    beside["geometry"].erase(key);
  }
  for (const char* joint : {"boom", "arm", "bucket"}) {
    for (const char* key : {"lower_rad", "upper_rad"}) beside["joints"][joint].erase(key);
  }
  const MachineFile file = read(urdf_of(zx120_joints()), beside);
  EXPECT_EQ(file.machine.limits[1].speed, test::zx120().limits[1].speed) << "it beats the URDF";
  EXPECT_TRUE(file.machine.cylinders.has_value());
  EXPECT_EQ(codes(file).count("urdf_scaled"), 0U);
  beside["body"] = nullptr;
  EXPECT_FALSE(read(urdf_of(zx120_joints()), beside).machine.body.has_value());
  beside["geometry"]["boom_length_m"] = 4.6;
  const std::string path = folder.file("digger.json");
  EXPECT_EQ(test::error_about([&] { read(urdf_of(zx120_joints()), beside); }, path),
            "geometry.boom_length_m: found it here and in the URDF, expected it in the URDF, as "
            "this file beside it is read for what it lacks");
}

TEST_F(Urdf, NamesTheJsonBesideItWhereThatIsWrong) {
  const std::string name = folder.file("digger.urdf") + " with " + folder.file("digger.json");
  const auto complaint_of = [&](const json& beside) {
    return test::error_about([&] { read(urdf_of(zx120_joints()), beside); }, name + " beside it");
  };
  const json head = {{"format", "excavplan-machine"}, {"version", 1}};
  json beside = head;
  beside["foo"] = 1;
  EXPECT_EQ(complaint_of(beside), "foo: is not a key of this file");
  beside = head;
  beside["robot_joints"]["boom"]["sign"] = 0.5;
  EXPECT_EQ(complaint_of(beside), "robot_joints.boom.sign: is 0.5, must be -1 or 1");
}

TEST_F(Urdf, BelievesMassesOfItsSize) {
  auto joints = zx120_joints();
  std::string text = urdf_of(joints);
  const std::string boom = test::link_text("boom_link", "0.03");
  text.replace(text.find(boom), boom.size(), test::link_text("boom_link", "900"));
  const MachineFile file = read(text);
  EXPECT_NEAR(file.machine.links[0].mass, 900.0, 1e-9);
  EXPECT_NEAR(file.machine.links[0].along, 0.3, 1e-12);
  EXPECT_NEAR(file.machine.links[0].across, 0.1, 1e-12);
  EXPECT_EQ(file.machine.links[1].mass, test::zx120().links[1].mass);
}

// ---- bad files ----------------------------------------------------------------------------------

TEST_F(Urdf, SaysWhatIsWrong) {
  const auto with = [](std::size_t i, const auto& change) {
    auto joints = zx120_joints();
    change(joints[i]);
    return urdf_of(joints);
  };
  const auto begins = [&](const std::string& text, const std::string& with_text) {
    const std::string found =
        std::regex_replace(complaint(text), std::regex("line [0-9]+"), "line #");
    EXPECT_EQ(found.substr(0, with_text.size()), with_text) << found;
  };
  begins(with(2, [](auto& j) { j.name = "stick"; }),
         "it does not say all; state in " + folder.file("digger.json") +
             " beside it: urdf.arm, the name of its joint (there is no 'arm_joint'). Its moving "
             "joints: swing_joint, boom_joint, stick, bucket_joint");
  begins(with(2, [](auto& j) { j.axis = "0 0 1"; }),
         "line #: joint 'arm_joint' has an axis that is not level");
  begins(with(2, [](auto& j) { j.axis = "1 1 0"; }),
         "line #: joint 'arm_joint' has an axis that is not parallel to that of the boom");
  begins(with(0, [](auto& j) { j.axis = "0 1 0"; }),
         "line #: joint 'swing_joint' has an axis that is not upright");
  begins(with(3, [](auto& j) { j.type = "prismatic"; }),
         "line #: joint 'bucket_joint' is 'prismatic'");
  begins(with(3, [](auto& j) { j.xyz = "nan 0 0"; }), "line #: xyz of 'origin' is 'nan 0 0'");
  begins(with(3, [](auto& j) { j.xyz = "1e308 0 0"; }), "line #: xyz of 'origin' is '1e308 0 0'");
  begins(with(3, [](auto& j) { j.xyz = "1 2"; }), "line #: xyz of 'origin' is not three numbers");
  for (const std::string glued : {"4.6.6 0", "2.3.0.0", "4-6 0", "+-4.6 0 0", "4.6+0 0", "1,2,3"}) {
    begins(with(3, [&](auto& j) { j.xyz = glued; }),
           "line #: xyz of 'origin' is '" + glued +
               "', expected numbers of at most 1e+06 with blanks between them");
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string name = zx120_joints()[i].name;
    const auto with_more = [&](const std::string& element) {
      std::string text = urdf_of(zx120_joints());
      return text.insert(text.find("<origin", text.find("<joint name=\"" + name)), element);
    };
    begins(with_more("<mimic joint=\"other\"/>"),
           "line #: joint '" + name + "' has a 'mimic', expected a joint that moves by itself");
    begins(with_more("<origin/>"),
           "line #: joint '" + name + "' has a second 'origin', expected one at most");
    begins(with_more("<limit/><limit/>"), "line #: joint '" + name + "' has a second 'limit'");
  }
  begins(with(3, [](auto& j) { j.xyz = "0 0 0"; }),
         "line #: joint 'arm_joint' is 0 m from the next pin, expected at least 0.05");
  begins(with(3, [](auto& j) { j.axis = "0 0 0"; }), "line #: joint 'bucket_joint' has an axis");
  begins(with(3, [](auto& j) { j.limit = ""; }),
         "it does not say all; state in " + folder.file("digger.json") +
             " beside it: joints.bucket.lower_rad, joints.bucket.upper_rad, in the angles of "
             "excavplan");
  begins(with(3, [](auto& j) { j.parent = "boom_link"; }),
         "line #: joint 'bucket_joint' moves too, between 'boom_joint' and 'arm_joint'");
  begins(with(3, [](auto& j) { j.parent = "nothing"; }),
         "line #: joint 'bucket_joint' joins link 'nothing', which the file lacks");
  begins(with(1, [](auto& j) { j.parent = "bucket_end_link"; }),
         "line #: joint 'boom_joint' is part");
  begins(with(1, [](auto& j) { j.child = "base_link"; }), "link 'base_link' appears twice");
  begins(urdf_of(zx120_joints(), test::link_text("loose")), "links 'base_link' and 'loose' hang");
  begins(urdf_of(zx120_joints(), test::joint_text({"again", "fixed", "base_link", "arm_link"})),
         "line #: joint 'again' is the second that leads to link 'arm_link'");
  begins("<robot name=\"a\"/>", "it has no link");
  begins("<sdf/>", "line #: is 'sdf', expected a URDF");
}

TEST_F(Urdf, ShowsHowToExpandAXacro) {
  const auto said = [](const std::string& command) {
    return "is a macro: this is a xacro, expand it first, with ROS: xacro " + command;
  };
  const std::string here = said(folder.file("digger.urdf > ") + folder.file("digger-plain.urdf"));
  EXPECT_EQ(complaint("<robot name=\"a\">\n<xacro:include filename=\"b\"/></robot>"),
            "line 2: 'xacro:include' " + here);
  EXPECT_EQ(complaint("<robot name=\"a\"><link name=\"${prefix}_b\"/></robot>"),
            "line 1: 'link' " + here);
  EXPECT_EQ(complaint("<robot name=\"a\"><link name=\"$(arg prefix)_b\"/></robot>"),
            "line 1: 'link' " + here);
  const std::string xacro =
      folder.write("a.urdf.xacro", "<robot name=\"a\"><xacro:macro name=\"b\"/></robot>");
  EXPECT_EQ(test::error_about([&] { load_machine_file(xacro); }, xacro),
            "line 1: 'xacro:macro' " + said(xacro + " > " + folder.file("a.urdf")));
}

TEST_F(Urdf, RefusesXmlThatIsNoneOrABomb) {
  EXPECT_EQ(complaint("<robot name=\"a\""), "line 1: found the end of the file, expected a name");
  EXPECT_EQ(complaint("<robot>\n</link>"),
            "line 2: found the end of 'link', expected the end of 'robot'");
  EXPECT_EQ(complaint("<robot name=\"&lol;\"/>"),
            "line 1: found '&lol;', expected one of the entities of XML, such as '&amp;'");
  EXPECT_EQ(complaint("<!DOCTYPE r [<!ENTITY a \"aaa\">]><robot name=\"&a;\"/>"),
            "line 1: found '<!DOCTYPE r [<!ENTITY a \"aaa\">]><robot n...', expected no document "
            "type and no entities of its own");
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  EXPECT_EQ(complaint(deep),
            "line 1: found more than 64 levels of elements, expected at most that");
  std::string wide = "<robot name=\"a\">";
  for (int i = 0; i < 200000; ++i) wide += "<a/>";
  EXPECT_EQ(complaint(wide + "</robot>"),
            "line 1: found more than 100000 elements, expected at most that");
  std::string many = "<robot name=\"a\">";
  for (int i = 0; i < 2000; ++i) many += "<link name=\"l" + std::to_string(i) + "\"/>";
  EXPECT_EQ(complaint(many + "</robot>"),
            "found more than 1000 links or joints, expected at most that");
}

}  // namespace
}  // namespace excavplan
