// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <excavplan/random.hpp>
#include <excavplan/simulation/calibration.hpp>
#include <excavplan/simulation/depth_camera.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include <excavplan/survey/cloud.hpp>

#include "base/angles.hpp"
#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "machine/dig_path_text.hpp"
#include "shared/figures.hpp"
#include "shared/joint_loads.hpp"
#include "shared/results.hpp"
#include "shared/site.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "simulate-dig",
    "digs once in soil of a known density: what the bucket lifts, what that costs, where the soil "
    "goes, and, if asked, what a depth camera sees before and after.",
    {{"simulate-dig --density 40", "the paper's fixed path in medium loam"},
     {"simulate-dig --density 80 --path 43deg,0.2m,2.6m --plot dig.svg", "another path, drawn"},
     {"simulate-dig --density 40 --path-from plan.json", "the path that plan-path --json planned"},
     {"simulate-dig --density 40 --before b.pcd --after a.pcd --seed 7", "make a pair of scans"}}};

struct Inputs {
  double density = 0.0;
  std::optional<DigParameters> path;
  std::optional<double> start;
  std::optional<std::string> path_from;
  TerrainInput terrain;
  std::optional<Eigen::Vector2d> dump_at;
  std::string soil = "loam";
  std::string machine = "zx120";
  double cell_size = 0.05;
  std::uint64_t seed = 1;
  double noise = DepthCamera{}.noise;
  std::optional<std::string> before;
  std::optional<std::string> after;
  std::optional<std::string> history;
  std::optional<std::string> plot;
  std::optional<std::string> report;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.option("density", inputs.density, Quantity::percent, "relative density of the ground");
  arguments.require("density");
  arguments.option("path", inputs.path,
                   dig_path_form().names + " (default: the paper's " +
                       dig_path_argument(paper_fixed_path()) + ")");
  arguments.option("start", inputs.start, Quantity::length,
                   "x where the tip meets the ground (default: planned)");
  arguments.file("path-from", inputs.path_from,
                 "take path and start from this result of plan-path --json");
  arguments.soil(inputs.soil);
  arguments.machine(inputs.machine);
  arguments.file("terrain", inputs.terrain.cloud,
                 "cloud of the ground in the site frame (default: level)");
  arguments.file("terrain-frame", inputs.terrain.frame,
                 "4 x 4 matrix that takes the terrain cloud into the site frame");
  arguments.option("dump-at", inputs.dump_at, "where the payload is dumped (default: 5.5,4)");
  arguments.option("cell", inputs.cell_size, Quantity::length, "cell of the simulated ground");
  arguments.file("before", inputs.before, "write the scene before, as a depth camera sees it");
  arguments.file("after", inputs.after, "write the scene after");
  arguments.option("seed", inputs.seed, "seed of the scans' noise");
  arguments.option("noise", inputs.noise, Quantity::length,
                   "depth noise of the scans at 1 m, growing with range squared");
  arguments.file("history", inputs.history,
                 "write forces, torques and cylinders of every step, CSV");
  arguments.plot(inputs.plot, "the section of the dig");
  arguments.file("report", inputs.report, "write an HTML report");
}

/// One camera over the dig, one over the heap, as a whole-scene cloud.
Cloud scan(const Terrain& terrain, const Inputs& inputs, const Eigen::Vector2d& dig_centre,
           const Eigen::Vector2d& dump_at, std::uint64_t epoch) {
  const HeightMap surface = terrain.surface();
  Cloud cloud;
  std::uint64_t camera_index = 0;
  for (const Eigen::Vector2d& place : {dig_centre, dump_at}) {
    DepthCamera camera = camera_above(place, height_at(surface, place.x(), place.y()));
    camera.noise = inputs.noise;
    const auto points =
        scan_surface(surface, camera, Random(inputs.seed, epoch, camera_index++).bits());
    cloud.points.insert(cloud.points.end(), points.begin(), points.end());
  }
  cloud.width = cloud.points.size();
  return cloud;
}

/// The inputs with the path of the result they name.
Inputs with_path(Inputs inputs) {
  if (!inputs.path_from) return inputs;
  if (inputs.path || inputs.start) {
    throw Error(ErrorKind::bad_input, "--path-from goes without --path and --start");
  }
  std::tie(inputs.path, inputs.start) = read_planned_path(*inputs.path_from);
  return inputs;
}

