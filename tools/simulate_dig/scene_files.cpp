// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_dig/scene_files.hpp"

#include <excavplan/results/force_history.hpp>

#include "base/files.hpp"
#include "figures/dug_dig.hpp"
#include "frame/tool.hpp"
#include "inputs/dig_plots.hpp"
#include "report/dig_report.hpp"

namespace excavplan::tools {

void write_files(const SceneFiles& files, const Machine& machine, const DigScene& scene,
                 std::uint64_t seed, Outcome& outcome) {
  write_scans(files.scans, scene, seed);
  files.fuel_log.write(machine, scene, seed);
  if (files.history) write_file(*files.history, force_history_csv(machine, scene));
  const std::string title = scene_title(scene);
  const DugDig dug = {machine,
                      scene.path,
                      scene.dig,
                      boom_plane_profile(scene.before),
                      boom_plane_profile(scene.after),
                      title};
  write_plots(files.plots, dig_figures({}), dug, outcome.lines, outcome.warnings);
  write_maps(
      files.maps, [&] { return scene_maps(scene); }, outcome);
  if (!files.report) return;
  outcome.page = page_of(scene_report(machine, scene), *files.report);
}

}  // namespace excavplan::tools
