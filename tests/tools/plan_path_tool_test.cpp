// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/machine/trajectory.hpp>

#include "support/report_page.hpp"
#include "support/svg_figure.hpp"
#include "support/tool_answers.hpp"
#include "support/urdf_file.hpp"

/// @file
/// plan-path: look-up and search, what it warns of, and the trajectory it writes.

namespace excavplan::test {
namespace {

TEST_F(Tools, PlanPathGivesTheKeysOfTheContract) {
  const json result = answer("plan-path", {"--density", "40"});
  expect_keys(result, "number", path_keys + cost_keys);
  expect_keys(result, "number",
              {"density_percent", "payload_volume_m3", "duration_s", "wall_time_s"});
  expect_keys(result, "string", {"source", "goal"});
  expect_keys(result, "number", {"fill_fraction"});
  expect_keys(result.at("cycle"), "number",
              {"energy_kj", "time_s", "efficiency_kg_per_kj", "rate_t_per_h"});
  EXPECT_TRUE(result.at("evaluations").is_number_integer());
}

TEST_F(Tools, TrajectoryIsTheTableOfTheContract) {
  const std::string file = folder.file("dig.csv");
  answer("plan-path", {"--density", "40", "--trajectory", file});
  std::istringstream lines(content_of(file));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(
      line.rfind("time_s,phase,boom_rad,arm_rad,bucket_rad,tip_x_m,tip_z_m,bucket_angle_rad,", 0),
      0U);
  const auto commas = std::count(line.begin(), line.end(), ',');
  double last = -1.0;
  Words phases;
  while (std::getline(lines, line)) {
    ASSERT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
    const double time = std::stod(line);
    EXPECT_GT(time, last);
    last = time;
    const std::size_t start = line.find(',') + 1;
    const std::string phase = line.substr(start, line.find(',', start) - start);
    if (phases.empty() || phases.back() != phase) phases.push_back(phase);
  }
  EXPECT_EQ(phases, Words({"approach", "penetrate", "drag", "scoop", "lift"}));
}

TEST_F(Tools, TrajectoryIsJsonIfItsFileEndsInJson) {
  const std::string file = folder.file("dig.json");
  answer("plan-path", {"--density", "40", "--trajectory", file});
  const Trajectory trajectory = load_trajectory(file);
  EXPECT_EQ(trajectory.machine, "zx120");
  EXPECT_EQ(trajectory.points.front().phase, DigPhase::approach);
  EXPECT_GT(trajectory.points.front().bucket.z, 0.3);
  EXPECT_EQ(trajectory.points.back().phase, DigPhase::lift);
  const std::string capital = folder.file("capital.JSON");
  answer("plan-path", {"--density", "40", "--trajectory", capital});
  EXPECT_EQ(content_of(capital), content_of(file));
}

TEST_F(Tools, TrajectoryBeginsAtThePresentJointsAndGoesOverTheCycle) {
  const std::string file = folder.file("cycle.json");
  const json result =
      answer("plan-path", {"--density", "40", "--joints", "-40deg,90deg,40deg,0.5", "--whole-cycle",
                           "--rate", "50Hz", "--trajectory", file});
  const Trajectory motion = load_trajectory(file);
  EXPECT_NEAR(motion.points.front().joints[1], 1.5707963267948966, 1e-15);
  EXPECT_EQ(motion.points.front().swing.angle, 0.5);
  EXPECT_EQ(motion.points.back().phase, DigPhase::back);
  EXPECT_NEAR(motion.points[1].time, 0.02, 1e-15);
  EXPECT_EQ(result["trajectory"]["points"], motion.points.size());
  EXPECT_EQ(result["trajectory"]["duration_s"], motion.duration());
}

/// The swing leaves the strip that is planned on.
TEST_F(Tools, TrajectoryIsClearOfAllScannedGround) {
  const auto scan = [&](const std::string& name, double half_width, double wall) {
    std::ostringstream points;
    for (double x = -9.4; x < 9.45; x += 0.1) {
      for (double y = -half_width; y < half_width; y += 0.1) {
        points << x << ' ' << y << ' ' << (x > 2.0 && x < 4.0 && y > 2.5 && y < 3.5 ? wall : 0.0)
               << '\n';
      }
    }
    return folder.write(name, points.str());
  };
  const auto words = [&](double half_width, double wall) {
    return Words{"--density",
                 "40",
                 "--whole-cycle",
                 "--terrain",
                 scan("ground.xyz", half_width, wall),
                 "--trajectory",
                 folder.file("m.json")};
  };
  const json seen = answer("plan-path", words(9.4, 0.0));
  EXPECT_FALSE(warns(seen, "unseen_way"));
  EXPECT_TRUE(seen.at("trustworthy"));
  const json strip = answer("plan-path", words(1.5, 0.0));
  EXPECT_TRUE(warns(strip, "unseen_way"));
  EXPECT_FALSE(strip.at("trustworthy"));
  Words around = words(1.5, 0.0);
  around.insert(around.end(), {"--surroundings", scan("around.xyz", 9.4, 0.0)});
  const json both = answer("plan-path", around);
  EXPECT_FALSE(warns(both, "unseen_way"));
  EXPECT_TRUE(both.at("trustworthy"));
  around.back() = scan("around.xyz", 9.4, 9.0);
  EXPECT_TRUE(warns(answer("plan-path", around), "no_motion"));
  around.back() = folder.write("mm.xyz", "0 0 0\n1 1 1\n");
  EXPECT_EQ(run_program("plan-path", around).code, 3);
  around.back() = scan("low.xyz", 9.4, 0.0);
  around.insert(around.end(), {"--terrain-frame", "0,0,0.5,0,0,0,1"});
  EXPECT_FALSE(warns(answer("plan-path", around), "surroundings_differ")) << "both in one frame";
  around.resize(around.size() - 2);
  around.back() = folder.file("none.xyz");
  around.insert(around.end(), {"--search", "--checkpoint", folder.file("search.json")});
  EXPECT_EQ(run_program("plan-path", around).code, 3);
  EXPECT_FALSE(std::filesystem::exists(folder.file("search.json"))) << "told before the search";
  around.erase(around.begin() + 3, around.begin() + 5);
  const ProgramResult alone = run_program("plan-path", around);
  EXPECT_TRUE(contains(alone.err, "--surroundings needs --terrain")) << alone.err;
  const ProgramResult blocked = run_program("plan-path", words(9.4, 9.0));
  EXPECT_TRUE(contains(blocked.out + blocked.err, "swing: the machine would be ")) << blocked.err;
}

/// A plane 0.1 rad up to the left, then the same with a cliff behind the machine.
TEST_F(Tools, TheGroundThatTheMachineStandsOnDecidesTrust) {
  const auto scan = [&](const std::string& name, double rise, double cliff) {
    std::ostringstream points;
    for (double x = -7.0; x < 9.45; x += 0.1) {
      for (double y = -6.0; y < 6.0; y += 0.1) {
        points << x << ' ' << y << ' ' << rise * y + (x < -2.5 ? cliff : 0.0) << '\n';
      }
    }
    return folder.write(name, points.str());
  };
  const auto plan = [&](const std::string& terrain, const Words& more) {
    return answer("plan-path", Words{"--density", "40", "--terrain", terrain} + more);
  };
  const std::string level = scan("level.xyz", 0.0, 0.0), tilted = scan("tilted.xyz", 0.1, 0.0);
  const json good = plan(level, {});
  EXPECT_TRUE(good.at("trustworthy")) << good.at("warnings");
  EXPECT_FALSE(good.contains("attitude"));
  EXPECT_TRUE(warns(plan(tilted, {}), "ground_tilted"));
  const json stated = plan(tilted, {"--attitude", "0.0997,0"});
  EXPECT_FALSE(warns(stated, "ground_tilted"));
  EXPECT_TRUE(stated.at("trustworthy")) << stated.at("warnings");
  EXPECT_EQ(stated["attitude"]["roll_rad"], 0.0997);
  EXPECT_TRUE(warns(plan(tilted, {"--attitude", "-0.0997,0"}), "ground_tilted"));
  EXPECT_TRUE(warns(plan(level, {"--attitude", "0,5deg"}), "ground_tilted"));
  const std::string cliff = scan("cliff.xyz", 0.0, -2.5);
  const json drop = plan(cliff, {});
  EXPECT_TRUE(warns(drop, "drop_at_tracks"));
  EXPECT_FALSE(drop.at("trustworthy"));
  const std::string strip = folder.write("strip.xyz", [] {
    std::ostringstream points;
    for (double x = 0.8; x < 9.45; x += 0.1) {
      for (double y = -1.6; y < 1.65; y += 0.1) points << x << ' ' << y << " 0\n";
    }
    return points.str();
  }());
  const json ahead = plan(strip, {});
  EXPECT_TRUE(warns(ahead, "ground_at_tracks_unseen"));
  EXPECT_TRUE(ahead.at("trustworthy")) << ahead.at("warnings");
  const json known = plan(strip, {"--surroundings", level});
  EXPECT_FALSE(warns(known, "ground_at_tracks_unseen"));
  EXPECT_TRUE(known.at("trustworthy")) << known.at("warnings");
  EXPECT_TRUE(warns(plan(strip, {"--surroundings", cliff}), "drop_at_tracks"));
  EXPECT_EQ(run_program("plan-path", {"--density", "40", "--attitude", "5deg"}).code, 2);
}

TEST_F(Tools, TrajectoryDumpsToTheRightIfTheSwingIsBelowZero) {
  const std::string file = folder.file("right.json");
  const json right = answer(
      "plan-path", {"--density", "40", "--swing", "-90deg", "--joints", "-40deg,90deg,40deg,6.1",
                    "--whole-cycle", "--rate", "50Hz", "--trajectory", file});
  const json left = answer("plan-path", {"--density", "40", "--swing", "90deg"});
  EXPECT_EQ(right["path"], left["path"]);
  EXPECT_EQ(right["cycle"], left["cycle"]);
  EXPECT_EQ(right["goal_parameters"], left["goal_parameters"]);
  const Trajectory motion = load_trajectory(file);
  EXPECT_EQ(motion.points.front().swing.angle, 6.1);
  double least = 10.0;
  for (const TrajectoryPoint& point : motion.points) least = std::min(least, point.swing.angle);
  EXPECT_NEAR(least, 1.5 * 3.141592653589793, 1e-9);
  EXPECT_NE(run_program("plan-path", {"--density", "40", "--swing", "-400deg"})
                .err.find("--swing: the swing from dig to dump (to the right: below 0) is -6.98"),
            std::string::npos);
}

TEST_F(Tools, TrajectoryIsAMessageByItsEndingOrItsFormat) {
  const std::string yaml = folder.file("dig.YML"), other = folder.file("dig.csv");
  answer("plan-path", {"--density", "40", "--trajectory", yaml});
  EXPECT_EQ(content_of(yaml).rfind("header: ", 0), 0U);
  answer("plan-path", {"--density", "40", "--trajectory", other, "--trajectory-format", "yaml"});
  EXPECT_EQ(content_of(other), content_of(yaml));
  const std::string com3 = folder.file("dig.com3");
  answer("plan-path", {"--density", "40", "--trajectory", com3});
  EXPECT_EQ(content_of(com3).rfind("joint_name: [\"boom_joint\"", 0), 0U);
}

TEST_F(Tools, TrajectoryOfAGivenFormatMayEndInAnyWay) {
  const std::string file = folder.file("dig.txt");
  answer("plan-path", {"--density", "40", "--trajectory", file, "--trajectory-format", "json"});
  EXPECT_EQ(json::parse(content_of(file)).at("format"), "excavplan-trajectory");
}

TEST_F(Tools, TrajectoryOnStandardOutputStandsAlone) {
  const std::string file = folder.file("dig.csv");
  answer("plan-path", {"--density", "40", "--trajectory", file});
  const ProgramResult run = run_program("plan-path", {"--density", "40", "--trajectory", "-"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out, content_of(file));
  EXPECT_NE(run.err.find("payload"), std::string::npos);
  const ProgramResult both =
      run_program("plan-path", {"--density", "40", "--trajectory", "-", "--json"});
  EXPECT_EQ(both.code, 2);
  EXPECT_NE(both.err.find("--json and --trajectory - are both for standard output"),
            std::string::npos);
}

TEST_F(Tools, TrajectoryThatCannotBeRunIsRefusedBeforeTheWork) {
  const std::string file = folder.file("dig.csv");
  const auto complaint = [&](const Words& words) {
    const ProgramResult run =
        run_program("plan-path", Words{"--density", "40", "--search"} + words);
    EXPECT_EQ(run.code, 2);
    EXPECT_FALSE(fs::exists(file));
    return run.err;
  };
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"--trajectory", folder.file("dig.xml")}, ".csv or .json or .yaml or .yml or .com3"},
      {{"--trajectory", file, "--rate", "0"}, "--rate [1/s] is 0, must be in 10 .. 500"},
      {{"--trajectory", file, "--rate", "1e9"}, "--rate [1/s] is 1000000000, must be in 10 .. 500"},
      {{"--trajectory", file, "--max-jerk", "0"}, "--max-jerk is 0, must be at least 0.1 rad/s^3"},
      {{"--trajectory", file, "--joints", "1,2"}, "--joints: '1,2' is not BOOM,ARM,BUCKET"},
      {{"--trajectory", file, "--joints", "1,2,nan"}, "--joints: 'nan' is not a number"},
      {{"--trajectory", file, "--joints", "80deg,1,0"}, "--joints: boom [rad] is 1.396"}};
  for (const auto& [words, text] : cases) {
    EXPECT_NE(complaint(words).find(text), std::string::npos) << text;
  }
}

