// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/report_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/base64.hpp"
#include "base/text.hpp"
#include "ground/window.hpp"
#include "planning/planned_digs.hpp"
#include "report/report_parts.hpp"

namespace excavplan {
namespace {

using Json = nlohmann::ordered_json;

// ---- Numbers ----------------------------------------------------------------------------------

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

// ---- Ground -----------------------------------------------------------------------------------

constexpr std::uint16_t unknown_code = 65535;
constexpr int no_zone = 255;

/// Steps of 0.1 mm, or as fine as 16 bits allow.
Json heights_json(const HeightMap& map) {
  const auto known = map.z.isFinite();
  const double highest = known.select(map.z, -std::numeric_limits<double>::infinity()).maxCoeff();
  const double lowest = known.select(map.z, std::numeric_limits<double>::infinity()).minCoeff();
  const double base = known.any() ? lowest : 0.0;
  const double step = known.any() ? std::max(1e-4, (highest - lowest) / (unknown_code - 1)) : 1.0;
  std::string bytes;
  for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
      const double z = map.z(row, col);
      const auto code = std::isfinite(z)
                            ? static_cast<std::uint16_t>(std::lround((z - base) / step))
                            : unknown_code;
      bytes.push_back(static_cast<char>(code & 255U));
      bytes.push_back(static_cast<char>(code >> 8U));
    }
  }
  return {{"base_m", base}, {"step_m", step}, {"codes", base64_of(bytes)}};
}

std::string zone_codes(const Eigen::ArrayXXi& zone) {
  std::string bytes;
  for (Eigen::Index row = 0; row < zone.rows(); ++row) {
    for (Eigen::Index col = 0; col < zone.cols(); ++col) {
      const int index = zone(row, col);
      bytes.push_back(static_cast<char>(index < 0 || index >= no_zone ? no_zone : index));
    }
  }
  return base64_of(bytes);
}

Json area_json(const ReportArea& area) {
  const HeightMap& first = area.states.front().map;
  const Eigen::Index by = coarsening(first.z.rows(), first.z.cols());
  Json json = {{"origin_m", {first.origin.x(), first.origin.y()}},
               {"cell_m", first.cell_size * static_cast<double>(by)},
               {"surveyed_cell_m", first.cell_size},
               {"rows", first.z.rows() / by},
               {"cols", first.z.cols() / by},
               {"states", Json::array()}};
  for (const ShownGround& state : area.states) {
    Json heights = heights_json(coarser(state.map, by));
    heights["name"] = state.name;
    json["states"].push_back(std::move(heights));
  }
  if (area.zone.size() > 0) json["zone"] = zone_codes(middle_cells(area.zone, by));
  return json;
}

Json zone_json(const ChangeZone& zone) {
  const Rectangle& extent = zone.extent;
  return {{"kind", name(zone.kind)},
          {"volume_m3", std::abs(zone.volume.value)},
          {"volume", readable(std::abs(zone.volume.value), zone.volume.sd) + " m³"},
          {"extent_m", {extent.x_min, extent.y_min, extent.x_max, extent.y_max}}};
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

}  // namespace excavplan
