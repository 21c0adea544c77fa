// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/ground.hpp"

#include <utility>

#include <excavplan/base/error.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/text.hpp"

namespace excavplan::tools {
namespace {

/// Where the bucket of a machine comes.
Rectangle strip_of(const Machine& machine) {
  const Rectangle all = planning_extent(machine);
  const double half = 0.5 * machine.bucket.width_outside;
  return {all.x_min, -half, all.x_max, half};
}

}  // namespace

void declare_ground(Arguments& arguments, GroundInput& input, const GroundUse& use) {
  arguments.file("ground", input.file,
                 "state of the ground in the site frame: a file of --ground-out, or a JSON that "
                 "names ESRI ASCII grids; its density of the bank comes before --density");
  arguments.exclude("ground", use.replaced);
  arguments.output("ground-out", input.out,
                   "write the state of the ground after " + use.after + ", GeoTIFF");
  arguments.require_ending({".tif", ".tiff"});
}

void declare_base(Arguments& arguments, GroundInput& input) {
  const Arguments::Use used = {[&input] { return input.file.has_value(); }, "it is of --ground"};
  arguments.only_if(used, [&] {
    arguments.option("base", input.base,
                     "where the machine stands in the frame of the ground file, which is that of "
                     "the scans too; its x axis is that of the file");
  });
}

std::optional<GivenGround> given_ground(const GroundInput& input, const Machine& machine,
                                        const SoilKind& soil, double density_percent) {
  if (!input.file) return std::nullopt;
  GivenGround given;
  given.state = load_ground(*input.file, soil);
  naming_options({{"the cell size is", *input.file + ": the cell size is"}},
                 [&] { require_simulated_cell(given.state.terrain.bank.cell_size); });
  given.state.terrain.bank.origin -= input.base;
  given.terrain = terrain_to_dig(given.state, soil, density_percent);
  given.density_percent = bank_density_percent(given.state.terrain, soil, strip_of(machine));
  return given;
}

void describe(const GroundInput& input, const GivenGround& given, Outcome& outcome) {
  const HeightMap& grid = given.terrain.bank;
  const auto& density = given.density_percent;
  outcome.json["ground_state"] = {
      {"frame", given.state.frame},
      {"cells", {grid.z.rows(), grid.z.cols()}},
      {"cell_size_m", grid.cell_size},
      {"bank_density_percent", density ? nlohmann::ordered_json(*density) : nullptr}};
  outcome.lines.push_back(
      "ground file  " + *input.file + ": density of the bank " +
      (density ? readable(*density) + " % from it, in place of the option" : "by the option"));
}

void write_ground(const GroundInput& input, const GivenGround* given, const Terrain& before,
                  const Terrain& after, const SoilKind& soil) {
  if (!input.out) return;
  GroundState state;
  if (given) {
    state = given->state;
  } else {
    state.terrain = before;
  }
  state.soil = soil.name;
  GroundState left = after_dig(std::move(state), after);
  left.terrain.bank.origin += input.base;
  save_ground(*input.out, left);
}

}  // namespace excavplan::tools
