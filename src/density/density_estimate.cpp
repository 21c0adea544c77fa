// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/density/density_estimate.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include <excavplan/change/bulking.hpp>
#include <excavplan/ground/resampling.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/text.hpp"
#include "density/density_in_soil.hpp"
#include "density/density_of_volumes.hpp"
#include "density/known_site.hpp"
#include "ground/too_few_cells.hpp"
#include "scans/cover.hpp"
#include "scans/point_checks.hpp"
#include "scans/scan_checks.hpp"
#include "scans/scan_pairs.hpp"
#include "soil/density_forms.hpp"

namespace excavplan {
namespace {

// ---- Scans to height maps ---------------------------------------------------------------------

/// The scans with their outlines.
struct OutlinedScans {
  OutlinedPair dig;
  std::optional<OutlinedPair> dump;
  double cell_size = 0.0;
  bool stands = false;  ///< the known ground for a scan before

  std::string names() const { return dig.names() + (dump ? ", " + dump->names() : ""); }
  double unit() const { return dig.scans.after.unit; }
  std::uint64_t machine_points() const {
    return dig.machine_points() + (dump ? dump->machine_points() : 0);
  }
};

bool is_given(const Scan& scan) { return !scan.files.empty() || !scan.clouds.empty(); }

/// The cells of a survey of known ground are the ground's, or as many of them together as the
/// points of the scans need, or little more than that.
double cell_on(const GroundState& ground, double needed) {
  constexpr double spare = 0.25;  // of a cell; ours
  const double cell = ground.terrain.bank.cell_size;
  return cell * std::max(1.0, std::ceil(needed / cell - spare));
}

std::optional<Rectangle> area_of_work(const DensityOptions& options) {
  if (options.worked_area || !options.dug_path || !options.dug_path->start_x) {
    return options.worked_area;
  }
  return worked_area(*options.dug_path);
}

/// The known ground for the scan before.
OutlinedPair outlined_in_ground(const GroundState& ground, const Scan& after) {
  const ScanOutline seen = outline(after);
  const Scan before = scan_of(ground, seen.extent.value_or(ground.terrain.bank.extent()));
  return outlined({before, after}, outline(before), seen);
}

OutlinedScans outline_scans(const DigScans& scans, const DensityOptions& options) {
  OutlinedScans seen;
  seen.stands = options.ground && !is_given(scans.before);
  seen.dig = seen.stands ? outlined_in_ground(*options.ground, scans.after)
                         : outlined({scans.before, scans.after}, options.threads);
  if (options.ground) seen.dig.scans.left_out = area_of_work(options);
  seen.cell_size = seen.dig.cell_size();
  if (options.ground) seen.cell_size = cell_on(*options.ground, seen.cell_size);
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

  std::vector<const SurfacePair*> pairs() const {
    std::vector<const SurfacePair*> all = {&dig.surfaces};
    if (dump) all.push_back(&dump->surfaces);
    return all;
  }
  std::vector<HeightMap> before() const {
    std::vector<HeightMap> maps;
    for (const SurfacePair* pair : pairs()) maps.push_back(pair->before.height);
    return maps;
  }
  std::vector<HeightMap> after() const {
    std::vector<HeightMap> maps = {dig.surfaces.after.height};
    if (dump) maps.push_back(dump->surfaces.after.height);
    return maps;
  }
};

Surfaces survey(const OutlinedScans& seen, const DensityOptions& options) {
  const auto survey_one = [&](const OutlinedPair& pair,
                              const std::optional<Eigen::Vector2d>& grid = std::nullopt) {
    return survey_pair(pair, seen.cell_size, options.registered, options.threads, grid);
  };
  Surfaces surfaces;
  if (options.ground) {
    surfaces.dig = survey_one(seen.dig, options.ground->terrain.bank.origin);
    Surface& before = surfaces.dig.surfaces.before;
    if (seen.stands) set_deviation(*options.ground, before);
    leave_out_obstacles(*options.ground, before);
  } else {
    surfaces.dig = survey_one(seen.dig);
  }
  if (seen.dump) surfaces.dump = survey_one(*seen.dump);
  return surfaces;
}

// ---- Height maps to volumes -------------------------------------------------------------------

/// Errors of the change are about what the scans show.
template <typename Measure>
VolumeChange about(const OutlinedScans& seen, const Measure& measure) {
  try {
    return measure();
  } catch (const TooFewCells& few) {
    throw few.of_scans(seen.names());
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, seen.names() + ": " + error.what());
  }
}

/// The path that was dug, on the ground before it.
DigPath path_of(const DugPath& dug, const HeightMap& before) {
  const GroundProfile profile = profile_under_bucket(before, dug.machine);
  const double lifted = dug.start_z ? *dug.start_z - profile(*dug.start_x) : 0.0;
  const auto path = make_dig_path(
      machine_for_planned_path(dug.machine), dug.parameters, *dug.start_x,
      [&](double x) { return profile(x) + lifted; }, rules_for_planned_path());
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) {
    throw Error(ErrorKind::bad_input, "path that was dug: " + infeasible->message);
  }
  return std::get<DigPath>(path);
}