TEST_F(Tools, GroundInTheWayEndsTrustButNotThePlan) {
  const std::string file = folder.write("dig.csv", "of an earlier plan");
  const Words words = {"--density",     "40",           "--trajectory", file, "--joints",
                       "40deg,30deg,0", "--whole-cycle"};
  const json plan = answer("plan-path", words);
  EXPECT_FALSE(plan.at("path").is_null());
  EXPECT_EQ(plan.at("trustworthy"), false);
  EXPECT_FALSE(plan.contains("trajectory"));
  const std::string warnings = plan.at("warnings").dump();
  EXPECT_NE(warnings.find("no_motion"), std::string::npos);
  EXPECT_NE(warnings.find("approach: the machine would be 5.1 m in the ground at x = "),
            std::string::npos)
      << warnings;
  const std::string head = content_of(file);
  EXPECT_EQ(head.rfind("time_s,phase,", 0), 0U);
  EXPECT_EQ(head.find('\n'), head.size() - 1) << "the head alone";
  EXPECT_EQ(run_program("plan-path", words + Words{"--strict"}).code, 4);
}

TEST_F(Tools, PresentJointsMayBeThoseOfTheRobot) {
  const std::string ours = folder.file("ours.csv"), its = folder.file("its.csv");
  json machine = json::parse(content_of(EXCAVPLAN_DATA_SOURCE "/machines/zx120.json"));
  machine["robot_joints"] = {{"boom", {{"name", "b"}, {"sign", -1}, {"zero_rad", 0.25}}},
                             {"arm", {{"name", "a"}}},
                             {"bucket", {{"name", "k"}}},
                             {"swing", {{"name", "s"}, {"sign", -1}}}};
  const std::string file = folder.write("robot.json", machine.dump());
  const auto plan = [&](const std::string& out, const std::string& joints) {
    return run_program("plan-path", {"--density", "40", "--machine", file, "--library",
                                     EXCAVPLAN_DATA_SOURCE "/libraries/zx120-loam-cycle.json",
                                     "--trajectory", out, "--joints", joints});
  };
  ASSERT_EQ(plan(ours, "0.5,1.5,0.5,0.3").code, 0);
  const ProgramResult named = plan(its, "s=-0.3,a=1.5,b=-0.25,k=0.5");
  ASSERT_EQ(named.code, 0) << named.err;
  EXPECT_EQ(content_of(its), content_of(ours));
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"s=0,a=1,b=0", "there is no angle of k"},
      {"s=0,a=1,b=0,k=0,a=1", "a is given twice"},
      {"boom=0,a=1,k=0,s=0", "'boom=0' is not NAME=ANGLE of a joint of the machine: b, a, k, s"},
      {"0.1,a=1,k=0,s=0", "'0.1' is not NAME=ANGLE"},
      {"s=x,a=1,b=0,k=0", "'x' is not a number"}};
  for (const auto& [joints, text] : cases) {
    const ProgramResult run = plan(its, joints);
    EXPECT_EQ(run.code, 2) << joints;
    EXPECT_NE(run.err.find(text), std::string::npos) << run.err;
  }
}

