// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/scans/scan_pose.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <Eigen/Dense>

#include <excavplan/base/error.hpp>

#include "base/random.hpp"
#include "base/statistics.hpp"
#include "base/table.hpp"
#include "base/text.hpp"
#include "clouds/cloud_summary.hpp"
#include "clouds/stream_sample.hpp"
#include "scans/scan_reading.hpp"

namespace excavplan {
namespace {

// Ours.
constexpr std::size_t fewest_points = 100;
constexpr std::size_t sampled_points = 5000;  // RANSAC counts on these
constexpr int trials = 3000;           // finds a plane of a tenth of the points, odds 20 to 1
constexpr double plane_width = 0.01;   // of the median range [-]
constexpr double least_share = 0.1;    // a lidar that saw a whole site has 0.14 to 0.15
constexpr double least_height = 0.05;  // [m]; nearer the plane goes through the place
constexpr double steep_look = 0.9962;  // cosine of 5 deg
constexpr double upright = 0.7071;     // cosine of 45 deg
constexpr int most_rounds = 20;
constexpr double thin_spread = 1e-3;  // points whose spread across their line is less lie on it [-]

[[noreturn]] void refuse_pose(const std::string& what) {
  throw Error(ErrorKind::bad_input, "pose of a scan: " + what);
}

struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;
  double distance(const Eigen::Vector3d& p) const { return normal.dot(p) + offset; }
};

/// The finite points, seen from a place.
std::vector<Eigen::Vector3d> seen_from(const Eigen::Vector3d& place,
                                       const std::vector<Eigen::Vector3d>& scan) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(scan.size());
  for (const Eigen::Vector3d& p : scan) {
    if (p.allFinite() && p != place) points.emplace_back(p - place);
  }
  return points;
}

double median_range(const std::vector<Eigen::Vector3d>& points) {
  std::vector<double> ranges;
  ranges.reserve(points.size());
  for (const Eigen::Vector3d& p : points) ranges.push_back(p.norm());
  return median(ranges);
}

/// The plane through three of the points that most of them lie on.
Plane most_common_plane(const std::vector<Eigen::Vector3d>& points, double width, Random random) {
  std::vector<Eigen::Vector3d> sample;
  for (std::size_t i = 0; i < sampled_points; ++i) {
    sample.push_back(points[random.index(points.size())]);
  }
  Plane best;
  std::ptrdiff_t most = -1;
  for (int trial = 0; trial < trials; ++trial) {
    const Eigen::Vector3d& a = sample[random.index(sample.size())];
    const Eigen::Vector3d& b = sample[random.index(sample.size())];
    const Eigen::Vector3d& c = sample[random.index(sample.size())];
    Plane plane;
    plane.normal = (b - a).cross(c - a);
    if (!(plane.normal.norm() > width * width)) continue;
    plane.normal.normalize();
    plane.offset = -plane.normal.dot(a);
    const auto count = std::count_if(sample.begin(), sample.end(), [&](const Eigen::Vector3d& p) {
      return std::abs(plane.distance(p)) < width;
    });
    if (count > most) {
      most = count;
      best = plane;
    }
  }
  return best;
}

/// From where the points were seen: the origin, as far as it is known.
enum class SeenFrom { origin, unknown };

/// Least squares over the points within `width` of `plane`.
Plane refitted(const std::vector<Eigen::Vector3d>& points, const Plane& plane, double width,
               SeenFrom from) {
  double weights = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(plane.distance(p)) > width) continue;
    const double squared = from == SeenFrom::origin ? p.squaredNorm() : 1.0;
    const double weight = 1.0 / (squared * squared);
    weights += weight;
    sum += weight * p;
    squares += weight * p * p.transpose();
  }
  const Eigen::Vector3d mean = sum / weights;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares / weights -
                                                            mean * mean.transpose());
  Plane fitted;
  fitted.normal = axes.eigenvectors().col(0);
  fitted.offset = -fitted.normal.dot(mean);
  return fitted;
}

struct Ground {
  Plane plane;
  double sd = 0.0;
  double share = 0.0;
};

/// From a plane near it.
Ground find_ground(const std::vector<Eigen::Vector3d>& points, const Plane& start, SeenFrom from) {
  constexpr double within = 2.5;
  double width = plane_width * median_range(points);
  Ground ground;
  ground.plane = start;
  for (int round = 0; round < most_rounds; ++round) {
    const Plane last = ground.plane;
    ground.plane = refitted(points, last, width, from);
    std::vector<double> away;
    for (const Eigen::Vector3d& p : points) {
      const double distance = std::abs(ground.plane.distance(p));
      if (distance <= width) away.push_back(distance);
    }
    ground.share = static_cast<double>(away.size()) / static_cast<double>(points.size());
    if (ground.share < least_share) {
      refuse_pose("only " + number_text(std::round(1000.0 * ground.share) / 10.0) +
                  " % of its points lie on one plane, less than 10 %: no ground plane to level it");
    }
    ground.sd = robust_sd(away);
    width = std::max(within * ground.sd, 0.1 * plane_width * median_range(points));
    if ((ground.plane.normal - last.normal).norm() < 1e-7) break;
  }
  return ground;
}