/// A planned path keeps to the safe distances on the ground it was planned on, and often just so;
/// here the ground may lie some millimetres off it.
DigPathOptions rules_of(const Inputs& inputs) {
  constexpr double of_angle = 0.01;   // [rad]; ours
  constexpr double of_length = 0.02;  // [m]; ours
  DigPathOptions rules;
  if (!inputs.path_from) return rules;
  rules.min_heel_clearance -= of_angle;
  rules.track_margin -= of_length;
  rules.max_depth += of_length;
  rules.lift_clearance -= of_length;
  return rules;
}

DigPath lay_out(const Inputs& inputs, const Machine& machine, const Terrain& ground) {
  const DigParameters parameters = inputs.path.value_or(paper_fixed_path());
  const GroundProfile profile = boom_plane_profile(ground);
  const DigPathOptions rules = rules_of(inputs);
  auto path = inputs.start ? make_dig_path(machine, parameters, *inputs.start, profile, rules)
                           : make_dig_path_anywhere(machine, parameters, profile, rules);
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) {
    throw Error(ErrorKind::bad_input, "this dig cannot be driven: " + infeasible->message);
  }
  return std::get<DigPath>(std::move(path));
}

/// The ground that the tip passes over, as wide as the bucket.
Rectangle strip_of(const Machine& machine, const DigPath& path) {
  const double half_width = 0.5 * machine.bucket.width_outside;
  Rectangle strip{path.start_x, -half_width, path.start_x, half_width};
  for (const DigPose& pose : path.poses) {
    if (pose.phase == DigPhase::lift) continue;
    strip.x_min = std::min(strip.x_min, pose.bucket.x);
    strip.x_max = std::max(strip.x_max, pose.bucket.x);
  }
  return strip;
}

/// Foot of the cone in which a heaped bucket comes to rest [m].
double heap_radius(const Machine& machine, const SoilKind& soil) {
  return std::cbrt(3.0 * heaped_capacity(machine) / (pi * std::tan(soil.angle_of_repose)));
}

/// The heap must not lie on the hole: the volumes of both would hide each other.
void require_clear_of_dig(const Eigen::Vector2d& dump_at, const Machine& machine,
                          const SoilKind& soil, const DigPath& path) {
  const Rectangle strip = strip_of(machine, path);
  const double beside_x = std::max({strip.x_min - dump_at.x(), dump_at.x() - strip.x_max, 0.0});
  const double beside_y = std::max({strip.y_min - dump_at.y(), dump_at.y() - strip.y_max, 0.0});
  const double away = std::hypot(beside_x, beside_y);
  const double radius = heap_radius(machine, soil);
  if (away >= radius) return;
  throw Error(ErrorKind::bad_input,
              "--dump-at: " + number_text(dump_at.x()) + "," + number_text(dump_at.y()) + " is " +
                  readable(away) + " m from the strip of this dig (x = " + readable(strip.x_min) +
                  " .. " + readable(strip.x_max) + " m, y = " + readable(strip.y_min) + " .. " +
                  readable(strip.y_max) + " m); a heap of " + readable(heaped_capacity(machine)) +
                  " m3 needs at least " + readable(radius) + " m");
}

std::optional<Warning> reach_warning(const Eigen::Vector2d& dump_at, const Machine& machine) {
  const double from_axis = dump_at.norm();
  const double reach = machine.boom_pin.x() + machine.full_length();
  if (from_axis >= machine.track_front && from_axis <= reach) return std::nullopt;
  return Warning{"dump_out_of_reach",
                 "the dump point " + number_text(dump_at.x()) + "," + number_text(dump_at.y()) +
                     " is " + readable(from_axis) + " m from the swing axis; " + machine.name +
                     " dumps from " + readable(machine.track_front) + " m (its tracks) to " +
                     readable(reach) + " m (all links in one line)"};
}

