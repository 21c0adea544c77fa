// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/survey/density_estimate.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <variant>

#include <excavplan/ground/bulking.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/text.hpp"
#include "survey/paper_change.hpp"
#include "survey/scan_reading.hpp"

namespace excavplan {
namespace {

// ---- Scans to height maps ---------------------------------------------------------------------

/// The scans with their outlines.
struct OutlinedScans {
  OutlinedPair dig;
  std::optional<OutlinedPair> dump;
  double cell_size = 0.0;
};

OutlinedScans outline_scans(const DigScans& scans, const DensityOptions& options) {
  OutlinedScans seen;
  seen.dig = outlined({scans.before, scans.after}, options.threads);
  seen.cell_size = seen.dig.cell_size();
  if (scans.dump) {
    seen.dump = outlined(*scans.dump, options.threads);
    seen.cell_size = std::max(seen.cell_size, seen.dump->cell_size());
  }
  if (options.cell_size) seen.cell_size = *options.cell_size;
  return seen;
}

struct Surfaces {
  RegisteredPair dig;
  std::optional<RegisteredPair> dump;

  std::vector<HeightMap> before() const {
    std::vector<HeightMap> maps = {dig.surfaces.before.height};
    if (dump) maps.push_back(dump->surfaces.before.height);
    return maps;
  }

  std::vector<HeightMap> after() const {
    std::vector<HeightMap> maps = {dig.surfaces.after.height};
    if (dump) maps.push_back(dump->surfaces.after.height);
    return maps;
  }
};

Surfaces survey(const OutlinedScans& seen, const DensityOptions& options) {
  const auto survey_one = [&](const OutlinedPair& pair) {
    return survey_pair(pair, seen.cell_size, options.registered, options.threads);
  };
  Surfaces surfaces;
  surfaces.dig = survey_one(seen.dig);
  if (seen.dump) surfaces.dump = survey_one(*seen.dump);
  return surfaces;
}

// ---- Height maps to volumes -------------------------------------------------------------------

/// Errors of the change are about what the scans show.
template <typename Measure>
VolumeChange about(const OutlinedScans& seen, const Measure& measure) {
  try {
    return measure();
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, seen.dig.names() + ": " + error.what());
  }
}

VolumeChange surface_volumes_of(const OutlinedScans& seen, const Surfaces& surfaces,
                                const ChangeOptions& options) {
  VolumeChange change = about(seen, [&] {
    return surfaces.dump ? measure_change(surfaces.dig.surfaces, surfaces.dump->surfaces, options)
                         : measure_change(surfaces.dig.surfaces, options);
  });
  for (const Warning& warning : change.warnings) {
    if (warning.code == "looks_swapped") {
      throw Error(ErrorKind::bad_file, seen.dig.names() + ": " + warning.message);
    }
  }
  return change;
}

VolumeChange paper_volumes_of(const OutlinedScans& seen, const VolumeChange& surface,
                              const DensityOptions& options) {
  const PaperScans scans = {seen.dig.scans, seen.dump ? &seen.dump->scans : nullptr};
  const PaperSettings settings = {options.change, seen.cell_size, options.paper};
  return about(seen, [&] { return paper_change(scans, surface, settings); });
}

// ---- What is known beside the volumes ---------------------------------------------------------

/// Loose soil on the floor of the path that was dug.
Fallback fallback_of(const DugPath& dug, const SurfacePair& surfaces, const VolumeChange& change) {
  const HeightMap& before = surfaces.before.height;
  HeightMap after = realigned(surfaces.after.height, surfaces.alignment);
  after.z -= change.areas.front().datum;
  const auto path = make_dig_path(dug.machine, dug.parameters, dug.start_x,
                                  profile_under_bucket(before, dug.machine));
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) {
    throw Error(ErrorKind::bad_input, "path that was dug: " + infeasible->message);
  }
  return measure_fallback(dug.machine, std::get<DigPath>(path), before, after);
}

// ---- Volumes to density -----------------------------------------------------------------------

/// Volume after without the voids between blocks, over the volume before.
Measured without_voids(const VolumeChange& change, const Measured& bulking, const Measured& voids) {
  const double before = change.before.value;
  return {bulking.value - voids.value / before, std::hypot(bulking.sd, voids.sd / before)};
}

/// k = f + (1 - f) k_measured with the errors of both.
Measured freed_of(const Measured& bulking, const Measured& fallback) {
  return {free_of_fallback(bulking.value, fallback.value),
          std::hypot((1.0 - fallback.value) * bulking.sd, (1.0 - bulking.value) * fallback.sd)};
}

/// The bulking factor for the law, if it differs from that of the scans.
std::optional<Measured> corrected(const DensityEstimate& estimate) {
  if (!estimate.blocks.voids && !estimate.fallback) return std::nullopt;
  Measured k = *estimate.bulking;
  if (estimate.blocks.voids) k = without_voids(estimate.change, k, *estimate.blocks.voids);
  if (estimate.fallback) k = freed_of(k, estimate.fallback->fraction);
  return k;
}

