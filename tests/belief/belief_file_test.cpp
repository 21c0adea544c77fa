// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/belief/belief_file.hpp>

#include <string>

#include <gtest/gtest.h>

#include "base/files.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

DigEvidence a_dig(double percent) {
  DigEvidence dig;
  dig.bank = {{{1.0 / 3.0, -0.1, 0.2}, 0.3}, {{2.0, 0.7, 0.4}, 0.1}};
  dig.bank_share = 0.9;
  dig.survey = SurveyReading{percent, 10.0 / 3.0, {{4, -2.1}, {5, 2.1}}};
  dig.payload_percent = Measured{percent + 1.0 / 7.0, 4.0};
  dig.resistance = {{0.1, 0.2, {45.0, 0.015, 0.8}}};
  dig.limits = {{true, -0.1, 0.3, {45.0, 0.02, 0.7}}};
  return dig;
}

std::string path_of(const std::string& name) { return ::testing::TempDir() + name; }

std::string error_of_text(const std::string& text) {
  const std::string path = path_of("belief_wrong.json");
  write_file(path, text);
  return test::error_about([&] { load_belief(path); }, path);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(BeliefFile, LosesNothing) {
  BeliefSettings settings;
  settings.length = 10.0 / 3.0;
  DigEvidence bare;
  const DensityBelief belief(settings, {a_dig(100.0 / 3.0), a_dig(70.0), bare}, a_dig(1.0 / 9.0));
  const std::string path = path_of("belief.json");
  save_belief(path, belief);
  DensityBelief read = load_belief(path);
  EXPECT_EQ(to_json(read), to_json(belief));
  const std::vector<GroundPlace> places = {{0.0, 0.0, 0.1}, {3.0, 1.0, 0.5}};
  EXPECT_TRUE((read.at(places).raw_percent == belief.at(places).raw_percent).all());
  EXPECT_TRUE((read.at(places).sd_percent == belief.at(places).sd_percent).all());
  ASSERT_TRUE(read.drop_last());
  EXPECT_EQ(read.digs().size(), 3U);  // the forgotten one is back
}

TEST(BeliefFile, IsReadStrictly) {
  const std::string text = to_json(DensityBelief({}, {a_dig(40.0)}));
  EXPECT_EQ(error_of_text(replaced(text, "\"length_m\": 4.0", "\"length_m\": 0.0")),
            "belief: correlation length [m] is 0, must be in 0.01 .. 10000");
  EXPECT_NE(error_of_text(replaced(text, "\"length_m\": 4.0", "\"length\": 4.0")).find("length"),
            std::string::npos);
  EXPECT_NE(
      error_of_text(replaced(text, "\"scan\": 4", "\"scan\": 4.5")).find("must be a whole number"),
      std::string::npos);
  EXPECT_NE(error_of_text(replaced(text, "\"version\": 1", "\"version\": 2")).find("version"),
            std::string::npos);
  EXPECT_NE(error_of_text(replaced(text, "\"bank_share\": 0.9", "\"bank_share\": 1.9"))
                .find("dig: share of bank is 1.9, must be in 0 .. 1"),
            std::string::npos);
  EXPECT_NE(error_of_text(replaced(text, "\"sd\": 0.2", "\"sd\": \"x\"")).find("sd"),
            std::string::npos);
}

}  // namespace
}  // namespace excavplan
