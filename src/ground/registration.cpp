// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/registration.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "base/normal_equations.hpp"
#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_check.hpp"
#include "ground/noise_model.hpp"
#include "ground/relief_pieces.hpp"
#include "ground/slopes.hpp"
#include "ground/too_few_cells.hpp"
#include "ground/window.hpp"

namespace excavplan {
namespace {

constexpr std::size_t fewest_cells = 100;
constexpr double tukey = 4.685;            // 95 % efficient for normal noise
constexpr double tukey_variance = 1.594;   // E w / (E psi')^2 of it for normal noise
constexpr double quartile_to_sd = 3.1386;  // a quarter of normal residuals is within 0.3186 sd
constexpr double least_bend = 0.02;        // ours: a shift of rough ground bends it by no more [-]
constexpr double significant = 11.345;     // chi-square, three degrees of freedom, 99 %
constexpr int rounds = 25;
constexpr std::size_t most_weighted = 20000;  // while weights are iterated; all at the end

/// Half-sample mode (Robertson and Cryer 1974).
double half_sample_mode(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::size_t first = 0;
  std::size_t count = values.size();
  while (count > 3) {
    const std::size_t half = (count + 1) / 2;
    std::size_t best = first;
    for (std::size_t i = first; i + half <= first + count; ++i) {
      if (values[i + half - 1] - values[i] < values[best + half - 1] - values[best]) best = i;
    }
    first = best;
    count = half;
  }
  return values[first + count / 2];
}

/// One cell known in both surfaces.
struct Sample {
  Cell cell;
  double change;
  Motion effect;
  double bend;  ///< change of its slope, less the tilt of the whole [-]
  double weight = 1.0;
};

double tukey_weight(double sds) {
  const double ratio = sds / tukey;
  return ratio < 1.0 ? std::pow(1.0 - ratio * ratio, 2) : 0.0;
}

/// Least squares with a prior. The columns of the motion are scaled by the share of the gradient
/// that is more than noise; otherwise noise on level ground would be taken for a shift.
class Aligner {
 public:
  Aligner(const Surface& before, const Surface& after, const AlignmentOptions& options)
      : map_(before.height), options_(options) {
    take_samples(before, after);
    prior_.setConstant(options.turn_prior);
    prior_.head<3>().setConstant(options.shift_prior);
  }

  Alignment find() {
    if (options_.left_out) keep_relief_that_agrees();
    return judge(fitted());
  }

 private:
  using Chosen = std::array<bool, 6>;
  static constexpr Chosen all = {true, true, true, true, true, true};
  static constexpr double relief = 0.25;  // ours: a slope that is no noise [-]

  struct Solution {
    Motion motion;
    MotionCovariance covariance;
  };

  Motion fitted() {
    Motion motion = Motion::Zero();
    stride_ = samples_.size() / most_weighted + 1;
    std::vector<double> changes;
    for (std::size_t i = 0; i < samples_.size(); i += stride_) {
      changes.push_back(samples_[i].change);
    }
    motion(2) = half_sample_mode(std::move(changes));
    for (int round = 0; round < rounds; ++round) {
      const double before = scale_;
      reweight(motion);
      if (round == 0) find_reliable();
      motion = solve(scale_ * scale_, all).motion;
      if (round > 3 && std::abs(scale_ - before) < 1e-3 * scale_) break;
    }
    stride_ = 1;
    reweight(motion);
    find_reliable();
    return motion;
  }

  static bool is_relief(const Sample& sample) { return sample.effect.head<2>().norm() > relief; }

  /// Where none does, there is no shift and no turn in plan.
  void keep_relief_that_agrees() {
    std::vector<Sample> level;
    std::vector<Sample> sloping;
    for (const Sample& sample : samples_) (is_relief(sample) ? sloping : level).push_back(sample);
    lateral_ = false;
    if (level.size() < fewest_cells) return;
    samples_ = std::move(level);
    const Motion motion = fitted();
    std::vector<ReliefCell> cells;
    cells.reserve(sloping.size());
    for (const Sample& sample : sloping) {
      cells.push_back(
          {sample.cell, sample.effect.head<2>(), sample.change - sample.effect.dot(motion)});
    }
    const Mask agrees = relief_that_agrees(cells, map_, scale_);
    for (const Sample& sample : sloping) {
      if (agrees(sample.cell.row, sample.cell.col)) samples_.push_back(sample);
    }
    lateral_ = agrees.count() >= static_cast<Eigen::Index>(fewest_cells);
  }