TEST_F(Tools, ALinkIsWrittenThrough) {
  const std::string target = folder.write("target.csv", "old");
  const std::string link = folder.file("link.csv");
  fs::create_symlink(target, link);
  answer("plan-path", {"--density", "40", "--trajectory", link});
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content_of(target).rfind("time_s,phase,", 0), 0U);
}

TEST_F(Tools, LibraryAnswersWithoutASingleDig) {
  const json plan = answer("plan-path", {"--density", "40"});
  EXPECT_EQ(plan["source"], "library");
  EXPECT_EQ(plan["evaluations"], 0);
  std::cout << "  " << 1000.0 * number(plan, "/wall_time_s") << " ms\n";
  EXPECT_NEAR(number(plan, "/efficiency_kg_per_kj"),
              number(plan, "/payload_mass_kg") / number(plan, "/energy_kj"), 1e-9);
}

TEST_F(Tools, LibraryThatWasBuiltIsUsed) {
  const std::string file = folder.file("library.json");
  const json library =
      answer("build-path-library",
             Words{"--soil", "sand", "--densities", "30,50", "--out", file} + small_library);
  const json plan = answer("plan-path", {"--soil", "sand", "--density", "50", "--library", file});
  EXPECT_EQ(plan.at("path"), library.at("entries").at(1).at("path"));
  EXPECT_EQ(plan.at("energy_kj"), library["entries"][1].at("energy_kj"));
}

TEST_F(Tools, TheTerrainMayBeInAnotherUnit) {
  const std::string metres = shipped("quickstart/before.pcd");
  const std::string scan = in_millimetres(folder, metres);
  for (const char* tool : {"plan-path", "simulate-dig"}) {
    const Words words = {"--density", "40", "--terrain"};
    const double mass =
        number(answer(tool, words + Words{scan, "--unit", "mm"}), "/payload_mass_kg");
    EXPECT_NEAR(mass, number(answer(tool, words + Words{metres}), "/payload_mass_kg"), 0.5) << tool;
    const ProgramResult wrong = run_program(tool, words + Words{scan});
    EXPECT_EQ(wrong.code, 3);
    EXPECT_TRUE(contains(wrong.err, "coordinates in mm")) << wrong.err;
    const ProgramResult alone = run_program(tool, {"--density", "40", "--unit", "mm"});
    EXPECT_EQ(alone.code, 2);
    EXPECT_TRUE(contains(alone.err, "--unit needs --terrain")) << alone.err;
  }
}

