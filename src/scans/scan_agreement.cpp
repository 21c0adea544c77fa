// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/scan_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "base/angles.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Ours:
constexpr Index fewest_common = 100;  // cells that are compared
constexpr double most_height = 0.1;   // of one map above the other [m]
constexpr double same_height = 0.15;  // [m]
constexpr double least_same = 0.6;    // of the cells that both know
constexpr double least_relief = 0.2;  // that shows a shift: above or below the median [m]
constexpr double furthest = 1.5, shift_step = 0.1;                      // [m]
constexpr double most_turn = 8.0 * pi / 180.0, turn_step = pi / 180.0;  // [rad]
constexpr double well = 0.6, better = 0.25;  // share of relief that agrees, and by which more does
constexpr std::size_t fewest_of_relief = 40, most_points = 1500;  // of relief

struct ShiftAndTurn {
  Vector2d shift = Vector2d::Zero();
  double turn = 0.0;
};

/// Two maps where both are known.
class Comparison {
 public:
  Comparison(const HeightMap& present, const HeightMap& earlier) : present_(present) {
    std::vector<double> heights;
    for (Index col = 0; col < earlier.z.cols(); ++col) {
      for (Index row = 0; row < earlier.z.rows(); ++row) {
        const double off = present.z(row, col) - earlier.z(row, col);
        if (!std::isfinite(off)) continue;
        differences_.push_back(off);
        heights.push_back(earlier.z(row, col));
        relief_.emplace_back(earlier.x(col), earlier.y(row), earlier.z(row, col));
      }
    }
    if (heights.empty()) return;
    const double level = median(heights);
    relief_.erase(
        std::remove_if(relief_.begin(), relief_.end(),
                       [&](const Vector3d& p) { return std::abs(p.z() - level) <= least_relief; }),
        relief_.end());
    const std::size_t each = relief_.size() / most_points + 1;
    for (std::size_t i = 0; i * each < relief_.size(); ++i) relief_[i] = relief_[i * each];
    relief_.resize((relief_.size() + each - 1) / each);
  }

  const std::vector<double>& differences() const { return differences_; }

  /// Share of the relief of the earlier map, once moved, that the present one has too.
  double agreement(const Eigen::Matrix2d& turned, const Vector2d& shift) const {
    std::size_t same = 0, known = 0;
    for (const Vector3d& p : relief_) {
      const Vector2d at = (turned * p.head<2>() + shift - present_.origin) / present_.cell_size;
      const auto col = static_cast<Index>(std::floor(at.x()));
      const auto row = static_cast<Index>(std::floor(at.y()));
      if (col < 0 || row < 0 || col >= present_.z.cols() || row >= present_.z.rows()) continue;
      const double off = std::abs(present_.z(row, col) - p.z());
      if (std::isnan(off)) continue;
      ++known;
      if (off <= same_height) ++same;
    }
    if (2 * known < relief_.size()) return 0.0;
    return static_cast<double>(same) / static_cast<double>(known);
  }

  /// The motion that brings the relief together best, if it does much better than none.
  std::optional<ShiftAndTurn> motion() const {
    if (relief_.size() < fewest_of_relief) return std::nullopt;
    const double still = agreement(Eigen::Matrix2d::Identity(), Vector2d::Zero());
    if (still >= well) return std::nullopt;
    double most = std::max(well, still + better);
    std::optional<ShiftAndTurn> best;
    for (double turn = -most_turn; turn <= most_turn + 1e-9; turn += turn_step) {
      const Eigen::Matrix2d turned = Eigen::Rotation2Dd(turn).toRotationMatrix();
      for (double x = -furthest; x <= furthest + 1e-9; x += shift_step) {
        for (double y = -furthest; y <= furthest + 1e-9; y += shift_step) {
          const double now = agreement(turned, {x, y});
          if (now <= most) continue;
          most = now;
          best = ShiftAndTurn{{x, y}, turn};
        }
      }
    }
    return best;
  }

 private:
  const HeightMap& present_;
  std::vector<Vector3d> relief_;  ///< of the earlier map, some of it
  std::vector<double> differences_;
};

}  // namespace

std::optional<std::string> disagreement(const HeightMap& present, const HeightMap& earlier) {
  const Comparison both(present, earlier);
  const std::vector<double>& off = both.differences();
  if (static_cast<Index>(off.size()) < fewest_common) return std::nullopt;
  std::vector<double> sorted = off;
  const double height = median(sorted);
  if (std::abs(height) > most_height) {
    return "the present scan lies " + readable(std::abs(height), 2) + " m " +
           (height > 0.0 ? "above" : "below") + " that of the surroundings";
  }
  const auto same = std::count_if(off.begin(), off.end(),
                                  [](double each) { return std::abs(each) <= same_height; });
  const double share = static_cast<double>(same) / static_cast<double>(off.size());
  if (share < least_same) {
    return "of the ground that the present scan and that of the surroundings both show only " +
           readable(100.0 * share, 2) + " % has the same height";
  }
  if (const auto motion = both.motion()) {
    return "the scan of the surroundings fits the present one better shifted by x = " +
           readable(motion->shift.x(), 2) + " m, y = " + readable(motion->shift.y(), 2) +
           " m and turned by " + readable(motion->turn * 180.0 / pi, 2) + " degrees";
  }
  return std::nullopt;
}

}  // namespace excavplan