/// Ground through an origin at which no sensor stood, as of apps that lay it on the ground: up is
/// the axis z or y of the scan that is near its normal. None of another plane, or where all points
/// lie ahead along z as those of a camera do.
std::optional<Ground> ground_at_origin(const std::vector<Eigen::Vector3d>& points,
                                       const Plane& start) {
  constexpr double nearly_all = 0.99;
  constexpr double endless = std::numeric_limits<double>::infinity();
  const auto ahead = std::count_if(points.begin(), points.end(), [](const Eigen::Vector3d& p) {
    return is_along_z(p, 0.0, endless);
  });
  if (static_cast<double>(ahead) >= nearly_all * static_cast<double>(points.size())) {
    return std::nullopt;
  }
  Ground ground = find_ground(points, start, SeenFrom::unknown);
  Plane& plane = ground.plane;
  const bool is_z = std::abs(plane.normal.z()) > upright;
  if (std::abs(plane.offset) >= least_height || !(is_z || std::abs(plane.normal.y()) > upright)) {
    return std::nullopt;
  }
  if ((is_z ? plane.normal.z() : plane.normal.y()) < 0.0) plane = {-plane.normal, -plane.offset};
  return ground;
}

/// The ground below a sensor at the origin.
Ground ground_below(const std::vector<Eigen::Vector3d>& points, const Plane& start) {
  Ground ground = find_ground(points, start, SeenFrom::origin);
  Plane& plane = ground.plane;
  if (plane.offset < 0.0) plane = {-plane.normal, -plane.offset};
  if (plane.offset < least_height) {
    refuse_pose("its largest plane is " + readable(plane.offset) +
                " m from the sensor, less than 0.05 m: it is not the ground");
  }
  return ground;
}

void check(const std::vector<Eigen::Vector3d>& in_scan,
           const std::vector<Eigen::Vector3d>& in_site) {
  if (in_scan.size() != in_site.size()) {
    refuse_pose(std::to_string(in_scan.size()) + " points of the scan, but " +
                std::to_string(in_site.size()) + " known places; each point needs one");
  }
  if (in_scan.size() < 3) {
    refuse_pose(std::to_string(in_scan.size()) + " known points, must be 3 or more");
  }
  for (std::size_t i = 0; i < in_scan.size(); ++i) {
    if (!in_scan[i].allFinite() || !in_site[i].allFinite()) {
      refuse_pose("known point " + std::to_string(i + 1) + " has a coordinate that is not finite");
    }
    const double farthest =
        std::max(in_scan[i].cwiseAbs().maxCoeff(), in_site[i].cwiseAbs().maxCoeff());
    if (farthest > 1e9) {
      refuse_pose("known point " + std::to_string(i + 1) + " is " + number_text(farthest) +
                  " m from the origin, must be within 1e9 m");
    }
  }
}

Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Distance of points from their mean (rms) [m].
double spread_about(const Eigen::Vector3d& mean, const std::vector<Eigen::Vector3d>& points) {
  double squares = 0.0;
  for (const Eigen::Vector3d& p : points) squares += (p - mean).squaredNorm();
  return std::sqrt(squares / static_cast<double>(points.size()));
}

/// The points must be as far from their middle in the scan as in the site, to a tenth.
void check_lengths(double in_scan, double in_site) {
  constexpr double most = 1.1;  // ours
  const double factor = in_site / in_scan;
  if (factor <= most && factor >= 1.0 / most) return;
  refuse_pose(
      "the known points are " + readable(factor) +
      " times as far from each other in the site as in the scan: one of them is in other units");
}

/// Points that no motion brings together have others' places.
void check_fit(const PointPose& pose, double spread) {
  constexpr double most = 0.1;  // ours: of the distance from their middle (rms)
  if (pose.rms <= most * spread) return;
  const auto worst = std::max_element(pose.residuals.begin(), pose.residuals.end());
  refuse_pose(
      "the known points come to lie " + readable(pose.rms, 2) +
      " m (rms) from their places, more than a tenth of their distance from their middle, " +
      readable(spread, 2) + " m; the worst is point " +
      std::to_string(worst - pose.residuals.begin() + 1) + ", " + readable(*worst, 2) +
      " m off: points are exchanged, mirrored or wrong");
}

