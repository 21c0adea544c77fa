// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/soil.hpp>

#include "support/report_page.hpp"
#include "support/tool_answers.hpp"

/// @file
/// simulate-dig: loads of the joints, its tables and scans, and digs that it refuses.

namespace excavplan::test {
namespace {

const Words all_joints = {"boom", "arm", "bucket"};

TEST_F(Tools, SimulateDigGivesTheKeysOfTheContract) {
  const json result = answer("simulate-dig", {"--density", "60"});
  expect_keys(result, "number", volume_keys + cost_keys);
  expect_keys(result, "number",
              {"payload_volume_m3", "duration_s", "peak_force_kn", "bulking_factor",
               "bulking_factor_true", "fallback_fraction", "solids_before_kg", "solids_after_kg",
               "final_angle_of_repose_rad", "wall_time_s"});
  expect_keys(result, "boolean", {"stalled"});
  for (const std::string& joint : all_joints) {
    expect_keys(
        result, "number",
        {"joints/" + joint + "/peak_torque_kn_m", "joints/" + joint + "/limit_kn_m",
         "joints/" + joint + "/cylinder/peak_force_kn", "joints/" + joint + "/cylinder/shortest_m",
         "joints/" + joint + "/cylinder/longest_m", "joints/" + joint + "/cylinder/stroke_m",
         "joints/" + joint + "/cylinder/stroke_share"});
  }
}

Words fields_of(const std::string& line) {
  Words fields;
  std::istringstream words(line);
  for (std::string word; std::getline(words, word, ',');) fields.push_back(word);
  return fields;
}

/// The columns of a CSV file but "phase", which holds words.
std::map<std::string, std::vector<double>> columns_of(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const Words names = fields_of(line);
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(lines, line)) {
    const Words fields = fields_of(line);
    EXPECT_EQ(fields.size(), names.size()) << line;
    for (std::size_t i = 0; i < std::min(names.size(), fields.size()); ++i) {
      if (names[i] != "phase") columns[names[i]].push_back(std::stod(fields[i]));
    }
  }
  return columns;
}

double farthest_from_zero(const std::vector<double>& values) {
  double farthest = 0.0;
  for (const double value : values) {
    if (std::abs(value) > std::abs(farthest)) farthest = value;
  }
  return farthest;
}

/// A machine whose arm stalls in dense soil.
std::string weak_arm() {
  json machine = json::parse(content_of(shipped("machines/zx120.json")));
  machine["joints"]["arm"]["torque_n_m"] = 20000;
  return machine.dump();
}

const std::string history_header =
    "phase,travelled_m,boom_rad,arm_rad,bucket_rad,soil_x_n,soil_z_n,boom_torque_n_m,"
    "arm_torque_n_m,bucket_torque_n_m,bucket_fill_m3";

TEST_F(Tools, ForceHistoryHasThePeaksOfTheResult) {
  const std::string file = folder.file("history.csv");
  const json result = answer("simulate-dig", {"--density", "70", "--history", file});
  const std::string csv = content_of(file);
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            history_header +
                ",boom_cylinder_m,arm_cylinder_m,bucket_cylinder_m,boom_cylinder_n,"
                "arm_cylinder_n,bucket_cylinder_n,time_s,joint_power_w");
  auto columns = columns_of(csv);
  double peak = 0.0;
  for (std::size_t i = 0; i < columns["soil_x_n"].size(); ++i) {
    peak = std::max(peak, std::hypot(columns["soil_x_n"][i], columns["soil_z_n"][i]));
  }
  EXPECT_NEAR(number(result, "/peak_force_kn"), peak / 1000.0, 1e-9);
  for (const std::string& joint : all_joints) {
    const json& load = result.at("joints").at(joint);
    const json& cylinder = load.at("cylinder");
    const auto& lengths = columns[joint + "_cylinder_m"];
    const auto [shortest, longest] = std::minmax_element(lengths.begin(), lengths.end());
    EXPECT_NEAR(number(load, "/peak_torque_kn_m"),
                farthest_from_zero(columns[joint + "_torque_n_m"]) / 1000.0, 1e-9);
    EXPECT_NEAR(number(cylinder, "/peak_force_kn"),
                farthest_from_zero(columns[joint + "_cylinder_n"]) / 1000.0, 1e-9);
    EXPECT_EQ(number(cylinder, "/shortest_m"), *shortest);
    EXPECT_EQ(number(cylinder, "/longest_m"), *longest);
    EXPECT_NEAR(number(cylinder, "/stroke_share"),
                (*longest - *shortest) / number(cylinder, "/stroke_m"), 1e-12);
    EXPECT_GT(number(cylinder, "/stroke_share"), 0.0);
    EXPECT_LT(number(cylinder, "/stroke_share"), 1.0);
  }
}