struct SurfaceVolumes {
  VolumeChange change;
  std::optional<KnownGround> known;
  std::vector<Warning> of_points;  ///< doubts
  std::vector<Warning> of_cover;
};

VolumeChange change_of(const Surfaces& surfaces, const KnownGround* known,
                       const ChangeOptions& options) {
  const SurfacePair& dig = surfaces.dig.surfaces;
  if (known != nullptr) {
    return surfaces.dump ? measure_change(dig, surfaces.dump->surfaces, *known, options)
                         : measure_change(dig, *known, options);
  }
  return surfaces.dump ? measure_change(dig, surfaces.dump->surfaces, options)
                       : measure_change(dig, options);
}

/// Where the hole of a dig along a path lies.
Rectangle around(const Rectangle& strip) {
  constexpr double beside = 0.6;  // ours: ground that slides into the cut [m]
  return {strip.x_min - beside, strip.y_min - beside, strip.x_max + beside, strip.y_max + beside};
}

/// Why a floor cannot be the one that was swept; nothing if it can.
std::optional<Warning> doubt_of(const KnownCut& cut) {
  constexpr double most_below = 0.1;  // ours: of the bank cut
  constexpr double most_left = 0.7;   // ours: of all that was cut
  const double error = 3.0 * known_tracking_sd * cut.swept_area;
  const bool is_below = cut.fallen < -most_below * cut.bank.value - error;
  const bool is_filled = cut.fallen > most_left * (cut.bank.value + cut.loose.value) + error;
  const bool is_unseen = cut.unseen_area > 0.5 * cut.swept_area;
  if (cut.bank.value > 0.0 && !is_below && !is_filled && !is_unseen) return std::nullopt;
  return Warning{WarningCode::dug_path_doubtful,
                 "along the path that was dug the bucket swept " + readable(cut.bank.value) +
                     " m^3 of bank and " + readable(cut.fallen) +
                     " m^3 of soil lie on its floor: the dig stalled or was not along this path, "
                     "or scans and ground are not in the site frame; the path is not used"};
}

/// Volumes in ground that is known, by the floor that was swept if it is told and can be.
SurfaceVolumes volumes_in_known_ground(const Surfaces& surfaces, const DensityOptions& options) {
  const HeightMap& before = surfaces.dig.surfaces.before.height;
  const SoilKind* soil = options.soil.kind ? &*options.soil.kind : nullptr;
  SurfaceVolumes volumes;
  volumes.known = known_ground_on(before, *options.ground, soil);
  ChangeOptions told = options.change;
  if (options.dug_path && !told.heap_near) told.heap_near = heap_area(*options.dug_path);
  const ChangeOptions without_path = told;
  std::optional<Warning> doubt;
  if (options.dug_path && options.dug_path->start_x) {
    const Machine& machine = options.dug_path->machine;
    const DigPath path = path_of(*options.dug_path, before);
    add_cut(path, machine, before, *volumes.known);
    if (!told.dig_area) told.dig_area = around(swept_strip(machine, path));
    volumes.change = change_of(surfaces, &*volumes.known, told);
    doubt = doubt_of(*volumes.change.cut);
    if (!doubt) return volumes;
    volumes.known->cut.resize(0, 0);  // {} would be the number 0 in all cells
    volumes.known->cover.resize(0, 0);
  }
  volumes.known->common_sd = untold_loose_sd;
  volumes.change = change_of(surfaces, &*volumes.known, without_path);
  if (doubt) volumes.change.warnings.push_back(*doubt);
  return volumes;
}

