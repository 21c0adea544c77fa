// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

/// What measure-efficiency doubts in a log.
class EfficiencyDoubts : public testing::Test {
 protected:
  json measured(const std::string& log, Words options = {}) const {
    options.insert(options.begin(), {folder.write("log.csv", log), "--json", "--volume", "0.3"});
    const ProgramResult result = run_program("measure-efficiency", options);
    EXPECT_EQ(result.code, 0) << result.err;
    return json::parse(result.out, nullptr, false);
  }
  /// Codes of the warnings, after each of which the result is not trustworthy.
  Words doubts(const std::string& log, Words options = {}) const {
    const json result = measured(log, std::move(options));
    Words codes;
    for (const json& warning : result.at("warnings")) codes.push_back(warning.at("code"));
    EXPECT_EQ(result.at("trustworthy").get<bool>(), codes.empty());
    return codes;
  }
  std::string text(const std::string& log, Words options = {}) const {
    const json result = measured(log, std::move(options));
    std::string message = result.at("warnings").at(0).at("message");
    const std::string path = folder.file("");
    return message.replace(message.find(path), path.size(), "");
  }

  TemporaryFolder folder;
};

/// A row each 0.2 s.
std::string flow_log(const std::vector<std::pair<double, double>>& stretches) {
  std::string rows = "time_s,fuel_flow_ml_per_s\n";
  double time = 0.0;
  for (const auto& [duration, flow] : stretches) {
    for (const double end = time + duration; time < end - 1e-9; time += 0.2) {
      rows += std::to_string(time) + "," + std::to_string(flow) + "\n";
    }
  }
  return rows;
}

TEST_F(EfficiencyDoubts, AReadingThatNoMachineGivesIsNotTrusted) {
  const std::string head = "time_s,fuel_flow_ml_per_s,phase\n0,2,drag\n4,2,drag\n8,2,scoop\n";
  EXPECT_EQ(doubts(head + "9,1,idle\n"), Words{});
  EXPECT_EQ(doubts(head + "9,-0.01,idle\n"), Words{}) << "noise about 0";
  EXPECT_EQ(doubts(head + "9,-1,idle\n"), Words{"implausible_fuel"});
  EXPECT_EQ(doubts(head + "9,1,idle\n10,1e308,idle\n"), Words{"implausible_fuel"});
  EXPECT_EQ(text(head + "9,-1,idle\n"),
            "log.csv: -1.00 mL/s at 9 s, where a fuel flow is 0 or more: the meter failed there, "
            "or the column is another");
  const std::string power = "time_s,power_w\n0,9000\n4,9000\n5,";
  EXPECT_EQ(doubts(power + "-9000\n9,9000\n"), Words{}) << "negative power counts as 0";
  EXPECT_EQ(doubts(power + "-9e9\n9,9000\n"), Words{"implausible_energy"});
}

TEST_F(EfficiencyDoubts, IdlingTakesLessThanTheDig) {
  const std::string log = flow_log({{8.0, 2.0}});
  EXPECT_EQ(doubts(log, {"--idle", "3.6L/h"}), Words{});
  EXPECT_EQ(doubts(log, {"--idle", "36L/h"}), Words{"idle_above_dig"});
  EXPECT_EQ(text(log, {"--idle", "36L/h"}),
            "log.csv: idling takes 10.0 mL/s, more than the 2.00 mL/s on average of the dig: check "
            "--idle and its unit");
}

TEST_F(EfficiencyDoubts, IdlingThatCountsAsTheDigIsNamed) {
  const std::string log = flow_log({{4.0, 0.8}, {6.0, 2.5}, {5.0, 0.8}});
  EXPECT_EQ(doubts(log), Words{"idle_in_dig"});
  EXPECT_EQ(text(log),
            "log.csv: the machine idles for 8.60 of the 14.8 s that count as the dig, as the log "
            "has no phases: give --from and --to, or --phases found; --subtract-idle or --count "
            "cycle if idling is to be left out or in");
  EXPECT_EQ(doubts(log, {"--from", "4", "--to", "10"}), Words{});
  EXPECT_EQ(doubts(log, {"--subtract-idle"}), Words{});
  EXPECT_EQ(doubts(log, {"--count", "cycle"}), Words{});
  EXPECT_EQ(doubts(flow_log({{6.0, 2.5}, {1.0, 0.8}, {4.0, 2.5}}), {"--idle", "2.88L/h"}), Words{});
}

}  // namespace
}  // namespace excavplan::test