  void take_samples(const Surface& before, const Surface& after) {
    const Gradient one = gradient_of(before.height);
    const Gradient two = gradient_of(after.height);
    const Eigen::Vector2d tilt(tilt_of(two.x - one.x), tilt_of(two.y - one.y));
    for_each_cell(map_.z, [&](Cell at) {
      const Eigen::Vector2d first(one.x(at.row, at.col), one.y(at.row, at.col));
      const Eigen::Vector2d second(two.x(at.row, at.col), two.y(at.row, at.col));
      const Eigen::Vector2d slope = 0.5 * (first + second);
      if (!(slope.norm() < options_.steepest)) return;
      Sample sample;
      sample.bend = (second - first - tilt).norm();
      sample.cell = at;
      sample.change = after.height.z(at.row, at.col) - before.height.z(at.row, at.col);
      sample.effect << slope.x(), slope.y(), 0.0, 0.0, 0.0, 0.0;
      samples_.push_back(sample);
    });
    leave_out();
    if (samples_.size() < fewest_cells) {
      throw TooFewCells("the surfaces share " + std::to_string(samples_.size()) +
                            " known cells with known neighbours and no steep gradient",
                        fewest_cells, map_.cell_size);
    }
    for (const Sample& sample : samples_) found_.centre += place_of(sample.cell);
    found_.centre /= static_cast<double>(samples_.size());
    for (Sample& sample : samples_) {
      sample.effect = motion_effect(place_of(sample.cell) - found_.centre, sample.effect.head<2>());
    }
  }

  Eigen::Vector3d place_of(Cell at) const {
    return {map_.x(at.col), map_.y(at.row), map_.z(at.row, at.col)};
  }

  /// Ground that was worked on, and that about a hole or a heap: both grow evenly to all sides, so
  /// that what remains of their slopes seems shifted.
  void leave_out() {
    constexpr double enough = 0.1;    // ours: of the samples
    constexpr double changed = 0.15;  // ours: more than slopes that are shifted by 0.2 m [m]
    constexpr double around = 0.6;    // ours [m]
    if (!options_.left_out || samples_.size() < fewest_cells) return;
    std::vector<double> changes;
    for (const Sample& sample : samples_) changes.push_back(sample.change);
    const double usual = half_sample_mode(std::move(changes));
    Eigen::ArrayXXd worked = Eigen::ArrayXXd::Zero(map_.z.rows(), map_.z.cols());
    for (const Sample& sample : samples_) {
      if (std::abs(sample.change - usual) > changed) worked(sample.cell.row, sample.cell.col) = 1.0;
    }
    worked = highest_within(worked, static_cast<Eigen::Index>(std::ceil(around / map_.cell_size)));
    std::vector<Sample> outside;
    for (const Sample& sample : samples_) {
      const bool is_worked =
          worked(sample.cell.row, sample.cell.col) > 0.0 ||
          options_.left_out->contains(map_.x(sample.cell.col), map_.y(sample.cell.row));
      if (!is_worked) outside.push_back(sample);
    }
    const auto least = enough * static_cast<double>(samples_.size());
    if (static_cast<double>(outside.size()) > least && outside.size() >= fewest_cells)
      samples_ = std::move(outside);
  }

  /// Median change of a slope; 0 if no cell is known in both.
  static double tilt_of(const Eigen::ArrayXXd& change) {
    std::vector<double> known = known_values(change);
    return known.empty() ? 0.0 : median(known);
  }

  /// Weights by the change of height and by that of slope: at the thin edge of a hole or a heap,
  /// slope and change have the same relation as on ground that was shifted.
  void reweight(const Motion& motion) {
    std::vector<double> away;
    away.reserve(samples_.size() / stride_ + 1);
    for (std::size_t i = 0; i < samples_.size(); i += stride_) {
      away.push_back(std::abs(samples_[i].change - samples_[i].effect.dot(motion)));
    }
    std::vector<double> sorted = away;
    scale_ = std::max(quartile_to_sd * upper_quantile(sorted, 0.25), least_noise);
    const double bend_sd = std::max(scale_ / (std::sqrt(6.0) * map_.cell_size), least_bend);
    for (std::size_t i = 0; i < away.size(); ++i) {
      Sample& sample = samples_[i * stride_];
      sample.weight = tukey_weight(away[i] / scale_) * tukey_weight(sample.bend / bend_sd);
    }
  }

