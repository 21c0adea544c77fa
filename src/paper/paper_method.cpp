// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/paper_method.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/memory.h>
#include <pcl/octree/octree_pointcloud_changedetector.h>
#include <pcl/point_types.h>

#include <excavplan/base/error.hpp>

#include "base/non_finite.hpp"
#include "base/text.hpp"

// PCL's filters write to the console only where they are misused (no points, more voxels than an
// int counts); both are excluded before they are called, so its global verbosity stays untouched.

namespace excavplan {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorKind::bad_input, "paper method: " + what);
}

void require_leaf(double leaf) {
  if (!(leaf > 0.0) || !std::isfinite(leaf)) {
    refuse("leaf is " + number_text(leaf) + " m, must be > 0");
  }
}

/// Extent of the finite points of one or two clouds.
struct Box {
  Eigen::Vector3d min = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d max = -min;

  void add(const Cloud& cloud) {
    for (const Eigen::Vector3d& point : cloud.points) {
      if (!point.allFinite()) continue;
      min = min.cwiseMin(point);
      max = max.cwiseMax(point);
    }
  }
  bool is_empty() const { return !(min.x() <= max.x()); }
};

void require_points(const Cloud& cloud, const std::string& name) {
  Box box;
  box.add(cloud);
  if (box.is_empty()) refuse("the cloud " + name + " has no finite point");
}

/// Beyond 2^31 voxels PCL's VoxelGrid returns its input unfiltered.
void require_countable(const Box& box, double leaf, PaperVoxels voxels) {
  constexpr double most_voxels = 2147483647.0;
  if (box.is_empty()) return;
  Eigen::Array3d count = ((box.max - box.min) / leaf).array() + 2.0;
  if (voxels == PaperVoxels::columns) count.z() = 1.0;
  if (count.prod() <= most_voxels) return;
  const Eigen::Vector3d size = box.max - box.min;
  refuse("an extent of " + number_text(size.x()) + " x " + number_text(size.y()) + " x " +
         number_text(size.z()) + " m holds more than 2^31 voxels of " + number_text(leaf) + " m");
}

/// What is taken off x and y before they become float: whole voxels, so that the lattice stays.
Eigen::Vector3d shift_of(const Box& box, double leaf) {
  if (box.is_empty()) return Eigen::Vector3d::Zero();
  return {leaf * std::floor(box.min.x() / leaf), leaf * std::floor(box.min.y() / leaf), 0.0};
}

PclCloud::Ptr to_pcl(const Cloud& cloud, const Eigen::Vector3d& shift) {
  PclCloud::Ptr shifted(new PclCloud);
  shifted->reserve(cloud.points.size());
  for (const Eigen::Vector3d& point : cloud.points) {
    if (!point.allFinite()) continue;
    const Eigen::Vector3f p = (point - shift).cast<float>();
    shifted->push_back({p.x(), p.y(), p.z()});
  }
  return shifted;
}

/// The points of `after` in voxels where `before` has none.
PclCloud::Ptr changed_points(const PclCloud::Ptr& before, const PclCloud::Ptr& after, double leaf) {
  pcl::octree::OctreePointCloudChangeDetector<pcl::PointXYZ> octree(leaf);
  octree.setInputCloud(before);
  octree.addPointsFromInputCloud();
  octree.switchBuffers();
  octree.setInputCloud(after);
  octree.addPointsFromInputCloud();
  pcl::Indices indices;
  octree.getPointIndicesFromNewVoxels(indices);
  std::sort(indices.begin(), indices.end());
  return pcl::make_shared<PclCloud>(*after, indices);
}

PclCloud::Ptr without_outliers(const PclCloud::Ptr& cloud, const PaperOptions& options) {
  if (cloud->size() < 2 || options.outlier_neighbours == 0) return cloud;
  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
  filter.setInputCloud(cloud);
  // PCL reads past the neighbours it found if there are fewer than asked for
  filter.setMeanK(std::min(options.outlier_neighbours, static_cast<int>(cloud->size()) - 1));
  filter.setStddevMulThresh(options.outlier_deviations);
  PclCloud::Ptr kept(new PclCloud);
  filter.filter(*kept);
  return kept;
}