TEST_F(Tools, LooksUpTheSlopeOfTheScannedGround) {
  const std::string library = folder.file("library.json");
  answer("build-path-library",
         Words{"--densities", "40", "--slopes=-0.1,0,0.1", "--goal", "energy", "--out", library} +
             small_library);
  const auto plan = [&](double rise) {
    std::string points;
    for (double x = 1.0; x < 11.0; x += 0.04) {
      for (double y = -2.0; y < 2.0; y += 0.04) {
        points += std::to_string(x) + " " + std::to_string(y) + " " +
                  std::to_string(rise * (x - 2.0)) + "\n";
      }
    }
    return answer("plan-path", {"--density", "40", "--goal", "energy", "--library", library,
                                "--terrain", folder.write("ground.xyz", points)});
  };
  const json gentle = plan(0.05);
  EXPECT_NEAR(gentle.at("look_up_slope_rad"), std::atan(0.05), 1e-4);
  EXPECT_GE(gentle.at("look_up_loss"), 0.0);
  EXPECT_FALSE(warns(gentle, "slope_outside_library"));
  const json steep = plan(0.3);
  EXPECT_NEAR(steep.at("look_up_slope_rad"), 0.1, 1e-12) << "as far as the library goes";
  EXPECT_TRUE(warns(steep, "slope_outside_library"));
  const json level =
      answer("plan-path", {"--density", "40", "--goal", "energy", "--library", library});
  EXPECT_EQ(level.at("look_up_slope_rad"), 0.0);
  EXPECT_EQ(level.at("look_up_loss"), 0.0);
}

TEST_F(Tools, ALookUpSaysWhereTheGroundIsNotThatOfTheLibrary) {
  const Words in_pit = {"--density", "40", "--terrain", shipped("quickstart/after.pcd")};
  EXPECT_FALSE(warns(answer("plan-path", in_pit), "ground_unlike_library"));  // its start is sought
  std::string steps;
  for (double x = 1.0; x < 11.0; x += 0.04) {
    for (double y = -2.0; y < 2.0; y += 0.04) {
      const double z = std::fmod(x, 0.8) < 0.4 ? 0.0 : 0.5;
      steps += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    }
  }
  const Words on_steps = {"--density", "40",        "--goal",
                          "energy",    "--terrain", folder.write("steps.xyz", steps)};
  const json unlike = answer("plan-path", on_steps);
  EXPECT_TRUE(warns(unlike, "ground_unlike_library") || warns(unlike, "no_dig")) << unlike;
  EXPECT_EQ(run_program("plan-path", on_steps + Words{"--strict"}).code, 4);
  const json even = answer(
      "plan-path", {"--density", "40", "--terrain", shipped("quickstart/before.pcd"), "--strict"});
  EXPECT_FALSE(warns(even, "ground_unlike_library"));
  EXPECT_LT(number(even, "/look_up_loss"), 0.05);
}

TEST_F(Tools, SearchIsAtLeastAsGoodAsTheLibrary) {
  const json library = answer("plan-path", {"--density", "40"});
  const json search = answer("plan-path", {"--density", "40", "--search"});
  std::cout << "  library " << library.at("efficiency_kg_per_kj") << ", search "
            << search.at("efficiency_kg_per_kj") << " kg/kJ after " << search.at("evaluations")
            << " digs\n";
  EXPECT_EQ(search["source"], "search");
  EXPECT_LE(search["evaluations"].get<int>(), 900 + 190);
  EXPECT_GE(number(search, "/cycle/efficiency_kg_per_kj"),
            number(library, "/cycle/efficiency_kg_per_kj"));
  EXPECT_NEAR(number(search, "/worth"), number(search, "/cycle/efficiency_kg_per_kj"), 1e-12);
  EXPECT_EQ(search.at("start_rule"), "searched with the path");
  const json range = search.at("/ranges_98_percent/drag_length_m"_json_pointer);
  EXPECT_LE(range.at(0), search.at("/path/drag_length_m"_json_pointer));
  EXPECT_GE(range.at(1), search.at("/path/drag_length_m"_json_pointer));
}

TEST_F(Tools, SearchTakesGoalRangesStartAndMethod) {
  const Words few = {"--density", "40", "--search", "--evaluations", "20"};
  const json by_time =
      answer("plan-path", few + Words{"--goal", "time", "--rest-of-cycle", "12s", "--drag-range",
                                      "1m,1.5m", "--start", "6.1"});
  EXPECT_EQ(by_time.at("worth_unit"), "kg/s");
  EXPECT_NEAR(number(by_time, "/worth"),
              number(by_time, "/payload_mass_kg") / number(by_time, "/cycle/time_s"), 1e-9);
  EXPECT_GT(number(by_time, "/cycle/time_s"), 12.0 + number(by_time, "/duration_s"));
  EXPECT_LE(number(by_time, "/path/drag_length_m"), 1.5);
  EXPECT_EQ(number(by_time, "/path/start_x_m"), 6.1);
  const json priced = answer("plan-path", few + Words{"--goal", "priced:3000"});
  EXPECT_NEAR(number(priced, "/worth"),
              number(priced, "/payload_mass_kg") /
                  (number(priced, "/cycle/energy_kj") + 3.0 * number(priced, "/cycle/time_s")),
              1e-9);
  const json paper = answer("plan-path", {"--density", "40", "--search", "--method", "paper",
                                          "--population", "6", "--generations", "2"});
  EXPECT_LE(paper.at("evaluations").get<int>(), 12);
  EXPECT_EQ(paper.at("stopped_by"), "generations");
}

TEST_F(Tools, SearchIsTheSameForAnyNumberOfThreads) {
  const auto plan = [](const char* threads) {
    json result = answer(
        "plan-path", {"--density", "30", "--search", "--evaluations", "40", "--threads", threads});
    result.erase("wall_time_s");
    return result.dump();
  };
  const std::string one = plan("1");
  EXPECT_EQ(one, plan("2"));
  EXPECT_EQ(one, plan("8"));
}

TEST_F(Tools, ABrokenDataFolderIsNamed) {
  const std::string data = folder.file("data");
  fs::copy(EXCAVPLAN_DATA_SOURCE, data, fs::copy_options::recursive);
  ::setenv("EXCAVPLAN_DATA", data.c_str(), 1);
  const auto said = [&](const Words& words) {
    const ProgramResult result = run_program("plan-path", Words{"--density", "40"} + words);
    EXPECT_EQ(result.code, 3) << result.err;
    return result.err;
  };
  const Words report = {"--report", folder.file("report.html")};
  for (const char* broken : {"<p>{{nothing}}</p>", "<p>{{title", "", "{{title}}"}) {
    folder.write("data/report/page.html", broken);
    EXPECT_EQ(said(report),
              "plan-path: " + data + "/report/page.html: is not the template of the reports\n");
  }
  EXPECT_FALSE(fs::exists(report[1]));
  folder.write("data/machines/zx120.json", R"({"format": "excavplan-machine", "version": 1})");
  const std::string urdf = folder.write("digger.urdf", urdf_of(zx120_joints()));
  EXPECT_TRUE(contains(said({"--machine", urdf}), data + "/machines/zx120.json: "));
  ::unsetenv("EXCAVPLAN_DATA");
}

