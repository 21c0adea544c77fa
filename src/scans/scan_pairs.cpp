// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/scan_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "ground/coarse_motion.hpp"
#include "ground/grid_cells.hpp"
#include "ground/sampling_gaps.hpp"
#include "ground/too_few_cells.hpp"
#include "scans/scan_reading.hpp"

namespace excavplan {
namespace {

void require_points(const Scan& scan, const ScanOutline& seen) {
  if (seen.finite_points >= 100) return;
  throw Error(ErrorKind::bad_file, name_of(scan) + ": holds fewer than 100 finite points" +
                                       (scan.area ? " inside the area" : ""));
}

std::string text(const Rectangle& r) {
  return "x " + readable(r.x_min) + " .. " + readable(r.x_max) + ", y " + readable(r.y_min) +
         " .. " + readable(r.y_max) + " m";
}

Rectangle overlap(const OutlinedPair& pair) {
  constexpr double least = 0.2;  // [m], ours
  const Rectangle& a = *pair.before.extent;
  const Rectangle& b = *pair.after.extent;
  const Rectangle both = {std::max(a.x_min, b.x_min), std::max(a.y_min, b.y_min),
                          std::min(a.x_max, b.x_max), std::min(a.y_max, b.y_max)};
  if (!(both.x_max - both.x_min > least && both.y_max - both.y_min > least)) {
    throw FrameError(name_of(pair.scans.before) + " and " + name_of(pair.scans.after) +
                     " do not overlap: " + text(a) + " and " + text(b));
  }
  return both;
}

/// With the ground between the points.
Surface filled_surface(const Scan& scan, const Rectangle& extent, const RasterOptions& options) {
  Surface surface = survey_surface(scan, extent, options);
  fill_sampling_gaps(surface);
  return surface;
}

std::vector<Surface> filled_surfaces(const std::vector<Scan>& scans, const Rectangle& extent,
                                     const RasterOptions& options, unsigned threads) {
  std::vector<Surface> surfaces(scans.size());
  parallel_for(scans.size(), threads,
               [&](std::size_t i) { surfaces[i] = filled_surface(scans[i], extent, options); });
  return surfaces;
}

/// Surveys one pair again and again as its scan after is brought back.
struct Registering {
  const Scan& after;
  const Rectangle& extent;
  RasterOptions raster;
  double small;  ///< largest shift that realigned() corrects [m]
  AlignmentOptions options;

  /// Aligns; surveys the scan after again where it moves by more than `small`, and aligns the rest.
  void align_again(RegisteredPair& result) const {
    constexpr int most_rounds = 3;
    result.surfaces.alignment = result.first =
        align(result.surfaces.before, result.surfaces.after, options);
    for (int round = 1; round < most_rounds && improve(small, result); ++round) {
    }
  }

  /// Takes the motion off the points if it is larger than `least`.
  bool improve(double least, RegisteredPair& result) const {
    SurfacePair& pair = result.surfaces;
    if (!(pair.alignment.largest_shift(pair.after.height) > least)) return false;
    result.correction = pair.alignment.correction() * result.correction;
    pair.after = filled_surface(corrected(after, result.correction), extent, raster);
    pair.alignment = align(pair.before, pair.after, options);
    return true;
  }

  /// Takes a start beyond the priors if the ground fits much better from there, and follows a large
  /// motion closely.
  void look_farther(RegisteredPair& result) const {
    constexpr double much_better = 2.0 / 3.0;  // ours
    constexpr double closely = 0.2;            // ours
    constexpr int most_rounds = 6;
    const SurfacePair& pair = result.surfaces;
    if (const auto start = coarse_correction(pair.before, pair.after)) {
      RegisteredPair other;
      other.correction = *start * result.correction;
      other.surfaces.before = pair.before;
      other.surfaces.after = filled_surface(corrected(after, other.correction), extent, raster);
      align_again(other);
      other.first = result.first;
      other.from_wide_start = true;
      if (other.surfaces.alignment.residual_sd < much_better * pair.alignment.residual_sd) {
        result = std::move(other);
      }
    }
    for (int round = 0; round < most_rounds && improve(closely * small, result); ++round) {
    }
  }
};

/// True if the start of align() may have been too far from the truth. What differs tells nothing if
/// ground is left out: from another start that is other ground.
bool could_be_elsewhere(const RegisteredPair& pair, bool is_whole) {
  const Alignment& found = pair.surfaces.alignment;
  return displacement_by(found.correction() * pair.correction, found.centre).is_beyond_prior() ||
         (is_whole && leaves_difference(pair.surfaces));
}

}  // namespace

Scan corrected(const Scan& scan, const Eigen::Matrix4d& correction) {
  Scan result = scan;
  result.site_from_scan = correction * scan.site_from_scan;
  return result;
}

OutlinedPair outlined(const ScanPair& scans, unsigned threads) {
  const std::vector<ScanOutline> seen = outlines({scans.before, scans.after}, threads);
  return outlined(scans, seen[0], seen[1]);
}

OutlinedPair outlined(const ScanPair& scans, const ScanOutline& before, const ScanOutline& after) {
  require_points(scans.before, before);
  require_points(scans.after, after);
  OutlinedPair pair = {scans, before, after};
  pair.scans.before.no_data = before.no_data;
  pair.scans.after.no_data = after.no_data;
  return pair;
}

Displacement displacement_by(const Eigen::Matrix4d& correction, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d moved = (correction * centre.homogeneous()).head<3>();
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(correction.topLeftCorner<3, 3>()));
  return {(moved - centre).norm(), std::abs(turn.angle())};
}