SurfaceVolumes surface_volumes_of(const OutlinedScans& seen, const Surfaces& surfaces,
                                  const DensityOptions& options) {
  SurfaceVolumes volumes;
  VolumeChange& change = volumes.change;
  if (options.ground) {
    about(seen, [&] {
      volumes = volumes_in_known_ground(surfaces, options);
      return volumes.change;
    });
  } else {
    change = about(seen, [&] { return change_of(surfaces, nullptr, options.change); });
  }
  volumes.of_points = check_points(surfaces.pairs(), change);
  volumes.of_cover = check_cover(surfaces.pairs(), change);
  std::vector<Warning> doubts = volumes.of_points;
  add_new(volumes.of_cover, doubts);
  for (const Warning& warning : change.warnings) {
    if (warning.code == WarningCode::sensor_place_doubtful) doubts.insert(doubts.begin(), warning);
  }
  // In known ground a hole of loose soil does not swell.
  if (!options.ground) {
    with_doubts(doubts, [&] { refuse_swapped(change, seen.dig.names(), seen.unit()); });
  }
  state_water(surfaces.pairs(), change);
  return volumes;
}

VolumeChange paper_volumes_of(const OutlinedScans& seen, const VolumeChange& surface,
                              const DensityOptions& options) {
  const SurveyedDig dig = {seen.dig.scans, seen.dump ? &seen.dump->scans : nullptr, surface,
                           options.change, seen.cell_size};
  return about(seen, [&] { return options.paper(dig); });
}

// ---- Whether the scans can be what they are taken for ------------------------------------------

std::vector<Warning> doubts_about(const OutlinedScans& seen) {
  std::vector<Warning> doubts = check_outlines(seen.dig);
  if (seen.dump) add_new(check_outlines(*seen.dump), doubts);
  return doubts;
}

std::vector<Warning> doubts_about(const OutlinedScans& seen, const Surfaces& surfaces,
                                  const SurfaceVolumes& volumes) {
  const VolumeChange& change = volumes.change;
  std::vector<Warning> doubts = volumes.of_points;
  add_new(check_volumes(change, seen.unit()), doubts);
  add_new(check_slopes(surfaces.pairs(), change), doubts);
  add_new(check_machine(seen.machine_points(), change), doubts);
  const auto check = [&](const OutlinedPair& outlined, const RegisteredPair& pair,
                         const AreaChange& area) {
    add_new(check_registration(outlined.scans, pair, area), doubts);
    add_new(check_tilt(outlined.scans, pair.surfaces, change, area), doubts);
    add_new(check_curvature(pair.surfaces, area), doubts);
  };
  check(seen.dig, surfaces.dig, change.areas.front());
  if (seen.dump) check(*seen.dump, *surfaces.dump, change.areas.back());
  add_new(volumes.of_cover, doubts);
  return doubts;
}

// ---- What is known beside the volumes ---------------------------------------------------------

/// Loose soil on the floor of the path that was dug.
Fallback fallback_of(const DugPath& dug, const SurfacePair& surfaces, const VolumeChange& change) {
  const HeightMap& before = surfaces.before.height;
  HeightMap after = realigned(surfaces.after.height, surfaces.alignment);
  const AreaChange& area = change.areas.front();
  after.z = area.difference.z.isNaN().select(after.z - area.datum, before.z + area.difference.z);
  return measure_fallback(dug.machine, path_of(dug, before), before, after);
}

/// Nothing where the start of the dug path is not known.
std::optional<Fallback> fallback_of(const DensityOptions& options, const Surfaces& surfaces,
                                    const VolumeChange& change) {
  if (!options.dug_path || !options.dug_path->start_x) return std::nullopt;
  return fallback_of(*options.dug_path, surfaces.dig.surfaces, change);
}

