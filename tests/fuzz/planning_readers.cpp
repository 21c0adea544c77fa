// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/ground/ascii_grid.hpp>
#include <excavplan/ground/plain_ground.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/machine/machine_file.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/planning/path_library.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/table.hpp"
#include "base/yaml.hpp"
#include "fuzz/file_readers.hpp"
#include "machine/dig_path_text.hpp"
#include "optimisation/search_checkpoint.hpp"
#include "planning/library_tasks.hpp"

namespace excavplan::test {
namespace {

std::string read_machine(const std::string& path) {
  const Machine machine = load_machine(path);
  return Said()
      .add("name", machine.name)
      .add("numbers", fingerprint(machine))
      .add("capacity", heaped_capacity(machine))
      .text();
}

/// A machine as of a robot; also of a file of ours, by the same call.
std::string read_urdf(const std::string& path) {
  const MachineFile file = load_machine_file(path);
  Said said;
  said.add("name", file.machine.name).add("numbers", fingerprint(file.machine));
  for (const Warning& warning : file.warnings) said.add("warning", code_text(warning.code));
  return said.text();
}

std::string read_soil(const std::string& path) {
  const SoilKind soil = load_soil(path);
  Said said;
  said.add("name", soil.name).add("numbers", fingerprint(soil));
  for (const double density : {0.0, 50.0, 100.0}) {
    const SoilState state = bank_state(soil, density);
    said.add("weight", state.unit_weight).add("cone", cone_index(soil, state, 0.3));
  }
  return said.text();
}

std::string read_law(const std::string& path) {
  const DensityLaw law = load_density_law(path);
  Said said;
  said.add("name", law.name).add("soil", law.soil).add("machine", law.machine);
  for (const DensityForm& form : {law.form, law.freed_form}) {
    said.add("form", formula(form) + ' ' + number_text(density_of_bulking(form, 1.2)) + ' ' +
                         number_text(residual_sd_at(form, 20.0)));
  }
  if (law.path) said.all("path", *law.path);
  return said.text();
}

std::string read_library(const std::string& path) { return to_json(load_path_library(path)); }

/// The entry of a build of one machine, soil, slope and density.
std::string read_entry(const std::string& path) {
  static const LibraryJob job = {{{load_machine(find_data_file("machines/zx120.json"))},
                                  {load_soil(find_data_file("soils/loam.json"))},
                                  {0.0},
                                  {40.0}},
                                 {}};
  const LibraryAnswer answer = read_answer(job, {0, 0, 0.0, 40.0}, path, read_file(path));
  return Said()
      .add("rank", answer.rank)
      .add("mass", answer.dig.payload_mass)
      .add("evaluations", answer.evaluations)
      .all("measured", answer.measured)
      .text();
}

std::string read_checkpoint(const std::string& path) {
  SearchProblem problem;
  problem.box = {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, 1.0)};
  problem.fingerprint = "parabola";
  SearchOptions options;
  options.checkpoint = path;
  options.resume = true;
  const SearchCheckpoint checkpoint(problem, options);
  Said said;
  for (const Eigen::Vector2d& point : {Eigen::Vector2d(0.25, 0.5), Eigen::Vector2d(0.5, 0.5)}) {
    const Evaluation* outcome = checkpoint.find(point);
    said.add("outcome", outcome == nullptr ? "none"
                                           : std::string(name(outcome->status)) + ' ' +
                                                 number_text(outcome->fitness));
  }
  return said.text();
}

std::string read_trajectory(const std::string& path) { return to_json(load_trajectory(path)); }

std::string read_path_from(const std::string& path) {
  const auto [parameters, start] = read_planned_path(path);
  return Said().all("number", to_vector(parameters)).add("start", start).text();
}

std::string read_yaml(const std::string& path) {
  return parse_yaml(path, read_file(path))
      .dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string read_table(const std::string& path) {
  const Table table = Table::read(path);
  Said said;
  for (const std::string& name : table.names()) said.all(name, table.column(name));
  return said.text();
}

/// Cells row by row from the top, as the files of grids hold them.
void say(Said& said, const HeightMap& map) {
  said.all("origin", map.origin).add("cell", map.cell_size);
  said.add("rows", static_cast<double>(map.z.rows()));
  said.all("z", map.z.colwise().reverse().transpose().reshaped());
}

std::string read_ground(const std::string& path) {
  const GroundState state = load_ground(path);
  const Terrain& terrain = state.terrain;
  Said said;
  said.add("frame", state.frame).add("soil", state.soil);
  say(said, terrain.bank);
  for (const Eigen::ArrayXXd* layer :
       {&terrain.loose, &terrain.bank_void_ratio, &terrain.loose_void_ratio, &terrain.obstacles,
        &state.seen, &state.deviation}) {
    said.add("size", static_cast<double>(layer->size())).all("value", layer->reshaped());
  }
  return said.text();
}

std::string read_grid(const std::string& path) {
  Said said;
  say(said, read_ascii_grid(path));
  return said.text();
}

/// Writes grids of the names that the valid file has.
void write_grids(const std::filesystem::path& folder) {
  constexpr const char* head = "ncols 2\nnrows 1\nxllcorner 1\nyllcorner 2\ncellsize 0.5\n";
  for (const auto& [name, cells] :
       {std::pair("bank.asc", "0.5 -9999"), {"loose.asc", "0.25 0"}, {"dense.asc", "40 60"}}) {
    std::ofstream(folder / name) << head << cells << '\n';
  }
}

/// Of a file its grids are put beside it; what is none, as /dev/null, lies in no folder of ours.
std::string read_plain_ground(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) {
    write_grids(std::filesystem::path(path).parent_path());
  }
  const PlainGround plain = load_plain_ground(path);
  Said said;
  say(said, plain.ground.terrain.bank);
  return said.add("frame", plain.ground.frame)
      .all("loose", plain.ground.terrain.loose.reshaped())
      .all("density", plain.bank_density_percent.reshaped())
      .text();
}

}  // namespace

std::vector<FileReader> planning_readers() {
  return {{"machine", read_machine},
          {"ground", read_ground},
          {"ascii_grid", read_grid},
          {"plain_ground", read_plain_ground},
          {"urdf", read_urdf},
          {"soil", read_soil},
          {"law", read_law},
          {"library", read_library, true},
          {"entry", read_entry, true},
          {"checkpoint", read_checkpoint, true},
          {"trajectory", read_trajectory},
          {"path_from", read_path_from},
          {"yaml", read_yaml},
          {"table", read_table}};
}

}  // namespace excavplan::test