nlohmann::ordered_json energy_json(const EnergyLedger& energy) {
  const auto kj = [](double joule) { return joule / 1000.0; };
  return {
      {"by_phase_kj",
       {{"penetrate", kj(energy.by_phase[0])},
        {"drag", kj(energy.by_phase[1])},
        {"scoop", kj(energy.by_phase[2])}}},
      {"by_joint_kj",
       {{"boom", kj(energy.by_joint[0])},
        {"arm", kj(energy.by_joint[1])},
        {"bucket", kj(energy.by_joint[2])}}},
      {"by_cause_kj",
       {{"soil", kj(energy.soil)}, {"payload", kj(energy.payload)}, {"links", kj(energy.links)}}},
      {"lift_kj", kj(energy.lift)}};
}

nlohmann::ordered_json ledger_json(const SoilLedger& soil) {
  return {{"bank_cut_m3", soil.bank_cut},
          {"loose_cut_m3", soil.loose_cut},
          {"payload_m3", soil.payload},
          {"spilled_m3", soil.spilled},
          {"fallen_back_m3", soil.fallen_back}};
}

nlohmann::ordered_json stall_json(const Stall& stall) {
  return {{"phase", name(stall.phase)},
          {"joint", name(stall.joint)},
          {"travelled_m", stall.travelled},
          {"torque_nm", stall.torque}};
}

/// What was done and what came of it.
struct Dug {
  DigPath path;
  Eigen::Vector2d dump_at;
  Terrain before;
  Terrain after;
  DigResult result;
  JointLoads loads;
  HeightMapVolumes volumes;
  double duration = 0.0;
  double wall_time = 0.0;
};

Dug dig(const Inputs& inputs, const Machine& machine, const SoilKind& soil, const Site& site) {
  Dug dug;
  dug.dump_at = inputs.dump_at.value_or(default_dump_point());
  dug.before = site.ground;
  dug.path = lay_out(inputs, machine, site.ground);
  require_clear_of_dig(dug.dump_at, machine, soil, dug.path);
  const HeightMapSimulator simulator(machine, soil, inputs.density);
  DigOptions options;
  options.history = true;
  options.dump_at = dug.dump_at;
  const Stopwatch watch;
  dug.result = simulator.dig(dug.before, dug.path, options);
  dug.wall_time = watch.seconds();
  dug.after = dug.result.after(dug.before);
  dug.loads = joint_loads(machine, dug.result.history);
  dug.volumes = height_map_volumes(dug.before, dug.after, dug.dump_at);
  dug.duration = time_dig_path(machine, dug.path).dig_duration();
  return dug;
}

nlohmann::ordered_json dug_json(const Inputs& inputs, const Machine& machine, const SoilKind& soil,
                                const Dug& dug) {
  const DigResult& result = dug.result;
  VolumeChange exact;
  exact.excavated.value = dug.volumes.excavated;
  exact.spilled.value = dug.volumes.spilled;
  exact.dumped.value = dug.volumes.dumped;
  exact.before.value = dug.volumes.excavated;
  exact.after.value = dug.volumes.spilled + dug.volumes.dumped;
  return {{"density_percent", inputs.density},
          {"soil", soil.name},
          {"path", path_json(dug.path.parameters, dug.path.start_x)},
          {"payload_mass_kg", result.payload_mass},
          {"payload_volume_m3", result.payload_volume},
          {"energy_kj", result.energy.total / 1000.0},
          {"efficiency_kg_per_kj", 1000.0 * result.efficiency()},
          {"duration_s", dug.duration},
          {"peak_force_kn", result.peak_force / 1000.0},
          {"stalled", result.stall.has_value()},
          {"stall", result.stall ? stall_json(*result.stall) : nlohmann::ordered_json()},
          {"volume", volumes_json(exact)},
          {"bulking_factor", dug.volumes.bulking_factor},
          {"bulking_factor_true", bulking_of_density(soil, inputs.density)},
          {"fallback_fraction", result.soil.fallback_fraction},
          {"solids_before_kg", result.soil.solids_before},
          {"solids_after_kg", result.soil.solids_after},
          {"final_angle_of_repose_rad", heap_slope(dug.before, dug.after, dug.dump_at)},
          {"energy", energy_json(result.energy)},
          {"joints", to_json(machine, dug.loads)},
          {"soil_ledger", ledger_json(result.soil)},
          {"dump_at_m", {dug.dump_at.x(), dug.dump_at.y()}},
          {"wall_time_s", dug.wall_time}};
}