/// The density by the law, for a known bulking factor.
void apply_law(DensityEstimate& estimate) {
  DensityLaw law = estimate.law;
  estimate.density_without_fallback = density_of_bulking(law.freed_form, estimate.bulking->value);
  estimate.corrected = corrected(estimate);
  if (estimate.fallback) law.form = law.freed_form;
  Measured k = estimate.corrected.value_or(*estimate.bulking);
  const bool known_error = !std::isnan(k.sd);
  if (!known_error) {
    k.sd = 0.0;
    estimate.warnings.push_back(
        {"volume_error_unknown",
         "this method gives no error of its volumes: the density interval contains only the "
         "scatter of the law"});
  }
  estimate.density = relative_density(law, k);
  estimate.trustworthy = known_error && estimate.density->trustworthy;
  for (const Warning& warning : estimate.density->warnings) estimate.warnings.push_back(warning);
  for (const Reading& reading : estimate.change.readings) {
    const double shift = reading.bulking.value - estimate.bulking->value;
    estimate.readings.push_back({reading, density_of_bulking(law.form, k.value + shift)});
  }
}

Warning warning_of(const BlockReport& report) {
  std::string message = "the soil is in blocks (score " + readable(report.score) + " of 1): ";
  for (std::size_t i = 0; i < report.reasons.size(); ++i) {
    message += (i > 0 ? "; " : "") + report.reasons[i];
  }
  message += report.voids ? "; the voids between them were estimated and subtracted"
                          : "; the voids between them are part of the volume, and their size "
                            "cannot be estimated";
  return {"blocks", message + ": the density is not trustworthy"};
}

/// Marks the estimate as not trustworthy where the scans do not support it.
void judge_scans(DensityEstimate& estimate) {
  if (estimate.blocks.blocks) {
    estimate.warnings.push_back(warning_of(estimate.blocks));
    estimate.trustworthy = false;
  }
  for (const Warning& warning : estimate.change.warnings) {
    if (warning.ends_trust) estimate.trustworthy = false;
  }
}

void keep_registration(const Surfaces& surfaces, DensityEstimate& estimate) {
  const auto registration = [](const RegisteredPair& pair) {
    return ScanRegistration{pair.correction, pair.first};
  };
  estimate.registration = registration(surfaces.dig);
  if (surfaces.dump) estimate.dump_registration = registration(*surfaces.dump);
}

/// The method, in the order of the paper, for each way to find the volumes.
std::vector<DensityEstimate> estimates(const DigScans& scans, const DensityLaw& law,
                                       const DensityOptions& options,
                                       std::initializer_list<VolumeMethod> methods) {
  const OutlinedScans seen = outline_scans(scans, options);  // extent, density of points, cell
  const Surfaces surfaces = survey(seen, options);           // height maps on each other
  const VolumeChange surface = surface_volumes_of(seen, surfaces, options.change);

  DensityEstimate known;  // whatever the method
  known.law = law;
  known.cell_size = seen.cell_size;
  if (options.registered) keep_registration(surfaces, known);
  if (options.dug_path) {
    known.fallback = fallback_of(*options.dug_path, surfaces.dig.surfaces, surface);
  }
  known.before = surfaces.before();
  known.blocks = assess_blocks(surfaces.after(), surface);

  std::vector<DensityEstimate> results;
  for (const VolumeMethod method : methods) {
    DensityEstimate& estimate = results.emplace_back(known);
    const bool by_paper = method == VolumeMethod::paper;
    estimate.method = method;
    // eqs. 3 and 4: volumes before and after
    estimate.change = by_paper ? paper_volumes_of(seen, surface, options) : surface;
    estimate.warnings = estimate.change.warnings;
    estimate.bulking = bulking_factor(estimate.change);  // eq. 1
    estimate.trustworthy = estimate.bulking.has_value();
    if (estimate.bulking) apply_law(estimate);  // corrected for fallback and voids, then to density
    judge_scans(estimate);
  }
  return results;
}

}  // namespace

std::optional<GroundDensity> DensityEstimate::ground_density() const {
  if (!density) return std::nullopt;
  GroundDensity ground(density->percent, density->sd_percent);
  ground.trustworthy = trustworthy;
  ground.soil = law.soil;
  return ground;
}

DensityEstimate estimate_density(const DigScans& scans, const DensityLaw& law,
                                 const DensityOptions& options) {
  return std::move(estimates(scans, law, options, {options.method}).front());
}

DensityEstimate estimate_density(const DigScans& scans, const SoilKind& soil,
                                 const DensityOptions& options) {
  return estimate_density(scans, density_law_of(soil), options);
}

BothEstimates estimate_by_both(const DigScans& scans, const DensityLaw& law,
                               const DensityOptions& options) {
  auto both = estimates(scans, law, options, {VolumeMethod::surface, VolumeMethod::paper});
  return {std::move(both[0]), std::move(both[1])};
}

}  // namespace excavplan
