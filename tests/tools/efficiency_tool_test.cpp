// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include <nlohmann/json.hpp>

#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

/// The tool in a folder of logs.
class MeasureEfficiency : public testing::Test {
 protected:
  ProgramResult run(Words words) const {
    return run_program("measure-efficiency", std::move(words));
  }

  json measured(Words words) const {
    words.emplace_back("--json");
    const ProgramResult result = run(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return json::parse(result.out, nullptr, false);
  }

  /// What the tool refuses with this code, its name and the folder left out.
  std::string refusal(int code, const Words& words) const {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.code, code) << result.err;
    EXPECT_EQ(result.out, "");
    std::string text = result.err.substr(0, result.err.find('\n'));
    const std::string start = "measure-efficiency: ";
    if (text.rfind(start, 0) == 0) text.erase(0, start.size());
    const std::string place = folder.file("");
    for (auto at = text.find(place); at != text.npos; at = text.find(place)) {
      text.erase(at, place.size());
    }
    return text;
  }

  std::string log(const std::string& name, const std::string& columns,
                  const std::string& rows) const {
    return folder.write(name, "time_s," + columns + "\n" + rows);
  }

  TemporaryFolder folder;
};

Words codes(const json& result) {
  Words list;
  for (const json& warning : result.at("warnings")) list.push_back(warning.at("code"));
  return list;
}

// ---- Oracles ----------------------------------------------------------------------------------

TEST_F(MeasureEfficiency, FindsTheGainOfThePaper) {
  // Yajima et al. 2026, section 4.3: 0.166 and 0.212 m3/mL, +27.7 %.
  const std::string fixed = log("fixed.csv", "fuel_flow_ml_per_s", "0,0.25\n8,0.25\n");
  const std::string planned = log("planned.csv", "fuel_flow_ml_per_s", "0,0.5\n4,0.5\n");
  const json result = measured({fixed, planned, "--volume", "0.332", "--second-volume", "424L"});
  EXPECT_NEAR(result.at("gain_percent").get<double>(), 27.7, 0.05);
  EXPECT_TRUE(result.at("gain_sd_percent").is_null());
  ASSERT_EQ(result.at("runs").size(), 2U);
  EXPECT_NEAR(result["runs"][0].at("efficiency_m3_per_ml").get<double>(), 0.166, 1e-12);
  EXPECT_NEAR(result["runs"][1].at("efficiency_m3_per_ml").get<double>(), 0.212, 1e-12);
  EXPECT_EQ(codes(result), Words(2, "implausible_fuel"));
}

TEST_F(MeasureEfficiency, WarnsOfOptionsOfScansThatAreNotGiven) {
  const std::string file = log("a.csv", "fuel_flow_ml_per_s", "10,1\n18,1\n");
  const json plain = measured({file, "--mass", "480"});
  const json ignored = measured({file, "--mass", "480", "--level", "--cell", "0.1"});
  ASSERT_EQ(codes(ignored).back(), "options_ignored");
  EXPECT_EQ(ignored["warnings"].back()["message"],
            "without effect: --level, --cell; there are no scans");
  EXPECT_EQ(ignored["warnings"].size(), plain["warnings"].size() + 1);
}

TEST_F(MeasureEfficiency, IntegratesFuelByTheTrapezoidRule) {
  const std::string file = log("a.csv", "fuel_flow_ml_per_s", "10,0\n12,4\n13,4\n17,0\n");
  const json run = measured({file, "--volume", "0.4"}).at("runs").at(0);
  EXPECT_DOUBLE_EQ(run.at("fuel_ml").get<double>(), 4.0 + 4.0 + 8.0);
  EXPECT_DOUBLE_EQ(run.at("duration_s").get<double>(), 7.0);
  EXPECT_DOUBLE_EQ(run.at("efficiency_m3_per_ml").get<double>(), 0.4 / 16.0);
}

TEST_F(MeasureEfficiency, CutsADigOutOfALongerLog) {
  const std::string file = log("a.csv", "fuel_flow_ml_per_s", "10,0\n12,4\n13,4\n17,0\n");
  // From 11 s (2 mL/s) to 15 s (2 mL/s): 3 + 4 + 6.
  const json run =
      measured({file, "--volume", "0.4", "--from", "11", "--to", "15s"}).at("runs").at(0);
  EXPECT_DOUBLE_EQ(run.at("fuel_ml").get<double>(), 13.0);
  EXPECT_DOUBLE_EQ(run.at("duration_s").get<double>(), 4.0);
}