bool Displacement::is_beyond_prior() const {
  constexpr double most = 3.0;  // standard deviations
  const AlignmentOptions priors;
  return shift > most * priors.shift_prior || turn > most * priors.turn_prior;
}

bool leaves_difference(const SurfacePair& pair) {
  constexpr double least = 0.010;    // ours: below it the volumes hardly suffer [m]
  constexpr double explained = 3.0;  // ours: neighbouring points err alike, which no scatter shows
  const Eigen::ArrayXXd variance = pair.before.variance + pair.after.variance;
  std::vector<double> known = known_values(variance);
  const double expected = known.empty() ? 0.0 : std::sqrt(median(known));
  return pair.alignment.residual_sd > std::max(least, explained * expected);
}

void require_memory(const OutlinedPair& pair, const Rectangle& extent, double cell_size) {
  constexpr double of_cell = 245.0;     // measured [byte]
  constexpr double of_unseen = 1500.0;  // more of a cell without points, measured [byte]
  const double width = extent.x_max - extent.x_min;
  const double depth = extent.y_max - extent.y_min;
  const double cells = width / cell_size * (depth / cell_size);
  const auto points =
      static_cast<double>(std::min(pair.before.finite_points, pair.after.finite_points));
  const double needed = of_cell * cells + of_unseen * std::max(0.0, cells - points);
  require(!(cell_size > 0.0 && needed > most_survey_memory),
          "a survey of " + readable(width) + " m x " + readable(depth) + " m in cells of " +
              number_text(cell_size) + " m needs about " + readable(needed / 1e9) +
              " GB of memory, most are " + number_text(most_survey_memory / 1e9) +
              " GB: are the scans in the unit that `unit` says?");
}

RegisteredPair survey_pair(const OutlinedPair& pair, double cell_size, bool registered,
                           unsigned threads, const std::optional<Eigen::Vector2d>& grid) {
  RasterOptions raster;
  raster.cell_size = cell_size;
  const Rectangle extent = overlap(pair);
  require_memory(pair, extent, cell_size);
  raster.node = grid.value_or(Eigen::Vector2d(extent.x_min, extent.y_min));
  if (registered) {
    return survey_registered(pair.scans, extent, raster, pair.registration_cell(), threads);
  }
  std::vector<Surface> both =
      filled_surfaces({pair.scans.before, pair.scans.after}, extent, raster, threads);
  RegisteredPair result;
  result.surfaces.before = std::move(both[0]);
  result.surfaces.after = std::move(both[1]);
  return result;
}

RegisteredPair survey_registered(const ScanPair& scans, const Rectangle& extent,
                                 const RasterOptions& options, double registration_cell,
                                 unsigned threads) {
  require(registration_cell >= 0.0 && std::isfinite(registration_cell), "registration_cell",
          registration_cell, "at least 0 m and finite");
  RasterOptions coarse = options;
  coarse.cell_size = std::max(options.cell_size, registration_cell);
  const bool is_fine = coarse.cell_size > options.cell_size;
  const double small = is_fine ? 0.0 : 0.5 * options.cell_size;
  const auto survey = [&](const RasterOptions& raster, const Eigen::Matrix4d& correction) {
    std::vector<Surface> both = filled_surfaces({scans.before, corrected(scans.after, correction)},
                                                extent, raster, threads);
    return SurfacePair{std::move(both[0]), std::move(both[1]), {}};
  };
  RegisteredPair result;
  result.surfaces = survey(coarse, result.correction);
  Registering registering = {scans.after, extent, coarse, small, {}};
  registering.options.left_out = scans.left_out;
  try {
    registering.align_again(result);
    if (could_be_elsewhere(result, !scans.left_out)) registering.look_farther(result);
  } catch (const TooFewCells& few) {
    throw few.of_scans(name_of(scans.before) + ", " + name_of(scans.after));
  }
  if (is_fine) {
    const Alignment found = result.surfaces.alignment;
    result.surfaces = survey(options, result.correction);
    result.surfaces.alignment = found;
  }
  result.correction = result.surfaces.alignment.correction() * result.correction;
  return result;
}

}  // namespace excavplan
