// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/ground_state.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <excavplan/ground/map_files.hpp>

#include "base/non_finite.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

/// Of numbers that no decimal of a few digits holds, with what is not known in each layer.
GroundState full_state() {
  GroundState state;
  HeightMap& bank = state.terrain.bank;
  bank.origin = {1234567.1 + 1.0 / 3.0, -20.7};
  bank.cell_size = 0.1 / 3.0;
  bank.z.resize(2, 3);
  bank.z << 1.0 / 3.0, -0.0, nan, 1e-300, -2.0 / 7.0, 5.5;
  state.terrain.loose = bank.z.abs().isNaN().select(0.0, 0.1 * bank.z.abs());
  state.terrain.bank_void_ratio = 0.5 + bank.z.abs();
  state.terrain.loose_void_ratio = bank.z.abs() / 3.0;
  state.terrain.obstacles = Eigen::ArrayXXd::Constant(2, 3, nan);
  state.terrain.obstacles(1, 1) = 2.1;
  state.seen = 1764187638.123456 + bank.z;
  state.deviation = 0.01 + bank.z.abs();
  state.frame = "site <A> & \"B\"";
  state.soil = "loam";
  return state;
}

void expect_same(const Eigen::ArrayXXd& a, const Eigen::ArrayXXd& b) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (std::isnan(b(i))) {
      EXPECT_TRUE(std::isnan(a(i)));
    } else {
      EXPECT_EQ(std::memcmp(&a(i), &b(i), sizeof(double)), 0) << a(i) << ' ' << b(i);
    }
  }
}

void expect_same(const GroundState& a, const GroundState& b) {
  EXPECT_EQ(a.terrain.bank.origin, b.terrain.bank.origin);
  EXPECT_EQ(a.terrain.bank.cell_size, b.terrain.bank.cell_size);
  expect_same(a.terrain.bank.z, b.terrain.bank.z);
  expect_same(a.terrain.loose, b.terrain.loose);
  expect_same(a.terrain.bank_void_ratio, b.terrain.bank_void_ratio);
  expect_same(a.terrain.loose_void_ratio, b.terrain.loose_void_ratio);
  expect_same(a.terrain.obstacles, b.terrain.obstacles);
  expect_same(a.seen, b.seen);
  expect_same(a.deviation, b.deviation);
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.soil, b.soil);
}

class GroundFile : public testing::Test {
 protected:
  std::string fault_of(const std::string& bytes) const {
    const std::string file = folder.write("changed.tif", bytes);
    return test::error_about([&] { load_ground(file); }, file);
  }
  test::TemporaryFolder folder;
};

TEST_F(GroundFile, LosesNothing) {
  const std::string file = folder.file("ground.tif");
  save_ground(file, full_state());
  expect_same(load_ground(file), full_state());
}

TEST_F(GroundFile, HasTheLayersThatTheStateHas) {
  GroundState state = full_state();
  state.seen = state.terrain.obstacles = state.terrain.bank_void_ratio = Eigen::ArrayXXd();
  state.frame = state.soil = "";
  const std::string file = folder.file("ground.tif");
  save_ground(file, state);
  expect_same(load_ground(file), state);
}

TEST_F(GroundFile, IsTheSameBytesOnceMore) {
  const std::string file = folder.file("ground.tif");
  save_ground(file, full_state());
  const std::string bytes = test::content_of(file);
  save_ground(file, load_ground(file));
  EXPECT_EQ(test::content_of(file), bytes);
}

TEST_F(GroundFile, NoBitOfItTurnsUnnoticed) {
  const std::string file = folder.file("ground.tif");
  save_ground(file, full_state());
  const std::string bytes = test::content_of(file);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ (1 << (at % 8)));
    EXPECT_NE(fault_of(changed), "no error") << "byte " << at;
  }
  for (std::size_t at = 0; at < bytes.size(); at += 29) {
    EXPECT_NE(fault_of(bytes.substr(0, at)), "no error") << "cut at " << at;
  }
  EXPECT_NE(fault_of(bytes + '\0'), "no error");
}

TEST_F(GroundFile, SaysWhyAFileIsNone) {
  const std::string file = folder.file("ground.tif");
  save_ground(file, full_state());
  const std::string bytes = test::content_of(file);
  EXPECT_EQ(fault_of(""), "ends at byte 0, within the head of a TIFF");
  EXPECT_TRUE(test::contains(fault_of("MM" + bytes.substr(2)), "byte 0: is no TIFF"));
  EXPECT_TRUE(test::contains(fault_of(bytes.substr(0, bytes.size() - 8)), "it is cut off"));
  std::string changed = bytes;
  changed.back() ^= 1;
  EXPECT_TRUE(test::contains(fault_of(changed), "do not have the checksum"));
  changed = bytes;
  changed.replace(changed.find("name=\"version\">1"), 16, "name=\"version\">2");
  EXPECT_EQ(fault_of(changed), "version of its metadata is '2', must be '1'");
}

TEST_F(GroundFile, IsNotAnyMap) {
  const GroundState state = full_state();
  const std::string file = folder.file("map.tif");
  write_map(file, {state.terrain.bank, {{"bank_m", "bank", state.terrain.bank.z}}});
  EXPECT_EQ(test::error_about([&] { load_ground(file); }, file),
            "has no 'format' in its metadata: no ground file of excavplan");
}

TEST_F(GroundFile, KeepsTheOldOneIfAStateIsNone) {
  const std::string file = folder.file("ground.tif");
  save_ground(file, full_state());
  GroundState state = full_state();
  state.terrain.loose(0, 1) = -0.1;
  EXPECT_TRUE(test::contains(test::error_of([&] { save_ground(file, state); }),
                             "loose_m of the cell at x = "));
  state = full_state();
  state.seen.resize(1, 1);
  EXPECT_EQ(test::error_of([&] { save_ground(file, state); }),
            "state of the ground: layer seen_s must be as large as the bank");
  state = full_state();
  state.deviation(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_NE(test::error_of([&] { save_ground(file, state); }), "no error");
  state = full_state();
  state.frame = "two\nlines";
  EXPECT_NE(test::error_of([&] { save_ground(file, state); }), "no error");
  expect_same(load_ground(file), full_state());
}

TEST(GroundState, AfterADigKeepsWhatIsTold) {
  const GroundState before = full_state();
  Terrain after = before.terrain;
  after.bank.z(0, 0) -= 0.1;
  after.bank_void_ratio.setZero();
  const GroundState state = after_dig(before, after);
  EXPECT_TRUE(std::isnan(state.deviation(0, 0)));
  EXPECT_EQ(state.deviation(1, 1), before.deviation(1, 1));
  expect_same(state.terrain.bank.z, after.bank.z);
  expect_same(state.terrain.bank_void_ratio, before.terrain.bank_void_ratio);
  expect_same(state.seen, before.seen);
  after.bank.origin.x() += 1.0;
  EXPECT_EQ(test::error_of([&] { after_dig(before, after); }),
            "a dig leaves the grid of its ground");
}

}  // namespace
}  // namespace excavplan
