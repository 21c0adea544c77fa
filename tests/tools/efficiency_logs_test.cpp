// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "support/run_program.hpp"
#include "support/svg_figure.hpp"
#include "support/svg_layout.hpp"
#include "support/tool_answers.hpp"
#include "support/utf16.hpp"

namespace excavplan::test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

/// Logs as spreadsheets and loggers write them, through measure-efficiency.
class EfficiencyLogs : public testing::Test {
 protected:
  json run(const std::string& log, Words options = {}) const {
    options.insert(options.begin(), {folder.write("log.csv", log), "--json"});
    if (std::find(options.begin(), options.end(), "--mass") == options.end()) {
      options.insert(options.end(), {"--volume", "0.4"});
    }
    const ProgramResult result = run_program("measure-efficiency", options);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.code == 0 ? json::parse(result.out).at("runs").at(0) : json();
  }

  double fuel(const std::string& log, Words options = {}) const {
    const json found = run(log, std::move(options));
    return found.is_null() ? NAN : found.at("fuel_ml").get<double>();
  }

  std::string refusal(const std::string& log, Words options = {}) const {
    const std::string path = folder.write("log.csv", log);
    options.insert(options.begin(), {path, "--volume", "0.4"});
    const ProgramResult result = run_program("measure-efficiency", options);
    EXPECT_NE(result.code, 0);
    std::string text = result.err.substr(0, result.err.find('\n'));
    if (const auto at = text.find(path); at != text.npos) text.replace(at, path.size(), "log.csv");
    return text.substr(text.find(' ') + 1);
  }

  TemporaryFolder folder;
};

TEST_F(EfficiencyLogs, TwelveDialectsHoldTheSameFuel) {
  const std::string plain = "time_s,fuel_flow_ml_per_s\n0.5,1.5\n4.5,2.5\n8.5,1.5\n";
  const std::string semicolons = "time_s;fuel_flow_ml_per_s\n0,5;1,5\n4,5;2,5\n8,5;1,5\n";
  const std::vector<std::pair<const char*, std::string>> dialects = {
      {"comma", plain},
      {"semicolon", "time_s;fuel_flow_ml_per_s\n0.5;1.5\n4.5;2.5\n8.5;1.5\n"},
      {"tab", "time_s\tfuel_flow_ml_per_s\n0.5\t1.5\n4.5\t2.5\n8.5\t1.5\n"},
      {"decimal comma", semicolons},
      {"BOM", "\xEF\xBB\xBF" + semicolons},
      {"UTF-16 LE", utf16(semicolons, false)},
      {"UTF-16 BE", utf16(plain, true)},
      {"text columns",
       "operator,time_s,remark,fuel_flow_ml_per_s\nK,0.5,,1.5\nK,4.5,stone,2.5\nK,8.5,,1.5\n"},
      {"units in headers", "Time [s];Fuel flow (mL/min)\n0,5;90\n4,5;150\n8,5;90\n"},
      {"ms clock", "time (ms),fuel flow / L/h\n500,5.4\n4500,9.0\n8500,5.4\n"},
      {"times of day", "Time;fuel_flow_ml_per_s\n23:59:57,5;1,5\n00:00:01,5;2,5\n00:00:05,5;1,5\n"},
      {"empty cells",
       "time_s,temperature,fuel_flow_ml_per_s,\n0.5,,1.5,\n4.5,80,2.5,\n,,,\n"
       "8.5,,1.5,\n"},
      {"CRLF", "time_s,fuel_flow_ml_per_s\r\n0.5,1.5\r\n4.5,2.5\r\n8.5,1.5\r\n"},
      {"quotes",
       "\"time_s\",\"fuel_flow_ml_per_s\"\n\"0,5\",\"1,5\"\n\"4,5\",\"2,5\"\n"
       "\"8,5\",\"1,5\"\n"},
      {"sep=", "sep=;\r\n" + semicolons},
  };
  for (const auto& [name, content] : dialects) {
    SCOPED_TRACE(name);
    EXPECT_NEAR(fuel(content), 16.0, 1e-9);
  }
}

