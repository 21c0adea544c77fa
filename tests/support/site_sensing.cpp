// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/site_sensing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace excavplan::scenes {

Eigen::Vector3d standpoint(Draft& d, double side, double height) {
  const Rectangle& extent = d.scene.extent;
  const double y = (side < 0.0 ? extent.y_min : extent.y_max) + side * d.random.uniform(0.2, 0.6);
  const double x = d.random.uniform(1.0, 4.5);
  return {x, y, d.scene.ground(x, y) + height};
}

Lidar lidar_at(const SiteScene& scene, const Eigen::Vector3d& position) {
  const Rectangle& extent = scene.extent;
  Lidar lidar;
  lidar.position = position;
  lidar.azimuth = {10.0, -10.0};
  double far = 0.0;
  for (const double x : {extent.x_min, extent.x_max}) {
    for (const double y : {extent.y_min, extent.y_max}) {
      const double azimuth = std::atan2(y - position.y(), x - position.x());
      lidar.azimuth = {std::min(lidar.azimuth(0), azimuth), std::max(lidar.azimuth(1), azimuth)};
      far = std::max(far, std::hypot(x - position.x(), y - position.y()));
    }
  }
  lidar.elevation = {-75.0 * degree, -std::atan2(position.z(), far)};
  lidar.range_noise = 0.01;
  lidar.max_range = 1.1 * std::hypot(far, position.z());
  return lidar;
}

void step_for(Lidar& lidar, std::size_t points) {
  points = std::min<std::size_t>(points, 100000);
  const double window =
      (lidar.azimuth(1) - lidar.azimuth(0)) * (lidar.elevation(1) - lidar.elevation(0));
  lidar.angle_step.setConstant(std::sqrt(0.6 * window / static_cast<double>(points)));
}

Lidar moved_a_little(Lidar lidar, Random& random) {
  for (int axis = 0; axis < 3; ++axis) lidar.position(axis) += random.uniform(-0.15, 0.15);
  return lidar;
}

void scan_by(Draft& d, const std::vector<Lidar>& lidars) {
  d.scene.sampling.lidars_before = lidars;
  for (const Lidar& lidar : lidars) {
    d.scene.sampling.lidars_after.push_back(moved_a_little(lidar, d.random));
  }
}

void scan_from(Draft& d, double height, bool both_sides) {
  d.scene.dig.wall_angle = d.random.uniform(55.0, 85.0) * degree;
  d.compose();
  const double first = d.random.uniform() < 0.5 ? -1.0 : 1.0;
  std::vector<Lidar> lidars = {lidar_at(d.scene, standpoint(d, first, height))};
  if (both_sides) lidars.push_back(lidar_at(d.scene, standpoint(d, -first, height)));
  for (Lidar& lidar : lidars) step_for(lidar, d.scene.sampling.points / lidars.size());
  scan_by(d, lidars);
}

void lidar_one(Draft& d) { scan_from(d, d.random.uniform(4.0, 6.0), false); }

void untold(Draft& d, double height, bool both_sides) {
  scan_from(d, height, both_sides);
  d.scene.sampling.places_told = false;
}

void lidar_untold(Draft& d) { untold(d, d.random.uniform(4.0, 6.0), false); }

void lidar_untold_low(Draft& d) { untold(d, 2.5, false); }

void lidar_untold_two(Draft& d) { untold(d, 2.5, true); }

void lidar_untold_thinned(Draft& d) {
  lidar_untold(d);
  d.scene.sampling.voxel = 0.04;
}

void lidar_one_low(Draft& d) { scan_from(d, 2.5, false); }

void lidar_two(Draft& d) { scan_from(d, 2.5, true); }

void rings(Draft& d, int count, bool both_sides) {
  d.scene.dig.wall_angle = d.random.uniform(55.0, 80.0) * degree;
  d.compose();
  const double side = d.random.uniform() < 0.5 ? -1.0 : 1.0;
  const double height = d.random.uniform(2.5, 4.0);
  const double lowest = -d.random.uniform(60.0, 70.0) * degree;
  std::vector<Lidar> lidars = {lidar_at(d.scene, standpoint(d, side, height))};
  if (both_sides) lidars.push_back(lidar_at(d.scene, standpoint(d, -side, height)));
  for (Lidar& lidar : lidars) {
    lidar.elevation(0) = lowest;
    lidar.angle_step = {0.2 * degree, (lidar.elevation(1) - lidar.elevation(0)) / (count - 1)};
  }
  scan_by(d, lidars);
}

void rings16(Draft& d) { rings(d, 16); }

void rings16_two(Draft& d) { rings(d, 16, true); }

void rings32_two(Draft& d) { rings(d, 32, true); }

void rings128_two(Draft& d) { rings(d, 128, true); }

void rings32(Draft& d) { rings(d, 32); }

void rings64(Draft& d) { rings(d, 64); }

void rings128(Draft& d) { rings(d, 128); }

void sparse(Draft& d) { d.scene.sampling.points = 5000; }

