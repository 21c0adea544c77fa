// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>
#include <excavplan/ground/ground_state.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/planning/path_library.hpp>

#include "bad_files/bad_file.hpp"
#include "fuzz/file_readers.hpp"
#include "optimisation/search_checkpoint.hpp"
#include "planning/library_tasks.hpp"
#include "support/las_file.hpp"
#include "support/png_bytes.hpp"
#include "support/ros_bytes.hpp"
#include "support/urdf_file.hpp"

namespace excavplan::test {
namespace {

void drop_sources(nlohmann::ordered_json& json) {
  if (json.is_object()) json.erase("sources");
  for (auto& part : json) {
    if (part.is_structured()) drop_sources(part);
  }
}

/// A shipped file without what is not read.
std::string shipped(const std::string& name) {
  auto json = nlohmann::ordered_json::parse(content_of_file(find_data_file(name)));
  drop_sources(json);
  return json.dump(1) + "\n";
}

std::string recorded(const std::string& name) {
  return content_of_file(EXCAVPLAN_RECORDINGS "/" + name);
}

std::string valid_library() {
  PathLibrary library = load_path_library(find_data_file("libraries/zx120-loam-energy.json"));
  library.entries.resize(1);
  library.entries.front().to_next_density = library.entries.front().to_next_slope = {};
  library.gaps.clear();
  return to_json(library);
}

std::string valid_entry() {
  const LibraryJob job = {{{load_machine(find_data_file("machines/zx120.json"))},
                           {load_soil(find_data_file("soils/loam.json"))},
                           {0.0},
                           {40.0}},
                          {}};
  PlannedDig dig;
  dig.parameters = paper_fixed_path();
  return do_task(job, to_text({{0, 0, 0.0, 40.0}, {dig}}), [](int, double) { return true; });
}

std::string valid_checkpoint() {
  SearchProblem problem;
  problem.box = {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, 1.0)};
  problem.fingerprint = "parabola";
  SearchOptions options;
  options.checkpoint = std::filesystem::temp_directory_path() / "excavplan-valid-checkpoint.json";
  SearchCheckpoint checkpoint(problem, options);
  checkpoint.add(Eigen::Vector2d(0.25, 0.5), {27.25});
  checkpoint.add(Eigen::Vector2d(0.5, 0.5), Evaluation::infeasible(0.2, "out of reach"));
  checkpoint.save();
  const std::string text = content_of_file(options.checkpoint);
  std::remove(options.checkpoint.c_str());
  return text;
}

std::string valid_ground() {
  GroundState state;
  state.terrain = undisturbed(flat_ground({1.5, -0.25, 2.0, 0.0}, 0.25, 0.125));
  state.terrain.bank.z(0, 1) = std::nan("");
  state.seen = 1764187638.5 + state.terrain.bank.z;
  state.frame = "quarry";
  const std::string file = std::filesystem::temp_directory_path() / "excavplan-valid-ground.tif";
  save_ground(file, state);
  std::string bytes = content_of_file(file);
  std::remove(file.c_str());
  return bytes;
}

constexpr const char* plain_ground =
    R"({"bank": "bank.asc", "loose": "loose.asc", "bank_density_percent": "dense.asc",
 "frame": "quarry", "cell_m": 0.25
})";

std::string valid_trajectory() {
  Trajectory trajectory{"zx120", {}};
  for (const double time : {0.0, 0.5, 1.25}) {
    TrajectoryPoint point;
    point.time = time;
    point.joints = {-0.25, 1.5 + time, 0.5};
    trajectory.points.push_back(point);
  }
  return to_json(trajectory);
}

constexpr const char* path_from =
    R"({"tool": "plan-path", "path": {"penetration_angle_rad": 0.75, "penetration_length_m": 0.35,
 "drag_length_m": 1.5, "start_x_m": 6.05}, "payload_mass_kg": 501, "warnings": []})";

constexpr const char* density_from =
    R"({"tool": "estimate-density", "density_percent": 41.5, "density_sd_percent": 4.25,
 "density_raw_percent": 41.5, "density_sd_given_law_percent": 2.5, "law_soil": "loam", "trustworthy": true,
 "zones": [{"kind": "dig", "extent_m": [4.5, -0.5, 6.5, 0.5]}], "warnings": []})";

constexpr const char* matrix = "# scanner\n0 -1 0 4.25\n1 0 0 0.0\n0 0 1 2.125\n0 0 0 1\n";

constexpr const char* pose_json =
    R"({"header": {"frame_id": "site"}, "pose": {"position": {"x": 1.5, "y": -2, "z": 0.25},
 "orientation": {"x": 0, "y": 0, "z": 0.6, "w": 0.8}}})";

constexpr const char* intrinsics_json =
    R"({"format": "excavplan-depth-intrinsics", "version": 1, "fx": 615.5, "fy": 615.25, "cx": 320,
 "cy": 240, "depth_unit_m": 0.001}
)";

constexpr const char* camera_yaml =
    "header:\n  stamp:\n    sec: 12\n    nanosec: 5\n  frame_id: 'camera'\n"
    "height: 480\nwidth: 640\ndistortion_model: plumb_bob\nd: [0.0, 0.0, 0.0, 0.0, 0.0]\n"
    "k:\n- 615.5\n- 0.0\n- 320.0\n- 0.0\n- 615.25\n- 240.0\n- 0.0\n- 0.0\n- 1.0\n"
    "binning_x: 0\nroi: {x_offset: 0, y_offset: 0, height: 0}\n---\n";