// Virtual work: what the cylinders push over a step is what the joint turns.
TEST_F(Tools, CylindersOfTheHistoryDoTheWorkOfTheirJoints) {
  const std::string file = folder.file("history.csv");
  const json result = answer("simulate-dig", {"--density", "40", "--history", file});
  auto columns = columns_of(content_of(file));
  for (const std::string& joint : all_joints) {
    const auto& angle = columns[joint + "_rad"];
    const auto& length = columns[joint + "_cylinder_m"];
    const double count = number(result, "/joints/" + joint + "/cylinder/count");
    int steps = 0;
    for (std::size_t i = 1; i + 1 < angle.size(); ++i) {
      const double turn = angle[i + 1] - angle[i - 1];
      if (std::abs(turn) < 1e-3) continue;
      const double force = columns[joint + "_cylinder_n"][i];
      const double torque = columns[joint + "_torque_n_m"][i];
      EXPECT_NEAR(count * force * (length[i + 1] - length[i - 1]), torque * turn,
                  0.02 * std::abs(torque * turn))
          << joint << ' ' << i;
      ++steps;
    }
    EXPECT_GT(steps, 10) << joint;
  }
}

TEST_F(Tools, ForceHistoryHoldsTimeAndPowerOfTheDig) {
  const std::string file = folder.file("history.csv");
  const json result = answer("simulate-dig", {"--density", "40", "--history", file});
  auto columns = columns_of(content_of(file));
  const auto& time = columns["time_s"];
  const auto& power = columns["joint_power_w"];
  double energy = 0.0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    EXPECT_GT(time[i], time[i - 1]) << i;
    energy += 0.5 * (power[i] + power[i - 1]) * (time[i] - time[i - 1]);
  }
  EXPECT_NEAR(energy / 1000.0, number(result, "/energy_kj"), 0.02 * number(result, "/energy_kj"));
  EXPECT_NEAR(time.back(), number(result, "/duration_s"), 0.1);
  const json measured = answer("measure-efficiency", {file, "--mass", "500"});
  EXPECT_NEAR(number(measured, "/runs/0/energy_kj"), energy / 1000.0, 1e-6 * energy);
  EXPECT_EQ(measured["runs"][0]["phases"], "marked");
}

TEST_F(Tools, FuelLogHoldsIdlingAndTheWorkOfTheCycle) {
  const std::string file = folder.file("fuel.csv");
  const Words words = {"--density", "40", "--fuel-log", file, "--seed", "5"};
  const json result = answer("simulate-dig", words);
  const std::string first = content_of(file);
  EXPECT_EQ(first.substr(0, first.find('\n')), "time_s,fuel_flow_ml_per_s,phase");
  const json run = answer("measure-efficiency", {file, "--volume", "0.2"}).at("runs").at(0);
  // data/engines/zx120.json: 2.8 L/h, and 18.4 L/h for 70.9 kW of the shaft, half of it at the
  // joints.
  const double per_kilojoule = 18.4 / 3.6 / 70.9 / 0.5;
  EXPECT_NEAR(number(run, "/idle/fuel_flow_ml_per_s"), 2.8 / 3.6, 0.01);
  EXPECT_NEAR(number(run, "/dig/fuel_ml_above_idle"), per_kilojoule * number(result, "/energy_kj"),
              0.25);
  EXPECT_NEAR(number(run, "/dig/duration_s"), number(result, "/duration_s"), 0.2);
  EXPECT_NEAR(number(run, "/cycle/duration_s"), number(result, "/cycle/time_s"), 0.2);
  answer("simulate-dig", words);
  EXPECT_EQ(content_of(file), first);
  answer("simulate-dig", {"--density", "40", "--fuel-log", file, "--seed", "6"});
  EXPECT_NE(content_of(file), first);
  answer("simulate-dig", {"--density", "80", "--machine", folder.write("weak.json", weak_arm()),
                          "--fuel-log", file});
  EXPECT_EQ(content_of(file).find("swing"), std::string::npos);
}

