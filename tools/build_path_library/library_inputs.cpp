// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "build_path_library/library_inputs.hpp"

#include "base/text.hpp"
#include "frame/console.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/search_method.hpp"

namespace excavplan::tools {

void declare_library(Arguments& arguments, LibraryInputs& inputs) {
  arguments.text("densities", "FIRST:STEP:LAST", inputs.densities,
                 "relative densities [%], or a list a,b,c");
  arguments.text("slopes", "LIST", inputs.slopes,
                 "slopes of the ground, rising away from the machine: first:step:last or a,b,c "
                 "[rad]");
  arguments.text("soil", "NAME,..", inputs.soils, "loam, sand, clay, gravel or soil files");
  arguments.text("machine", "NAME,..", inputs.machines, "zx120 or machine files");
  declare_simulator(arguments, inputs.simulator);
  declare_goal(arguments, inputs.goal);
  arguments.choice("method", inputs.method, {"memetic", "paper"},
                   "memetic: three densities without a warm start, the others from neighbours; "
                   "paper: a genetic algorithm for each");
  const auto if_method = [&](const std::string& word, const std::string& other) {
    return Arguments::Use{[&inputs, word] { return inputs.method == word; },
                          "--method " + other + " has none"};
  };
  arguments.only_if(if_method("memetic", "paper"), [&] {
    arguments.option("points", inputs.anchored.points,
                     "memetic: initial digs of a search without a warm start");
    arguments.option("polish", inputs.anchored.polish_evaluations,
                     "memetic: simulated digs of one Nelder-Mead search");
    arguments.option("inherited", inputs.anchored.inherited_evaluations,
                     "memetic: simulated digs of a density that starts from its neighbours");
  });
  arguments.only_if(if_method("paper", "memetic"), [&] {
    declare_genetic(arguments, inputs.genetic);
    arguments.option("generations", inputs.genetic.generations, "paper: generations of a search");
  });
  arguments.option("cell", inputs.search.cell_size, Quantity::length,
                   "cell size of the simulated ground");
  arguments.option("seed", inputs.search.seed, "seed; the same seed gives the same file");
}

const OptionNames library_option_names = [] {
  OptionNames names = {
      {"library: densities", "--densities"},
      {"library: slopes", "--slopes"},
      cell_option()[0],
      {"machines x soils x slopes x densities of a library",
       "--machine x --soil x --slopes x --densities"},
      {"points of a library search", "--points"},
      {"search: first_generation", "--points"},
      {"polish evaluations of a library search", "--polish"},
      {"inherited evaluations of a library search", "--inherited"},
  };
  names.insert(names.end(), search_option_names().begin(), search_option_names().end());
  return names;
}();

LibraryGrid grid_of(const LibraryInputs& inputs) {
  LibraryGrid grid;
  for (const std::string& name : split(inputs.machines, ',')) {
    grid.machines.push_back(machine_named(name));
  }
  for (const std::string& name : split(inputs.soils, ',')) grid.soils.push_back(soil_named(name));
  grid.slopes = parse_series("--slopes", inputs.slopes, Quantity::angle);
  grid.densities_percent = parse_densities("--densities", inputs.densities);
  return grid;
}

LibrarySearch search_of(const LibraryInputs& inputs, const LibraryGrid& grid, Console& console) {
  LibrarySearch search = inputs.search;
  search.objective = objective_of(inputs.goal, grid.machines);
  search.simulator = simulator_of(inputs.simulator, console);
  search.method = inputs.anchored;
  if (inputs.method == "paper") search.method = inputs.genetic;
  return search;
}

}  // namespace excavplan::tools