TEST_F(Tools, SearchWarnsOfADamagedShippedLibraryAndGoesOn) {
  const std::string data = folder.file("data");
  fs::copy(EXCAVPLAN_DATA_SOURCE, data, fs::copy_options::recursive);
  folder.write("data/libraries/zx120-loam-cycle.json", R"({"format": "excavplan-path-library")");
  fs::remove(data + "/libraries/zx120-sand-cycle.json");
  ::setenv("EXCAVPLAN_DATA", data.c_str(), 1);
  const Words few = {"--density", "40", "--search", "--evaluations", "10"};
  const json loam = answer("plan-path", few);
  const json sand = answer("plan-path", few + Words{"--soil", "sand"});  // has none
  ::unsetenv("EXCAVPLAN_DATA");
  EXPECT_TRUE(warns(loam, "library_unreadable"));
  EXPECT_EQ(sand.at("warnings"), json::array());
}

TEST_F(Tools, ASearchHasTheGenerationsOfItsHelpHoweverManyDigsItMayMake) {
  EXPECT_TRUE(contains(run_program("plan-path", {"--help"}).out, "0: 20, with --method"));
  const Words many = {"--density", "40", "--search", "--evaluations", "100000"};
  json usual = answer("plan-path", many);
  const json twenty = answer("plan-path", many + Words{"--generations", "20"});
  EXPECT_EQ(usual.at("stopped_by"), "generations");
  usual["wall_time_s"] = twenty.at("wall_time_s");
  EXPECT_EQ(usual, twenty);
}

TEST_F(Tools, InterruptedSearchReportsItAndResumes) {
  const std::string plot = folder.file("best_so_far.svg");
  const Words words = {"--density",     "40", "--search",     "--evaluations",         "500",
                       "--generations", "20", "--checkpoint", folder.file("digs.json")};
  const ProgramResult stopped =
      interrupted("plan-path", words + Words{"--plot", plot}, "generation 0:");
  EXPECT_EQ(stopped.code, 75) << stopped.err;
  EXPECT_TRUE(fs::exists(plot));
  const json resumed = answer("plan-path", words + Words{"--resume"});
  json at_once = answer("plan-path", Words(words.begin(), words.end() - 2));
  at_once["wall_time_s"] = resumed.at("wall_time_s");
  EXPECT_EQ(resumed, at_once);
}

TEST_F(Tools, InterruptedSearchForAnUncertainDensityResumes) {
  const Words words = {"--density",
                       "40",
                       "--density-sd",
                       "8",
                       "--search",
                       "--evaluations",
                       "150",
                       "--generations",
                       "20",
                       "--checkpoint",
                       folder.file("digs.json")};
  const ProgramResult stopped = interrupted("plan-path", words, "generation 0:");
  EXPECT_EQ(stopped.code, 75) << stopped.err;
  EXPECT_FALSE(fs::exists(folder.file("digs.json")));
  EXPECT_TRUE(fs::exists(folder.file("digs.json.soil1")));
  const json resumed = answer("plan-path", words + Words{"--resume"});
  json at_once = answer("plan-path", Words(words.begin(), words.end() - 2));
  at_once["wall_time_s"] = resumed.at("wall_time_s");
  EXPECT_EQ(resumed, at_once);
}

/// Level ground, 2500 points per m2, but for a part of it.
std::string ground_without(const Rectangle& part) {
  std::string points;
  for (int i = 50; i < 500; ++i) {
    for (int j = -90; j < 90; ++j) {
      const double x = 0.02 * i, y = 0.02 * j;
      if (!part.contains(x, y)) points += std::to_string(x) + " " + std::to_string(y) + " 0\n";
    }
  }
  return points;
}

TEST_F(Tools, NoDigGoesWhereTheScanDoesNotSee) {
  const auto cloud = [&](const Rectangle& part) {
    return folder.write("unseen.xyz", ground_without(part));
  };
  const Words plan = {"--density", "40", "--search", "--goal", "energy", "--terrain"};
  const json narrow = answer("plan-path", plan + Words{cloud({5.0, -1.0, 5.2, 1.0})});
  EXPECT_FALSE(warns(narrow, "unseen_ground"));
  const json far = answer("plan-path", plan + Words{cloud({6.0, -1.0, 8.0, 1.0})});
  EXPECT_TRUE(warns(far, "unseen_ground"));
  EXPECT_LT(number(far, "/path/start_x_m"), 6.0);
  EXPECT_LT(number(far, "/efficiency_kg_per_kj"), 1.01 * number(narrow, "/efficiency_kg_per_kj"));
  const json all = answer("plan-path", plan + Words{cloud({2.2, -1.4, 8.8, 1.4}), "--strict"}, 4);
  EXPECT_EQ(all.at("path"), nullptr);
  EXPECT_TRUE(contains(all.at("reason"), "is not known")) << all;
}

TEST_F(Tools, APlanThatMayStallIsNotTrusted) {
  const Words plan = {"--density",
                      "40",
                      "--soil",
                      "clay",
                      "--density-sd",
                      "10",
                      "--search",
                      "--penetration-range",
                      "0.5,0.9",
                      "--angle-range",
                      "60deg,80deg",
                      "--evaluations",
                      "30"};
  const json risky = answer("plan-path", plan);
  EXPECT_GT(number(risky, "/stall_probability"), 0.05);
  EXPECT_TRUE(warns(risky, "may_stall"));
  EXPECT_EQ(run_program("plan-path", plan + Words{"--strict"}).code, 4);
}

TEST_F(Tools, OptionsWithoutEffectAreWarnedOf) {
  const Words few = {"--density", "40", "--population", "6", "--evaluations", "6"};
  const json looked_up = answer("plan-path", few);
  ASSERT_TRUE(warns(looked_up, "options_ignored"));
  EXPECT_EQ(looked_up["warnings"][0]["message"],
            "without effect: --population, --evaluations; nothing is searched without --search");
  const json started = answer("plan-path", {"--density", "40", "--start", "5.7"});
  ASSERT_TRUE(warns(started, "options_ignored"));
  const json searched = answer("plan-path", few + Words{"--search"});
  ASSERT_TRUE(warns(searched, "options_ignored"));
  EXPECT_EQ(searched["warnings"][0]["message"],
            "without effect: --population; the default method has none, --method paper has");
  const json paper = answer("plan-path", few + Words{"--search", "--method", "paper"});
  EXPECT_FALSE(warns(paper, "options_ignored"));
  EXPECT_FALSE(warns(answer("plan-path", {"--density", "40"}), "options_ignored"));
}

