// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/estimate_inputs.hpp"

#include "estimate_density/estimate_plots.hpp"
#include "estimate_density/survey_map_names.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/recordings.hpp"

namespace excavplan::tools {

void declare_estimate(Arguments& arguments, EstimateInputs& inputs) {
  arguments.positional("BEFORE", inputs.before,
                       "cloud before the dig: PCD, PLY, LAS, GeoTIFF, ASCII grid, OBJ or XYZ, or " +
                           std::string(recording_form) +
                           "; one cloud alone is that after it, on a --site");
  arguments.positional("AFTER", inputs.after, "cloud after the dig");
  declare_further_clouds(arguments, inputs.frames);
  arguments.file("dump-before", inputs.dump_before,
                 "cloud of the dump area before; BEFORE and AFTER then show the dig area only");
  arguments.file("dump-after", inputs.dump_after, "cloud of the dump area after");
  arguments.option("area", inputs.frames.area,
                   "ignore points outside this area (default: where both scans have points)");
  arguments.option("dig-area", inputs.options.change.dig_area,
                   "area of the hole (default: detected)");
  arguments.option("dump-area", inputs.options.change.dump_area,
                   "area of the heap (default: detected)");
  declare_frames(arguments, inputs.frames);
  declare_units(arguments, inputs.frames);
  declare_method(arguments, inputs.method);
  arguments.flag("no-register", inputs.still,
                 "do not look for a motion of the sensor between the scans: there was none");
  arguments.option("cell", inputs.options.cell_size, Quantity::length,
                   "cell size of the height map, voxel size of --method paper (default: from the "
                   "point density, at least 0.05)");
  declare_soil(arguments, inputs.soil);
  arguments.only_if({[&inputs] { return inputs.method.uses("surface"); },
                     "--method paper has no error to weigh a second density by"},
                    [&] { inputs.second.declare(arguments); });
  declare_dug_path(arguments, inputs.method);
  declare_site(arguments, inputs.site);
  declare_machine_in_view(arguments, inputs.frames.view);
  declare_plots(arguments, inputs.plots, names_of(estimate_figures()));
  declare_maps(arguments, inputs.maps, survey_map_names(inputs.dump_before));
  arguments.report(inputs.report);
}

KnownDig known_dig(const EstimateInputs& inputs) {
  KnownDig dig{machine_named(inputs.frames.view.machine), inputs.options, {}};
  dig.options.registered = !inputs.still;
  apply_method(inputs.method, dig.machine, dig.options);
  dig.law = law_of(inputs.soil, inputs.frames.view.machine, dig.options);
  return dig;
}

Outcome shown_estimate(const EstimateInputs& inputs, const KnownDig& dig,
                       const DensityEstimate& counts, const TakenUnits& units) {
  Outcome outcome = estimate_outcome(counts, dig.options.soil);
  add_machine_warnings(counts, dig.law, dig.machine, units, outcome);
  if (inputs.soil.proctor) {
    add_compaction(counts, *dig.options.soil.kind, *inputs.soil.proctor, outcome);
  }
  inputs.second.check(counts, outcome);
  draw_estimate(inputs.plots, inputs.report, counts, outcome);
  write_maps(
      inputs.maps, [&] { return survey_maps(counts.change, counts.before); }, outcome);
  return outcome;
}

}  // namespace excavplan::tools