TEST_F(EfficiencyLogs, WhatIsNotClearIsRefusedWithLineAndColumn) {
  EXPECT_EQ(refusal("time_s,power_w\n0,1\n1,\n"),
            "log.csv: line 3: power_w is '', expected a number");
  EXPECT_EQ(refusal("time_s;fuel flow [mL/h]\n0;1,234\n1;2,345\n"),
            "log.csv: line 2: fuel flow [mL/h] is '1,234', which may be a decimal or thousands: "
            "give --decimal");
  EXPECT_EQ(refusal("time_s,fuel_flow\n0,1\n1,1\n"),
            "log.csv: column 'fuel_flow' states no unit, expected one as in 'NAME [UNIT]', of "
            "mL/s, mL/min, L/h, L/min, gal/h: or give --time-unit or --rate-unit");
  EXPECT_EQ(refusal("time_s,fuel_flow [kg/h]\n0,1\n1,1\n"),
            "log.csv: column 'fuel_flow [kg/h]' is in 'kg/h', expected one of mL/s, mL/min, L/h, "
            "L/min, gal/h");
  EXPECT_EQ(refusal("time_s,fuel_flow_l_per_h,Fuel rate (L/h)\n0,1,1\n1,1,1\n"),
            "log.csv: holds both fuel_flow_l_per_h and Fuel rate (L/h), expected one of them: give "
            "--rate-column");
  EXPECT_EQ(refusal("time_s,t [ms],power_w\n0,0,1\n1,1,1\n"),
            "log.csv: holds both time_s and t [ms], expected one of them: give --time-column");
  EXPECT_EQ(refusal("time;power_w\n12:00:00;1\n12:60:00;1\n"),
            "log.csv: line 3: time is '12:60:00', expected a time as 13:05:59.250");
}

TEST_F(EfficiencyLogs, DatesAreReadAsTheirColumnShowsThem) {
  const auto of = [&](const std::string& first, const std::string& second) {
    const std::string head = "time;fuel_flow_ml_per_s\n";
    return fuel(head + first + " 23:59:57,5;2\n" + second + " 00:00:05,5;2\n");
  };
  for (const auto& [first, second] :
       std::vector<std::pair<std::string, std::string>>{{"2026-11-23", "2026-11-24"},
                                                        {"2024/02/29", "2024/03/01"},
                                                        {"23.11.2026", "24.11.2026"},
                                                        {"9.3.2026", "10.3.2026"},
                                                        {"11/23/2026", "11/24/2026"},
                                                        {"23/11/2026", "24/11/2026"},
                                                        {"12/12/2026", "12/13/2026"}}) {
    EXPECT_NEAR(of(first, second), 16.0, 1e-5) << first;
  }
  const std::string halves = "time,power_w\n3/4/2026 11:59:55 AM,1000\n3/4/2026 12:00:05 PM,1000\n";
  EXPECT_NEAR(run(halves).at("energy_kj").get<double>(), 10.0, 1e-9) << "either month";
}

TEST_F(EfficiencyLogs, DatesThatAreNoneOrGoBackAreRefusedWithTheirLine) {
  const auto message = [&](const std::string& first, const std::string& second) {
    return refusal("time,power_w\n" + first + ",1\n" + second + ",1\n");
  };
  EXPECT_EQ(
      message("2026-02-28 10:00:00", "2026-02-30 10:00:00"),
      "log.csv: line 3: time is '2026-02-30 10:00:00', a date that the calendar does not have");
  EXPECT_EQ(
      message("13/13/2026 10:00:00", "13/14/2026 10:00:00"),
      "log.csv: line 2: time is '13/13/2026 10:00:00', a date that the calendar does not have");
  EXPECT_EQ(message("2026-11-23T10:00:00", "2026-11-22T10:00:05"),
            "log.csv: line 3: time is '2026-11-22T10:00:05', must be later than "
            "'2026-11-23T10:00:00' of the row before");
  EXPECT_EQ(message("10:00:05", "10:00:00"),
            "log.csv: line 3: time is '10:00:00', must be later than '10:00:05' of the row before");
  EXPECT_EQ(message("01/02/2026 23:59:59", "01/03/2026 00:00:01"),
            "log.csv: line 2: time is '01/02/2026 23:59:59', whose day and month may be either: "
            "write dates as 2026-11-23");
  EXPECT_EQ(message("2026-11-23 10:00:00", "10:00:05"),
            "log.csv: line 3: time is '10:00:05', expected a date or none as in "
            "'2026-11-23 10:00:00'");
}

