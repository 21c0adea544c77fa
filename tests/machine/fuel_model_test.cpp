// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/fuel_model.hpp>

#include <gtest/gtest.h>

#include <string>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>

#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

using test::error_of;

TEST(FuelModel, IsALineFromIdlingToTheRatedPower) {
  const FuelModel model = load_fuel_model(find_data_file("engines/zx120.json"));
  EXPECT_EQ(model.name, "zx120");
  EXPECT_DOUBLE_EQ(model.flow(0.0), 2.8 / 3.6);
  EXPECT_DOUBLE_EQ(model.flow(model.drive_efficiency * model.rated_power), 21.2 / 3.6);
  EXPECT_DOUBLE_EQ(model.flow(0.5 * model.drive_efficiency * model.rated_power), 12.0 / 3.6);
  EXPECT_DOUBLE_EQ(model.flow(1e6), 21.2 / 3.6);
  // 248 g/kWh at 43 MJ/kg.
  EXPECT_NEAR(model.rated_efficiency(), 3.6 / (0.248 * 43.03), 0.001);
}

TEST(FuelModel, NumbersInOtherUnitsAreRefused) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::string& rated, const std::string& idle) {
    const std::string path = folder.write(
        "fuel.json",
        R"({"format": "excavplan-fuel-model", "version": 1, "name": "a", "rated_power_w": 70900,)"
        R"("rated_flow_l_per_h": )" +
            rated + R"(, "idle_flow_l_per_h": )" + idle +
            R"(, "drive_efficiency": 0.5, "heating_value_mj_per_l": 35.7})");
    const std::string text = error_of([&] { load_fuel_model(path); }, ErrorKind::bad_file);
    return text.substr(text.find(' ') + 1);
  };
  EXPECT_EQ(refusal("5.9", "0.8"),
            "rated_flow_l_per_h: makes an engine with an efficiency of 1.21 at the rated power, "
            "must be in 0.2 .. 0.5");
  EXPECT_EQ(refusal("21.2", "28"), "idle_flow_l_per_h: must be below rated_flow_l_per_h");
}

}  // namespace
}  // namespace excavplan