std::vector<std::string> dug_lines(const Machine& machine, const SoilKind& soil, double density,
                                   const Dug& dug) {
  const DigResult& result = dug.result;
  std::vector<std::string> lines =
      dig_lines({dug.path.parameters, dug.path.start_x, result.payload_mass, result.payload_volume,
                 result.energy.total, dug.duration});
  const std::string shares = "  of which   soil " + readable(result.energy.soil / 1000.0) +
                             ", payload " + readable(result.energy.payload / 1000.0) + ", links " +
                             readable(result.energy.links / 1000.0) + " kJ";
  lines.insert(lines.begin() + 3, shares);  // below the energy
  lines.push_back("peak force   " + readable(result.peak_force / 1000.0) + " kN");
  for (std::string& line : load_lines(machine, dug.loads)) lines.push_back(std::move(line));
  lines.push_back("volumes      hole " + readable(dug.volumes.excavated) + ", spill " +
                  readable(dug.volumes.spilled) + ", heap " + readable(dug.volumes.dumped) + " m3");
  lines.push_back("bulking      " + readable(dug.volumes.bulking_factor, 4) +
                  " from the height maps, " + readable(bulking_of_density(soil, density), 4) +
                  " by dry mass, fallback " + readable(100.0 * result.soil.fallback_fraction) +
                  " %");
  return lines;
}

void write_scans(const Inputs& inputs, const Dug& dug) {
  const Eigen::Vector2d dig_centre(dug.path.start_x - 0.5 * (dug.path.parameters.drag_length + 0.8),
                                   0.0);
  if (inputs.before) {
    write_cloud(*inputs.before, scan(dug.before, inputs, dig_centre, dug.dump_at, 0),
                cloud_format_of_name(*inputs.before));
  }
  if (inputs.after) {
    write_cloud(*inputs.after, scan(dug.after, inputs, dig_centre, dug.dump_at, 1),
                cloud_format_of_name(*inputs.after));
  }
}

Outcome work(Inputs inputs) {
  inputs = with_path(std::move(inputs));
  for (const auto& file : {inputs.before, inputs.after}) {
    if (file) cloud_format_of_name(*file);  // refuses a wrong name before anything is written
  }
  if (inputs.before && inputs.before == inputs.after) {
    throw Error(ErrorKind::bad_input, "--before and --after are one file, " + *inputs.before);
  }
  for (const auto& file :
       {inputs.before, inputs.after, inputs.history, inputs.plot, inputs.report}) {
    if (file) require_folder_of(*file);
  }
  const Machine machine = machine_named(inputs.machine);
  const SoilKind soil = soil_named(inputs.soil);
  const Rectangle extent = scene_extent(machine, inputs.dump_at.value_or(default_dump_point()));
  Site site = make_site(inputs.terrain, extent, inputs.cell_size);
  const Dug dug = dig(inputs, machine, soil, site);

  Outcome outcome;
  outcome.json = dug_json(inputs, machine, soil, dug);
  outcome.lines = dug_lines(machine, soil, inputs.density, dug);
  outcome.warnings = std::move(site.warnings);
  if (auto warning = reach_warning(dug.dump_at, machine)) {
    outcome.warnings.push_back(std::move(*warning));
  }
  if (dug.result.stall) {
    outcome.warnings.push_back({"stalled", describe(*dug.result.stall)});
  }
  write_scans(inputs, dug);
  const std::string title = soil.name + " at " + readable(inputs.density) + " % relative density";
  const auto figure = [&] {
    return dig_figure(machine, dug.path,
                      {boom_plane_profile(dug.before), boom_plane_profile(dug.after)},
                      "Dig in " + title, outcome.lines);
  };
  if (inputs.history) write_file(*inputs.history, to_csv(machine, dug.result.history));
  if (inputs.plot) write_file(*inputs.plot, figure());
  if (inputs.report) {
    write_file(*inputs.report,
               html_report("Dig in " + title, {figure()}, outcome.lines, outcome.json));
  }
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