  /// Share of the squared gradient on stable ground that the noise of the cells does not explain:
  /// planes through 3 x 3 cells of two maps err by a twelfth of the variance of a difference over
  /// the squared cell, half of that each.
  void find_reliable() {
    double weights = 0.0;
    Eigen::Vector2d squares = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < samples_.size(); i += stride_) {
      const Sample& sample = samples_[i];
      weights += sample.weight;
      squares += sample.weight * sample.effect.head<2>().cwiseAbs2();
    }
    const double noise = scale_ * scale_ / (24.0 * map_.cell_size * map_.cell_size);
    constexpr double margin = 1.2;  // ours
    Eigen::Vector2d share(0.0, 0.0);
    if (weights > 0.0) {
      share = (1.0 - margin * noise * (squares / weights).cwiseInverse().array()).cwiseMax(0.0);
    }
    reliable_ = {std::sqrt(share.x()),       std::sqrt(share.y()), 1.0, 1.0, 1.0,
                 std::sqrt(share.maxCoeff())};
    if (!lateral_) reliable_[0] = reliable_[1] = reliable_[5] = 0.0;
  }

  Solution solve(double variance, const Chosen& chosen) const {
    MotionCovariance normal = MotionCovariance::Zero();
    Motion right = Motion::Zero();
    for (std::size_t i = 0; i < samples_.size(); i += stride_) {
      const Sample& sample = samples_[i];
      if (sample.weight == 0.0) continue;
      normal.selfadjointView<Eigen::Lower>().rankUpdate(sample.effect, sample.weight / variance);
      right += sample.weight * sample.change / variance * sample.effect;
    }
    normal.triangularView<Eigen::StrictlyUpper>() = normal.transpose();
    Motion use;
    for (int i = 0; i < 6; ++i) {
      use(i) = chosen[static_cast<std::size_t>(i)] ? reliable_[static_cast<std::size_t>(i)] : 0.0;
    }
    normal = use.asDiagonal() * normal * use.asDiagonal();
    normal.diagonal() += prior_.cwiseAbs2().cwiseInverse();
    const NormalEquations<6> equations(normal, use.cwiseProduct(right));
    return {equations.solution(), equations.covariance()};
  }

  /// Of what each cell adds to the estimate, its weighted residual, as for any M-estimate (Huber
  /// 1981): the thin edges of a change weigh little, but as whole residuals they would pass for
  /// error that is correlated over metres.
  double inflated_variance(const Motion& motion) {
    Eigen::ArrayXXd weighted = Eigen::ArrayXXd::Constant(map_.z.rows(), map_.z.cols(), nan);
    std::size_t stable = 0;
    for (const Sample& sample : samples_) {
      if (sample.weight == 0.0) continue;
      weighted(sample.cell.row, sample.cell.col) =
          sample.weight * (sample.change - sample.effect.dot(motion));
      ++stable;
    }
    found_.stable_share = static_cast<double>(stable) / static_cast<double>(samples_.size());
    const double variance =
        find_noise(weighted, map_.cell_size).large_area_variance(map_.cell_size);
    return std::max(tukey_variance * variance, scale_ * scale_);
  }

  /// Keeps the significant part of the motion and sets the covariance of what may be left.
  Alignment judge(const Motion& robust) {
    const double variance = inflated_variance(robust);
    const Solution full = solve(variance, all);
    found_.found = full.motion;
    found_.covariance = full.covariance;
    found_.residual_sd = scale_;
    const std::array<int, 3> vertical = {2, 3, 4};
    const std::array<int, 3> lateral = {0, 1, 5};
    found_.vertical_is_significant = stands_out(full, vertical);
    found_.lateral_is_significant = stands_out(full, lateral);
    Chosen chosen = {};
    found_.left.setZero();
    for (const int i : vertical) {
      chosen[static_cast<std::size_t>(i)] = found_.vertical_is_significant;
      for (const int j : vertical) found_.left(i, j) = full.covariance(i, j);
      if (!found_.vertical_is_significant) continue;
      found_.left.row(i).setZero();
      found_.left(i, i) = prior_(i) * prior_(i);
    }
    for (const int i : lateral) {
      chosen[static_cast<std::size_t>(i)] = found_.lateral_is_significant;
      for (const int j : lateral) found_.left(i, j) = full.covariance(i, j);
    }
    found_.motion = solve(variance, chosen).motion;
    for (int i = 0; i < 6; ++i) {
      found_.supported[static_cast<std::size_t>(i)] =
          full.covariance(i, i) < 0.25 * prior_(i) * prior_(i);
    }
    return found_;
  }

