// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/error_field.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "base/non_finite.hpp"
#include "ground/noise_model.hpp"
#include "ground/registration.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

constexpr double cell = 0.1;
constexpr double plug_in = 1.15;  // docs/methods.md#volumes

/// Ground in waves with one square zone in its middle; the rim, without a gradient, is not used.
struct Site {
  HeightMap map;
  Eigen::ArrayXXi zone;
  Eigen::ArrayXXd residual;
};

Site site_of(Eigen::Index cells, Eigen::Index zone_cells, double wave_length) {
  const double edge = cell * static_cast<double>(cells);
  Site site;
  site.map = flat_ground({0.0, 0.0, edge, edge}, cell);
  const double wave = 2.0 * 3.141592653589793 / wave_length;
  for_each_cell(site.map.z, [&](Cell at) {
    const double x = wave * site.map.x(at.col);
    const double y = wave * site.map.y(at.row);
    site.map.z(at.row, at.col) = 0.1 * (std::sin(x) + std::sin(y + 0.6));
  });
  const Eigen::Index first = (cells - zone_cells) / 2;
  site.zone.setConstant(cells, cells, -1);
  site.zone.block(first, first, zone_cells, zone_cells).setZero();
  site.residual.setConstant(cells, cells, nan);
  site.residual.block(1, 1, cells - 2, cells - 2).setZero();
  site.residual.block(first, first, zone_cells, zone_cells).setConstant(nan);
  return site;
}

/// The prior of what motion is left, about the middle of the site.
Alignment left_of(const Site& site, double shift, double turn) {
  const Rectangle extent = site.map.extent();
  Alignment alignment;
  alignment.centre = {0.5 * extent.x_max, 0.5 * extent.y_max, 0.0};
  alignment.left.setZero();
  alignment.left.diagonal() << shift, shift, 0.02, turn, turn, turn;
  alignment.left = alignment.left.cwiseAbs2().eval();
  return alignment;
}

ZoneErrors predicted(const Site& site, const NoiseModel& noise, const Alignment& alignment) {
  return ErrorField{site.map, site.residual, site.zone, 1, noise, alignment}.predict();
}

/// The cells of a site one by one, each with the effects of a motion on it.
class Cells {
 public:
  Cells(const Site& site, const Alignment& alignment) : size_(site.map.cell_size) {
    const Gradient gradient = gradient_of(site.map);
    for_each_cell(site.map.z, [&](Cell at) {
      const bool is_known = !std::isnan(site.residual(at.row, at.col));
      if (!is_known && site.zone(at.row, at.col) < 0) return;
      const Eigen::Vector2d slope(gradient.x(at.row, at.col), gradient.y(at.row, at.col));
      const Eigen::Vector3d place(site.map.x(at.col), site.map.y(at.row),
                                  site.map.z(at.row, at.col));
      auto& part = is_known ? known_ : zone_;
      part.push_back({place.head<2>(), motion_effect(place - alignment.centre, slope)});
    });
  }

  /// Variance of the volume of the zone by correlated noise, given the errors of all other cells.
  double variance_given_known(const NoiseModel& noise) const {
    const auto count = static_cast<Eigen::Index>(known_.size());
    Eigen::MatrixXd covariance(count, count);
    Eigen::VectorXd with_zone = Eigen::VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const One& one = known_[static_cast<std::size_t>(i)];
      for (Eigen::Index j = 0; j <= i; ++j) {
        covariance(i, j) = between(one, known_[static_cast<std::size_t>(j)], noise);
      }
      covariance(i, i) += noise.white;
      for (const One& other : zone_) with_zone(i) += between(one, other, noise);
    }
    double own = 0.0;
    for (const One& one : zone_) {
      for (const One& other : zone_) own += between(one, other, noise);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    return std::pow(size_, 4) * (own - with_zone.dot(factor.solve(with_zone)));
  }

  /// Variance of the volume of the zone by the motion alone, from independent errors of the cells.
  double variance_by_motion(double white, const MotionCovariance& left) const {
    MotionCovariance information = left.inverse();
    for (const One& one : known_) information += one.effect * one.effect.transpose() / white;
    Motion volume = Motion::Zero();
    for (const One& one : zone_) volume += size_ * size_ * one.effect;
    return volume.dot(information.inverse() * volume);
  }

 private:
  struct One {
    Eigen::Vector2d place;
    Motion effect;
  };
  static double between(const One& a, const One& b, const NoiseModel& noise) {
    return noise.at((a.place - b.place).norm());
  }

  double size_;
  std::vector<One> known_;
  std::vector<One> zone_;
};

/// Of the variance by correlated noise, found to exact; the covariance is taken for fitted.
double found_to_exact(const Site& site, double length, double power) {
  const Alignment alignment = left_of(site, 0.001, 0.005);
  const NoiseModel noise{1e-6, 1e-6, length, power};
  const double exact = Cells(site, alignment).variance_given_known(noise);
  return predicted(site, noise, alignment).correlated(0, 0) / (plug_in * exact);
}

/// Blocks of cells with four points each stand for the cells: within 7 %.
TEST(ErrorField, CorrelatedErrorIsThatOfKrigingCellByCellTimesTheFactorForAFittedCovariance) {
  const Site site = site_of(32, 8, 3.2);
  for (const double power : {1.0, 1.5, 2.0}) {
    for (const double length : {0.2, 0.3}) {
      EXPECT_NEAR(found_to_exact(site, length, power), 1.0, 0.07) << power << " " << length;
    }
  }
}

TEST(ErrorField, CorrelatedErrorOnASmallSiteIsThatOfKrigingTimesTheFactorToo) {
  EXPECT_NEAR(found_to_exact(site_of(20, 6, 2.0), 0.2, 1.5), 1.0, 0.07);
}

/// The ground around a zone tells the motion that is left by its relief, here in waves of 32 cells.
/// The mean over a block of 4 cells keeps 0.95 of the square of such a wave, over one of 8 0.81.
TEST(ErrorField, ErrorByTheMotionThatIsLeftIsThatOfRegressionCellByCell) {
  const Site site = site_of(64, 8, 3.2);
  const NoiseModel noise{1e-4, 0.0, 0.0, 1.0};
  for (const double turn : {1e-5, 0.01}) {
    const Alignment alignment = left_of(site, 0.02, turn);
    const double exact = Cells(site, alignment).variance_by_motion(noise.white, alignment.left);
    const ZoneErrors errors = predicted(site, noise, alignment);
    EXPECT_EQ(errors.correlated(0, 0), 0.0);
    EXPECT_NEAR(errors.datum(0, 0) / exact, 1.0, 0.07) << turn;
  }
}

}  // namespace
}  // namespace excavplan