TEST_F(Tools, ACellSizeIsOfUseOnlyWhereDigsAreSimulated) {
  const auto ignores = [](const Words& words) {
    return warns(answer("plan-path", Words{"--density", "40", "--cell", "0.06"} + words),
                 "options_ignored");
  };
  EXPECT_TRUE(ignores({}));
  EXPECT_TRUE(ignores({"--density-sd", "0"}));
  EXPECT_FALSE(ignores({"--density-sd", "5"}));
  EXPECT_FALSE(ignores({"--search", "--evaluations", "20"}));
  EXPECT_FALSE(ignores({"--terrain", shipped("quickstart/before.pcd")}));
}

TEST_F(Tools, PlanForAnUncertainDensityGivesTheValueOfKnowingIt) {
  const Words few = {"--search", "--evaluations", "30", "--goal", "energy"};
  const json plan = answer("plan-path", few + Words{"--density", "40", "--density-sd", "8"});
  EXPECT_EQ(plan.at("expected_efficiency_kg_per_kj"), plan.at("worth"));
  EXPECT_GE(number(plan, "/value_of_knowing_percent"), 0.0);
  EXPECT_LT(number(plan, "/value_of_knowing_percent"), 5.0);
  const std::string file = folder.write(
      "result.json", R"({"density_percent": 40, "density_sd_percent": 8, "trustworthy": true})");
  const json from = answer("plan-path", few + Words{"--density-from", file});
  EXPECT_EQ(from.at("path"), plan.at("path"));
}

TEST_F(Tools, FiguresOfAPlanScatterWithTheDensity) {
  const auto answered = [](const Words& words) {
    return answer("plan-path", Words{"--goal", "energy"} + words);
  };
  const json sure = answered({"--density", "40"});
  const json plan = answered({"--density", "40", "--density-sd", "8"});
  EXPECT_EQ(plan.at("path"), sure.at("path"));
  EXPECT_FALSE(sure.contains("efficiency_sd_kg_per_kj"));
  EXPECT_EQ(plan.at("density_sd_percent"), 8.0);
  EXPECT_EQ(plan.at("evaluations"), 3);
  EXPECT_EQ(plan.at("stall_probability"), 0.0);
  // As the best efficiency falls over density, so does that of one path, in first order.
  const double soft = answered({"--density", "32"}).at("efficiency_kg_per_kj");
  const double firm = answered({"--density", "48"}).at("efficiency_kg_per_kj");
  EXPECT_NEAR(plan.at("efficiency_sd_kg_per_kj"), 0.5 * (soft - firm), 0.1 * (soft - firm));
  EXPECT_GT(plan.at("energy_sd_kj"), 0.0);
}

TEST_F(Tools, ADensityByTheLawOfAnotherSoilIsWarnedOf) {
  const std::string result =
      folder.write("result.json", R"({"density_percent": 40, "law_soil": "sand"})");
  const json plan = answer("plan-path", {"--density-from", result});
  const ProgramResult piped = run_program("plan-path", {"--density-from", "-", "--json"}, result);
  EXPECT_EQ(piped.code, 0) << piped.err;
  EXPECT_EQ(json::parse(piped.out).at("path"), plan.at("path"));
  ASSERT_EQ(warning_codes(plan), Words{"law_of_other_soil"});
  EXPECT_EQ(plan["warnings"][0].at("message").get<std::string>().rfind(result + ": ", 0), 0U);
  EXPECT_FALSE(warns(answer("plan-path", {"--density-from", result, "--soil", "sand"}),
                     "law_of_other_soil"));
}

TEST_F(Tools, PlanTakesTheResultOfAnEstimate) {
  const ProgramResult estimate =
      run_program("estimate-density", quickstart(folder) + Words{"--json", "--soil", "loam"});
  const std::string file = folder.write("result.json", estimate.out);
  const json plan = answer("plan-path", {"--density-from", file, "--strict"});
  EXPECT_EQ(plan.at("density_percent"), json::parse(estimate.out).at("density_percent"));
  EXPECT_EQ(plan.at("warnings"), json::array());
}

TEST_F(Tools, ADensityMeasuredElsewhereIsWarnedOf) {
  const auto result = [&](const std::string& extent) {
    return folder.write("result.json", R"({"density_percent": 40, "zones": [
        {"kind": "dump", "extent_m": [5, 3, 6, 4]}, {"kind": "dig", "extent_m": )" +
                                           extent + "}]}");
  };
  const Words ground = {"--terrain", shipped("quickstart/before.pcd")};
  const auto plan = [&](const std::string& file, const Words& more) {
    return answer("plan-path", Words{"--density-from", file} + more);
  };
  const std::string near = result("[4.5, -0.5, 6.1, 0.5]");
  EXPECT_FALSE(warns(plan(near, ground), "density_from_elsewhere"));
  const std::string far = result("[4.5, 19.5, 6.1, 20.5]");
  const json other_site = plan(far, ground);
  EXPECT_TRUE(warns(other_site, "density_from_elsewhere"));
  EXPECT_FALSE(other_site.at("trustworthy"));
  EXPECT_FALSE(warns(plan(far, {}), "density_from_elsewhere"));  // whose ground is not known
}

/// That of the quick start, of before and after the dig that the density is from.
TEST_F(Tools, AScanOfBeforeTheDigThatTheDensityIsFromIsNotTrusted) {
  if (!std::filesystem::exists(std::string(EXCAVPLAN_BIN) + "/estimate-density")) GTEST_SKIP();
  const json estimate = answer("estimate-density", quickstart(folder));
  const std::string file = folder.write("density.json", estimate.dump());
  for (const char* scan : {"before", "after"}) {
    const json plan = answer("plan-path", {"--density-from", file, "--terrain",
                                           shipped(std::string("quickstart/") + scan + ".pcd")});
    EXPECT_EQ(warns(plan, "ground_before_dig"), scan == std::string("before"))
        << plan.at("warnings");
  }
}