  static bool stands_out(const Solution& solution, const std::array<int, 3>& which) {
    Eigen::Matrix3d covariance;
    Eigen::Vector3d motion;
    for (int i = 0; i < 3; ++i) {
      motion(i) = solution.motion(which[static_cast<std::size_t>(i)]);
      for (int j = 0; j < 3; ++j) {
        covariance(i, j) = solution.covariance(which[static_cast<std::size_t>(i)],
                                               which[static_cast<std::size_t>(j)]);
      }
    }
    return squared_by(covariance, motion) > significant;
  }

  const HeightMap& map_;
  const AlignmentOptions& options_;
  std::vector<Sample> samples_;
  Motion prior_;
  std::array<double, 6> reliable_ = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  bool lateral_ = true;     // shift and turn in plan can be told
  std::size_t stride_ = 1;  // of the samples in use
  double scale_ = 0.0;      // robust sd of a stable cell [m]
  Alignment found_;
};

Eigen::Isometry3d rigid(const Alignment& alignment) {
  const Eigen::Vector3d turn = alignment.motion.tail<3>();
  const double angle = turn.norm();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translate(alignment.centre + alignment.motion.head<3>());
  if (angle > 0.0) motion.rotate(Eigen::AngleAxisd(angle, turn / angle));
  motion.translate(-alignment.centre);
  return motion;
}

/// Slope along one axis from the known neighbours on both sides, or the one side that is known.
double slope(double low, double here, double high, double cell_size) {
  if (!std::isnan(low) && !std::isnan(high)) return (high - low) / (2.0 * cell_size);
  if (!std::isnan(high)) return (high - here) / cell_size;
  return std::isnan(low) ? 0.0 : (here - low) / cell_size;
}

}  // namespace

void require_alignment(const Alignment& alignment, const char* what) {
  const bool finite =
      alignment.centre.allFinite() && alignment.motion.allFinite() && alignment.left.allFinite();
  if (!finite) refuse(std::string(what) + ": a number of the alignment is not finite");
}

MotionCovariance Alignment::default_left() {
  MotionCovariance left = MotionCovariance::Zero();
  left(2, 2) = std::pow(AlignmentOptions{}.shift_prior, 2);
  return left;
}

Eigen::Matrix4d Alignment::correction() const { return rigid(*this).inverse().matrix(); }

double Alignment::largest_shift(const HeightMap& map) const {
  const Rectangle extent = map.extent();
  double largest = 0.0;
  for (const double x : {extent.x_min, extent.x_max}) {
    for (const double y : {extent.y_min, extent.y_max}) {
      const Eigen::Vector3d corner(x, y, centre.z());
      largest = std::max(largest, (rigid(*this) * corner - corner).head<2>().norm());
    }
  }
  return largest;
}

Alignment align(const Surface& before, const Surface& after, const AlignmentOptions& options) {
  constexpr double smallest = 1e-9;  // the square of a smaller one could not be divided by
  const auto positive = [](double value) { return value >= smallest && std::isfinite(value); };
  require(positive(options.shift_prior), "align: shift_prior", options.shift_prior,
          "positive and finite");
  require(positive(options.turn_prior), "align: turn_prior", options.turn_prior,
          "positive and finite");
  require(options.steepest > 0.0, "align: steepest", options.steepest, "positive");
  require_surface(before, "align, surface before");
  require_surface(after, "align, surface after");
  if (!same_grid(before.height, after.height)) {
    refuse("align: the surfaces must be on one grid: same origin, cell and size");
  }
  return Aligner(before, after, options).find();
}

HeightMap realigned(const HeightMap& after, const Alignment& alignment) {
  require_map(after, "realigned");
  require_alignment(alignment, "realigned");
  HeightMap map = after;
  if (alignment.motion.isZero()) return map;
  const auto z = [&](Eigen::Index row, Eigen::Index col) {
    const bool inside = row >= 0 && col >= 0 && row < after.z.rows() && col < after.z.cols();
    return inside ? after.z(row, col) : nan;
  };
  for_each_cell(after.z, [&](Cell at) {
    const double here = after.z(at.row, at.col);
    if (std::isnan(here)) return;
    const Eigen::Vector2d gradient(
        slope(z(at.row, at.col - 1), here, z(at.row, at.col + 1), after.cell_size),
        slope(z(at.row - 1, at.col), here, z(at.row + 1, at.col), after.cell_size));
    const Eigen::Vector3d place =
        Eigen::Vector3d(after.x(at.col), after.y(at.row), here) - alignment.centre;
    map.z(at.row, at.col) -= motion_effect(place, gradient).dot(alignment.motion);
  });
  return map;
}

}  // namespace excavplan