TEST_F(Tools, MachineWithoutCylindersHasJointLoadsOnly) {
  json machine = json::parse(content_of(shipped("machines/zx120.json")));
  machine.erase("cylinders");
  const std::string file = folder.file("history.csv");
  const Words words = {"--density", "40", "--machine", folder.write("machine.json", machine.dump()),
                       "--history", file};
  const json result = answer("simulate-dig", words);
  const std::string csv = content_of(file);
  EXPECT_EQ(csv.substr(0, csv.find('\n')), history_header + ",time_s,joint_power_w");
  EXPECT_GT(number(result, "/joints/arm/peak_torque_kn_m"), 0.0);
  EXPECT_TRUE(result["joints"]["arm"]["cylinder"].is_null());
  const ProgramResult text = run_program("simulate-dig", words);
  EXPECT_TRUE(contains(text.out, "peak torque")) << text.out;
  EXPECT_FALSE(contains(text.out, "cylinder")) << text.out;
}

TEST_F(Tools, JointThatStallsIsSeenAboveItsLimit) {
  json machine = json::parse(content_of(shipped("machines/zx120.json")));
  machine["joints"]["arm"]["torque_n_m"] = 20000;
  const json result = answer("simulate-dig", {"--density", "80", "--machine",
                                              folder.write("machine.json", machine.dump())});
  ASSERT_TRUE(result.at("stalled").get<bool>());
  EXPECT_EQ(result.at("stall").at("joint"), "arm");
  EXPECT_EQ(result.at("stall").at("cause"), "torque");
  EXPECT_EQ(number(result, "/joints/arm/limit_kn_m"), 20.0);
  EXPECT_GT(number(result, "/joints/arm/peak_torque_kn_m"), 20.0);
}

TEST_F(Tools, ADigThatLiftsTheMachineSaysSo) {
  const json result = answer("simulate-dig", {"--density", "95"});
  ASSERT_TRUE(result.at("stalled").get<bool>());
  const json& stall = result.at("stall");
  EXPECT_EQ(stall.at("cause"), "front_lifts");
  EXPECT_EQ(stall.at("phase"), "penetrate");
  EXPECT_GT(number(stall, "/travelled_m"), 0.0);
  EXPECT_TRUE(stall.at("joint").is_null() && stall.at("torque_nm").is_null());
  ASSERT_EQ(warning_codes(result), Words{"stalled"});
  const std::string message = result["warnings"][0]["message"];
  EXPECT_TRUE(contains(message, "the machine's front lifts in the phase penetrate")) << message;
}

TEST_F(Tools, DumpPointsOutOfReachAreWarnedOf) {
  for (const auto& [place, distance] : std::vector<std::pair<std::string, std::string>>{
           {"9,0", "9.00"}, {"0,-8.6", "8.60"}, {"0,1.5", "1.50"}}) {
    const json result = answer("simulate-dig", {"--density", "40", "--dump-at", place});
    ASSERT_EQ(warning_codes(result), Words{"dump_out_of_reach"}) << place;
    const std::string message = result["warnings"][0]["message"];
    EXPECT_TRUE(contains(message, place + " is " + distance + " m from the swing axis")) << message;
    EXPECT_TRUE(contains(message, "1.80 m (its tracks) to 8.49 m")) << message;
  }
  EXPECT_EQ(warning_codes(answer("simulate-dig", {"--density", "40", "--dump-at", "-6.1,6.1"})),
            Words{"dump_out_of_reach"});
  EXPECT_EQ(warning_codes(answer("simulate-dig", {"--density", "40", "--dump-at", "-5,5"})),
            Words{});
}

TEST_F(Tools, ScansAreTheSameForTheSameSeed) {
  const TemporaryFolder again;
  const TemporaryFolder other;
  const std::string first = content_of(scan_pair(folder, 40, 7).after);
  EXPECT_EQ(first, content_of(scan_pair(again, 40, 7).after));
  EXPECT_NE(first, content_of(scan_pair(other, 40, 8).after));
}

TEST_F(Tools, ReportHoldsWhatIsPrintedAndWhatWasGiven) {
  const std::string file = folder.file("<b>.html");
  const ProgramResult result =
      run_program("simulate-dig", {"--density", "40", "--json", "--report", file});
  EXPECT_EQ(result.code, 0) << result.err;
  const std::string page = content_of(file);
  EXPECT_EQ(result_on(page), result.out);
  EXPECT_TRUE(
      contains(page, "<tr class=\"given\"><th scope=\"row\"><code>--density</code></th><td>40<"));
  const std::string defaults = page.substr(page.find("All others, at their defaults"));
  EXPECT_TRUE(contains(defaults, "<tr><th scope=\"row\"><code>--soil</code></th><td>loam</td>"));
  EXPECT_FALSE(contains(defaults, "<code>--density</code>"));
  EXPECT_TRUE(contains(page, "&lt;b&gt;.html</td>"));
  EXPECT_FALSE(contains(page, "<b>"));
}