TEST_F(MeasureEfficiency, PartsOfALogAddUp) {
  const std::string file = log("a.csv", "power_w", "0,500\n1,-900\n2.5,1200\n4,300\n9,-10\n");
  const auto energy = [&](const std::string& from, const std::string& to) {
    const json result = measured({file, "--mass", "700", "--from", from, "--to", to});
    return result.at("runs").at(0).at("energy_kj").get<double>();
  };
  EXPECT_NEAR(energy("0", "1.2345") + energy("1.2345", "3") + energy("3", "9"), energy("0", "9"),
              1e-12);
}

TEST_F(MeasureEfficiency, LitresPerHourAreMillilitresPerSecond) {
  const std::string hourly = log("h.csv", "fuel_flow_l_per_h", "0,7.2\n9,7.2\n");
  EXPECT_DOUBLE_EQ(measured({hourly, "--mass", "600"}).at("runs").at(0).at("fuel_ml").get<double>(),
                   18.0);
}

TEST_F(MeasureEfficiency, NegativeJointPowerCountsAsZero) {
  // The boom runs from +3 to -1 kW in 4 s: its positive part is a triangle of 3 kW and 3 s. The arm
  // takes 2 kW; the bucket only gives back.
  const std::string joints = log("j.csv", "boom_power_w,arm_power_w,bucket_power_w",
                                 "0,3000,2000,-500\n4,-1000,2000,-900\n");
  const json run = measured({joints, "--mass", "500"}).at("runs").at(0);
  EXPECT_DOUBLE_EQ(run.at("energy_kj").get<double>(), 4.5 + 8.0);
  EXPECT_DOUBLE_EQ(run.at("efficiency_kg_per_kj").get<double>(), 500.0 / 12.5);
}

TEST_F(MeasureEfficiency, GainCarriesTheErrorOfBothPayloads) {
  const std::string file = log("a.csv", "power_w", "0,1000\n10,1000\n");
  const json result = measured({file, file, "--mass", "500", "--mass-sd", "15", "--second-mass",
                                "600", "--second-mass-sd", "24"});
  EXPECT_NEAR(result.at("gain_percent").get<double>(), 20.0, 1e-12);
  EXPECT_NEAR(result.at("gain_sd_percent").get<double>(), 120.0 * std::hypot(0.03, 0.04), 1e-12);
  EXPECT_TRUE(result.at("trustworthy").get<bool>());
}

/// Level ground 4 x 4 m with a cone on it, a point every 2 cm.
std::string cone(double radius, double height) {
  std::string text;
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 200; ++j) {
      const double x = 4.0 + 0.02 * i;
      const double y = -2.0 + 0.02 * j;
      const double z = height * std::max(0.0, 1.0 - std::hypot(x - 6.0, y) / radius);
      text += std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z) + '\n';
    }
  }
  return text;
}

TEST_F(MeasureEfficiency, HeapBetweenTwoScansHasTheVolumeOfACone) {
  const std::string file = log("a.csv", "fuel_flow_ml_per_s", "0,2\n10,2\n");
  const std::string before = folder.write("before.xyz", cone(1.0, 0.0));
  const std::string after = folder.write("after.xyz", cone(0.8, 0.45));
  const json result = measured({file, "--dump-before", before, "--dump-after", after});
  const json run = result.at("runs").at(0);
  const double volume = std::acos(-1.0) * 0.8 * 0.8 * 0.45 / 3.0;
  EXPECT_NEAR(run.at("volume_m3").get<double>(), volume, 0.005 * volume);
  EXPECT_GT(run.at("volume_sd_m3").get<double>(), 0.0);
  EXPECT_LT(run.at("volume_sd_m3").get<double>(), 0.01);
  EXPECT_DOUBLE_EQ(run.at("efficiency").get<double>(), run.at("volume_m3").get<double>() / 20.0);
  EXPECT_EQ(codes(result), Words{});
  EXPECT_EQ(refusal(3, {file, "--dump-before", after, "--dump-after", before}),
            "after.xyz, before.xyz: no ground rose by more than the noise of the scans");
}

