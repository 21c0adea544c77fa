// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/trajectory.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include <excavplan/data_files.hpp>
#include <excavplan/error.hpp>
#include <excavplan/random.hpp>

namespace excavplan {
namespace {

constexpr double tolerance = 1e-6;  // of a limit, for rounding in differences of small steps

const Machine& zx120() {
  static const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  return machine;
}

double flat(double) { return 0.0; }

DigPath fixed_path(double step = 0.025) {
  DigPathOptions options;
  options.step = step;
  return std::get<DigPath>(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat, options));
}

DigPath path_through(const std::vector<JointAngles>& joints) {
  DigPath path;
  for (const JointAngles& angles : joints) {
    path.poses.push_back({DigPhase::scoop, forward_kinematics(zx120(), angles), angles});
  }
  return path;
}

/// Largest share of a limit that the samples use: {speed, acceleration}, both taken as differences
/// of the joints and of the stated rates, with standstill before and after.
std::pair<double, double> used_share(const Machine& machine, const Trajectory& trajectory) {
  double speed = 0.0, acceleration = 0.0;
  const auto& points = trajectory.points;
  for (int i = 0; i < 3; ++i) {
    const JointLimits& limits = machine.limits[static_cast<std::size_t>(i)];
    double mean_before = 0.0, step_before = 0.0;
    for (std::size_t k = 1; k <= points.size(); ++k) {
      const bool over = k == points.size();
      const double step = over ? 0.0 : points[k].time - points[k - 1].time;
      const double mean = over ? 0.0 : (points[k].joints[i] - points[k - 1].joints[i]) / step;
      const double change = std::abs(mean - mean_before) / (0.5 * (step + step_before));
      acceleration = std::max(acceleration, change / limits.acceleration);
      speed = std::max(speed, std::abs(mean) / limits.speed);
      mean_before = mean;
      step_before = step;
      if (over) break;
      const double rate_change = std::abs(points[k].rates[i] - points[k - 1].rates[i]) / step;
      acceleration = std::max(acceleration, rate_change / limits.acceleration);
      speed = std::max(speed, std::abs(points[k].rates[i]) / limits.speed);
    }
  }
  return {speed, acceleration};
}

void expect_well_formed(const Trajectory& trajectory) {
  const auto& points = trajectory.points;
  ASSERT_EQ(points.front().time, 0.0);
  ASSERT_EQ(points.front().rates.norm(), 0.0);
  ASSERT_EQ(points.back().rates.norm(), 0.0);
  for (std::size_t k = 1; k < points.size(); ++k) {
    ASSERT_TRUE(std::isfinite(points[k].time));
    ASSERT_GT(points[k].time, points[k - 1].time);
    if (points[k].phase != points[k - 1].phase) {
      const JointAngles at_change = points[k - 1].rates;
      if (k > 1) {
        ASSERT_EQ(at_change.norm(), 0.0);
      }
    }
  }
}

// ---- oracles ------------------------------------------------------------------------------------

// One joint alone is a trapezoid: full acceleration, full speed, full braking.
TEST(Trajectory, SingleJointMoveIsTheTextbookTrapezoid) {
  for (const double turn : {0.05, 0.3, 2.0}) {
    std::vector<JointAngles> joints;
    for (int i = 0; i <= 1000; ++i) joints.emplace_back(-0.3, 1.5, turn * i / 1000);
    const Trajectory trajectory = time_dig_path(zx120(), path_through(joints), {1.0});
    const double v = zx120().limits[2].speed, a = zx120().limits[2].acceleration;
    const double expected = turn > v * v / a ? turn / v + v / a : 2.0 * std::sqrt(turn / a);
    EXPECT_NEAR(trajectory.duration(), expected, 0.005 * expected);
    EXPECT_GE(trajectory.duration(), expected * (1 - 1e-9));
  }
}

TEST(Trajectory, PaperFixedPathTakesAFewSeconds) {
  const Trajectory trajectory = time_dig_path(zx120(), fixed_path(), {1.0});
  EXPECT_GT(trajectory.dig_duration(), 3.5);
  EXPECT_LT(trajectory.dig_duration(), 5.0);
  EXPECT_GT(trajectory.duration(), trajectory.dig_duration());
}

TEST(Trajectory, DurationHardlyDependsOnTheSampling) {
  const double fine = time_dig_path(zx120(), fixed_path(0.002)).duration();
  EXPECT_NEAR(time_dig_path(zx120(), fixed_path(0.025)).duration(), fine, 0.03 * fine);
  EXPECT_NEAR(time_dig_path(zx120(), fixed_path(0.1)).duration(), fine, 0.10 * fine);
}

TEST(Trajectory, SlowerLimitsTakeLonger) {
  const double full = time_dig_path(zx120(), fixed_path(), {1.0}).duration();
  const double half = time_dig_path(zx120(), fixed_path(), {0.5}).duration();
  EXPECT_GT(half, full * std::sqrt(2.0) - 1e-9);
  EXPECT_LT(half, full * 2.0 + 1e-9);
}

// ---- properties ---------------------------------------------------------------------------------

TEST(Trajectory, GoesThroughThePosesOfThePath) {
  const DigPath path = fixed_path();
  const Trajectory trajectory = time_dig_path(zx120(), path);
  ASSERT_EQ(trajectory.points.size(), path.poses.size());
  for (std::size_t k = 0; k < path.poses.size(); ++k) {
    EXPECT_EQ(trajectory.points[k].joints, path.poses[k].joints);
    EXPECT_EQ(trajectory.points[k].phase, path.poses[k].phase);
    EXPECT_EQ(trajectory.points[k].bucket.floor_angle, path.poses[k].bucket.floor_angle);
  }
  expect_well_formed(trajectory);
}

TEST(Trajectory, TenThousandDigsKeepTheirLimitsAtEverySample) {
  Random random(21);
  int digs = 0;
  double speed = 0.0, acceleration = 0.0;
  while (digs < 10000) {
    DigParameters parameters;
    for (const DigParameterInfo& info : dig_parameter_table()) {
      parameters.*info.field = random.uniform(info.lower, info.upper);
    }
    const auto outcome = make_dig_path(zx120(), parameters, random.uniform(3.0, 8.0), flat);
    if (!std::holds_alternative<DigPath>(outcome)) continue;
    ++digs;
    const Trajectory trajectory = time_dig_path(zx120(), std::get<DigPath>(outcome), {1.0});
    expect_well_formed(trajectory);
    const auto [v, a] = used_share(zx120(), trajectory);
    ASSERT_LE(v, 1.0 + tolerance);
    ASSERT_LE(a, 1.0 + tolerance);
    speed += v / 10000;
    acceleration += a / 10000;
  }
  EXPECT_GT(speed, 0.9);  // fast as well as safe: some joint is nearly always at its limit
  EXPECT_GT(acceleration, 0.9);
}

TEST(Trajectory, StatedRatesAreThoseOfTheJoints) {
  const Trajectory trajectory = time_dig_path(zx120(), fixed_path(0.002), {1.0});
  const auto& points = trajectory.points;
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    if (points[k - 1].phase != points[k + 1].phase) continue;
    const JointAngles slope =
        (points[k + 1].joints - points[k - 1].joints) / (points[k + 1].time - points[k - 1].time);
    ASSERT_LT((slope - points[k].rates).norm(), 0.03) << points[k].time;
  }
}