void lattice(Draft& d) {
  const double size = d.random.uniform(3.5, 4.5);
  SiteScene& scene = d.scene;
  enlarge(scene.dig, size);
  scene.heap *= size;
  for (double* side :
       {&scene.extent.x_min, &scene.extent.x_max, &scene.extent.y_min, &scene.extent.y_max}) {
    *side *= size;
  }
  d.compose();
  scene.sampling.lattice = d.random.uniform(0.1, 0.3);
  scene.sampling.noise = 0.01;
}

void stripes(Draft& d) {
  d.scene.sampling.stripe_error = 0.004;
  d.scene.sampling.stripe_width = d.random.uniform(0.02, 0.05);
}

void outliers(Draft& d) { d.scene.sampling.outliers = 0.01; }

void outliers_rough(Draft& d) {
  outliers(d);
  const double roughness = d.random.uniform(0.015, 0.025);
  d.ground(d.random.uniform(2.0, 8.0) * degree, roughness);
}

void outliers_lidars(Draft& d) {
  outliers(d);
  scan_from(d, d.random.uniform(4.0, 6.0), true);
}

void flying(Draft& d) { d.scene.sampling.flying = 0.02; }

void multipath(Draft& d) { d.scene.sampling.multipath = 0.02; }

void no_data(Draft& d) {
  constexpr std::array<double, 4> heights = {-9999.0, -99.0, 0.0, 3.4e38};
  d.scene.sampling.no_data = d.random.uniform(0.005, 0.03);
  d.scene.sampling.no_data_height = heights[d.random.index(4)];
  // a zero is "none" where the ground lies elsewhere
  Eigen::Isometry3d lifted = Eigen::Isometry3d::Identity();
  lifted.translation().z() = 37.0;
  const double none = d.scene.sampling.no_data_height;
  d.scene.frame_before = d.scene.frame_after = [=](const Eigen::Vector3d& p) {
    return p.z() == none ? p : Eigen::Vector3d(lifted * p);
  };
}

PointMap scaled(double factor) {
  return [factor](const Eigen::Vector3d& p) { return Eigen::Vector3d(factor * p); };
}

PointMap moved(const Eigen::Isometry3d& motion) {
  return [motion](const Eigen::Vector3d& p) { return Eigen::Vector3d(motion * p); };
}

Eigen::Vector3d level_direction(Random& random) {
  const double heading = random.uniform(0.0, 2.0 * pi);
  return {std::cos(heading), std::sin(heading), 0.0};
}

void units_mm(Draft& d) { d.scene.frame_before = d.scene.frame_after = scaled(1000.0); }

void units_cm(Draft& d) { d.scene.frame_before = d.scene.frame_after = scaled(100.0); }

void one_scan_mm(Draft& d) { d.scene.frame_after = scaled(1000.0); }

void tilted(Draft& d) {
  d.scene.dig.wall_angle = d.random.uniform(75.0, 85.0) * degree;
  d.compose();
  const double tilt = d.random.uniform(20.0, 45.0) * degree;
  const Eigen::Isometry3d frame(Eigen::AngleAxisd(tilt, level_direction(d.random)));
  d.scene.frame_before = d.scene.frame_after = moved(frame);
}

void camera_frame(Draft& d) {
  const Eigen::Vector3d centre(2.7, 0.0, 0.0);
  Eigen::Vector3d position = standpoint(d, -1.0, d.random.uniform(3.0, 6.0));
  if (d.random.uniform() < 0.5) position = {2.7, -0.3, 7.0};
  const Eigen::Vector3d forward = (centre - position).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d camera = Eigen::Isometry3d::Identity();
  camera.linear() << right, forward.cross(right), forward;
  camera.translation() = position;
  d.scene.frame_before = d.scene.frame_after = moved(camera.inverse());
}

void moved_far(Draft& d) {
  d.ground(8.0 * degree, 0.01);
  const Eigen::Vector3d centre(2.7, 0.0, 0.0);
  Eigen::Isometry3d motion = Eigen::Translation3d(centre) *
                             random_motion(0.0, 2.0 * degree, Random(d.random.bits())) *
                             Eigen::Translation3d(-centre);
  motion.pretranslate(0.3 * level_direction(d.random));
  d.scene.frame_after = moved(motion);
}

void swapped(Draft& d) { d.scene.swapped = true; }

void swapped_areas(Draft& d) {
  d.scene.swapped = true;
  d.scene.two_areas = true;
}

void offsets(Draft& d) {
  const auto kind = d.random.index(3);
  const double reach = kind == 0 ? 1.0 : 1000.0;
  Eigen::Vector3d offset(kind == 2 ? 4.5e5 : 0.0, kind == 2 ? 5.4e6 : 0.0, 0.0);
  for (double& coordinate : offset) coordinate += d.random.uniform(-reach, reach);
  d.scene.frame_before = d.scene.frame_after =
      moved(Eigen::Isometry3d(Eigen::Translation3d(offset)));
  d.scene.offset_pair = true;
}

}  // namespace excavplan::scenes
