// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/report_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/text.hpp"
#include "planning/planned_digs.hpp"

namespace excavplan::tools {
namespace {

using Json = nlohmann::ordered_json;

// ---- Numbers ----------------------------------------------------------------------------------

/// Rounded to 1e-6, far below what can be seen; null if not finite.
Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * 1e6) / 1e6 + 0.0;  // no minus zero
}

template <typename Items, typename Value>
Json numbers(const Items& items, const Value& value) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(number(value(item)));
  return list;
}

/// An array of boom, arm and bucket for each item.
template <typename Items, typename Value>
Json joint_numbers(const Items& items, const Value& value) {
  Json lists = Json::array();
  for (int joint = 0; joint < 3; ++joint) {
    lists.push_back(numbers(items, [&](const auto& item) { return value(item)(joint); }));
  }
  return lists;
}

template <typename Items>
Json phase_names(const Items& items) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(name(item.phase));
  return list;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      word = word << 8 | (at + i < bytes.size() ? bytes[at + i] : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      text += at + i > bytes.size() ? '=' : digits[word >> (18 - 6 * i) & 63U];
    }
  }
  return text;
}

// ---- Ground -----------------------------------------------------------------------------------

constexpr Eigen::Index most_cells = 250000;  // ours
constexpr std::uint16_t unknown_height = 65535;
constexpr std::uint8_t no_zone = 255;

/// Cells of a drawn one, along x and y.
Eigen::Index coarsening(const HeightMap& map) {
  Eigen::Index by = 1;
  while ((map.z.rows() / by) * (map.z.cols() / by) > most_cells) ++by;
  return by;
}

/// Means of the known cells of squares of `by` cells.
HeightMap coarsened(const HeightMap& map, Eigen::Index by) {
  if (by == 1) return map;
  HeightMap coarse = map;
  coarse.cell_size = map.cell_size * static_cast<double>(by);
  coarse.z.resize(map.z.rows() / by, map.z.cols() / by);
  for (Eigen::Index row = 0; row < coarse.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < coarse.z.cols(); ++col) {
      const auto cells = map.z.block(row * by, col * by, by, by);
      const auto known = cells.isFinite();
      coarse.z(row, col) = known.select(cells, 0.0).sum() / static_cast<double>(known.count());
    }
  }
  return coarse;
}

/// The middle cells of the same squares.
Eigen::ArrayXXi coarsened(const Eigen::ArrayXXi& zone, Eigen::Index by) {
  Eigen::ArrayXXi coarse(zone.rows() / by, zone.cols() / by);
  for (Eigen::Index row = 0; row < coarse.rows(); ++row) {
    for (Eigen::Index col = 0; col < coarse.cols(); ++col) {
      coarse(row, col) = zone(row * by + by / 2, col * by + by / 2);
    }
  }
  return coarse;
}

/// Steps of 0.1 mm, or as fine as 16 bits allow.
Json heights_json(const HeightMap& map) {
  const auto known = map.z.isFinite();
  const double highest = known.select(map.z, -std::numeric_limits<double>::infinity()).maxCoeff();
  const double lowest = known.select(map.z, std::numeric_limits<double>::infinity()).minCoeff();
  const double base = known.any() ? lowest : 0.0;
  const double step = known.any() ? std::max(1e-4, (highest - lowest) / (unknown_height - 1)) : 1.0;
  std::vector<std::uint8_t> bytes;
  for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
      const double z = map.z(row, col);
      const auto code = std::isfinite(z)
                            ? static_cast<std::uint16_t>(std::lround((z - base) / step))
                            : unknown_height;
      bytes.push_back(static_cast<std::uint8_t>(code & 255U));
      bytes.push_back(static_cast<std::uint8_t>(code >> 8U));
    }
  }
  return {{"base_m", base}, {"step_m", step}, {"codes", base64(bytes)}};
}

std::string zone_codes(const Eigen::ArrayXXi& zone) {
  std::vector<std::uint8_t> bytes;
  for (Eigen::Index row = 0; row < zone.rows(); ++row) {
    for (Eigen::Index col = 0; col < zone.cols(); ++col) {
      const int index = zone(row, col);
      bytes.push_back(index < 0 || index >= no_zone ? no_zone : static_cast<std::uint8_t>(index));
    }
  }
  return base64(bytes);
}

