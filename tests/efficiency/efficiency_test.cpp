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

/// Ground of 4 m by 4 m, a point every 2 cm.
template <typename Height>
Scan scan_of(const Height& height) {
  auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 200; ++j) {
      const double x = 0.02 * (i - 100) + 0.01;
      const double y = 0.02 * (j - 100) + 0.01;
      cloud->points.emplace_back(x, y, height(x, y));
    }
  }
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  return scan;
}

/// A square heap of 0.4 m^3 on level ground.
Scan heap(double height) {
  return scan_of([height](double x, double y) {
    return std::max(std::abs(x), std::abs(y)) < 0.5 ? height : 0.0;
  });
}

TEST_F(Efficiency, TakesTheHeapBetweenScansInMemory) {
  LoggedDig scanned = dig(2000.0);
  scanned.lifted = ScanPair{heap(0.0), heap(0.4)};
  scanned.cell_size = 0.1;
  const DigEfficiency found = measure_efficiency(scanned);
  EXPECT_EQ(found.unit(), "m3_per_kj");
  EXPECT_NEAR(found.payload.amount.value, 0.4, 0.004);
}

/// 1 at its top, 0 from the radius on.
double cone(double x, double y, double radius) {
  return std::max(0.0, 1.0 - std::hypot(x, y) / radius);
}

TEST_F(Efficiency, SoilThatLiesBesideTheHoleWasNotLifted) {
  const Scan level = scan_of([](double, double) { return 0.0; });
  const Scan dug = scan_of(
      [](double x, double y) { return 0.3 * cone(x - 1.2, y, 0.6) - 0.4 * cone(x + 0.4, y, 0.8); });
  LoggedDig scanned = dig(2000.0);
  scanned.lifted = PitScans{{level, dug}};
  scanned.bulking_factor = Measured{1.2, 0.0};
  const double third = std::acos(-1.0) / 3.0;
  const double hole = third * 0.64 * 0.4, spill = third * 0.36 * 0.3;
  EXPECT_NEAR(measure_efficiency(scanned).payload.amount.value, 1.2 * hole - spill, 0.02 * hole);
}

TEST_F(Efficiency, ABankVolumeAndItsErrorGrowByTheFactor) {
  LoggedDig bank = dig(2000.0);
  bank.lifted = BankVolume{{0.4, 0.04}};
  bank.bulking_factor = Measured{1.5, 0.0};
  const Measured loose = measure_efficiency(bank).payload.amount;
  EXPECT_DOUBLE_EQ(loose.value, 0.6);
  EXPECT_DOUBLE_EQ(loose.sd, 0.06) << "a tenth as well";
  bank.bulking_factor->sd = 0.15;
  EXPECT_DOUBLE_EQ(measure_efficiency(bank).payload.amount.sd, 0.06 * std::sqrt(2.0));
}

/// A peak before a dig is no rest of the log that tells what the machine takes.
TEST_F(Efficiency, OnlyARestAsLongAsTheDigCastsDoubtOnIt) {
  for (const int rest : {8, 12}) {
    std::string rows = "time_s,power_w\n";
    for (int i = 0; i <= 20; ++i) {
      rows += std::to_string(i) + (i < rest ? ",9000\n" : ",3000\n");
    }
    LoggedDig later = dig(1.0);
    later.file = folder.write("rest.csv", rows);
    later.from = rest;
    later.idle = 500.0;
    const DigEfficiency found = measure_efficiency(later);
    EXPECT_DOUBLE_EQ(found.cost, 3.0 * (20 - rest));
    EXPECT_EQ(test::has(found.warnings, "dig_below_rest"), rest > 10) << rest;
    EXPECT_EQ(found.trustworthy, rest < 10) << rest;
  }
}

TEST_F(Efficiency, HalvesOfADayMayBeWrittenSmall) {
  for (const auto& [first, second] :
       {std::pair("11:59:55 AM", "12:00:05 PM"), {"11:59:55 am", "12:00:05 pm"}}) {
    LoggedDig noon = dig(1.0);
    const std::string row = ",2000\n";
    noon.file = folder.write("noon.csv", "time,power_w\n" + (first + row) + second + row);
    EXPECT_DOUBLE_EQ(measure_efficiency(noon).cost, 20.0) << first;
  }
}

TEST_F(Efficiency, GallonsAreThoseOfTheUnitedStates) {
  for (const char* unit : {"gal/h", "gph"}) {
    LoggedDig hour = dig(1.0);
    hour.file = folder.write("hour.csv",
                             std::string("time [h],fuel flow [") + unit + "]\n0,2\n0.5,2\n1,2\n");
    EXPECT_NEAR(measure_efficiency(hour).cost, 2.0 * 3785.411784, 1e-6) << unit;
  }
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