TEST_F(EfficiencyLogs, OptionsSayWhatALogDoesNot) {
  const std::string log = "Zeit;Verbrauch\n0;1,200\n60000;1,200\n";
  EXPECT_NEAR(fuel(log, {"--time-column", "Zeit", "--time-unit", "ms", "--rate-column", "Verbrauch",
                         "--rate-unit", "L/h", "--decimal", "comma"}),
              20.0, 1e-9);
  EXPECT_NEAR(fuel("time_s|fuel|flow\n0|1|x\n10|1|x\n",
                   {"--rate-unit", "mL/s", "--rate-column", "fuel", "--delimiter", "bar"}),
              10.0, 1e-12);
  const std::string both = "time_s,fuel_flow_ml_per_s,power_w\n0,1,7000\n10,1,7000\n";
  EXPECT_NEAR(fuel(both, {"--meter", "fuel"}), 10.0, 1e-12);
  EXPECT_NEAR(run(both, {"--meter", "power"}).at("energy_kj").get<double>(), 70.0, 1e-12);
}

TEST_F(EfficiencyLogs, ColumnsAreStatedWithTheirUnitOrWithout) {
  const std::string log = "Clock [ms],Motor [L/h],Pumpe [L/h]\n0,7.2,1\n10000,7.2,1\n";
  for (const char* name : {"Motor", "motor", "Motor [L/h]"}) {
    EXPECT_NEAR(fuel(log, {"--time-column", "Clock", "--rate-column", name}), 20.0, 1e-9) << name;
  }
  EXPECT_EQ(refusal(log, {"--rate-column", "Motto"}),
            "log.csv: has no column 'Motto', its columns are: Clock [ms], Motor [L/h], Pumpe "
            "[L/h]");
  EXPECT_EQ(refusal("Zeit,Motor [L/h]\n0,7.2\n10,7.2\n"),
            "log.csv: has no column of fuel or power, expected one of fuel_flow_ml_per_s, "
            "fuel_flow_l_per_h, power_w, or of boom, arm and bucket each boom_power_w, "
            "boom_torque_n_m with boom_rate_rad_per_s, or boom_head_pressure_pa with "
            "boom_rod_pressure_pa and boom_piston_speed_m_per_s; its columns are: Zeit, Motor "
            "[L/h]: give --rate-column");
  EXPECT_EQ(refusal("Zeit,Motor [L/h]\n0,7.2\n10,7.2\n", {"--rate-column", "Motor"}),
            "log.csv: has no column 'time_s', its columns are: Zeit, Motor [L/h]: give "
            "--time-column");
  EXPECT_EQ(refusal("time_s,fuel_flow_l_per_h\n0,2\n9,2\n", {"--rate-unit", "mL/s"}),
            "log.csv: column 'fuel_flow_l_per_h' is in 'l_per_h' by its name, but 'mL/s' is stated "
            "as its unit");
  EXPECT_NEAR(fuel("time_s,fuel_flow_l_per_h\n0,3.6\n9,3.6\n", {"--rate-unit", "L/h"}), 9.0, 1e-9);
}

TEST_F(EfficiencyLogs, ReadingsBeyondAllNumbersAreRefused) {
  EXPECT_EQ(refusal("time_s,power [kW]\n0,1\n9,1e308\n"),
            "log.csv: line 3: power of power [kW] is too large for a number");
  const json large = run("time_s,power [W]\n0,1e306\n9,1e306\n");
  const ProgramResult text =
      run_program("measure-efficiency", {folder.file("log.csv"), "--volume", "0.4"});
  EXPECT_NE(text.out.find("9.00e+303 ± 1.8e+302 kJ"), std::string::npos) << text.out;
}

TEST_F(EfficiencyLogs, UnitsOfFuelFlowAgree) {
  for (const auto& [unit, rate] :
       std::vector<std::pair<std::string, std::string>>{{"mL/s", "2"},
                                                        {"mL/min", "120"},
                                                        {"L/h", "7.2"},
                                                        {"l/min", "0.12"},
                                                        {"cc/s", "2"},
                                                        {"gal/h", "1.9020387764947"}}) {
    const std::string rows = "\n0," + rate + "\n10," + rate + "\n";
    EXPECT_NEAR(fuel("time_s,fuel flow [" + unit + "]" + rows), 20.0, 1e-7) << unit;
  }
}

// ---- Energy -----------------------------------------------------------------------------------

TEST_F(EfficiencyLogs, TorquesAndRatesGiveThePositiveWork) {
  // Boom 50 kN m at -0.1 rad/s gives back; arm 40 kN m at 0.2 rad/s is 8 kW; bucket 10 deg/s.
  const json found =
      run("time_s,boom_torque_n_m,arm torque [kN "
          "m],bucket_torque_n_m,boom_rad_per_s,arm_rate_rad_per_s,"
          "bucket rate [deg/s]\n0,50000,40,1800,-0.1,0.2,10\n5,50000,40,1800,-0.1,0.2,10\n",
          {"--mass", "500"});
  EXPECT_NEAR(found.at("energy_kj").get<double>(), 40.0 + 1.8 * 5.0 * std::acos(-1.0) / 18.0, 1e-9);
  EXPECT_EQ(found.at("meter"), "torques and rates");
  EXPECT_NEAR(found.at("energy_sd_kj").get<double>(), 0.02 * found.at("energy_kj").get<double>(),
              1e-12);
}