/// The ground of the next scan is never quite that on which it was planned.
TEST_F(Tools, SimulateDigTakesTheSimulatorAsked) {
  const Words words = {"--density", "40"};
  const json usual = answer("simulate-dig", words);
  const json built_in = answer("simulate-dig", words + Words{"--simulator", "height-map"});
  const json section = answer("simulate-dig", words + Words{"--simulator", "section"});
  EXPECT_EQ(built_in.at("energy_kj"), usual.at("energy_kj"));
  EXPECT_NE(section.at("energy_kj"), usual.at("energy_kj"));
  EXPECT_NEAR(number(section, "/energy_kj"), number(usual, "/energy_kj"),
              0.2 * number(usual, "/energy_kj"));
}

TEST_F(BadInput, ThePathOfAPlanMayComeMillimetresNearerToTheTracks) {
  const auto asked = [](double start) {
    return Words{"--density", "40", "--path", "45deg,0.35m,0.3m", "--start", std::to_string(start)};
  };
  double start = 4.2;
  while (run_program("simulate-dig", asked(start)).code == 0) start -= 0.01;
  refused(2, "it must stay beyond 2.300 m", "simulate-dig", asked(start));
  const auto planned = [&](double start_x) {
    const json path = {{"penetration_angle_rad", 0.7853981634},
                       {"penetration_length_m", 0.35},
                       {"drag_length_m", 0.3},
                       {"start_x_m", start_x}};
    return Words{"--density", "40", "--path-from",
                 folder.write("near.json", json{{"path", path}}.dump())};
  };
  EXPECT_EQ(run_program("simulate-dig", planned(start)).code, 0);
  EXPECT_EQ(run_program("simulate-dig", planned(start - 0.1)).code, 2);
}

TEST_F(BadInput, ThePathOfAPlanIsDugAndNothingElseTaken) {
  const ProgramResult plan = run_program("plan-path", {"--density", "40", "--json"});
  const std::string file = folder.write("plan.json", plan.out);
  const Words dig = {"--density", "40", "--path-from", file};
  const json dug = answer("simulate-dig", dig);
  const json planned = json::parse(plan.out);
  EXPECT_EQ(dug.at("path"), planned.at("path"));
  EXPECT_NEAR(dug.at("energy_kj"), planned.at("energy_kj"),
              0.01 * planned["energy_kj"].get<double>());
  refused(2, "--path-from excludes --start", "simulate-dig", dig + Words{"--start", "5"});
  const std::string other = folder.write("other.json", R"({"path": {"start_x_m": 5}})");
  refused(3, other + ": path.penetration_angle_rad: is missing", "simulate-dig",
          {"--density", "40", "--path-from", other});
}

TEST_F(BadInput, PathsThatCannotBeDrivenAreRefusedWithTheReason) {
  refused(2, "this dig cannot be driven: penetrate, after ", "simulate-dig",
          {"--density", "40", "--path", "45deg,9m,1.5m", "--plot", plot});
  refused(2, "this dig cannot be driven: penetrate, after 0.000 m: the height of the ground",
          "simulate-dig", {"--density", "40", "--start", "30", "--plot", plot});
  refused(2, "is not a path ANGLE,LENGTH,LENGTH", "simulate-dig",
          {"--density", "40", "--path", "45deg,0.35m"});
}

// The heap, a cone at the soil's angle of repose, may touch the strip of the dig but not cover it.
TEST_F(BadInput, DumpPointsOnOrTooNearTheDigAreRefused) {
  const auto dig = [](const std::string& place) {
    return Words{"--density", "40", "--dump-at", place};
  };
  refused(2, "--dump-at 5,0 is 0.00 m from the strip of this dig (x = 3.43 .. 6.05 m, y = -0.350",
          "simulate-dig", dig("5,0") + Words{"--plot", plot});
  const Machine machine = load_machine(shipped("machines/zx120.json"));
  const SoilKind loam = load_soil(shipped("soils/loam.json"));
  const double radius = std::cbrt(3.0 * heaped_capacity(machine) /
                                  (3.14159265358979 * std::tan(loam.angle_of_repose)));
  const double edge = 0.5 * machine.bucket.width_outside;
  const std::string reason = "m3 needs at least 0.83";
  for (const double side : {-1.0, 1.0}) {
    const auto beside = [&](double gap) {
      return "5," + std::to_string(side * (edge + radius + gap));
    };
    refused(2, reason, "simulate-dig", dig(beside(-0.01)));
    EXPECT_EQ(warning_codes(answer("simulate-dig", dig(beside(0.01)))), Words{});
  }
  refused(2, reason, "simulate-dig", dig("6.8,0"));
  EXPECT_EQ(warning_codes(answer("simulate-dig", dig("6.9,0"))), Words{});
  refused(2, "--dump-at: '5' is not a point X,Y", "simulate-dig", dig("5"));
}