/// Which axis of the sensor shows ahead.
Eigen::Vector3d forward(const Eigen::Vector3d& up, SeenFrom from) {
  if (up.z() > upright) return Eigen::Vector3d::UnitX();
  if (from == SeenFrom::unknown) return -Eigen::Vector3d::UnitZ();
  if (up.z() < -steep_look) return -Eigen::Vector3d::UnitY();
  return Eigen::Vector3d::UnitZ();
}

/// @param origin  of the scan, where the sensor is taken to have stood unless `told` says where
LevelPose level(const std::vector<Eigen::Vector3d>& scan,
                const std::optional<Eigen::Vector3d>& told, const Eigen::Vector3d& origin,
                std::uint64_t seed) {
  const Eigen::Vector3d place = told.value_or(origin);
  if (!place.allFinite()) refuse_pose("the place of its sensor is not finite");
  const std::vector<Eigen::Vector3d> points = seen_from(place, scan);
  if (points.size() < fewest_points) {
    refuse_pose(std::to_string(points.size()) + " finite points, must be 100 or more to level it");
  }
  const Plane start = most_common_plane(points, plane_width * median_range(points), Random(seed));
  const auto at_origin = told ? std::nullopt : ground_at_origin(points, start);
  const Ground ground = at_origin ? *at_origin : ground_below(points, start);
  const Eigen::Vector3d up = ground.plane.normal;
  LevelPose pose;
  pose.height = ground.plane.offset;
  pose.residual_sd = ground.sd;
  pose.ground_share = ground.share;
  pose.tilt = std::acos(std::clamp(-up.z(), -1.0, 1.0));
  const Eigen::Vector3d ahead = forward(up, at_origin ? SeenFrom::unknown : SeenFrom::origin);
  const Eigen::Vector3d x = (ahead - ahead.dot(up) * up).normalized();
  pose.site_from_scan.topLeftCorner<3, 3>() << x.transpose(), up.cross(x).transpose(),
      up.transpose();
  pose.site_from_scan(2, 3) = pose.height;
  const Eigen::Vector3d moved = pose.site_from_scan.topLeftCorner<3, 3>() * place;
  pose.site_from_scan.topRightCorner<3, 1>() -= moved;
  return pose;
}

}  // namespace

LevelPose level_on_ground(const Cloud& scan, std::uint64_t seed) {
  return level(scan.points, scan.sensor_origin, Eigen::Vector3d::Zero(), seed);
}

LevelPose level_on_ground(const Scan& scan, std::uint64_t seed) {
  StreamSample<Eigen::Vector3d> sample(std::size_t{1} << 16);
  visit_scan(scan, [&sample](const std::vector<Eigen::Vector3d>& points) { sample.add(points); });
  const std::vector<Standpoint> known = standpoints_of(scan);
  const auto told = known.size() == 1 ? std::optional(known[0].place) : std::nullopt;
  try {
    return level(sample.values(), told, scan.site_from_scan.topRightCorner<3, 1>(), seed);
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, name_of(scan) + ": " + error.what());
  }
}

KnownPoints read_known_points(const std::string& path) {
  const Table table = Table::read(path);
  const std::string sensor = table.has("camera_x_m") ? "camera_" : "scan_";
  KnownPoints points;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto value = [&](const std::string& name) { return table.column(name)[i]; };
    points.in_scan.emplace_back(value(sensor + "x_m"), value(sensor + "y_m"),
                                value(sensor + "z_m"));
    points.in_site.emplace_back(value("x_m"), value("y_m"), value("z_m"));
  }
  return points;
}

PointPose pose_of_points(const std::vector<Eigen::Vector3d>& in_scan,
                         const std::vector<Eigen::Vector3d>& in_site) {
  check(in_scan, in_site);
  const Eigen::Vector3d scan_mean = mean_of(in_scan);
  const Eigen::Vector3d site_mean = mean_of(in_site);
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < in_scan.size(); ++i) {
    products += (in_site[i] - site_mean) * (in_scan[i] - scan_mean).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()(1) > thin_spread * thin_spread * svd.singularValues()(0))) {
    refuse_pose("the known points lie on one line, so the rotation about it is undetermined");
  }
  const double spread = spread_about(site_mean, in_site);
  check_lengths(spread_about(scan_mean, in_scan), spread);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  sign.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  PointPose pose;
  pose.site_from_scan.topLeftCorner<3, 3>() = rotation;
  pose.site_from_scan.topRightCorner<3, 1>() = site_mean - rotation * scan_mean;
  double squares = 0.0;
  for (std::size_t i = 0; i < in_scan.size(); ++i) {
    const Eigen::Vector3d placed = rotation * (in_scan[i] - scan_mean) + site_mean;
    pose.residuals.push_back((placed - in_site[i]).norm());
    squares += (placed - in_site[i]).squaredNorm();
  }
  pose.rms = std::sqrt(squares / static_cast<double>(in_scan.size()));
  check_fit(pose, spread);
  return pose;
}

}  // namespace excavplan
