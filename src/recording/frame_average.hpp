// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

/// @file Organised frames of a sensor that stands still, averaged pixel by pixel. Private to the
/// library.

namespace excavplan {

/// What frames agree on.
struct AveragedFrames {
  std::vector<Eigen::Vector3d> points;  ///< [m]; NaN where fewer than half of the frames agree
  std::vector<double> variance;         ///< of each point along its ray [m^2]; NaN where unknown
  double frame_sd = 0.0;                ///< median over the points of the sd of one frame [m]
};

/// Keeps one range a pixel and frame: the rays are those of the first frame that saw something.
class FrameAverage {
 public:
  /// As many points as before, in the frame of the sensor [m], NaN where it saw nothing. @return
  /// false, and takes nothing, if more than 5 % of the pixels that were seen before lie more than 2
  /// mrad off their rays (ours), as those of lidars do that start a turn anywhere
  bool add(const std::vector<Eigen::Vector3d>& points);

  /// The mean of the ranges within 3 robust sd (at least 1 mm) of their median.
  AveragedFrames result() const;

 private:
  std::vector<Eigen::Vector3d> rays_;       ///< unit vectors; zero where nothing was seen yet
  std::vector<std::vector<float>> frames_;  ///< the ranges of each [m], NaN where nothing was seen
};

}  // namespace excavplan