TEST_F(EfficiencyLogs, PressuresActOnTheAreasOfTheMachine) {
  // The arm's piston is 0.115 m, its rod 0.08 m; two cylinders of the boom give back.
  const json found =
      run("time_s,boom_head_pressure_bar,boom_rod_pressure_bar,boom_piston_speed_m_per_s,"
          "arm_head_pressure_bar,arm_rod_pressure_bar,arm_piston_speed_m_per_s,"
          "bucket_head_pressure_bar,bucket_rod_pressure_bar,bucket_piston_speed_m_per_s\n"
          "0,100,0,-0.1,200,10,0.1,0,50,-0.2\n4,100,0,-0.1,200,10,0.1,0,50,-0.2\n",
          {"--mass", "500"});
  const double quarter = std::acos(-1.0) / 4.0;
  const double arm = 0.1 * quarter * (200e5 * 0.115 * 0.115 - 10e5 * (0.115 * 0.115 - 0.08 * 0.08));
  const double bucket = 0.2 * quarter * 50e5 * (0.105 * 0.105 - 0.07 * 0.07);
  EXPECT_NEAR(found.at("energy_kj").get<double>(), 0.004 * (arm + bucket), 1e-9);
  EXPECT_EQ(found.at("meter"), "pressures and speeds");
}

// ---- Phases and idling ------------------------------------------------------------------------

/// Idling at 0.8 mL/s for 5 s, a dig of 6 s at 2.8, a lift of 3 s at 1.8, idling.
std::string cycle_log(bool with_phases) {
  std::string text =
      with_phases ? "time_s,fuel_flow_ml_per_s,phase\n" : "time_s,fuel_flow_ml_per_s\n";
  const auto add = [&](double from, double to, const char* flow, const char* phase) {
    for (int i = 0; from + 0.1 * i < to - 1e-9; ++i) {
      text += std::to_string(from + 0.1 * i + 0.05) + "," + flow;
      text += with_phases ? std::string(",") + phase + "\n" : "\n";
    }
  };
  add(0.0, 5.0, "0.8", "idle");
  add(5.0, 6.0, "2.8", "penetrate");
  add(6.0, 10.0, "2.8", "Drag");
  add(10.0, 11.0, "2.8", "scoop");
  add(11.0, 14.0, "1.8", "lift");
  add(14.0, 18.0, "0.8", "idle");
  return text;
}

TEST_F(EfficiencyLogs, MarkedPhasesPartTheDigFromTheCycle) {
  const json found = run(cycle_log(true));
  EXPECT_EQ(found.at("phases"), "marked");
  EXPECT_NEAR(found.at("duration_s").get<double>(), 6.0, 1e-9);
  EXPECT_NEAR(found.at("fuel_ml").get<double>(), 6.0 * 2.8 - 0.5 * 0.05 * 3.0, 0.1);
  EXPECT_EQ(found.at("dig").at("fuel_ml"), found.at("fuel_ml"));
  EXPECT_NEAR(found.at("cycle").at("duration_s").get<double>(), 9.0, 1e-9);
  EXPECT_NEAR(found.at("cycle").at("fuel_ml").get<double>(), 16.8 + 5.4, 0.1);
  const json whole = run(cycle_log(true), {"--count", "cycle"});
  EXPECT_EQ(whole.at("fuel_ml"), found.at("cycle").at("fuel_ml"));
  const json none = run(cycle_log(true), {"--phases", "none"});
  EXPECT_NEAR(none.at("fuel_ml").get<double>(), 9.0 * 0.8 + 16.8 + 5.4, 0.15);
  EXPECT_TRUE(none.at("cycle").is_null());
}

