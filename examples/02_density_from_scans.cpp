// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// How dense was the ground? From the scans before and after one dig, as files or as clouds in
/// memory, to the density that plan_dig() takes: 02_density_from_scans [BEFORE AFTER]

#include <cstdio>

#include <excavplan/base/data_files.hpp>
#include <excavplan/density/density_estimate.hpp>

using namespace excavplan;

int main(int count, char** words) {
  DigScans scans;
  scans.before.files = {count > 2 ? words[1] : find_data_file("quickstart/before.pcd")};
  scans.after.files = {count > 2 ? words[2] : find_data_file("quickstart/after.pcd")};
  const DensityLaw law = load_density_law(find_data_file("laws/zx120-loam.json"));

  const DensityEstimate estimate = estimate_density(scans, law);
  for (const Warning& warning : estimate.warnings) {
    std::printf("%s: %s\n", code_text(warning.code).c_str(), warning.message.c_str());
  }
  const auto show = [](const char* what, const Measured& volume) {
    std::printf("%-8s %.4f +- %.4f m3\n", what, volume.value, volume.sd);
  };
  show("hole", estimate.change.excavated);
  show("spill", estimate.change.spilled);
  show("heap", estimate.change.dumped);
  if (!estimate.density) return 1;  // no dumped soil in the scans, says a warning
  std::printf("bulking factor %.3f +- %.3f, density %.1f +- %.1f %%, %s\n", estimate.bulking->value,
              estimate.bulking->sd, estimate.density->percent, estimate.density->sd_percent,
              estimate.trustworthy ? "trustworthy" : "not trustworthy");
}