TEST_F(MeasureEfficiency, ScansAreBroughtIntoTheSiteFrame) {
  const std::string file = log("a.csv", "fuel_flow_ml_per_s", "0,2\n10,2\n");
  const std::string before = folder.write("before.xyz", cone(1.0, 0.0));
  const std::string after = folder.write("after.xyz", cone(0.8, 0.45));
  const std::string far = folder.write("far.txt", "1 0 0 20\n0 1 0 0\n0 0 1 0.3\n0 0 0 1\n");
  const Words words = {file, "--dump-before", before, "--dump-after", after, "--before-frame", far};
  EXPECT_EQ(
      refusal(3, words),
      "before.xyz and after.xyz do not overlap: x 24.0 .. 28.0, y -2.00 .. 1.98 m and x 4.00 .. "
      "7.98, y -2.00 .. 1.98 m; --before-frame and --after-frame transform them into one frame");
  Words both = words;
  both.insert(both.end(), {"--after-frame", far});
  EXPECT_NEAR(measured(both).at("runs").at(0).at("volume_m3").get<double>(), 0.3016, 0.002);
}

TEST_F(MeasureEfficiency, TextsNameItsOwnOptions) {
  const std::string help = run({"--help"}).out;
  const std::string file = log("a.csv", "fuel_flow_ml_per_s", "0,2\n10,2\n");
  const auto heap_and_slump = [](double height) {
    std::string rows;
    for (int i = 0; i < 200; ++i) {
      for (int j = 0; j < 200; ++j) {
        const bool heap = std::hypot(i - 60, j - 100) < 30.0;
        const bool slump = std::hypot(i - 160, j - 100) < 25.0;
        const double z = (heap ? height : 0.0) - (slump ? 0.5 * height : 0.0);
        rows += std::to_string(4.0 + 0.02 * i) + " " + std::to_string(-2.0 + 0.02 * j) + " " +
                std::to_string(z) + "\n";
      }
    }
    return rows;
  };
  const std::string before = folder.write("before.xyz", heap_and_slump(0.0));
  const std::string after = folder.write("after.xyz", heap_and_slump(0.4));
  for (const auto& [area, code] :
       {std::pair("3,-3,9,3", "other_change"), std::pair("4.8,-3,9,3", "zone_at_border")}) {
    const json result =
        measured({file, "--dump-before", before, "--dump-after", after, "--area", area});
    const Words found = codes(result);
    EXPECT_NE(std::count(found.begin(), found.end(), code), 0) << code;
    const std::string text = result.at("warnings").dump();
    for (auto at = text.find("--"); at != text.npos; at = text.find("--", at + 2)) {
      const auto end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", at);
      EXPECT_NE(help.find("  " + text.substr(at, end - at) + " "), help.npos) << text;
    }
  }
}

// ---- What is given ----------------------------------------------------------------------------

TEST_F(MeasureEfficiency, KeysThatDoNotApplyAreNull) {
  const std::string file = log("a.csv", "fuel_flow_ml_per_s", "0,2\n10,2\n");
  const json result = measured({file, "--mass", "0.7t"});
  const json run = result.at("runs").at(0);
  for (const char* key : {"volume_m3", "volume_sd_m3", "mass_sd_kg", "energy_kj", "efficiency_sd",
                          "efficiency_m3_per_ml", "efficiency_m3_per_kj", "efficiency_kg_per_kj"}) {
    EXPECT_TRUE(run.at(key).is_null()) << key;
  }
  EXPECT_EQ(run.at("file"), file);
  EXPECT_EQ(run.at("mass_kg"), 700.0);
  EXPECT_EQ(run.at("efficiency_kg_per_ml"), 35.0);
  EXPECT_EQ(run.at("efficiency"), 35.0);
  EXPECT_EQ(run.at("efficiency_unit"), "kg_per_ml");
  EXPECT_TRUE(result.at("gain_percent").is_null());
  EXPECT_TRUE(result.at("gain_sd_percent").is_null());
}

TEST_F(MeasureEfficiency, EachKindOfEfficiencyHasItsKey) {
  const std::string fuel = log("f.csv", "fuel_flow_ml_per_s", "0,2\n10,2\n");
  const std::string power = log("p.csv", "power_w", "0,2000\n10,2000\n");
  for (const auto& [words, unit, value] : std::vector<std::tuple<Words, std::string, double>>{
           {{fuel, "--volume", "0.4"}, "m3_per_ml", 0.02},
           {{power, "--volume", "0.4"}, "m3_per_kj", 0.02},
           {{fuel, "--mass", "500"}, "kg_per_ml", 25.0},
           {{power, "--mass", "500"}, "kg_per_kj", 25.0}}) {
    const json run = measured(words).at("runs").at(0);
    EXPECT_EQ(run.at("efficiency_unit"), unit);
    EXPECT_DOUBLE_EQ(run.at("efficiency_" + unit).get<double>(), value);
  }
}

