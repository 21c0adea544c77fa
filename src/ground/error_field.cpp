// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/error_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "base/angles.hpp"
#include "ground/grid_cells.hpp"
#include "ground/registration.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

/// Kriging with a fitted covariance underestimates its error (Zimmerman and Cressie 1992); the
/// factor is ours, from 300 simulated surveys.
constexpr double plug_in = 1.15;

/// A patch of the grid: the mean error over it is one datum, or one part of a zone.
struct Block {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double size = 0.0;
  double cells = 0.0;
  double mean = 0.0;  // of the residual
  Motion effect = Motion::Zero();
  int zone = -1;
};

/// The covariance of a noise model by table.
class CovarianceTable {
 public:
  explicit CovarianceTable(const NoiseModel& noise) {
    if (noise.correlated == 0.0) return;
    constexpr double least_log = 16.0;  // exp(-16) is negligible
    constexpr std::size_t steps = 4096;
    const double farthest = noise.length * std::pow(least_log, 1.0 / noise.power);
    per_distance_ = static_cast<double>(steps) / farthest;
    for (std::size_t i = 0; i <= steps; ++i) {
      values_.push_back(noise.at(farthest * static_cast<double>(i) / steps));
    }
  }

  /// Between the means over two blocks, each taken at the four Gauss points of its square: the
  /// covariance of sums over points, so that the matrix of many blocks stays positive.
  double between(const Block& a, const Block& b) const {
    if (values_.empty()) return 0.0;
    constexpr double gauss = 0.28867513459481287;  // of the edge
    const Eigen::Vector2d apart = a.centre - b.centre;
    const double sum = gauss * (a.size + b.size);
    const double difference = gauss * (a.size - b.size);
    double total = 0.0;
    for (const double x : {sum, -sum, difference, -difference}) {
      for (const double y : {sum, -sum, difference, -difference}) {
        const double u = apart.x() + x;
        const double v = apart.y() + y;
        total += at(std::sqrt(u * u + v * v));
      }
    }
    return total / 16.0;
  }

 private:
  double at(double distance) const {
    const double place = distance * per_distance_;
    const auto i = static_cast<std::size_t>(place);
    if (i + 1 >= values_.size()) return 0.0;
    return values_[i] + (place - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
  }

  double per_distance_ = 0.0;
  std::vector<double> values_;
};

/// Groups cells into square blocks: small ones in and near the zones, large ones far away.
class Blocks {
 public:
  Blocks(const ErrorField& field, const Gradient& gradient) : field_(field), gradient_(gradient) {
    const HeightMap& map = field.before;
    const bool correlated = field.noise.correlated > 0.0;
    const double reach =
        correlated ? std::sqrt(field.noise.integral() / field.noise.correlated / (2.0 * pi)) : 0.0;
    Eigen::ArrayXXd outside = (field.zone >= 0)
                                  .select(Eigen::ArrayXXd::Zero(map.z.rows(), map.z.cols()),
                                          std::numeric_limits<double>::infinity());
    const Eigen::ArrayXXd distance = map.cell_size * slope_limited(outside, 1.0);
    near_ = correlated && field.zones > 0 ? 2.5 * reach : -1.0;
    const auto cells_near = static_cast<double>((distance <= near_).count());
    const auto cells = static_cast<double>(map.z.size());
    const double fewest = std::sqrt(std::max(cells_near / most_near, cells / 16.0 / most_far));
    small_ = std::max<Eigen::Index>(
        1, static_cast<Eigen::Index>(std::round(std::max(0.5 * reach / map.cell_size, fewest))));
    collect(distance);
  }

  const std::vector<Block>& known() const { return known_; }
  const std::vector<Block>& wanted() const { return wanted_; }

 private:
  static constexpr double most_near = 900.0;  // ours
  static constexpr double most_far = 250.0;   // ours

  void collect(const Eigen::ArrayXXd& distance) {
    const HeightMap& map = field_.before;
    const double height = map.z.isNaN().select(0.0, map.z).sum() /
                          std::max<double>(1.0, static_cast<double>((!map.z.isNaN()).count()));
    std::map<std::tuple<int, Eigen::Index, Eigen::Index, Eigen::Index>, Block> blocks;
    for_each_cell(map.z, [&](Cell at) {
      const int zone = field_.zone(at.row, at.col);
      const double residual = field_.residual(at.row, at.col);
      if (zone < 0 && std::isnan(residual)) return;
      const Eigen::Index size =
          distance(at.row, at.col) <= near_ || zone >= 0 ? small_ : 4 * small_;
      Block& block = blocks[{zone, size, at.row / size, at.col / size}];
      const double z = map.z(at.row, at.col);
      const Eigen::Vector3d place =
          Eigen::Vector3d(map.x(at.col), map.y(at.row), std::isnan(z) ? height : z) -
          field_.alignment.centre;
      Eigen::Vector2d slope(gradient_.x(at.row, at.col), gradient_.y(at.row, at.col));
      if (slope.hasNaN()) slope.setZero();
      block.centre += Eigen::Vector2d(map.x(at.col), map.y(at.row));
      block.size = map.cell_size * static_cast<double>(size);
      block.cells += 1.0;
      block.mean += zone < 0 ? residual : 0.0;
      block.effect += motion_effect(place, slope);
      block.zone = zone;
    });
    for (auto& [key, block] : blocks) {
      block.centre /= block.cells;
      block.mean /= block.cells;
      block.effect /= block.cells;
      block.size = std::min(block.size, map.cell_size * std::sqrt(block.cells));
      (block.zone < 0 ? known_ : wanted_).push_back(block);
    }
  }

