// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/design/cut_and_fill.hpp>

#include <array>
#include <cmath>
#include <random>

#include <excavplan/design/design_words.hpp>

#include "design_files.hpp"
#include "support/errors.hpp"

namespace excavplan::test {
namespace {

using std::string;

DesignSurface plane_design(double z, double slope, double size) {
  DesignSurface design;
  design.name = "plane";
  Tin tin;
  tin.points = {
      {0, 0, z}, {size, 0, z + slope * size}, {size, size, z + slope * size}, {0, size, z}};
  tin.triangles = {{0, 1, 2}, {0, 2, 3}};
  design.shape = tin;
  return design;
}

HeightMap ground_at(double z) { return flat_ground({-2, -2, 12, 12}, 0.1, z); }

TEST(CutAndFill, OfAPlaneThroughTheGroundIsTwoWedges) {
  const CutAndFill volumes = cut_and_fill(plane_design(-0.5, 0.1, 10.0), ground_at(0.0));
  EXPECT_NEAR(volumes.cut.value, 0.5 * 0.5 * 5.0 * 10.0, 1e-9);
  EXPECT_NEAR(volumes.fill.value, 0.5 * 0.5 * 5.0 * 10.0, 1e-9);
  EXPECT_NEAR(volumes.area, 100.0, 1e-9);
  EXPECT_EQ(volumes.cut.sd, 0.0);
}

TEST(CutAndFill, ADesignThatOnlyCutsEndsAtTheGround) {
  DesignSurface design = plane_design(-0.5, 0.1, 10.0);
  design.cuts_only = true;
  const CutAndFill volumes = cut_and_fill(design, ground_at(0.0));
  EXPECT_NEAR(volumes.cut.value, 12.5, 1e-9);
  EXPECT_EQ(volumes.fill.value, 0.0);
  EXPECT_NEAR(volumes.area, 50.0, 1e-9);
}

TEST(CutAndFill, DeviationsAreThoseOfRepeatedScans) {
  const DesignSurface design = plane_design(-0.5, 0.0, 10.0);
  CutOptions options;
  options.errors.height_sd = 0.01;
  options.errors.tilt_sd = 0.002;
  Surface ground;
  ground.height = ground_at(0.0);
  const double noise = 0.02;
  ground.variance =
      Eigen::ArrayXXd::Constant(ground.height.z.rows(), ground.height.z.cols(), noise * noise);
  std::mt19937 random(1);
  const auto normal = [&random] {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(random()) / 4294967296.0;
    return sum;
  };
  const HeightMap level = ground.height;
  double squares = 0.0;
  constexpr int scans = 200;
  CutAndFill volumes;
  for (int scan = 0; scan < scans; ++scan) {
    const double shift = options.errors.height_sd * normal();
    const double along_x = options.errors.tilt_sd * normal(),
                 along_y = options.errors.tilt_sd * normal();
    for (Eigen::Index col = 0; col < level.z.cols(); ++col) {
      for (Eigen::Index row = 0; row < level.z.rows(); ++row) {
        ground.height.z(row, col) = shift + along_x * (level.x(col) - 5.0) +
                                    along_y * (level.y(row) - 5.0) + noise * normal();
      }
    }
    volumes = cut_and_fill(design, ground, options);
    squares += std::pow(volumes.cut.value - 50.0, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / scans) / volumes.cut.sd, 1.0, 0.2);
}

TEST(CutAndFill, NoiseOnFinishedGroundIsNeitherCutNorFill) {
  const DesignSurface design = plane_design(0.0, 0.0, 10.0);
  Surface ground;
  ground.height = ground_at(0.0);
  ground.variance = Eigen::ArrayXXd::Constant(ground.height.z.rows(), ground.height.z.cols(), 1e-4);
  std::mt19937 random(2);
  for (double& z : ground.height.z.reshaped())
    z = 0.0346 * (static_cast<double>(random()) / 4294967296.0 - 0.5);
  const CutAndFill volumes = cut_and_fill(design, ground);
  // By cells alone each of them would be a quarter of the width of the noise: 0.43 m^3.
  EXPECT_LT(volumes.cut.value, 0.11);
  EXPECT_LT(volumes.fill.value, 0.11);
  EXPECT_TRUE(volumes.deviation.is_within);
  EXPECT_NEAR(volumes.deviation.rms, 0.01, 5e-4);
}

TEST(CutAndFill, UnknownGroundIsFilledAndTold) {
  HeightMap ground = ground_at(0.0);
  ground.z.block(40, 40, 20, 20).setConstant(std::nan(""));
  const CutAndFill volumes = cut_and_fill(plane_design(-0.5, 0.0, 10.0), ground);
  EXPECT_NEAR(volumes.cut.value, 50.0, 1e-6);
  EXPECT_NEAR(volumes.unseen_area, 4.0, 1e-9);
  EXPECT_NEAR(volumes.cut.sd, 4.0 * 0.25 * 0.5, 1e-6);
  ASSERT_EQ(volumes.notes.size(), 1u);
}

TEST(CutAndFill, RimAndSteepFacesDoNotCountForTheDeviation) {
  HeightMap ground = ground_at(-0.5);
  const CutAndFill volumes = cut_and_fill(plane_design(-0.5, 0.0, 10.0), ground);
  EXPECT_NEAR(volumes.deviation.area, 9.8 * 9.8, 1e-9);
  EXPECT_NEAR(volumes.deviation.rms, 0.0, 1e-12);
  EXPECT_EQ(cut_and_fill(plane_design(-10.0, 2.0, 10.0), ground).deviation.area, 0.0);
}

TEST(CutAndFill, WhatIsNearAnUprightFaceDoesNotCountForTheDeviation) {
  for (const double face : {5.03, 5.0, 4.2}) {  // of two floors, within a cell or between two
    DesignSurface design;
    Tin tin;
    for (const auto& [from, to, z] : {std::array{0.0, face, -0.8}, {face, 10.0, -0.3}}) {
      tin.points.insert(tin.points.end(), {{from, 0, z}, {to, 0, z}, {to, 10, z}, {from, 10, z}});
    }
    tin.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {1, 4, 7}, {1, 7, 2}};
    design.shape = tin;
    const double counted = cut_and_fill(design, ground_at(0.0)).deviation.area;
    EXPECT_LT(counted, 9.7 * 9.8) << face;
    EXPECT_GT(counted, 9.4 * 9.8) << face;
  }
}

TEST(CutAndFill, UnknownGroundFarFromTheDesignChangesNothing) {
  HeightMap ground = ground_at(0.0);
  const DesignSurface design = plane_design(-0.5, 0.0, 2.0);
  ground.z.block(25, 25, 6, 6).setConstant(std::nan(""));
  const CutAndFill near = cut_and_fill(design, ground);
  ground.z.rightCols(20).setConstant(std::nan(""));
  const CutAndFill both = cut_and_fill(design, ground);
  EXPECT_GT(near.unseen_area, 0.0);
  EXPECT_EQ(both.unseen_area, near.unseen_area);
  EXPECT_EQ(both.cut.value, near.cut.value);
}

TEST(CutAndFill, ABodyIsNoSurface) {
  DesignSurface design = plane_design(-0.5, 0.0, 10.0);
  Tin& tin = std::get<Tin>(design.shape);
  tin.points.push_back({0, 0, 1});
  tin.points.push_back({10, 0, 1});
  tin.points.push_back({10, 10, 1});
  tin.triangles.push_back({4, 5, 6});
  const string error = error_of([&] { cut_and_fill(design, ground_at(0.0)); }, ErrorKind::bad_file);
  EXPECT_NE(error.find("lie above one another on 50"), string::npos) << error;
}

string placement_error(const DesignSurface& design, const HeightMap& ground) {
  return error_of([&] { cut_and_fill(design, ground); }, ErrorKind::bad_file);
}

/// A design as if its file had other axes or units.
DesignSurface wrong(double factor, bool swapped) {
  DesignSurface design;
  design.name = "trench";
  Tin tin;
  for (Eigen::Vector3d p : battered_trench({100.0, 30.0}).points) {
    if (swapped) std::swap(p.x(), p.y());
    tin.points.push_back(factor * p);
  }
  tin.triangles = battered_trench({0, 0}).triangles;
  design.shape = tin;
  return design;
}

TEST(Placement, WhatWouldMakeADesignFitIsTold) {
  const HeightMap ground = flat_ground({95, 25, 120, 40}, 0.1);
  EXPECT_NO_THROW(cut_and_fill(wrong(1.0, false), ground));
  EXPECT_NE(placement_error(wrong(1.0, true), ground).find("are swapped"), string::npos);
  EXPECT_NE(
      placement_error(wrong(1.0 / 0.3048, false), ground).find("they are feet taken for metres"),
      string::npos);
  EXPECT_NE(placement_error(wrong(1000.0, true), ground)
                .find("are swapped and they are millimetres taken for metres"),
            string::npos);
  EXPECT_NE(placement_error(plane_design(0, 0, 1), ground).find("in the same frame?"),
            string::npos);
  EXPECT_NE(placement_error(wrong(1.0, false), ground_at(0)).find("in the same frame?"),
            string::npos)
      << "a trench of centimetres is none";
  EXPECT_EQ(placement_error(plane_design(0, 0, 30), ground_at(0)).find("swapped"), string::npos)
      << "a single mistake is likelier than two";
  EXPECT_NE(placement_error(plane_design(-200, 0, 10), ground_at(0)).find("200 m below the ground"),
            string::npos);
}

TEST(DesignWords, ATrenchIsCutAsItsWordsSay) {
  DesignWords words = trench_of_size("10x0.7x1.2m");
  words.heading = 0.7;
  words.from = {1.0, 1.0};
  EXPECT_NEAR(cut_and_fill(design_of_words(words, ground_at(0.3)), ground_at(0.3)).cut.value,
              10 * 0.7 * 1.2, 1e-9);
  words.batter = 0.5;
  words.length = 6.0;
  const double b = 0.6;
  const double walls = 1.2 * b * (6.0 + 0.7) + 4.0 / 3.0 * 1.2 * b * b;
  EXPECT_NEAR(cut_and_fill(design_of_words(words, ground_at(0.3)), ground_at(0.3)).cut.value,
              6 * 0.7 * 1.2 + walls, 1e-9);
}

TEST(DesignWords, ASlopeRisesToTheLeft) {
  DesignWords words;
  words.kind = DesignKind::slope;
  words.length = 5.0;
  words.floor_width = 2.0;
  words.floor_z = -1.0;
  words.batter = 1.5;
  words.from = {2.0, 5.0};
  const CutAndFill volumes = cut_and_fill(design_of_words(words, ground_at(0.0)), ground_at(0.0));
  EXPECT_NEAR(volumes.cut.value, 5.0 * (2.0 + 0.75), 1e-9);
  EXPECT_NEAR(volumes.area, 5.0 * 3.5, 1e-9);
}

TEST(DesignWords, AHeapAsideIsNoPartOfATrench) {
  DesignWords words = trench_of_size("6x1x0.5");
  words.batter = 1.0;
  words.from = {2.0, 1.0};
  HeightMap ground = ground_at(0.0);
  const double without = cut_and_fill(design_of_words(words, ground), ground).cut.value;
  ground.z.bottomRows(60).setConstant(6.0);
  words.depth.reset();
  words.floor_z = -0.5;
  EXPECT_NEAR(cut_and_fill(design_of_words(words, ground), ground).cut.value, without, 1e-9);
}

TEST(DesignWords, SizesAndRules) {
  EXPECT_NEAR(*trench_of_size("15x1x50cm").depth, 0.5, 1e-12);
  EXPECT_NEAR(trench_of_size("15x1x2ft").length, 4.572, 1e-12);
  for (const char* size : {"", "15", "15x1", "15x1x-1", "15x1x0.5x2", "axbxc", "15x1xnan", "m"}) {
    EXPECT_NE(error_of([&] { trench_of_size(size); }).find("must be length x width x depth"),
              string::npos)
        << size;
  }
  DesignWords words = trench_of_size("15x1x0.5");
  words.floor_z = 1.0;
  EXPECT_NE(error_of([&] { design_of_words(words, ground_at(0)); }).find("either a depth or"),
            string::npos);
  words.floor_z.reset();
  words.from = {1000.0, 0.0};
  EXPECT_NE(error_of([&] { design_of_words(words, ground_at(0)); }).find("no ground is known"),
            string::npos);
}

}  // namespace
}  // namespace excavplan::test