PclCloud::Ptr one_point_per_voxel(const PclCloud::Ptr& cloud, double leaf, PaperVoxels voxels) {
  if (cloud->empty()) return cloud;
  Eigen::Vector4f size = Eigen::Vector4f::Constant(static_cast<float>(leaf));
  pcl::PointXYZ lift(0.0F, 0.0F, 0.0F);
  if (voxels == PaperVoxels::columns) {  // one layer of voxels over the lowest point
    const auto [low, high] = std::minmax_element(
        cloud->begin(), cloud->end(), [](const auto& a, const auto& b) { return a.z < b.z; });
    lift.z = -low->z;
    size.z() = 2.0F * (high->z - low->z) + 1.0F;
  }
  PclCloud::Ptr lifted(new PclCloud(*cloud));
  for (pcl::PointXYZ& point : *lifted) point.z += lift.z;
  pcl::VoxelGrid<pcl::PointXYZ> filter;
  filter.setInputCloud(lifted);
  filter.setLeafSize(size);
  PclCloud::Ptr centroids(new PclCloud);
  filter.filter(*centroids);
  for (pcl::PointXYZ& point : *centroids) point.z -= lift.z;
  return centroids;
}

/// The paper's V(region, s) = sum (s z)^+ l^2.
double clipped_sum(const PclCloud& centroids, double sign, double leaf) {
  double sum = 0.0;
  for (const pcl::PointXYZ& point : centroids) {
    sum += std::max(0.0, sign * static_cast<double>(point.z));
  }
  return sum * leaf * leaf;
}

/// One point per voxel of the soil that changed in one area.
PclCloud::Ptr changed_soil(const CloudPair& area, double leaf, const PaperOptions& options) {
  Box box;
  box.add(area.before);
  box.add(area.after);
  require_countable(box, leaf, options.voxels);
  const Eigen::Vector3d shift = shift_of(box, leaf);
  const auto changed = changed_points(to_pcl(area.before, shift), to_pcl(area.after, shift), leaf);
  return one_point_per_voxel(without_outliers(changed, options), leaf, options.voxels);
}

void require_options(const PaperOptions& options) {
  if (options.outlier_neighbours < 0) {
    refuse("outlier_neighbours is " + std::to_string(options.outlier_neighbours) +
           ", must be >= 0");
  }
  if (!(options.outlier_deviations > 0.0)) {
    refuse("outlier_deviations is " + number_text(options.outlier_deviations) + ", must be > 0");
  }
}

}  // namespace

double paper_volume(const Cloud& cloud, double sign, double leaf, PaperVoxels voxels) {
  require_leaf(leaf);
  Box box;
  box.add(cloud);
  require_countable(box, leaf, voxels);
  const auto points = to_pcl(cloud, shift_of(box, leaf));
  return clipped_sum(*one_point_per_voxel(points, leaf, voxels), sign, leaf);
}

VolumeChange paper_volumes(const CloudPair& dig, const CloudPair& dump, double leaf,
                           const PaperOptions& options) {
  require_leaf(leaf);
  require_options(options);
  require_points(dig.before, "dig.before");
  require_points(dig.after, "dig.after");
  require_points(dump.before, "dump.before");
  require_points(dump.after, "dump.after");
  const auto dug = changed_soil(dig, leaf, options);
  const auto heap = changed_soil(dump, leaf, options);
  VolumeChange change;
  change.excavated = {clipped_sum(*dug, -1.0, leaf), nan};
  change.spilled = {clipped_sum(*dug, +1.0, leaf), nan};
  change.dumped = {clipped_sum(*heap, +1.0, leaf), nan};
  change.before = change.excavated;
  change.after = {change.spilled.value + change.dumped.value, nan};
  change.covariance_before_after = nan;
  return change;
}

}  // namespace excavplan