TEST_F(EfficiencyLogs, TwoDigsOfALogCountOncePerDig) {
  std::string log = "time_s,power_w,phase\n";
  for (int i = 0; i < 20; ++i) {
    log += std::to_string(i) + ",5000," +
           (i % 10 < 3   ? "drag"
            : i % 10 < 5 ? "scoop"
                         : "swing") +
           "\n";
  }
  const json found = run(log);
  EXPECT_EQ(found.at("digs"), 2);
  EXPECT_NEAR(found.at("duration_s").get<double>(), 4.5 + 5.0, 1e-9);
  EXPECT_NEAR(found.at("dig").at("energy_kj").get<double>(), 5.0 * 4.75, 1e-9);
  EXPECT_NEAR(found.at("cycle").at("energy_kj").get<double>(), 5.0 * 9.5, 1e-9);
}

TEST_F(EfficiencyLogs, UnknownPhasesAreRefused) {
  EXPECT_EQ(refusal("time_s,power_w,phase\n0,1,drag\n1,1,digging\n"),
            "log.csv: line 3: phase is 'digging', expected penetrate, drag, scoop, or one of "
            "approach, lift, swing, dump, return, lower, idle, rest");
  EXPECT_EQ(refusal("time_s,power_w,phase\n0,1,lift\n1,1,lift\n"),
            "log.csv: holds no dig from 0 to 1 s: no row there is of penetrate, drag or scoop");
}

TEST_F(EfficiencyLogs, JointAnglesShowTheDig) {
  // The arm curls in from 3 to 7 s, the bucket from 7.5 to 9 s; then the boom lifts.
  std::string log = "time_s,power_w,boom_rad,arm_rad,bucket_rad\n";
  for (int i = 0; i <= 150; ++i) {
    const double t = 0.1 * i;
    const double arm = 0.9 + 0.3 * std::clamp(t - 3.0, 0.0, 4.0);
    const double bucket = 0.2 + 0.6 * std::clamp(t - 7.5, 0.0, 1.5);
    log += std::to_string(t) + ",5000," + std::to_string(t > 10 ? -0.02 * i : 0.0) + "," +
           std::to_string(arm) + "," + std::to_string(bucket) + "\n";
  }
  const json found = run(log, {"--phases", "found"});
  EXPECT_EQ(found.at("phases"), "found");
  EXPECT_NEAR(found.at("duration_s").get<double>(), 6.0, 0.11);
  EXPECT_NEAR(found.at("cycle").at("duration_s").get<double>(), 15.0, 1e-9);
  EXPECT_EQ(refusal(cycle_log(false), {"--phases", "found"}),
            "log.csv: has no columns arm_rad and bucket_rad, which finding the dig by the joints "
            "needs");
}

TEST_F(EfficiencyLogs, IdlingIsFoundOrStatedAndBothFiguresAreThere) {
  const json found = run(cycle_log(true));
  EXPECT_NEAR(found.at("idle").at("fuel_flow_ml_per_s").get<double>(), 0.8, 1e-9);
  EXPECT_TRUE(found.at("idle").at("found").get<bool>());
  const double gross = found.at("dig").at("fuel_ml").get<double>();
  const double net = found.at("dig").at("fuel_ml_above_idle").get<double>();
  EXPECT_NEAR(gross - net, 6.0 * 0.8, 1e-9);
  EXPECT_EQ(found.at("fuel_ml").get<double>(), gross);
  const json subtracted = run(cycle_log(true), {"--subtract-idle", "--idle", "2.88L/h"});
  EXPECT_NEAR(subtracted.at("fuel_ml").get<double>(), net, 1e-9);
  EXPECT_FALSE(subtracted.at("idle").at("found").get<bool>());
  const std::string steady = "time_s,fuel_flow_ml_per_s\n0,2\n10,2\n";
  EXPECT_TRUE(run(steady).at("idle").is_null());
  EXPECT_EQ(refusal(steady, {"--subtract-idle"}),
            "log.csv: idling cannot be subtracted: the log shows none for 2 s: give --idle");
  EXPECT_EQ(refusal(steady, {"--idle", "5kW"}), "--idle is a power, but log.csv records fuel");
  EXPECT_EQ(refusal(steady, {"--idle", "3"}),
            "--idle: '3' is no rate, expected one such as 2.8L/h, 0.8mL/s or 5kW");
}

// ---- Content of the bucket --------------------------------------------------------------------

/// Points every 2 cm over a square, at z(x, y).
template <typename Height>
std::string cloud(double half_width, const Height& height) {
  std::string text;
  for (double x = -half_width + 0.01; x < half_width; x += 0.02) {
    for (double y = -half_width + 0.01; y < half_width; y += 0.02) {
      text +=
          std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(height(x, y)) + '\n';
    }
  }
  return text;
}

