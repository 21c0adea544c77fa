// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/density/density_estimate.hpp>
#include <excavplan/efficiency/efficiency.hpp>
#include <excavplan/estimating/job_cost.hpp>
#include <excavplan/experiments/study.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/planning/rehearsal.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/soil/density_fit.hpp>

/// @file
/// Figures of results as the tools draw them (docs/formats.md#figures), 170 mm wide: the content of
/// an image file. Equal results give equal bytes, for PNG and PDF on one system with its fonts.
///
/// All of them @throws Error (bad_input) if the format is PNG or PDF and the system has no font.

namespace excavplan {

/// A kind of image file.
enum class ImageFormat {
  svg,
  png,  ///< 300 dots per inch
  pdf,
};

/// Height change of each surveyed area where its zones are, with sections through hole and heap.
std::string change_image(const DensityEstimate& estimate, ImageFormat format = ImageFormat::svg);

/// The estimated density with its 95 % interval, beside it the law with the measured bulking
/// factor.
std::string density_image(const DensityEstimate& estimate, ImageFormat format = ImageFormat::svg);

/// Samples, the forms of the law fitted to them and 95 % of digs about the one to use.
std::string law_image(const DensityCalibration& calibration, ImageFormat format = ImageFormat::svg);

/// What is drawn of one dig.
enum class DigImage {
  section,    ///< machine, ground and bucket in the plane of the boom
  forces,     ///< of the soil, and payload, over time
  torques,    ///< of the joints, with their limits
  power,      ///< and energy over time
  cylinders,  ///< their pressures or forces; the axes say so of a machine without
};

/// A simulated dig. @param scene  with the history of its dig
std::string dig_image(const Machine& machine, const DigScene& scene,
                      DigImage what = DigImage::section, ImageFormat format = ImageFormat::svg);

/// A planned dig, simulated once more. @param plan  with a dig
/// @throws Error as rehearse()
std::string dig_image(const Machine& machine, const DigPlan& plan, const PlanSite& site,
                      DigImage what = DigImage::section, ImageFormat format = ImageFormat::svg);

/// What a job is going to take, with 95 % intervals.
std::string job_estimate_image(const JobEstimate& estimate, const std::optional<JobCost>& cost = {},
                               ImageFormat format = ImageFormat::svg);

/// Heights of the ground, seen from above.
std::string ground_image(const HeightMap& ground, ImageFormat format = ImageFormat::svg);

/// A machine, how far its tip comes and how hard it digs there.
std::string reach_image(const Machine& machine, ImageFormat format = ImageFormat::svg);

/// Efficiency of each run with its 95 % interval. @param runs  at least one
std::string efficiency_image(const std::vector<DigEfficiency>& runs,
                             ImageFormat format = ImageFormat::svg);

/// Gains and errors of the density by condition, with their 95 % intervals.
std::string study_image(const std::vector<StudyResult>& results,
                        ImageFormat format = ImageFormat::svg);

}  // namespace excavplan
