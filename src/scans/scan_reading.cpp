// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/scan_reading.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Geometry>

#include <excavplan/scans/machine_front.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "clouds/point_stream.hpp"

namespace excavplan {
namespace {

void require_scan(const Scan& scan) {
  const auto require = [](bool holds, const char* rule) {
    if (!holds) refuse(std::string("scan: ") + rule);
  };
  const auto& clouds = scan.clouds;
  require(std::find(clouds.begin(), clouds.end(), nullptr) == clouds.end(),
          "one of its clouds is a null pointer");
  require(scan.site_from_scan.allFinite(), "a number of site_from_scan is not finite");
  require(scan.unit > 0.0 && std::isfinite(scan.unit), "unit must be above 0 and finite");
  require(!scan.sensor_origin || scan.sensor_origin->allFinite(), "sensor_origin must be finite");
  const auto& area = scan.area;
  require(!area || (area->x_max > area->x_min && area->y_max > area->y_min),
          "area is empty, its x and y must grow");
}

/// A file that names the unit of its coordinates is read in that unit, or not at all.
void require_unit(const Scan& scan, const std::string& file, const CloudShape& shape) {
  constexpr double alike = 1e-5;  // of a foot and a US survey foot, which differ by 2e-6
  if (!shape.unit || std::abs(*shape.unit / scan.unit - 1.0) < alike) return;
  const bool is_foot = std::abs(*shape.unit / 0.3048 - 1.0) < alike;
  throw Error(ErrorKind::bad_file,
              file + ": found coordinates in units of " + number_text(*shape.unit) +
                  " m by its coordinate system, but they are read in units of " +
                  number_text(scan.unit) + " m: give " +
                  (is_foot              ? "`unit` ft"
                   : *shape.unit == 1.0 ? "`unit` m"
                                        : "the right `unit`"));
}

}  // namespace

bool is_no_data(double height, const std::vector<double>& no_data) {
  constexpr double same = 1e-6;      // [unit of the file]
  constexpr double relative = 1e-6;  // as of float32
  return std::any_of(no_data.begin(), no_data.end(), [&](double none) {
    return std::abs(height - none) <= same + relative * std::abs(none);
  });
}

VisitedScan visit_scan(const Scan& scan, const PointVisitor& visit) {
  require_scan(scan);
  const bool is_moved = scan.site_from_scan != Eigen::Matrix4d::Identity() || scan.unit != 1.0;
  const Eigen::Matrix3d rotation = scan.unit * scan.site_from_scan.topLeftCorner<3, 3>();
  const Eigen::Vector3d shift = scan.site_from_scan.topRightCorner<3, 1>();
  const bool has_no_data = !scan.no_data.empty();
  VisitedScan visited;
  std::uint64_t passed_on = 0;
  std::vector<Eigen::Vector3d> kept;
  const PointVisitor bring_in = [&](const std::vector<Eigen::Vector3d>& points) {
    kept.clear();
    for (const Eigen::Vector3d& point : points) {
      if (has_no_data && is_no_data(point.z(), scan.no_data)) continue;
      const Eigen::Vector3d p = is_moved ? Eigen::Vector3d(rotation * point + shift) : point;
      if (scan.area && !scan.area->contains(p.x(), p.y())) continue;
      if (scan.machine && scan.machine->holds(p)) {
        ++visited.machine_points;
      } else {
        kept.push_back(p);
      }
    }
    passed_on += kept.size();
    visit(kept);
  };
  const PointVisitor pass_on = [&](const std::vector<Eigen::Vector3d>& points) {
    passed_on += points.size();
    visit(points);
  };
  const bool as_it_is = !is_moved && !scan.area && !scan.machine && !has_no_data;
  const PointVisitor& take = as_it_is ? pass_on : bring_in;
  CloudShape& shape = visited.shape;
  const auto follow = [&shape](CloudShape next) {
    next.left_out += shape.left_out;
    shape = next;
  };
  for (const std::string& file : scan.files) {
    const CloudShape next = stream_shape(file, take);
    require_unit(scan, file, next);
    follow(next);
  }
  for (const auto& cloud : scan.clouds) {
    visit_parts(cloud->points, take);
    follow({cloud->width, cloud->height, {}, cloud->left_out, {}});
  }
  const bool is_one = scan.files.size() + scan.clouds.size() == 1;
  if (!is_one || shape.points() != passed_on) shape = {passed_on, 1, {}, shape.left_out, {}};
  return visited;
}

std::vector<Standpoint> standpoints_of(const Scan& scan) {
  require_scan(scan);
  constexpr double one_place = 0.05;      // [m], ours
  constexpr std::size_t most_places = 4;  // ours
  Scan none = scan;
  none.files.clear();
  none.clouds.clear();
  std::vector<Standpoint> found;
  bool are_known = true;
  const auto part_from = [&](const std::optional<Eigen::Vector3d>& said) -> Scan& {
    are_known = are_known && said.has_value();
    const Eigen::Vector3d metres = scan.unit * said.value_or(Eigen::Vector3d::Zero());
    const Eigen::Vector3d place = (scan.site_from_scan * metres.homogeneous()).head<3>();
    for (Standpoint& known : found) {
      if ((known.place - place).norm() < one_place) return known.scan;
    }
    found.push_back({place, none});
    return found.back().scan;
  };
  for (const std::string& file : scan.files) {
    const bool is_told = scan.sensor_origin.has_value();
    part_from(is_told ? scan.sensor_origin : read_sensor_origin(file)).files.push_back(file);
  }
  for (const auto& cloud : scan.clouds) {
    const auto said = scan.sensor_origin || !cloud ? scan.sensor_origin : cloud->sensor_origin;
    part_from(said).clouds.push_back(cloud);
  }
  if (!are_known || found.size() > most_places) found.clear();
  return found;
}

Cloud gathered(const Scan& scan) {
  Scan held = scan;
  held.files.clear();
  held.clouds.clear();
  for (const std::string& file : scan.files) {
    held.clouds.push_back(std::make_shared<const Cloud>(read_cloud(file)));
  }
  held.clouds.insert(held.clouds.end(), scan.clouds.begin(), scan.clouds.end());
  Cloud all;
  visit_scan(held, [&all](const std::vector<Eigen::Vector3d>& points) {
    all.points.insert(all.points.end(), points.begin(), points.end());
  });
  all.width = all.points.size();
  return all;
}

std::string name_of(const Scan& scan) {
  if (!scan.name.empty()) return scan.name;
  if (scan.files.empty()) return "a scan in memory";
  std::string name = scan.files.front();
  for (std::size_t i = 1; i < scan.files.size(); ++i) name += " with " + scan.files[i];
  return name;
}

void write_cloud(const std::string& path, const Scan& scan, const CloudFormat& format) {
  const std::vector<Standpoint> known = standpoints_of(scan);
  const OrderedPoints source = [&](const PointVisitor& visit) {
    CloudShape shape = visit_scan(scan, visit).shape;
    if (known.size() == 1) shape.sensor = known.front().place;
    return shape;
  };
  write_points(path, source, format);
}

}  // namespace excavplan