/// Work of the joints over density in digs on the ground that was dug; a warning where the scan
/// does not show enough of it.
void add_work(const DensityOptions& options, const Surfaces& surfaces, LawsForDig& laws) {
  if (!options.joint_work) return;
  constexpr double cell = 0.05;
  constexpr double widest_gap = 0.3;  // that is filled; ours [m]
  const DugPath& dug = *options.dug_path;
  const HeightMap& before = surfaces.dig.surfaces.before.height;
  try {
    const Terrain ground =
        undisturbed(resampled(before, planning_extent(dug.machine), cell, widest_gap));
    const DigPath path = path_of(dug, before);
    const LoadedDig dig = {dug.machine, path, ground, *options.soil.kind, options.soil.scatter};
    laws.work = work_over_density(dig, laws.law.freed_form, options.threads);
  } catch (const Error& error) {
    laws.warnings.emplace_back(WarningCode::loads_not_used,
                               std::string("the dig of the joint loads cannot be "
                                           "simulated on the scanned ground: ") +
                                   error.what());
  }
}

std::optional<Fallback> fallback_in_ground(const VolumeChange& change) {
  if (!(change.cut->swept_area > 0.0)) return std::nullopt;
  return fallback_in(*change.cut);
}

/// Share of the variance of the bulking factor by the scans that the scan before made.
double shared_share(const VolumeChange& change) {
  const auto k = bulking_factor(change);
  if (!k) return 0.0;
  const Eigen::Vector3d slope(-k->value, 1.0, 1.0);
  const double all = slope.dot(change.errors.scans() * slope);
  return all > 0.0 ? std::clamp(slope.dot(change.shared * slope) / all, 0.0, 1.0) : 0.0;
}

/// Little bank in the cut says little of its density.
void judge_bank(DensityEstimate& estimate) {
  constexpr double least = 1.0 / 3.0;  // ours
  if (!estimate.change.cut) return;    // the paper's volumes
  const KnownCut& cut = *estimate.change.cut;
  if (!estimate.density || cut.bank_share() >= least) return;
  estimate.warnings.emplace_back(
      WarningCode::earlier_soil,
      "of what was cut " + readable(100.0 * cut.bank_share(), 2) +
          " % was undisturbed ground, the rest loose soil of earlier digs: too little to tell its "
          "density; the volumes are as measured",
      true);
}

Warning warning_of(const BlockReport& report) {
  std::string message = "the soil is in blocks (score " + readable(report.score) + " of 1): ";
  for (std::size_t i = 0; i < report.reasons.size(); ++i) {
    message += (i > 0 ? "; " : "") + report.reasons[i];
  }
  message += report.voids ? "; the voids between them were estimated and subtracted"
                          : "; the voids between them are part of the volume, and their size "
                            "cannot be estimated";
  return {WarningCode::blocks, message + ": the density is not trustworthy"};
}

/// Says by warnings that end trust why there is no density, or one beyond the range of the law.
void name_causes(DensityEstimate& estimate) {
  if (estimate.trustworthy) return;
  if (estimate.density && estimate.density->trustworthy) return;  // what ended it has said so
  const std::set<WarningCode> causes =
      estimate.bulking
          ? std::set<WarningCode>{WarningCode::density_above_range,
                                  WarningCode::density_below_range}
          : std::set<WarningCode>{WarningCode::no_hole_found, WarningCode::no_dumped_soil,
                                  WarningCode::zone_unseen};
  bool is_named = false;
  for (Warning& warning : estimate.warnings) {
    if (causes.count(warning.code) > 0) warning.ends_trust = true;
    is_named = is_named || warning.ends_trust;
  }
  if (is_named) return;
  estimate.warnings.emplace_back(WarningCode::density_not_trustworthy,
                                 estimate.bulking ? "the density is farther beyond 0 .. 100 % than "
                                                    "its error explains"
                                                  : "a volume is not known, so that there is no "
                                                    "bulking factor",
                                 true);
}

