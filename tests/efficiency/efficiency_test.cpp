// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/efficiency/efficiency.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

using test::error_of;

// The arithmetic is tested through measure-efficiency: tests/tools/efficiency_tool_test.cpp.
class Efficiency : public testing::Test {
 protected:
  LoggedDig dig(double power) const {
    const std::string row = "," + std::to_string(power) + "\n";
    LoggedDig dig;
    dig.file = folder.write("dig.csv", "time_s,power_w\n0" + row + "10" + row);
    dig.lifted = Payload{Lifted::mass, {500.0, 5.0}};
    return dig;
  }

  test::TemporaryFolder folder;
};

TEST_F(Efficiency, IsPayloadOverEnergyWithItsError) {
  const DigEfficiency found = measure_efficiency(dig(2000.0));
  EXPECT_DOUBLE_EQ(found.cost, 20.0);
  EXPECT_EQ(found.log.time, (std::vector<double>{0.0, 10.0}));
  EXPECT_EQ(found.log.rate(), (std::vector<double>{2000.0, 2000.0}));
  EXPECT_DOUBLE_EQ(found.value().value, 25.0);
  EXPECT_DOUBLE_EQ(found.value().sd, 25.0 * std::hypot(0.01, 0.02));
  EXPECT_EQ(found.unit(), "kg_per_kj");
  EXPECT_EQ(found.symbol(), "kg/kJ");
  EXPECT_TRUE(found.trustworthy);
  const Measured gain = efficiency_gain(measure_efficiency(dig(2500.0)), found);
  EXPECT_NEAR(gain.value, 25.0, 1e-12);
  EXPECT_NEAR(gain.sd, 125.0 * std::hypot(0.01, 0.01), 1e-12);
  const Measured apart = efficiency_gain(measure_efficiency(dig(2500.0)), found, true);
  EXPECT_NEAR(apart.sd, 125.0 * std::sqrt(2.0) * std::hypot(0.01, 0.02), 1e-12);
}

/// A square heap of 0.4 m^3 on level ground, a point every 2 cm.
Scan heap(double height) {
  auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 200; ++j) {
      const double x = 0.02 * (i - 100) + 0.01;
      const double y = 0.02 * (j - 100) + 0.01;
      cloud->points.emplace_back(x, y, std::max(std::abs(x), std::abs(y)) < 0.5 ? height : 0.0);
    }
  }
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  return scan;
}

TEST_F(Efficiency, TakesTheHeapBetweenScansInMemory) {
  LoggedDig scanned = dig(2000.0);
  scanned.lifted = ScanPair{heap(0.0), heap(0.4)};
  scanned.cell_size = 0.1;
  const DigEfficiency found = measure_efficiency(scanned);
  EXPECT_EQ(found.unit(), "m3_per_kj");
  EXPECT_NEAR(found.payload.amount.value, 0.4, 0.004);
}

TEST_F(Efficiency, MessagesNameTheFields) {
  LoggedDig late = dig(1.0);
  late.to = 11.0;
  EXPECT_EQ(error_of([&] { measure_efficiency(late); }),
            "to: 11 s is outside " + late.file + ", which runs from 0 to 10 s");
  LoggedDig empty = dig(1.0);
  empty.lifted = Payload{Lifted::volume, {0.0, 0.0}};
  EXPECT_EQ(error_of([&] { measure_efficiency(empty); }), "volume: 0, must be above 0");
  empty.prefix = "--second-";
  EXPECT_EQ(error_of([&] { measure_efficiency(empty); }), "--second-volume: 0, must be above 0");
}

// What a dig costs is summed over its rows, so that many digs cost no more than one.
TEST(LogRows, OfAllDigsAreAsManyAsThoseOfTheLog) {
  constexpr std::size_t rows = 10000;
  DigLog log;
  log.rates = {{}};
  for (std::size_t i = 0; i < rows; ++i) {
    log.time.push_back(0.1 * static_cast<double>(i));
    log.rates[0].push_back(i % 2 == 0 ? 1.0 : 3.0);
  }
  std::size_t looked_at = 0;
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < rows; i += 2) {
    const LogInterval dig{log.time[i] - 0.05, log.time[i] + 0.05};
    const LogRows around = rows_around(log.time, dig);
    looked_at += around.last - around.first;
    sum += log.integral(dig);
  }
  EXPECT_LE(looked_at, 2 * rows);
  EXPECT_NEAR(sum, 0.1 * 2.5 * (rows / 2 - 1), 1e-6);
  EXPECT_EQ(rows_around(log.time, {-1.0, 1e9}).last, rows);
}

}  // namespace
}  // namespace excavplan