TEST_F(Tools, BlocksAreStatedAndOffByDefault) {
  auto held_down = json::parse(content_of(shipped("machines/zx120.json")));
  held_down.erase("body");  // dense soil would lift the machine
  const Words dig = {"--density", "85", "--machine", folder.write("zx120.json", held_down.dump())};
  EXPECT_TRUE(answer("simulate-dig", dig)["blocks"].is_null());
  const json broken = answer("simulate-dig", dig + Words{"--blocks", "--block-size", "12cm"});
  EXPECT_GT(number(broken, "/blocks/count"), 50.0);
  expect_keys(broken, "number", {"blocks/soil_m3", "blocks/voids_m3", "blocks/count"});
  EXPECT_NEAR(number(broken, "/volume/after_m3"),
              number(broken, "/blocks/soil_m3") + number(broken, "/blocks/voids_m3"), 1e-9);
  EXPECT_NEAR(number(broken, "/solids_after_kg"), number(broken, "/solids_before_kg"), 1e-6);
  const json soft = answer("simulate-dig", {"--density", "40", "--blocks"});
  EXPECT_TRUE(soft["blocks"].is_null());
  EXPECT_TRUE(warns(soft, "no_blocks"));
}

TEST_F(Tools, CamerasStandWhereTheyAreTold) {
  const std::string one = folder.file("one.pcd");
  const std::string two = folder.file("two.pcd");
  const Words over_heap = {"--camera", "5.5,3,2.5,5.5,4,0"};
  answer("simulate-dig", Words{"--density", "40", "--after", one} + over_heap);
  answer("simulate-dig", Words{"--density", "40", "--after", two} + over_heap +
                             Words{"--camera=4.5,-1,2.5,4.9,0,0"});
  EXPECT_GT(fs::file_size(two), 1.7 * static_cast<double>(fs::file_size(one)));
}

TEST_F(BadInput, CamerasThatMakeNoSense) {
  refused(2, "is not a place and a target X,Y,Z,TX,TY,TZ", "simulate-dig",
          {"--density", "40", "--camera", "5,3,2.5"});
  refused(2, "distance from position to target", "simulate-dig",
          {"--density", "40", "--before", folder.file("b.pcd"), "--camera", "5,3,2,5,3,2"});
  const auto placed = [&](const std::string& place) {
    return Words{"--density", "40",       "--before",    folder.file("b.pcd"), "--history",
                 plot,        "--camera", "5,0,3,5,0,0", "--camera",           place};
  };
  refused(2,
          "--camera: the one at 5,3,-2 that faces 5,3,0 sees no ground: it stands 2.00 m below it, "
          "must be above",
          "simulate-dig", placed("5,3,-2,5,3,0"));
  refused(2, "--camera: the one at 5,3,2 that faces 5,3,9 sees no ground: none lies in its view",
          "simulate-dig", placed("5,3,2,5,3,9"));
}

TEST_F(Tools, SettingsOfScansThatAreNotWrittenAreReported) {
  const Words words = {"--density", "40", "--seed", "7", "--noise", "0.01"};
  const json ignored = answer("simulate-dig", words);
  ASSERT_EQ(warning_codes(ignored), (Words{"options_ignored", "options_ignored"}));
  EXPECT_EQ(ignored["warnings"][0]["message"], "without effect: --noise; no scans are written");
  EXPECT_EQ(ignored["warnings"][1]["message"],
            "without effect: --seed; there are neither scans (--before, --after) nor --blocks nor "
            "a --fuel-log");
  const json used = answer("simulate-dig", words + Words{"--after", folder.file("after.pcd")});
  EXPECT_FALSE(warns(used, "options_ignored"));
}

TEST_F(Tools, SettingsOfBlocksThatAreNotThereAreReported) {
  const Words words = {"--density", "85", "--block-size", "0.3", "--block-swell", "0.5"};
  const ProgramResult result = run_program("simulate-dig", words);
  EXPECT_TRUE(contains(result.err,
                       "without effect: --block-size, --block-swell; there are no blocks "
                       "without --blocks\n"))
      << result.err;
  EXPECT_FALSE(warns(answer("simulate-dig", words + Words{"--blocks"}), "options_ignored"));
}

}  // namespace
}  // namespace excavplan::test