/// Marks the estimate as not trustworthy where the scans do not support it.
void judge_scans(DensityEstimate& estimate) {
  name_causes(estimate);
  if (estimate.blocks.blocks) {
    estimate.warnings.push_back(warning_of(estimate.blocks));
    estimate.trustworthy = false;
  }
  for (Warning& warning : estimate.warnings) {
    const bool is_leant_on =
        warning.code == WarningCode::little_stable_ground && estimate.registration;
    if (is_leant_on) warning.ends_trust = true;
    if (warning.ends_trust) estimate.trustworthy = false;
  }
  estimate.warnings = causes_of(std::move(estimate.warnings));
}

void keep_registration(const Surfaces& surfaces, DensityEstimate& estimate) {
  const auto registration = [](const RegisteredPair& pair) {
    return ScanRegistration{pair.correction, pair.first};
  };
  estimate.registration = registration(surfaces.dig);
  if (surfaces.dump) estimate.dump_registration = registration(*surfaces.dump);
}

void require_measured(const std::string& what, const Measured& figure) {
  require(figure.value > 0.0 && std::isfinite(figure.value), what, figure.value,
          "above 0 and finite");
  require(figure.sd >= 0.0 && std::isfinite(figure.sd), what + ", its sd,", figure.sd,
          "at least 0 and finite");
}

constexpr double farthest_dump = 1000.0;  // ours: from the swing axis [m]

void check(const DensityLaw& law, const DensityOptions& options) {
  require_form(law.form);
  require_form(law.freed_form);
  const double cell = options.cell_size.value_or(1.0);
  require(cell > 0.0 && std::isfinite(cell), "cell_size", cell, "above 0 m and finite");
  if (options.dug_path) require_machine(options.dug_path->machine);
  if (options.dug_path && options.dug_path->dump_at) {
    const double far = options.dug_path->dump_at->cwiseAbs().maxCoeff();
    require(far <= farthest_dump, "dump_at of the path that was dug", far,
            "at most " + readable(farthest_dump) + " m");
  }
  if (options.dug_path && options.dug_path->start_z) {
    require(std::isfinite(*options.dug_path->start_z), "start_z", *options.dug_path->start_z,
            "finite");
  }
  if (options.ground) require_ground_state(*options.ground, "ground");
  require(std::isfinite(options.scan_time), "scan_time", options.scan_time, "finite");
  if (options.soil.kind) require_soil(*options.soil.kind);
  for (const SoilLaw& possible : options.soil.possible) {
    require_soil(possible.soil);
    require_form(possible.law.form);
    require_form(possible.law.freed_form);
    require_in("weight of a soil", possible.weight, 0.0, 1.0);
  }
  if (options.payload_mass) require_measured("payload_mass [kg]", *options.payload_mass);
  if (options.joint_work) {
    require_measured("joint_work [J]", *options.joint_work);
    require(
        options.dug_path && options.dug_path->start_x && options.soil.kind && !options.soil.unknown,
        "joint_work needs the path that was dug, its start and the kind of soil");
  }
  if (const auto& water = options.soil.water_content) {
    require(water->value >= 0.0 && water->value <= 10.0, "water_content", water->value,
            "in 0 .. 10, a share of the dry mass: 12 % is 0.12");
    require_in("water_content, its sd,", water->sd, 0.0, 10.0);
  }
}

void require_volumes(const DensityOptions& options, std::initializer_list<VolumeMethod> methods) {
  const bool has_paper =
      std::find(methods.begin(), methods.end(), VolumeMethod::paper) != methods.end();
  require(!has_paper || options.paper,
          "VolumeMethod::paper needs DensityOptions::paper, the volumes by paper_change() of "
          "excavplan::paper, which is built where PCL is found (libpcl-dev)");
}

/// What known ground adds to an estimate: a density by solids, its doubts, and the ground after.
void finish_in_ground(const DensityOptions& options, const SurfacePair& surfaces,
                      const SurfaceVolumes& volumes, const LawsForDig& laws,
                      DensityEstimate& estimate) {
  if (!estimate.bulking) set_density_by_solids(estimate, laws, options);
  judge_bank(estimate);
  estimate.shared_with_before = shared_share(volumes.change);
  const double density = estimate.density ? estimate.density->percent : 50.0;
  const double fallback = expected_fallback(laws.law, density);
  estimate.ground_after =
      ground_after(options, {surfaces, volumes.change, *volumes.known, fallback});
}

