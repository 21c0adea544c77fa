// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include <excavplan/base/data_files.hpp>
#include <excavplan/density/density_estimate.hpp>

#include "support/survey_scenes.hpp"

/// @file
/// Digs of survey_scenes.hpp as estimate_density() takes them, and what it answers.

namespace excavplan::test {

using scenes::degree;
using scenes::Part;
using scenes::Points;
using Affine = Eigen::Affine3d;

constexpr std::size_t points_of_a_scan = 40000;

/// A dig and its scans: of the whole scene, or of dig and dump area.
struct Survey {
  scenes::Dig dig;
  scenes::ScanErrors errors;
  bool whole = true;
  Points before, after, dump_before, dump_after;

  Survey(std::uint64_t seed, bool is_whole, double slope = 0.0, double roughness = 0.0,
         std::size_t points = points_of_a_scan)
      : dig(scenes::random_dig(seed)), whole(is_whole) {
    errors.noise = 0.005;
    errors.slope = slope;
    errors.roughness = roughness;
    const auto scan = [&](Part part, bool is_after) {
      return scenes::scan(dig, part, errors, points, seed, is_after);
    };
    before = scan(whole ? Part::whole : Part::dig, false);
    after = scan(whole ? Part::whole : Part::dig, true);
    if (whole) return;
    dump_before = scan(Part::dump, false);
    dump_after = scan(Part::dump, true);
  }

  static void move(Points& points, const Affine& motion) {
    for (Eigen::Vector3d& point : points) point = motion * point;
  }
  void move_all(const Affine& motion) {
    for (Points* points : {&before, &after, &dump_before, &dump_after}) move(*points, motion);
  }

  DigScans scans() const {
    const auto scan_of = [](const Points& points) {
      auto cloud = std::make_shared<Cloud>();
      cloud->points = points;
      cloud->width = points.size();
      Scan scan;
      scan.clouds = {cloud};
      return scan;
    };
    DigScans all{scan_of(before), scan_of(after)};
    if (!whole) all.dump = ScanPair{scan_of(dump_before), scan_of(dump_after)};
    return all;
  }
};

const DensityLaw& paper_law();

/// The estimate, or the text of the error.
struct Answer {
  std::optional<DensityEstimate> estimate;
  std::string error;

  bool trusted() const { return estimate && estimate->trustworthy; }
  const Warning* warning(const std::string& code) const {
    if (!estimate) return nullptr;
    for (const Warning& each : estimate->warnings) {
      if (code_text(each.code) == code) return &each;
    }
    return nullptr;
  }
};

Answer answer_to(const DigScans& scans);

/// Trusted, and off by more than three standard deviations in k, or four in the hole.
bool is_trusted_and_wrong(const Answer& answer, const scenes::Dig& dig);

Affine turned(double angle, const Eigen::Vector3d& axis);

Eigen::Vector3d level_axis(Random& random);

/// Into the frame of a camera that looks at the middle of the scene: x right, y down, z forward.
Affine camera(double pitch, double height);

}  // namespace excavplan::test