class BucketContents : public EfficiencyLogs {
 protected:
  json content(Words options) const {
    options.insert(options.begin(), {log(), "--json"});
    const ProgramResult result = run_program("measure-efficiency", options);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.code == 0 ? json::parse(result.out).at("runs").at(0) : json();
  }
  std::string message(Words options) const {
    options.insert(options.begin(), log());
    const ProgramResult result = run_program("measure-efficiency", options);
    EXPECT_EQ(result.code, 2);
    const std::string text = result.err.substr(0, result.err.find('\n'));
    return text.substr(text.find(' ') + 1);
  }
  std::string log() const {
    return folder.write("fuel.csv", "time_s,fuel_flow_ml_per_s\n0,2\n10,2\n");
  }
};

TEST_F(BucketContents, BulkingFactorTurnsOneVolumeIntoTheOther) {
  const json loose =
      content({"--volume", "0.45", "--volume-sd", "0.009", "--bulking-factor", "1.25,0.05"});
  EXPECT_NEAR(loose.at("volume_m3").get<double>(), 0.45, 1e-12);
  EXPECT_NEAR(loose.at("bank_volume_m3").get<double>(), 0.36, 1e-12);
  EXPECT_NEAR(loose.at("bank_volume_sd_m3").get<double>(), 0.36 * std::hypot(0.02, 0.04), 1e-12);
  const json bank = content({"--bank-volume", "0.36", "--bulking-factor", "1.25"});
  EXPECT_NEAR(bank.at("volume_m3").get<double>(), 0.45, 1e-12);
  EXPECT_NEAR(bank.at("efficiency").get<double>(), 0.0225, 1e-12);
  EXPECT_EQ(message({"--bank-volume", "0.36"}),
            "--bulking-factor is missing: the bank volume is of undisturbed soil, the bucket holds "
            "loose soil");
  EXPECT_EQ(message({"--mass", "500", "--bulking-factor", "1.2"}),
            "--bulking-factor turns volumes into each other; a mass needs none");
  EXPECT_EQ(message({"--volume", "0.4", "--bulking-factor", "0.8"}),
            "--bulking-factor: 0.8, must be in 1 .. 3");
}

TEST_F(BucketContents, ScansOfTheBucketShowWhatIsInIt) {
  // A trough of 0.8 x 0.8 m with a floor of slope 0.3, filled to its rim.
  const auto is_inside = [](double x, double y) {
    return std::max(std::abs(x), std::abs(y)) < 0.4;
  };
  const auto empty = [&](double x, double y) { return is_inside(x, y) ? -0.3 + 0.3 * x : 0.0; };
  const auto full = [](double, double) { return 0.0; };
  const std::string before = folder.write("empty.xyz", cloud(0.6, empty));
  const std::string after = folder.write("full.xyz", cloud(0.6, full));
  const json run = content({"--bucket-before", before, "--bucket-after", after});
  EXPECT_NEAR(run.at("volume_m3").get<double>(), 0.3 * 0.64, 0.005);
  EXPECT_NEAR(run.at("volume_sd_m3").get<double>(), 0.005 * 0.64, 1e-3);
  const ProgramResult swapped = run_program(
      "measure-efficiency", {log(), "--bucket-before", after, "--bucket-after", before});
  EXPECT_EQ(swapped.code, 3);
  EXPECT_NE(swapped.err.find("fuller than the empty one, must be above 0"), std::string::npos);
}

TEST_F(BucketContents, TheHoleTimesTheFactorIsWhatWasLifted) {
  const auto level = [](double, double) { return 0.0; };
  const auto pit = [](double x, double y) {
    return -0.4 * std::max(0.0, 1.0 - std::hypot(x, y) / 0.8);
  };
  const json run =
      content({"--pit-before", folder.write("before.xyz", cloud(2.0, level)), "--pit-after",
               folder.write("after.xyz", cloud(2.0, pit)), "--bulking-factor", "1.2,0.03"});
  const double hole = std::acos(-1.0) * 0.8 * 0.8 * 0.4 / 3.0;
  EXPECT_NEAR(run.at("volume_m3").get<double>(), 1.2 * hole, 0.01 * hole);
  EXPECT_NEAR(run.at("bank_volume_m3").get<double>(), hole, 0.01 * hole);
  EXPECT_GE(run.at("volume_sd_m3").get<double>(), 0.03 * 0.99 * hole);
}

// ---- Sets of runs -----------------------------------------------------------------------------