/// The method, in the order of the paper, for each way to find the volumes.
std::vector<DensityEstimate> estimates(const DigScans& scans, const DensityLaw& law,
                                       const DensityOptions& options,
                                       std::initializer_list<VolumeMethod> methods) {
  check(law, options);
  require_volumes(options, methods);
  const OutlinedScans seen = outline_scans(scans, options);  // extent, density of points, cell
  std::vector<Warning> doubts = doubts_about(seen);
  Surfaces surfaces;
  const SurfaceVolumes volumes = with_doubts(doubts, [&] {
    surfaces = survey(seen, options);  // height maps on each other
    return surface_volumes_of(seen, surfaces, options);
  });
  const VolumeChange& surface = volumes.change;
  add_new(doubts_about(seen, surfaces, volumes), doubts);

  DensityEstimate known;  // whatever the method
  known.fallback =
      options.ground ? fallback_in_ground(surface) : fallback_of(options, surfaces, surface);
  LawsForDig laws = laws_for_dig(law, options, known.fallback);
  add_work(options, surfaces, laws);
  known.law = laws.law;
  known.cell_size = seen.cell_size;
  known.machine_points = seen.machine_points();
  if (options.registered) keep_registration(surfaces, known);
  known.before = surfaces.before();
  known.blocks = assess_blocks(surfaces.after(), surface);

  std::vector<DensityEstimate> results;
  for (const VolumeMethod method : methods) {
    DensityEstimate& estimate = results.emplace_back(known);
    const bool by_paper = method == VolumeMethod::paper;
    estimate.method = method;
    // eqs. 3 and 4: volumes before and after
    estimate.change = by_paper ? paper_volumes_of(seen, surface, options) : surface;
    estimate.warnings = doubts;  // the causes first
    add_new(estimate.change.warnings, estimate.warnings);
    estimate.bulking = bulking_factor(estimate.change);  // eq. 1
    estimate.trustworthy = estimate.bulking.has_value();
    if (estimate.bulking) set_density(estimate, laws, options);
    if (options.ground) finish_in_ground(options, surfaces.dig.surfaces, volumes, laws, estimate);
    judge_scans(estimate);
  }
  return results;
}

}  // namespace

Rectangle worked_area(const DugPath& dug) {
  constexpr double around = 1.0;  // ours: soil that slides and spills [m]
  constexpr double curl = 1.5;    // ours: of the bucket towards the machine, at most [m]
  require(dug.start_x.has_value(), "the area of a dug path needs its start");
  const DigParameters& path = dug.parameters;
  const double length = path.penetration_length + path.drag_length;
  const double half = 0.5 * dug.machine.bucket.width_outside + around;
  return {*dug.start_x - length - curl - around, -half, *dug.start_x + around, half};
}

std::optional<Rectangle> heap_area(const DugPath& dug) {
  constexpr double slope = 0.65;     // of loose soil, 33 degrees
  constexpr double spread_by = 2.0;  // of a heap on a heap, in radii of a cone
  if (!dug.dump_at) return std::nullopt;
  const double radius = std::cbrt(3.0 * heaped_capacity(dug.machine) / (pi * slope));
  const Eigen::Vector2d low = dug.dump_at->array() - spread_by * radius;
  const Eigen::Vector2d high = dug.dump_at->array() + spread_by * radius;
  return Rectangle{low.x(), low.y(), high.x(), high.y()};
}

DensityEstimate estimate_density(const DigScans& scans, const DensityLaw& law,
                                 const DensityOptions& options) {
  return std::move(estimates(scans, law, options, {options.method}).front());
}

DensityEstimate estimate_density(const DigScans& scans, const SoilKind& soil,
                                 const DensityOptions& options) {
  DensityOptions in_soil = options;
  in_soil.soil.kind = soil;
  return estimate_density(scans, density_law_of(soil), in_soil);
}

BothEstimates estimate_by_both(const DigScans& scans, const DensityLaw& law,
                               const DensityOptions& options) {
  auto both = estimates(scans, law, options, {VolumeMethod::surface, VolumeMethod::paper});
  return {std::move(both[0]), std::move(both[1])};
}

}  // namespace excavplan