// docs/formats.md: more than 5 m from the hole. The holes are long in x, so that the distance is
// that of their nearer edge from y = 0.
TEST_F(Tools, ADensityMeasuredElsewhereIsOneOfMoreThanFiveMetresOff) {
  const auto is_elsewhere = [&](const std::string& y_min, const std::string& y_max) {
    const std::string file = folder.write("result.json", R"({"density_percent": 40, "zones": [
        {"kind": "dig", "extent_m": [-50, )" + y_min + ", 50, " +
                                                             y_max + "]}]}");
    const json plan = answer(
        "plan-path", {"--density-from", file, "--terrain", shipped("quickstart/before.pcd")});
    return warns(plan, "density_from_elsewhere");
  };
  EXPECT_FALSE(is_elsewhere("4.8", "6"));
  EXPECT_TRUE(is_elsewhere("5.2", "6"));
  EXPECT_FALSE(is_elsewhere("-6", "-4.8"));
  EXPECT_TRUE(is_elsewhere("-6", "-5.2"));
}

TEST_F(Tools, ADensityAboveTheRangeIsPlannedWithAllItMayBe) {
  const std::string law = folder.file("stiff.json");
  const std::string digs = folder.write(
      "stiff.csv", "bulking_factor,density_percent\n1.00,40\n1.08,60\n1.14,80\n1.20,100\n");
  answer("calibrate-density", {"--samples", digs, "--out", law});
  const json estimate = answer("estimate-density", quickstart(folder) + Words{"--law", law});
  EXPECT_EQ(number(estimate, "/density_percent"), 100.0);
  const double excess = number(estimate, "/density_raw_percent") - 100.0;
  EXPECT_GT(excess, 3.0);
  EXPECT_GE(number(estimate, "/density_sd_percent"), excess);
  EXPECT_LT(number(estimate, "/density_interval_percent/0"), 100.0 - excess);
  const json plan =
      answer("plan-path", {"--density-from", folder.write("hard.json", estimate.dump())});
  EXPECT_EQ(plan["density_sd_percent"], estimate["density_sd_percent"]);
}

TEST_F(Tools, PlanWarnsOfAnEstimateThatShouldNotBeTrusted) {
  const std::string file =
      folder.write("result.json", R"({"density_percent": 100, "trustworthy": false})");
  EXPECT_TRUE(warns(answer("plan-path", {"--density-from", file}), "density_not_trustworthy"));
  answer("plan-path", {"--density-from", file, "--strict"}, 4);
}

TEST_F(BadInput, ResultsWithoutADensityAreRefused) {
  const std::string file = folder.file("result.json");
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {R"({"density_percent": null})",
            "density_percent: is null, as the scans gave no density"},
           {R"({"density_percent": "40"})", "density_percent: is \"40\", expected a number"},
           {R"({"density_percent": 140})", "density_percent: is 140, must be in 0 .. 100"},
           {R"({"bulking_factor": 1.2})", "density_percent: is missing"},
           {R"({"tool": "estimate-density", "density_percent": 40, "law_soil": null})",
            "density_sd_percent: is missing"},
           {R"({"tool": "plan-path", "density_percent": 40})",
            "tool: is \"plan-path\", expected a result of estimate-density --json"},
           {R"({"format": "excavplan-law", "density_percent": 40})",
            "format: is \"excavplan-law\", expected a result of estimate-density --json"},
           {R"({"density_percent": 40, "density_sd_percent": 1e9})",
            "density_sd_percent: is 1e+09, must be in 0 .. 1000"},
           {R"({"density_percent": 40, "trustworthy": "yes"})",
            "trustworthy: is \"yes\", expected true or false"},
           {R"({"density_percent": 40, "law_soil": 3})", "law_soil: is 3, expected a text"},
           {R"({"density_percent": 40, "law": {}})", "law: is {}, expected a text"},
           {R"({"density_percent": 40, "zones": "here"})", "zones: expected a list of objects"},
           {R"({"density_percent": 40, "zones": [{"kind": "dig", "extent_m": [1, 2]}]})",
            "zones[0].extent_m: expected a list of 4 numbers, got [1,2]"},
           {R"({"density_percent": 40, "zones": [{"kind": "dig", "extent_m": [2, 0, 1, 1]}]})",
            "zones[0].extent_m: must be [x_min, y_min, x_max, y_max]"},
           {"[40]", "expected a result of estimate-density --json"},
           {R"({"density_percent": 40, "density_percent": 80})", "appears twice"},
           {"{\"zones\": " + std::string(100000, '['), "more than 64 levels"},
           {"", "not valid JSON"}}) {
    folder.write("result.json", text);
    refused(3, reason, "plan-path", {"--density-from", file, "--plot", plot});
  }
  refused(3, "none.json: ", "plan-path", {"--density-from", folder.file("none.json")});
  refused(2, "give either --density, --density-from or --site", "plan-path", {});
  refused(2, "--goal priced: the price of time is -5, must be in 0 .. 1e+09 W", "plan-path",
          {"--density", "40", "--goal", "priced:-5"});
  refused(2, "--density excludes --density-from", "plan-path",
          {"--density", "40", "--density-from", file});
}

TEST_F(BadInput, ALibraryOfAnotherSoilIsNamedByItsFile) {
  const std::string file = shipped("libraries/zx120-sand-cycle.json");
  refused(2, file + ": does not fit", "plan-path", {"--density", "40", "--library", file});
}

TEST_F(BadInput, SearchOptionsAreRefusedByName) {
  const Words search = {"--density", "40", "--search"};
  refused(2, "--goal: 'speed'", "plan-path", search + Words{"--goal", "speed"});
  refused(2, "--drag-range: '2' is not FROM,TO", "plan-path", search + Words{"--drag-range", "2"});
  refused(2, "upper end of the search range of the drag length is 1,", "plan-path",
          search + Words{"--drag-range", "2,1"});
  refused(2, "--resume needs --checkpoint", "plan-path", search + Words{"--resume"});
}

TEST_F(Tools, SearchWithoutADigNamesTheNearestAndItsLimit) {
  const Words steep = {"--search",      "--evaluations", "5",
                       "--angle-range", "1.4,1.4",       "--penetration-range",
                       "0.9,0.9",       "--drag-range",  "3,3"};
  const std::string nearest =
      "no dig inside the search ranges can be done on this ground; the nearest, 80.2 deg, 0.900 m, "
      "3.00 m from x = 6.";
  for (const Words& density :
       {Words{"--density", "40"}, {"--density", "40", "--density-sd", "8"}}) {
    const json none = answer("plan-path", steep + density);
    EXPECT_EQ(none.at("path"), nullptr);
    EXPECT_TRUE(contains(none.at("reason"), nearest)) << none;
    EXPECT_TRUE(warns(none, "no_dig"));
    answer("plan-path", steep + density + Words{"--strict"}, 4);
  }
}

TEST_F(Tools, WithoutADigNoTrajectoryOfAnEarlierPlanStays) {
  const auto plan_to = [&](const std::string& name, const Words& more) {
    return answer("plan-path", Words{"--density", "40", "--trajectory", folder.file(name), "--plot",
                                     folder.file("dig.svg")} +
                                   more);
  };
  const Words none = {"--search",      "--evaluations", "5",
                      "--angle-range", "1.4,1.4",       "--penetration-range",
                      "0.9,0.9",       "--drag-range",  "3,3"};
  for (const std::string name : {"dig.csv", "dig.json"}) {
    const json made = plan_to(name, {});
    EXPECT_EQ(made.at("trustworthy"), true);
    EXPECT_EQ(made.at("soil"), "loam");
    EXPECT_EQ(made.at("machine"), "zx120");
    EXPECT_EQ(made.at("simulator"), "height-map");
    const std::size_t size = content_of(folder.file(name)).size();
    const json left = plan_to(name, none);
    EXPECT_EQ(left.at("trustworthy"), false);
    EXPECT_TRUE(warns(left, "plot_not_written"));
    EXPECT_LT(content_of(folder.file(name)).size(), size / 10) << name;
  }
  EXPECT_EQ(json::parse(content_of(folder.file("dig.json"))).at("points"), json::array());
}