Json area_json(const ReportArea& area) {
  const HeightMap& first = area.states.front().map;
  const Eigen::Index by = coarsening(first);
  Json json = {{"origin_m", {first.origin.x(), first.origin.y()}},
               {"cell_m", first.cell_size * static_cast<double>(by)},
               {"surveyed_cell_m", first.cell_size},
               {"rows", first.z.rows() / by},
               {"cols", first.z.cols() / by},
               {"states", Json::array()}};
  for (const ShownGround& state : area.states) {
    Json heights = heights_json(coarsened(state.map, by));
    heights["name"] = state.name;
    json["states"].push_back(std::move(heights));
  }
  if (area.zone.size() > 0) json["zone"] = zone_codes(coarsened(area.zone, by));
  return json;
}

Json zone_json(const ChangeZone& zone) {
  const Rectangle& extent = zone.extent;
  return {{"kind", name(zone.kind)},
          {"volume_m3", std::abs(zone.volume.value)},
          {"volume", readable(std::abs(zone.volume.value), zone.volume.sd) + " m³"},
          {"extent_m", {extent.x_min, extent.y_min, extent.x_max, extent.y_max}}};
}

// ---- Machine ----------------------------------------------------------------------------------

Json pin_json(const PolarPin& pin) { return {number(pin.distance), number(pin.angle)}; }

Json cylinder_json(const Cylinder& cylinder) {
  const CylinderGeometry& geometry = cylinder.geometry();
  Json json = {{"count", geometry.count},
               {"foot", pin_json(geometry.foot)},
               {"shortest_m", number(cylinder.shortest())}};
  if (const auto* pin = std::get_if<PolarPin>(&geometry.rod)) {
    json["rod"] = pin_json(*pin);
    return json;
  }
  const auto& bars = std::get<FourBar>(geometry.rod);
  const auto bar = [](const Bar& each) -> Json {
    return {{"pin", pin_json(each.pin)}, {"length_m", number(each.length)}};
  };
  json["rocker"] = bar(bars.rocker);
  json["link"] = bar(bars.link);
  return json;
}

Json machine_json(const Machine& machine) {
  const Bucket& bucket = machine.bucket;
  Json json = {{"name", machine.name},
               {"boom_pin_m", {machine.boom_pin.x(), machine.boom_pin.y()}},
               {"lengths_m", {machine.boom_length, machine.arm_length, machine.bucket_length}},
               {"track_front_m", machine.track_front},
               {"torque_limits_kn_m",
                numbers(machine.limits, [](const auto& limit) { return limit.torque / 1000.0; })},
               {"profile_m", Json::array()},
               {"width_m", bucket.width_outside},
               {"width_inside_m", bucket.width_inside}};
  for (const Eigen::Vector2d& corner : bucket.profile) {
    json["profile_m"].push_back({number(corner.x()), number(corner.y())});
  }
  if (bucket.teeth) {
    json["teeth"] = {{"count", bucket.teeth->count},
                     {"width_m", bucket.teeth->width},
                     {"length_m", bucket.teeth->length}};
  }
  if (!machine.cylinders) return json;
  for (const Cylinder& cylinder : *machine.cylinders) {
    json["cylinders"].push_back(cylinder_json(cylinder));
  }
  return json;
}

// ---- Digs -------------------------------------------------------------------------------------

/// Times at which a trajectory is nearest to the poses of its path, which it rounds at corners.
std::vector<double> times_of(const std::vector<DigPose>& poses, const Trajectory& trajectory) {
  const auto& points = trajectory.points;
  std::vector<double> times;
  std::size_t from = 0;  // a path is not driven backwards
  for (const DigPose& pose : poses) {
    double least = std::numeric_limits<double>::infinity();
    double time = 0.0;
    std::size_t nearest = from;
    for (std::size_t i = from; i + 1 < points.size(); ++i) {
      const JointAngles along = points[i + 1].joints - points[i].joints;
      const double length = along.squaredNorm();
      const double share =
          length > 0.0 ? std::clamp((pose.joints - points[i].joints).dot(along) / length, 0.0, 1.0)
                       : 0.0;
      const double distance = (points[i].joints + share * along - pose.joints).norm();
      if (distance >= least - 1e-9) continue;
      least = distance;
      nearest = i;
      time = points[i].time + share * (points[i + 1].time - points[i].time);
    }
    from = nearest;
    times.push_back(times.empty() ? time : std::max(time, times.back()));
  }
  return times;
}

