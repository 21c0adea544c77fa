// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/clouds/cloud.hpp>
#include <excavplan/ground/registration.hpp>
#include <excavplan/ground/surface.hpp>

/// @file
/// Surfaces from scans: files of any size, read several times and not held, or clouds in memory.

namespace excavplan {

class MachineFront;

/// What was seen at one time of one piece of ground: files, clouds in memory, or both.
struct Scan {
  std::vector<std::string> files;                                ///< each as read_cloud() reads it
  Eigen::Matrix4d site_from_scan = Eigen::Matrix4d::Identity();  ///< a rigid motion
  std::optional<Rectangle> area;  ///< points outside, in the site frame, are left out
  std::vector<std::shared_ptr<const Cloud>> clouds = {};  ///< in the frame of the files; not null
  double unit = 1.0;  ///< length of a unit of their coordinates; `site_from_scan` is in metres [m]
  /// Where the sensor stood, in the frame and unit of the files; unset: where files and clouds say
  /// themselves, if they all do, at up to four places.
  std::optional<Eigen::Vector3d> sensor_origin = {};
  bool z_is_up = false;   ///< is known, so that no frame of a camera is suspected
  std::string name = {};  ///< for messages; empty: that of its first file
  std::shared_ptr<const MachineFront> machine = {};  ///< points that it holds are left out
  std::vector<double> no_data = {};  ///< heights of the files that mean "none"; left out
  /// What is doubtful about its points, as who made them knows (RecordedScan::warnings): becomes
  /// part of every result.
  std::vector<Warning> doubts = {};
};

/// The error (bad_file) of scans outside the expected area, mostly because `site_from_scan` does
/// not match their frame.
class FrameError : public Error {
 public:
  /// @param message  names the scans and what does not fit
  explicit FrameError(const std::string& message) : Error(ErrorKind::bad_file, message) {}
};

/// Summary of the points of a scan inside the area, from a first pass.
struct ScanOutline {
  std::uint64_t points = 0;          ///< finite or not
  std::uint64_t finite_points = 0;   ///< inside the area
  std::uint64_t machine_points = 0;  ///< that Scan::machine held, left out
  std::vector<double> no_data;       ///< heights as Scan::no_data that are found in it
  double no_data_share = 0.0;  ///< of its points that have these, which count nowhere else [-]
  std::uint64_t no_data_points = 0;  ///< likewise; of large scans an estimate
  std::optional<Rectangle> extent;   ///< as plan_extent(); none without finite points
  double density = 0.0;      ///< points per m^2 of occupied ground; NaN if they have no area
  double height_step = 0.0;  ///< of heights that were rounded; 0: they were not [m]
  double height = 0.0;       ///< from the lowest to the highest point but 0.1 % on either side [m]
  /// Share of the points within 60 degrees of z, 0.1 to 20 m along it, as a depth camera sees [-].
  double seen_along_z = 0.0;
  /// Direction in which the points scatter least, z >= 0: the normal of the ground.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// Reads a scan once. Extent and density come from all points of a small scan, and of a large one
/// from a random choice of 32768 to 65536 that is the same every time.
/// @throws Error (bad_file) as read_cloud()
ScanOutline outline(const Scan& scan);

/// As that of a cloud of the scan's points, from four passes over its files.
/// @throws Error (bad_file) as read_cloud(), or if a file changes while it is read
CloudSummary summarise(const Scan& scan);

/// Writes the points of a scan, in the site frame, as write_cloud() does that of a cloud. They are
/// read twice and not held. Width and height are those of its file if all points are of one, the
/// place of the sensor is written if it is known and one.
/// @throws Error as write_cloud() and read_cloud(), and (bad_file) if a file changes while it is
/// read
void write_cloud(const std::string& path, const Scan& scan, const CloudFormat& format);

/// One outline for each scan, found in parallel (0 threads: one per core).
std::vector<ScanOutline> outlines(const std::vector<Scan>& scans, unsigned threads = 0);

/// Cell for scans that are to be compared, from the sparsest of them [m]: so large that it holds 12
/// points, which is where the noise of a volume stops falling with smaller cells, and, if it can,
/// as large as 5 cm or a hundredth of the shorter side of the smallest scan; smaller ones show no
/// more of what a bucket does (docs/methods.md#volumes).
double cell_for(const std::vector<ScanOutline>& outlines);

/// Cell for volumes from such scans [m]: as cell_for() but for two points, so that cells of sparse
/// scans are not coarser than the dig. Points are then tested for outliers in groups of cells
/// (survey_surface()).
double survey_cell(const std::vector<ScanOutline>& outlines);

/// The surface of a scan on the grid of rasterise(), which documents the outlier test.
///
/// Within a cell the points are averaged by tiles of equal area as far as they are enough, so that
/// neither a wall with few points nor a rim with many pulls the mean; then moved to the cell's
/// centre by their own slope or, where they do not determine it, by that of the cells around. Where
/// points lie on two levels one above the other, as with plants on the ground, and no cell around
/// shows the upper level as its ground, the lower one counts; the two levels of a wall are
/// adjacent and both count. The variance is that of the mean, from the scatter about the plane, not
/// below (0.1 mm)^2; NaN for a cell with one accepted point.
///
/// The result does not depend on how a scan is parted into files.
/// @throws Error as rasterise(); (bad_file) as read_cloud(), or if a file changes while it is read
Surface survey_surface(const Scan& scan, const Rectangle& extent,
                       const RasterOptions& options = {});

/// One surface for each scan on one grid, in parallel (0: one per core); the same for any threads.
std::vector<Surface> survey_surfaces(const std::vector<Scan>& scans, const Rectangle& extent,
                                     const RasterOptions& options = {}, unsigned threads = 0);

/// Two scans of one piece of ground.
struct ScanPair {
  Scan before;                             ///< the dig
  Scan after;                              ///< the dig
  std::optional<Rectangle> left_out = {};  ///< of their registration: AlignmentOptions
};

/// Surfaces of a pair of scans, for measure_change().
struct RegisteredPair {
  SurfacePair surfaces;  ///< on one grid, with their alignment
  /// Transforms points of the scan after into the frame of the scan before, by the ground that did
  /// not change; the identity where the motion is not significant.
  Eigen::Matrix4d correction = Eigen::Matrix4d::Identity();
  Alignment first;               ///< what align() found before anything was corrected
  bool from_wide_start = false;  ///< a search beyond the priors of align() came first
};

/// Surveys both scans and registers the one after to the one before, by align() on cells of at
/// least `registration_cell`: smaller ones of a sparse scan do not show slopes. A motion that moves
/// points by more than half a cell in plan, or at all where those cells are larger than the
/// survey's, is taken off the points, which are then surveyed again. Where the motion exceeds three
/// times the priors, or the stable ground differs by more than the scatter of its points explains,
/// shifts to 1.2 m and turns to 6 degrees are tried as well, and kept if they leave two thirds of
/// the difference or less. Cells that lie between the points of a sparse scan, its rings or its
/// lines are interpolated; they count no points.
/// @throws Error as survey_surface() and align(), but (bad_file) if they share too few known cells
RegisteredPair survey_registered(const ScanPair& scans, const Rectangle& extent,
                                 const RasterOptions& options, double registration_cell,
                                 unsigned threads = 0);

}  // namespace excavplan