class RunSets : public testing::Test {
 protected:
  /// A table of runs of 10 s, each of one log of so much flow [mL/s].
  std::string table(const std::string& name, const std::vector<double>& flows) const {
    std::string rows = "file;volume_m3;note\n";
    for (std::size_t i = 0; i < flows.size(); ++i) {
      const std::string log = name + std::to_string(i) + ".csv";
      const std::string flow = std::to_string(flows[i]);
      folder.write(log, "time_s,fuel_flow_ml_per_s\n0," + flow + "\n10," + flow + "\n");
      rows += log + ";0,4;a " + std::to_string(i) + "\n";
    }
    return folder.write(name + ".csv", rows);
  }
  ProgramResult run(Words words) const {
    return run_program("measure-efficiency", std::move(words));
  }

  TemporaryFolder folder;
};

TEST_F(RunSets, GainOfOneSetOverAnotherHasItsTest) {
  const std::string operators = table("operator", {2.0, 2.1, 1.9, 2.2});
  const std::string plan = table("plan", {1.6, 1.7, 1.5, 1.55});
  const ProgramResult result = run({"--runs", plan, "--against", operators, "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const json found = json::parse(result.out);
  EXPECT_EQ(found.at("runs").size(), 8U);
  EXPECT_EQ(found.at("sets").at("against").at("runs"), 4);
  const double against = std::pow(2.0 * 2.1 * 1.9 * 2.2, 0.25);
  const double ours = std::pow(1.6 * 1.7 * 1.5 * 1.55, 0.25);
  EXPECT_NEAR(found.at("gain_percent").get<double>(), 100.0 * (against / ours - 1.0), 1e-9);
  EXPECT_LT(found.at("gain_interval_percent").at(0).get<double>(),
            found.at("gain_percent").get<double>());
  EXPECT_EQ(found.at("sets").at("test"), "permutation");
  EXPECT_NEAR(found.at("sets").at("p_value").get<double>(), 2.0 / 70.0, 1e-12);
  EXPECT_EQ(run({"--runs", plan, "--against", operators, "--json"}).out, result.out);
  const ProgramResult text = run({"--runs", plan, "--against", operators});
  EXPECT_NE(text.out.find("p = 0.029 (permutation test over all 70 divisions)"), std::string::npos)
      << text.out;
}

TEST_F(RunSets, FoldersOfLogsShareTheirPayload) {
  const auto folder_of = [&](const std::string& name, double flow) {
    const std::string place = folder.file(name);
    std::filesystem::create_directory(place);
    for (const char* log : {"/a.csv", "/b.csv"}) {
      std::ofstream(place + log) << "time_s,fuel_flow_ml_per_s\n0," << flow << "\n10," << flow
                                 << "\n";
      flow *= 1.01;
    }
    return place;
  };
  const ProgramResult result = run({"--runs", folder_of("plan", 1.0), "--against",
                                    folder_of("operator", 2.0), "--volume", "0.1", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NEAR(json::parse(result.out).at("gain_percent").get<double>(), 100.0, 1e-9);
}

TEST_F(RunSets, FaultsAreNamedByTheLineOfTheTable) {
  const std::string good = table("good", {2.0, 2.1});
  const auto message = [&](Words words) {
    std::string text = run(std::move(words)).err;
    text = text.substr(0, text.find('\n'));
    const std::string place = folder.file("");
    for (auto at = text.find(place); at != text.npos; at = text.find(place)) {
      text.erase(at, place.size());
    }
    return text.substr(text.find(' ') + 1);
  };
  const std::string bad = folder.write("bad.csv", "file,volume_m3\ngood0.csv,0.4\nno.csv,0.4\n");
  EXPECT_EQ(message({"--runs", good, "--against", bad}),
            "bad.csv: line 3: no.csv: cannot be opened: No such file or directory");
  const std::string odd = folder.write("odd.csv", "file,volum_m3\ngood0.csv,0.4\n");
  EXPECT_EQ(message({"--runs", good, "--against", odd}),
            "odd.csv: column 'volum_m3' is none of a table of runs, expected of: file, note, "
            "bulking_factor, volume_m3, volume_sd_m3, bank_volume_m3, bank_volume_sd_m3, mass_kg, "
            "mass_sd_kg, from_s, to_s, dump_before, dump_after, pit_before, pit_after, "
            "bucket_before, bucket_after");
  const std::string low =
      folder.write("low.csv", "file,volume_m3\ngood0.csv,0.4\ngood1.csv,-0.4\n");
  EXPECT_EQ(message({"--runs", good, "--against", low}),
            "low.csv: line 3: volume_m3: -0.4, must be above 0");
  EXPECT_EQ(run({"--runs", good, "--against", low}).code, 3);
  const std::string none = folder.write("none.csv", "file,mass_kg\ngood0.csv,4\n,4\n");
  EXPECT_EQ(message({"--runs", good, "--against", none}),
            "none.csv: line 3: file is '', expected the name of a log");
  const std::string one = table("one", {2.0});
  EXPECT_EQ(message({"--runs", one, "--against", good}),
            "the set of --runs has 1 run, a comparison needs 2 or more");
  EXPECT_EQ(message({"--runs", good}), "--runs and --against go together");
  EXPECT_EQ(message({good, "--runs", good, "--against", good}),
            "--runs and --against exclude RUN.csv, SECOND.csv and options of a second dig");
}

TEST_F(RunSets, ARecordingThatCountsTwiceIsNotTrusted) {
  const std::string operators = table("operator", {2.0, 2.1, 1.9});
  const auto codes = [&](const std::string& set) {
    const ProgramResult result = run({"--runs", set, "--against", operators, "--json"});
    EXPECT_EQ(result.code, 0) << result.err;
    const json found = json::parse(result.out, nullptr, false);
    Words list;
    for (const json& warning : found.at("warnings")) list.push_back(warning.at("code"));
    EXPECT_EQ(found.at("trustworthy").get<bool>(), list.empty());
    return list;
  };
  EXPECT_EQ(codes(table("plan", {1.6, 1.7, 1.5})), Words{});
  EXPECT_EQ(codes(table("copy", {1.6, 1.7, 1.6})), Words{"repeated_run"}) << "by content";
  EXPECT_EQ(codes(table("other", {1.6, 1.7, 2.0})), Words{"repeated_run"}) << "of the other set";
  const std::string parts = folder.write(
      "parts.csv", "file,volume_m3,from_s,to_s\nplan0.csv,0.2,0,5\nplan0.csv,0.2,5,10\n");
  EXPECT_EQ(codes(parts), Words{}) << "two digs of a longer log";
}

TEST_F(RunSets, TextSaysWhereIntervalAndTestDiffer) {
  const auto last = [&](const std::string& plan, const std::string& operators) {
    const std::string text = run({"--runs", plan, "--against", operators}).out;
    return text.substr(text.rfind('\n', text.size() - 2) + 1, 12);
  };
  EXPECT_EQ(last(table("p3", {1.0, 1.01, 1.02}), table("o3", {2.0, 2.01, 2.02})), "the interval");
  EXPECT_EQ(last(table("p4", {1.0, 1.01, 1.02, 1.03}), table("o4", {2.0, 2.01, 2.02, 2.03})),
            "gain: 98.5 %");
}

TEST_F(RunSets, FigureShowsEveryRun) {
  const std::string operators = table("operator", {2.0, 2.1, 1.9, 2.2});
  const std::string plan = table("plan", {1.6, 1.7, 1.5, 1.55});
  const std::string file = folder.file("sets.svg");
  for (const char* size : {"40mm", "85mm", "300mm", "170mm"}) {
    const ProgramResult result =
        run({"--runs", plan, "--against", operators, "--plot", file, "--plot-size", size});
    ASSERT_EQ(result.code, 0) << result.err;
    expect_legible(content_of(file), size);
  }
  expect_figure(file, {"efficiency [m³/mL]", "against", "runs", "geometric mean", "a run",
                       "4 runs against 4, gain: 29"});
}

TEST(SampleRecordings, RepeatTheFieldExperiment) {
  const json truth = json::parse(content_of(shipped("recordings/truth.json")));
  const auto volume = [&](const char* run) {
    return std::to_string(truth.at(run).at("payload_volume_m3").get<double>());
  };
  const ProgramResult result =
      run_program("measure-efficiency",
                  {shipped("recordings/fixed.csv"), shipped("recordings/planned.csv"), "--volume",
                   volume("fixed"), "--second-volume", volume("planned"), "--json", "--strict"});
  ASSERT_EQ(result.code, 0) << result.err;
  const json found = json::parse(result.out);
  // As in section 4.3: a similar volume for less fuel.
  EXPECT_NEAR(found["runs"][1].at("volume_m3").get<double>(),
              found["runs"][0].at("volume_m3").get<double>(), 0.02);
  EXPECT_GT(found.at("gain_percent").get<double>(), 30.0);
  for (const json& run : found.at("runs")) {
    EXPECT_NEAR(run.at("idle").at("fuel_flow_ml_per_s").get<double>(), 2.8 / 3.6, 0.01);
  }
}

}  // namespace
}  // namespace excavplan::test