TEST_F(Tools, ADigThatLiftsNextToNothingIsNotWorthMaking) {
  const json none =
      answer("plan-path",
             {"--density", "40", "--search", "--evaluations", "10", "--drag-range", "0.3,0.3",
              "--penetration-range", "0.01,0.02", "--angle-range", "0.2,0.4", "--strict"},
             4);
  EXPECT_EQ(none.at("path"), nullptr);
  EXPECT_TRUE(contains(none.at("reason"), "no dig is worth making")) << none;
  EXPECT_EQ(none.at("goal"), "cycle");
}

TEST_F(Tools, PlansForTheCycleAndForThePapersGoal) {
  const json cycle = answer("plan-path", {"--density", "10"});
  const json energy = answer("plan-path", {"--density", "10", "--goal", "energy"});
  EXPECT_GE(number(cycle, "/fill_fraction"), 0.8);
  EXPECT_GT(number(energy, "/efficiency_kg_per_kj"), number(cycle, "/efficiency_kg_per_kj"));
  EXPECT_LT(number(energy, "/cycle/efficiency_kg_per_kj"),
            number(cycle, "/cycle/efficiency_kg_per_kj"));
  const Words few = {"--density", "40", "--search", "--evaluations", "20"};
  const json far = answer("plan-path", few + Words{"--swing", "180deg", "--dump-height", "4m"});
  const json near = answer("plan-path", few + Words{"--swing", "30deg", "--dump-height", "2m"});
  for (const char* figure : {"/cycle/energy_kj", "/cycle/time_s"}) {
    EXPECT_GT(number(far, figure), number(near, figure)) << figure;
  }
  const ProgramResult text = run_program("plan-path", {"--density", "40"});
  EXPECT_TRUE(contains(text.out, "of the heaped capacity")) << text.out;
  EXPECT_TRUE(contains(text.out, "kg/kJ, of the cycle ")) << text.out;
  EXPECT_TRUE(contains(text.out, "t/h, of the cycle ")) << text.out;
}

TEST_F(BadInput, OptionsOfTheGoalThatHaveNoEffectOrNoLibraryAreRefused) {
  const Words plan = {"--density", "40"};
  for (const char* option : {"--swing", "--dump-height", "--rest-of-cycle"}) {
    refused(2, std::string(option) + " has no effect on the goal energy", "plan-path",
            plan + Words{"--search", "--goal", "energy", option, "2"});
    refused(2, "does not fit; its goal is cycle", "plan-path", plan + Words{option, "2"});
  }
  refused(2, "no library of zx120 in loam for the goal time is shipped", "plan-path",
          plan + Words{"--goal", "time"});
  refused(2,
          "the smallest fill of the bucket, as a fraction of its heaped capacity is 2, must be in "
          "0 .. 1\nSee",
          "plan-path", plan + Words{"--min-fill", "2"});
  refused(2, "the dump height is 12 m, the bucket pin reaches", "plan-path",
          plan + Words{"--search", "--dump-height", "12"});
}

TEST_F(RealScans, OfASiteAreGroundToPlanOn) {
  const json library = answer("plan-path", {"--density", "40", "--terrain", terrain});
  EXPECT_EQ(library.at("source"), "library");
  EXPECT_TRUE(warns(library, "sparse_terrain"));
  const std::string csv = folder.file("dig.csv");
  const std::string plot = folder.file("dig.svg");
  const json search = answer("plan-path", {"--density", "40", "--terrain", terrain, "--search",
                                           "--trajectory", csv, "--plot", plot});
  std::cout << "  library " << library.at("efficiency_kg_per_kj") << ", search "
            << search.at("efficiency_kg_per_kj") << " kg/kJ\n";
  EXPECT_GE(number(search, "/cycle/efficiency_kg_per_kj"),
            number(library, "/cycle/efficiency_kg_per_kj"));
  EXPECT_EQ(content_of(csv).rfind("time_s,phase,", 0), 0U);
  expect_figure(plot, {"scoop"});
}

TEST_F(Tools, ADensityOfAnySoilIsNamed) {
  const auto planned = [&](const std::string& law) {
    const json estimate = {{"density_percent", 58.0}, {"density_sd_percent", 0.0}, {"law", law}};
    return answer("plan-path", {"--density-from", folder.write("estimate.json", estimate.dump())});
  };
  EXPECT_TRUE(warns(planned("any soil"), "density_of_unknown_soil"));
  EXPECT_FALSE(warns(planned("zx120-loam"), "density_of_unknown_soil"));
}

TEST_F(Tools, ReportOfAPlanShowsThePlannedGroundAndTheTrajectory) {
  const std::string file = folder.file("report.html");
  const json plan = answer(
      "plan-path", {"--density", "40", "--report", file, "--trajectory", folder.file("dig.json")});
  const json scene = drawn_on(content_of(file));
  EXPECT_EQ(scene["areas"][0]["states"][1]["name"], "planned");
  const json written = json::parse(content_of(folder.file("dig.json")));
  const json& dig = scene["digs"][0];
  ASSERT_EQ(dig["time_s"].size(), written["points"].size());
  EXPECT_NEAR(dig["time_s"].back().get<double>(), written["points"].back()["time_s"].get<double>(),
              1e-6);
  EXPECT_NEAR(dig["loads"]["energy_kj"].back().get<double>(), number(plan, "/energy_kj"), 0.01);
}

TEST_F(Tools, ReportOfNoPlanSaysSo) {
  const std::string file = folder.file("report.html");
  answer("plan-path",
         {"--density", "40", "--search", "--evaluations", "5", "--angle-range", "1.4,1.4",
          "--penetration-range", "0.9,0.9", "--drag-range", "3,3", "--report", file});
  const std::string page = content_of(file);
  EXPECT_TRUE(contains(page, "There is no dig.</strong> 1 warning"));
  EXPECT_TRUE(contains(page, "<code>no_dig</code>"));
  EXPECT_EQ(drawn_on(page)["digs"].size(), 0U);
}

}  // namespace
}  // namespace excavplan::test