  const ErrorField& field_;
  const Gradient& gradient_;
  double near_ = -1.0;
  Eigen::Index small_ = 1;
  std::vector<Block> known_;
  std::vector<Block> wanted_;
};

/// R with R R^T = the covariance, which may be singular: a motion known exactly has none.
Eigen::MatrixXd square_root(const MotionCovariance& covariance) {
  const Eigen::SelfAdjointEigenSolver<MotionCovariance> eigen(covariance);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

struct Known {
  Eigen::MatrixXd covariance;  // lower triangle
  Eigen::MatrixXd trend;       // scaled by the root of what motion may be left
  Eigen::VectorXd mean;
};

Known known_of(const std::vector<Block>& blocks, const NoiseModel& noise,
               const Eigen::MatrixXd& root) {
  const CovarianceTable table(noise);
  const auto count = static_cast<Eigen::Index>(blocks.size());
  Known known{Eigen::MatrixXd::Zero(count, count), Eigen::MatrixXd(count, 6),
              Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Block& block = blocks[static_cast<std::size_t>(i)];
    known.trend.row(i) = block.effect.transpose() * root;
    known.mean(i) = block.mean;
    known.covariance(i, i) =
        noise.white / block.cells + 1e-5 * noise.correlated;  // positive definite
    if (noise.correlated == 0.0) continue;
    for (Eigen::Index j = 0; j <= i; ++j) {
      known.covariance(i, j) += table.between(block, blocks[static_cast<std::size_t>(j)]);
    }
  }
  return known;
}

struct Wanted {
  Eigen::MatrixXd covariance;  // zones x zones
  Eigen::MatrixXd with_known;  // known x zones
  Eigen::MatrixXd trend;       // 6 x zones, scaled
};

struct Zones {
  Eigen::Index count;
  double cell_area;
};

Wanted wanted_of(const Blocks& blocks, const NoiseModel& noise, const Eigen::MatrixXd& root,
                 const Zones& zones) {
  const CovarianceTable table(noise);
  const auto known = static_cast<Eigen::Index>(blocks.known().size());
  Wanted wanted{Eigen::MatrixXd::Zero(zones.count, zones.count),
                Eigen::MatrixXd::Zero(known, zones.count), Eigen::MatrixXd::Zero(6, zones.count)};
  for (const Block& part : blocks.wanted()) {
    const double area = part.cells * zones.cell_area;
    wanted.trend.col(part.zone) += area * root.transpose() * part.effect;
    if (noise.correlated == 0.0) continue;
    for (const Block& other : blocks.wanted()) {
      wanted.covariance(part.zone, other.zone) +=
          area * other.cells * zones.cell_area * table.between(part, other);
    }
    for (Eigen::Index i = 0; i < known; ++i) {
      wanted.with_known(i, part.zone) +=
          area * table.between(part, blocks.known()[static_cast<std::size_t>(i)]);
    }
  }
  return wanted;
}

}  // namespace

ZoneErrors ErrorField::predict() const {
  if (zones == 0) return {};
  const Gradient gradient = gradient_of(before);
  const Blocks blocks(*this, gradient);
  const Eigen::MatrixXd root = square_root(alignment.left);
  const Known known = known_of(blocks.known(), noise, root);
  const Wanted wanted =
      wanted_of(blocks, noise, root, {zones, before.cell_size * before.cell_size});

  const Eigen::LLT<Eigen::MatrixXd> factor(known.covariance);
  const Eigen::MatrixXd to_wanted = factor.solve(wanted.with_known);
  const Eigen::MatrixXd to_trend = factor.solve(known.trend);
  const Eigen::MatrixXd information =
      Eigen::MatrixXd::Identity(6, 6) + known.trend.transpose() * to_trend;
  const Eigen::LDLT<Eigen::MatrixXd> trend_factor(information);
  const Eigen::VectorXd motion = trend_factor.solve(to_trend.transpose() * known.mean);
  const Eigen::MatrixXd rest = wanted.trend - known.trend.transpose() * to_wanted;

  ZoneErrors errors;
  errors.mean = to_wanted.transpose() * known.mean + rest.transpose() * motion;
  errors.correlated = plug_in * (wanted.covariance - wanted.with_known.transpose() * to_wanted);
  errors.datum = rest.transpose() * trend_factor.solve(rest);
  return errors;
}

}  // namespace excavplan