/// Forces in the middle of each step; the energy at its ends, summed as EnergyLedger does.
Json loads_json(const ReportDig& dig) {
  const auto& poses = dig.path.poses;
  const std::size_t steps = std::min(dig.history.size(), poses.size() - 1);
  const std::vector<ForceSample> history(dig.history.begin(),
                                         dig.history.begin() + static_cast<std::ptrdiff_t>(steps));
  const std::vector<double> times = times_of(poses, dig.trajectory);
  std::vector<double> middle;
  std::vector<double> power;
  std::vector<double> energy = {0.0};
  for (std::size_t i = 0; i < steps; ++i) {
    const JointAngles turn = poses[i + 1].joints - poses[i].joints;
    const double work = history[i].torque.cwiseProduct(turn).cwiseMax(0.0).sum();
    const double took = times[i + 1] - times[i];
    middle.push_back(0.5 * (times[i] + times[i + 1]));
    power.push_back(took > 0.0 ? work / took : 0.0);
    energy.push_back(energy.back() + work);
  }
  const auto per_thousand = [](double value) { return value / 1000.0; };
  const auto same = [](double value) { return value; };
  const std::vector<double> ends(times.begin(),
                                 times.begin() + static_cast<std::ptrdiff_t>(steps) + 1);
  return {{"time_s", numbers(middle, same)},
          {"phase", phase_names(history)},
          {"torque_kn_m", joint_numbers(history,
                                        [](const ForceSample& sample) -> JointAngles {
                                          return sample.torque / 1000.0;
                                        })},
          {"soil_x_kn", numbers(history, [](const auto& s) { return s.soil.x() / 1000.0; })},
          {"soil_z_kn", numbers(history, [](const auto& s) { return s.soil.y() / 1000.0; })},
          {"fill_m3", numbers(history, [](const auto& s) { return s.bucket_fill; })},
          {"power_kw", numbers(power, per_thousand)},
          {"energy_time_s", numbers(ends, same)},
          {"energy_kj", numbers(energy, per_thousand)}};
}

Json dig_json(const ReportDig& dig) {
  const auto& points = dig.trajectory.points;
  using Point = TrajectoryPoint;
  Json json = {{"name", dig.name},
               {"ground_z_m", number(dig.path.ground_z)},
               {"start_x_m", number(dig.path.start_x)},
               {"time_s", numbers(points, [](const Point& p) { return p.time; })},
               {"phase", phase_names(points)},
               {"joints_rad", joint_numbers(points, [](const Point& p) { return p.joints; })},
               {"rates_rad_per_s", joint_numbers(points, [](const Point& p) { return p.rates; })},
               {"tip_x_m", numbers(points, [](const Point& p) { return p.bucket.x; })},
               {"tip_z_m", numbers(points, [](const Point& p) { return p.bucket.z; })}};
  if (dig.state) json["state"] = *dig.state;
  if (!dig.history.empty()) json["loads"] = loads_json(dig);
  return json;
}

}  // namespace

ReportDig played_dig(const std::string& name, const Machine& machine, const DigPath& path,
                     const DigResult& dig) {
  ReportDig played = {name, path, {machine.name, {}}, dig.history};
  auto& poses = played.path.poses;
  if (dig.stall && !dig.torques.empty()) poses.resize(dig.torques.size() + 1);
  if (dig.stall && dig.torques.empty()) poses.resize(2);
  played.history.resize(std::min(played.history.size(), poses.size() - 1));
  std::vector<JointAngles> torques = dig.torques;
  torques.resize(std::min(torques.size(), poses.size() - 1));
  played.trajectory = time_dig_path(machine, played.path, {}, torques);
  return played;
}

std::vector<ReportArea> surveyed_areas(const VolumeChange& change,
                                       const std::vector<HeightMap>& before) {
  std::vector<ReportArea> areas;
  for (std::size_t i = 0; i < change.areas.size() && i < before.size(); ++i) {
    HeightMap after = before[i];
    after.z += change.areas[i].difference.z;
    areas.push_back({{{"before", before[i]}, {"after", std::move(after)}}, change.areas[i].zone});
  }
  return areas;
}

nlohmann::ordered_json to_json(const ReportScene& scene) {
  Json json = {{"areas", Json::array()}, {"zones", Json::array()}, {"digs", Json::array()}};
  for (const ReportArea& area : scene.areas) json["areas"].push_back(area_json(area));
  for (const ChangeZone& zone : scene.zones) json["zones"].push_back(zone_json(zone));
  if (scene.machine) json["machine"] = machine_json(*scene.machine);
  for (const ReportDig& dig : scene.digs) json["digs"].push_back(dig_json(dig));
  return json;
}

}  // namespace excavplan::tools
