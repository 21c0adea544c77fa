// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <excavplan/clouds/cloud.hpp>

/// @file
/// PCL's StatisticalOutlierRemoval, 50 neighbours and one standard deviation, on one cloud: the
/// step with which many pipelines begin, to be timed beside excavplan.
///
///     outlier_removal CLOUD

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "outlier_removal: one cloud is needed\n");
    return EXIT_FAILURE;
  }
  try {
    const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
    excavplan::stream_cloud(words[1], [&](const std::vector<Eigen::Vector3d>& points) {
      for (const Eigen::Vector3d& p : points) {
        cloud->push_back(
            {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
      }
    });
    pcl::StatisticalOutlierRemoval<pcl::PointXYZ> removal;
    removal.setInputCloud(cloud);
    removal.setMeanK(50);
    removal.setStddevMulThresh(1.0);
    pcl::PointCloud<pcl::PointXYZ> kept;
    removal.filter(kept);
    std::printf("%zu of %zu points kept\n", kept.size(), cloud->size());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "outlier_removal: %s\n", e.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