TEST(Trajectory, UsesOnlyTheFractionOfTheLimitsItMay) {
  const auto [speed, acceleration] =
      used_share(zx120(), time_dig_path(zx120(), fixed_path(), {0.6}));
  EXPECT_LE(speed, 0.6 * (1 + tolerance));
  EXPECT_LE(acceleration, 0.6 * (1 + tolerance));
}

TEST(Trajectory, RoughPathsKeepTheLimitsToo) {
  Random random(22);
  for (int n = 0; n < 200; ++n) {
    std::vector<JointAngles> joints = {JointAngles(-0.3, 1.5, 0.5)};
    const double size = std::pow(10.0, random.uniform(-6, -0.5));
    for (int i = 0; i < 20; ++i) {
      joints.push_back(joints.back() + size * JointAngles(random.uniform(-1, 1),
                                                          random.uniform(-1, 1),
                                                          random.uniform(-1, 1)));
    }
    const Trajectory trajectory = time_dig_path(zx120(), path_through(joints), {1.0});
    expect_well_formed(trajectory);
    const auto [speed, acceleration] = used_share(zx120(), trajectory);
    ASSERT_LE(speed, 1.0 + tolerance);
    ASSERT_LE(acceleration, 1.0 + tolerance);
  }
}

// ---- degenerate paths ---------------------------------------------------------------------------