std::string new_las() {
  LasFile file;
  file.minor = 4;
  file.format = 6;
  return file.bytes();
}

const Points& las_points() {
  static const Points points = {{1.0, 2.0, -0.5}, {1.25, 2.5, -0.25}, {4.5, -1.0, 0.0}, {0, 0, 0}};
  return points;
}

std::string message(const std::string& bytes) { return std::string(1, '\0') + bytes; }

using Maker = std::function<std::string()>;

/// The text of one, of formats that need no more.
const std::map<std::string, Maker>& makers() {
  static const std::map<std::string, Maker> list = {
      {"xyz", [] { return "# x y z [m]\n4.95 -0.02 -0.31\n1e1 -0.5 +0.25\n4.97 nan -0.3\n"; }},
      {"known_points",
       [] {
         return "scan_x_m,scan_y_m,scan_z_m,x_m,y_m,z_m\n1,2,3.5,4,5,6\n2,2,3,5.25,5,6\n"
                "1,9,3,4,12,6\n";
       }},
      {"log", [] { return "time_s,power_w\n0.0,1000\n0.5,3000.5\n1.0,2000\n"; }},
      {"samples",
       [] { return "bulking_factor,density_percent\n1.05,15\n1.12,35\n1.23,60\n1.40,85\n"; }},
      {"table", [] { return "# numbers\nfirst,second\n1,2.5\n-3e2,4\n0.125,6\n"; }},
      {"yaml", [] { return camera_yaml; }},
      {"depth_png",
       [] {
         return png_of(4, {500, 1000, 0, 2000, 3000, 65535, 700, 800});
       }},
      {"ground", valid_ground},
      {"ascii_grid",
       [] {
         return "ncols 3\nnrows 2\nxllcorner 1.5\nyllcorner -2\ncellsize 0.5\nNODATA_value -1\n"
                "0.5 -1 0.25\n-0.75 12.5 1e-3\n";
       }},
      {"plain_ground", [] { return plain_ground; }},
      {"machine", [] { return shipped("machines/zx120.json"); }},
      {"urdf", [] { return urdf_of(zx120_joints()); }},
      {"soil", [] { return shipped("soils/loam.json"); }},
      {"law", [] { return shipped("laws/paper.json"); }},
      {"library", valid_library},
      {"entry", valid_entry},
      {"checkpoint", valid_checkpoint},
      {"trajectory", valid_trajectory},
      {"path_from", [] { return path_from; }},
      {"density_from", [] { return density_from; }},
      {"settings",
       [] {
         return "# of a site\nsoil = \"sand\"\nsearch = true\ncell = 5\n[plan-path]\nsoil = 0.1\n"
                "camera = [[1, 2, 3, 4, 5, 6], \"0,0,2,5,0,0\"]\n[simulate-dig]\nnoise = 0x10\n";
       }},
      {"option", [] { return "45deg,0.35m,1.5m"; }},
      {"mcap", [] { return recorded("scene_none.mcap"); }},
      {"bag", [] { return recorded("scene_none.bag"); }},
      {"db3", [] { return recorded("scene_zstd.db3"); }},
      {"point_cloud2", [] { return message(cloud_bytes(1000000007, "lidar", las_points(), 2)); }},
      {"livox", [] { return message(livox_bytes(1000000007, "lidar", las_points())); }},
      {"image_message",
       [] {
         return message(depth_bytes(1000000007, "camera", 2, {500, 0, 1500, 2000}));
       }},
      {"compressed_image",
       [] {
         const std::string png = png_of(2, {500, 0, 1500, 2000});
         return message(RosBytes(cdr_little)
                            .header(1000000007, "camera")
                            .text("16UC1; compressedDepth png")
                            .data(std::string(12, '\0') + png));
       }},
      {"camera_info",
       [] {
         return message(camera_bytes({640, 480, 600.5, 601.5, {0.0, 0.0}}));
       }},
      {"joint_state",
       [] {
         return message(joint_bytes(5, {{"boom_joint", 0.25}, {"arm", -1.5}}));
       }},
      {"transforms", [] {
         return message(transform_bytes({{1000, "map", "base", {1, 2, 3}, {0, 0, 0, 1}},
                                         {1000, "base", "lidar", {0, 0, 2}, {0, 0, 1, 0}}}));
       }}};
  return list;
}

}  // namespace

std::vector<std::string> valid_files(const std::string& format) {
  if (format == "pcd") return valid_pcd_files();
  if (format == "ply") return valid_ply_files();
  if (format == "las") return {LasFile().bytes(), new_las()};
  if (format == "frame") return {matrix, pose_json};
  if (format == "intrinsics") return {intrinsics_json, camera_yaml};
  if (format == "mcap") return {recorded("scene_none.mcap"), recorded("scene_zstd.mcap")};
  if (format == "bag") return {recorded("scene_none.bag"), recorded("scene_bz2.bag")};
  if (format == "db3") return {recorded("scene_zstd.db3"), recorded("scene.db3")};
  return {makers().at(format)()};
}

}  // namespace excavplan::test