TEST_F(MeasureEfficiency, PeopleGetALineForEachRunAndTheGain) {
  const std::string file = log("a.csv", "fuel_flow_ml_per_s", "0,2\n10,2\n");
  const ProgramResult result = run({file, file, "--volume", "0.4", "--second-volume", "0.5"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out, file + ": 0.400 m3, 20.00 ± 0.40 mL in 10.0 s: 0.0200 m3/mL\n" + file +
                            ": 0.500 m3, 20.00 ± 0.40 mL in 10.0 s: 0.0250 m3/mL\n" +
                            "gain of the second: 25.0 %\n");
  EXPECT_EQ(result.err, "");
}

TEST_F(MeasureEfficiency, ImplausiblyLowFuelIsNotTrustworthy) {
  // 1000 times too little: litres taken for millilitres.
  const std::string file = log("a.csv", "fuel_flow_ml_per_s", "0,0.002\n10,0.002\n");
  const Words words = {file, "--volume", "0.4", "--strict", "--json"};
  const ProgramResult result = run(words);
  EXPECT_EQ(result.code, 4);
  const json parsed = json::parse(result.out, nullptr, false);
  EXPECT_EQ(codes(parsed), Words{"implausible_fuel"});
  EXPECT_FALSE(parsed.at("trustworthy").get<bool>());
  EXPECT_EQ(codes(measured({file, "--mass", "600"})), Words{"implausible_fuel"});
  const std::string good = log("b.csv", "fuel_flow_l_per_h", "0,8\n8,8\n");
  EXPECT_EQ(run({good, "--volume", "0.45", "--strict"}).code, 0);
}

TEST_F(MeasureEfficiency, WarnsOfAGapInTheLog) {
  std::string rows;
  for (int i = 0; i < 50; ++i) rows += std::to_string(0.1 * i) + ",2\n";
  const std::string whole = log("a.csv", "fuel_flow_ml_per_s", rows);
  const std::string torn = log("b.csv", "fuel_flow_ml_per_s", rows + "7,2\n");
  EXPECT_EQ(codes(measured({whole, "--volume", "0.2"})), Words{});
  EXPECT_EQ(codes(measured({torn, "--volume", "0.2"})), Words{"gap_in_log"});
  EXPECT_EQ(codes(measured({torn, "--volume", "0.2", "--to", "4.5"})), Words{});
}

// ---- Bad input --------------------------------------------------------------------------------

TEST_F(MeasureEfficiency, TimeMustRise) {
  const auto message = [&](const std::string& rows) {
    return refusal(3, {log("a.csv", "power_w", rows), "--mass", "1"});
  };
  EXPECT_EQ(message("0,1\n1,1\n0.5,1\n"),
            "a.csv: line 4: time_s is 0.5 s, must be above 1 s of the row before");
  EXPECT_EQ(message("0,1\n0,1\n"),
            "a.csv: line 3: time_s is 0 s, must be above 0 s of the row before");
  EXPECT_EQ(message("0,1\n"), "a.csv: holds one row, at least 2 are needed");
}

TEST_F(MeasureEfficiency, ColumnsMustGiveEitherFuelOrEnergy) {
  const auto message = [&](const std::string& columns, const std::string& rows) {
    return refusal(3, {log("a.csv", columns, rows), "--mass", "1"});
  };
  EXPECT_EQ(message("speed", "0,1\n1,1\n"),
            "a.csv: has no column of fuel or power, expected one of fuel_flow_ml_per_s, "
            "fuel_flow_l_per_h, power_w, or of boom, arm and bucket each boom_power_w, "
            "boom_torque_n_m with boom_rate_rad_per_s, or boom_head_pressure_pa with "
            "boom_rod_pressure_pa and boom_piston_speed_m_per_s; its columns are: time_s, speed: "
            "give --rate-column");
  EXPECT_EQ(message("fuel_flow_ml_per_s,power_w", "0,1,1\n1,1,1\n"),
            "a.csv: holds both fuel_flow_ml_per_s and power_w, expected one of them: give --meter");
  EXPECT_EQ(message("boom_power_w,arm_power_w", "0,1,1\n1,1,1\n"),
            "a.csv: has no column of bucket_power, but of another joint; all three are needed");
  EXPECT_EQ(message("power_w", "0,-5\n1,-5\n"),
            "a.csv: power adds up to 0 kJ from 0 to 1 s, must be above 0");
}

TEST_F(MeasureEfficiency, PayloadIsGivenInOneWay) {
  const std::string a = log("a.csv", "power_w", "0,1\n1,1\n");
  const std::string ask =
      "payload of a.csv: give exactly one of --volume, --bank-volume, --mass, or scans of dump, "
      "pit or bucket (--dump-before with --dump-after and so on)";
  EXPECT_EQ(refusal(2, {a}), ask);
  EXPECT_EQ(refusal(2, {a, "--volume", "1", "--mass", "1"}), ask);
  EXPECT_EQ(refusal(2, {a, a, "--mass", "1"}),
            "payload of a.csv: give exactly one of --second-volume, --second-bank-volume, "
            "--second-mass, or scans of dump, pit or bucket (--second-dump-before with "
            "--second-dump-after and so on)");
  EXPECT_EQ(refusal(2, {a, "--dump-before", "x"}),
            "--dump-before needs --dump-after, which is missing");
  EXPECT_EQ(refusal(2, {a, "--mass", "1", "--volume-sd", "1"}),
            "--volume-sd needs --volume, which is missing");
  EXPECT_EQ(refusal(2, {a, "--mass", "0"}), "--mass: 0, must be above 0");
  EXPECT_EQ(refusal(2, {a, "--mass", "1", "--mass-sd", "-1"}),
            "--mass-sd: -1, must be 0 or more and at most the amount");
  EXPECT_EQ(refusal(2, {a, "--mass", "1", "--mass-sd", "1e308"}),
            "--mass-sd: 1e+308, must be 0 or more and at most the amount");
  EXPECT_EQ(refusal(2, {a, "--volume", "0,391"}),
            "--volume: '0,391' has a comma where decimals follow a point, expected a volume such "
            "as 0.4 or 400L");
  EXPECT_EQ(refusal(2, {a, "--mass", "1", "--second-mass", "1"}),
            "SECOND.csv is missing, but options of a second dig are given");
}

TEST_F(MeasureEfficiency, CutsOutsideTheLogAreRefused) {
  const std::string a = log("a.csv", "power_w", "1,1\n3,1\n");
  EXPECT_EQ(refusal(2, {a, "--mass", "1", "--from", "0"}),
            "--from: 0 s is outside a.csv, which runs from 1 to 3 s");
  EXPECT_EQ(refusal(2, {a, a, "--mass", "1", "--second-mass", "1", "--second-to", "4"}),
            "--second-to: 4 s is outside a.csv, which runs from 1 to 3 s");
  EXPECT_EQ(refusal(2, {a, "--mass", "1", "--from", "2", "--to", "2"}),
            "--from: 2 s must be before --to, 2 s");
}

TEST_F(MeasureEfficiency, RunsOfTwoKindsAreNotCompared) {
  const std::string power = log("p.csv", "power_w", "0,1\n1,1\n");
  const std::string fuel = log("f.csv", "fuel_flow_ml_per_s", "0,1\n1,1\n");
  EXPECT_EQ(refusal(2, {power, fuel, "--mass", "1", "--second-mass", "1"}),
            "the runs cannot be compared: p.csv is in kg/kJ, f.csv in kg/mL");
}

TEST_F(MeasureEfficiency, MissingAndForeignFilesAreNamed) {
  EXPECT_EQ(refusal(3, {folder.file("no.csv"), "--mass", "1"}),
            "no.csv: cannot be opened: No such file or directory");
  const std::string a = log("a.csv", "power_w", "0,1\n1,1\n");
  EXPECT_EQ(refusal(3, {a, "--dump-before", a, "--dump-after", a}),
            "a.csv: line 1: found 'time_s,power_w', expected numbers, or names of columns with x, "
            "y and z");
  EXPECT_EQ(refusal(2, {}),
            "RUN.csv is missing: log of a dig; or a set of runs by --runs and --against");
  EXPECT_EQ(refusal(2, {a, "--volumes", "1"}), "unknown option --volumes, did you mean --volume?");
}

}  // namespace
}  // namespace excavplan::test