TEST(Trajectory, DigsWithEmptyOrTinyPhasesAreTimed) {
  for (const double push : {0.0, 1e-310, 1e-9, 1e-3}) {
    for (const double drag : {0.0, 1e-310, 1e-9, 1e-3}) {
      const auto path = std::get<DigPath>(make_dig_path(zx120(), {0.7, push, drag}, 6.0, flat));
      const Trajectory trajectory = time_dig_path(zx120(), path, {1.0});
      expect_well_formed(trajectory);
      const auto [speed, acceleration] = used_share(zx120(), trajectory);
      EXPECT_LE(speed, 1.0 + tolerance);
      EXPECT_LE(acceleration, 1.0 + tolerance);
    }
  }
}

TEST(Trajectory, PhaseOfASingleStepGetsAPointHalfway) {
  const Trajectory trajectory =
      time_dig_path(zx120(), path_through({{-0.3, 1.5, 0.5}, {-0.3, 1.5, 0.7}}), {1.0});
  ASSERT_EQ(trajectory.points.size(), 3u);
  EXPECT_NEAR(trajectory.points[1].joints[2], 0.6, 1e-15);
  EXPECT_NEAR(trajectory.duration(), 2.0 * std::sqrt(0.2 / 1.5), 1e-9);
}

TEST(Trajectory, PosesThatDoNotMoveAreDropped) {
  const JointAngles a(-0.3, 1.5, 0.5), b(-0.3, 1.5, 0.6), c(-0.3, 1.5, 0.7);
  EXPECT_EQ(time_dig_path(zx120(), path_through({a, a, b, b, b, c, c})).points.size(), 3u);
  const Trajectory still = time_dig_path(zx120(), path_through({a, a}));
  EXPECT_EQ(still.points.size(), 1u);
  EXPECT_EQ(still.duration(), 0.0);
  EXPECT_EQ(Trajectory().duration(), 0.0);
  EXPECT_EQ(Trajectory().dig_duration(), 0.0);
}

TEST(Trajectory, BadInputIsAnErrorThatNamesIt) {
  const auto complaint = [](const DigPath& path, double fraction) -> std::string {
    try {
      time_dig_path(zx120(), path, {fraction});
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      return error.what();
    }
    return "accepted";
  };
  const std::string rule = ", must be above 0 and at most 1";
  EXPECT_EQ(complaint(fixed_path(), 0.0), "TrajectoryOptions::speed_fraction is 0" + rule);
  EXPECT_EQ(complaint(fixed_path(), 1.1), "TrajectoryOptions::speed_fraction is 1.1" + rule);
  EXPECT_EQ(complaint(fixed_path(), std::numeric_limits<double>::quiet_NaN()),
            "TrajectoryOptions::speed_fraction is nan" + rule);
  EXPECT_EQ(complaint(DigPath(), 0.8), "the dig path has 0 poses, must have at least 2");
  DigPath broken = fixed_path();
  broken.poses[3].joints[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint(broken, 0.8), "pose 3 of the dig path has a joint that is not finite");
}

// ---- CSV ----------------------------------------------------------------------------------------

TEST(Trajectory, CsvHoldsEveryPointExactly) {
  const Trajectory trajectory = time_dig_path(zx120(), fixed_path());
  std::istringstream csv(to_csv(trajectory));
  std::string line;
  ASSERT_TRUE(std::getline(csv, line));
  EXPECT_EQ(line, "time_s,phase,boom_rad,arm_rad,bucket_rad,tip_x_m,tip_z_m,bucket_angle_rad");
  for (const TrajectoryPoint& point : trajectory.points) {
    ASSERT_TRUE(std::getline(csv, line));
    std::istringstream fields(line);
    std::string field;
    std::vector<double> values;
    while (std::getline(fields, field, ',')) {
      if (values.size() == 1 && field == name(point.phase)) continue;
      double value = 0.0;
      const auto result = std::from_chars(field.data(), field.data() + field.size(), value);
      ASSERT_EQ(result.ptr, field.data() + field.size()) << line;
      values.push_back(value);
    }
    const std::vector<double> expected = {
        point.time,     point.joints[0], point.joints[1],         point.joints[2],
        point.bucket.x, point.bucket.z,  point.bucket.floor_angle};
    EXPECT_EQ(values, expected);
  }
  EXPECT_FALSE(std::getline(csv, line));
}

}  // namespace
}  // namespace excavplan
