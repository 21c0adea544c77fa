// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/scan_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include <Eigen/Geometry>

#include <excavplan/change/change_options.hpp>

#include "base/angles.hpp"
#include "base/normal_equations.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "clouds/cloud_units.hpp"
#include "ground/grid_cells.hpp"
#include "ground/plane_fit.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

constexpr const char* give_frames =
    "let `level` find the ground, or give the transform into a frame with z up by `frame`, or "
    "`before_frame` and `after_frame`";

std::string degrees(double angle) { return readable(angle / degree, 2) + " degrees"; }

std::string size_of(const Rectangle& r) {
  return readable(r.x_max - r.x_min) + " x " + readable(r.y_max - r.y_min);
}

// ---- Units --------------------------------------------------------------------------------------

std::optional<Warning> too_small(const OutlinedPair& pair) {
  constexpr double dense =
      std::numeric_limits<double>::infinity();  // its volume tells of wide ones
  const auto before = doubt_of_extent(*pair.before.extent, dense, pair.scans.before.unit);
  return before ? before : doubt_of_extent(*pair.after.extent, dense, pair.scans.after.unit);
}

/// Twice as large and more in both directions, and by the same factor to a tenth.
std::optional<Warning> other_units(const OutlinedPair& pair) {
  constexpr double least_factor = 2.0;  // ours
  constexpr double alike = 0.1;         // ours, of the logarithm of the factor
  const Rectangle& a = *pair.before.extent;
  const Rectangle& b = *pair.after.extent;
  const double x = std::log((b.x_max - b.x_min) / (a.x_max - a.x_min));
  const double y = std::log((b.y_max - b.y_min) / (a.y_max - a.y_min));
  const double points = std::log(static_cast<double>(pair.after.finite_points) /
                                 static_cast<double>(pair.before.finite_points));
  const double factor = 0.5 * (x + y);
  if (std::abs(factor) < std::log(least_factor) || std::abs(x - y) > alike * std::abs(factor)) {
    return std::nullopt;
  }
  if (std::abs(points) > std::abs(factor)) return std::nullopt;  // it shows more ground
  return Warning{WarningCode::units,
                 "the scans show " + size_of(a) + " m before and " + size_of(b) +
                     " m after, in both directions a factor of " +
                     readable(std::exp(std::abs(factor))) +
                     ": one of them is in other units: give `before_unit` or `after_unit`"};
}

std::optional<Warning> coarse_heights(const OutlinedPair& pair) {
  constexpr double most = 0.021;  // ours [m]: steps of 2 cm are a tenth of a shallow hole
  const bool is_after = pair.after.height_step > pair.before.height_step;
  const double step = std::max(pair.before.height_step, pair.after.height_step);
  if (!(step > most)) return std::nullopt;
  return Warning{
      WarningCode::coarse_heights,
      name_of(is_after ? pair.scans.after : pair.scans.before) + ": all heights are multiples of " +
          readable(step) +
          " m: volumes of a dig need finer ones; write the coordinates with more digits"};
}

/// Of a machine that takes nothing out of scans, or most of them.
std::optional<Warning> not_in_view(const OutlinedPair& pair) {
  constexpr double most = 0.5;  // ours, of a scan
  const bool is_told = pair.scans.before.machine || pair.scans.after.machine;
  if (!is_told) return std::nullopt;
  for (const ScanOutline* seen : {&pair.before, &pair.after}) {
    const auto of_machine = static_cast<double>(seen->machine_points);
    if (of_machine > most * (of_machine + static_cast<double>(seen->finite_points))) {
      return Warning{WarningCode::machine_pose,
                     "more than half of the points of a scan lie in the machine as it is said to "
                     "have stood: its pose or the frame of the scans is wrong",
                     true};
    }
  }
  if (pair.machine_points() > 0) return std::nullopt;
  return Warning{WarningCode::machine_pose,
                 "no point lies in the machine as it is said to have stood: it is not in view, or "
                 "its pose or the frame of the scans is wrong, and it is still in them"};
}

// ---- Frame --------------------------------------------------------------------------------------

std::optional<Warning> not_up(const ScanOutline& seen, const Scan& scan) {
  constexpr double nearly_all = 0.99;
  constexpr double steepest = 45.0 * degree;  // ours: no ground to dig in
  const double off = std::acos(std::min(seen.normal.z(), 1.0));
  if (off > steepest) {
    const bool is_y = std::abs(seen.normal.y()) > std::cos(steepest);
    return Warning{WarningCode::frame, name_of(scan) + ": the ground lies at " + degrees(off) +
                                           " to level, so z is not up" +
                                           (is_y ? "; if y is, give `frame` y-up; else " : ": ") +
                                           give_frames};
  }
  if (scan.z_is_up || scan.site_from_scan != Eigen::Matrix4d::Identity()) return std::nullopt;
  if (!(seen.seen_along_z >= nearly_all)) return std::nullopt;
  return Warning{WarningCode::frame,
                 name_of(scan) +
                     ": all points lie ahead of the origin along z, as in the frame of a camera, "
                     "where hole and heap are exchanged: " +
                     give_frames + "; if z is up, say so by `frame` lidar"};
}

/// Of the plane through the ground that did not change.
double tilt_of_stable(const HeightMap& ground, const Eigen::ArrayXXi& zone) {
  PlaneFit fit;
  for_each_cell(zone, [&](Cell at) {
    const double z = ground.z(at.row, at.col);
    if (zone(at.row, at.col) >= 0 || std::isnan(z)) return;
    fit.add(ground.x(at.col) - ground.origin.x(), ground.y(at.row) - ground.origin.y(), z);
  });
  const Eigen::Vector2d gradient = fit.plane().gradient();
  return std::atan(std::hypot(gradient.x(), gradient.y()));
}

/// Ground z = a + b x + c y + d x^2 + e x y + f y^2 that did not change, about its middle.
struct Bowl {
  double across = 0.0;   ///< 2 f [1/m]
  double along = 0.0;    ///< 2 d
  double twist = 0.0;    ///< e
  double sagitta = 0.0;  ///< by the curvature, from the middle to the rim [m]
  double rest_sd = 0.0;  ///< of the ground about it [m]
};

Bowl bowl_of_stable(const HeightMap& ground, const Eigen::ArrayXXi& zone) {
  const Rectangle extent = ground.extent();
  const Eigen::Vector2d middle(0.5 * (extent.x_min + extent.x_max),
                               0.5 * (extent.y_min + extent.y_max));
  NormalEquations<6> equations;
  for_each_cell(zone, [&](Cell at) {
    const double z = ground.z(at.row, at.col);
    if (zone(at.row, at.col) >= 0 || std::isnan(z)) return;
    const double x = ground.x(at.col) - middle.x();
    const double y = ground.y(at.row) - middle.y();
    NormalEquations<6>::Vector terms;
    terms << 1.0, x, y, x * x, x * y, y * y;
    equations.add(terms, z);
  });
  const auto found = equations.solution();
  Bowl bowl{2.0 * found(5), 2.0 * found(3), found(4), 0.0, 0.0};
  const double half = 0.5 * std::max(extent.x_max - extent.x_min, extent.y_max - extent.y_min);
  bowl.sagitta = 0.25 * std::abs(bowl.across + bowl.along) * half * half;
  const double left = equations.squares_about(found);
  bowl.rest_sd = std::sqrt(std::max(0.0, left) / std::max(1.0, equations.matrix()(0, 0)));
  return bowl;
}

/// Slope of the walls of the hole between neighbouring cells, and whether they are so wide that the
/// cells tell it.
struct Walls {
  double angle = 0.0;
  bool resolved = true;
};

Walls walls_of(const VolumeChange& change, const AreaChange& area, const HeightMap& after) {
  constexpr double wall = 1.0;         // ours: steeper than loose soil stands [-]
  constexpr double in_one_step = 0.6;  // ours, of the depth
  std::vector<double> steps;
  std::vector<double> depths;
  const auto in_hole = [&](Cell at) {
    const int zone = area.zone(at.row, at.col);
    return zone >= 0 && change.zones[static_cast<std::size_t>(zone)].kind == ZoneKind::dig;
  };
  for_each_cell(area.zone, [&](Cell at) {
    if (!in_hole(at)) return;
    depths.push_back(-area.difference.z(at.row, at.col));
    if (std::isnan(depths.back())) depths.pop_back();
    double step = 0.0;
    for_each_neighbour(area.zone, at, [&](Cell n) {
      const double down = std::abs(after.z(at.row, at.col) - after.z(n.row, n.col));
      if (in_hole(n) && down > step) step = down;
    });
    if (step > wall * after.cell_size) steps.push_back(step);
  });
  const double step = quantile(steps, 0.9);
  return {std::atan(step / after.cell_size), step < in_one_step * quantile(depths, 0.95)};
}

// ---- Order --------------------------------------------------------------------------------------

/// Volumes that fell and rose in the zones of an area [m^3].
struct Balance {
  double fell = 0.0;
  double rose = 0.0;
};

Balance balance_of(const AreaChange& area) {
  Balance sum;
  const double cell_area = area.difference.cell_size * area.difference.cell_size;
  for_each_cell(area.zone, [&](Cell at) {
    const double change = area.difference.z(at.row, at.col);
    if (area.zone(at.row, at.col) < 0 || std::isnan(change)) return;
    (change < 0.0 ? sum.fell : sum.rose) += cell_area * std::abs(change);
  });
  return sum;
}

/// Slope of the steepest tenth of a kind of zones, before or after, whichever is the steeper [-]. A
/// wall of a hole is ground that was seen; a heap in the hollow between two others is a steep
/// change and stands no steeper than they.
double steepness(const std::vector<const SurfacePair*>& pairs, const VolumeChange& change,
                 ZoneKind kind) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::ArrayXXi& zones = change.areas[i].zone;
    const Gradient before = gradient_of(pairs[i]->before.height);
    const Gradient after = gradient_of(pairs[i]->after.height);
    for_each_cell(zones, [&](Cell at) {
      const int zone = zones(at.row, at.col);
      if (zone < 0 || change.zones[static_cast<std::size_t>(zone)].kind != kind) return;
      const double slope = std::max(std::hypot(before.x(at.row, at.col), before.y(at.row, at.col)),
                                    std::hypot(after.x(at.row, at.col), after.y(at.row, at.col)));
      if (!std::isnan(slope)) slopes.push_back(slope);
    });
  }
  return quantile(slopes, 0.9);
}

double gap_between(const Rectangle& a, const Rectangle& b) {
  const double x = std::max(a.x_min, b.x_min) - std::min(a.x_max, b.x_max);
  const double y = std::max(a.y_min, b.y_min) - std::min(a.y_max, b.y_max);
  return std::hypot(std::max(x, 0.0), std::max(y, 0.0));
}

/// Volume of other ground that fell beside the heap, as the spill does where scans are swapped, and
/// deeper than tracks and its error. Nothing where the heap is too small to be a hole.
double lost_beside_heap(const VolumeChange& change) {
  constexpr double track = 0.05;       // ours, mean depth [m]
  constexpr double least_heap = 0.2;   // ours, of what was dug
  constexpr double established = 2.0;  // ours [sd]
  const double beside = ChangeOptions{}.spill_distance;
  double lost = 0.0;
  if (change.dumped.value < least_heap * change.excavated.value) return lost;
  for (const ChangeZone& zone : change.zones) {
    const double least = std::max(track * zone.area, established * zone.volume.sd);
    if (zone.kind != ZoneKind::other || !(zone.volume.value < -least)) continue;
    if (std::any_of(change.zones.begin(), change.zones.end(), [&](const ChangeZone& heap) {
          return heap.kind == ZoneKind::dump && gap_between(heap.extent, zone.extent) < beside;
        })) {
      lost -= zone.volume.value;
    }
  }
  return lost;
}

/// The most that a scan lies above the one before, else its heights are of another datum or unit;
/// ours: a sensor on a mast stands no higher over one on the ground [m].
constexpr double most_above = 10.0;

/// How far the scan after lies above the scan before where nothing changed, as it was given [m].
double height_above(const RegisteredPair& pair, const AreaChange& area) {
  const Eigen::Vector3d& centre = pair.surfaces.alignment.centre;
  const Eigen::Vector4d back = pair.correction * centre.homogeneous();
  return area.datum + centre.z() - back.z();
}

}  // namespace

std::vector<Warning> causes_of(std::vector<Warning> warnings) {
  struct Cause {
    WarningCode code;
    std::set<WarningCode> effects;
  };
  // What is judged by lengths, and by heights above a plane.
  static const std::vector<Cause> causes = {
      {WarningCode::units,
       {WarningCode::blocks,
        WarningCode::coarse_heights,
        WarningCode::curved_ground,
        WarningCode::dug_path_doubtful,
        WarningCode::flat_water,
        WarningCode::floor_cut,
        WarningCode::grass,
        WarningCode::hole_in_shadow,
        WarningCode::implausible_energy,
        WarningCode::implausible_fuel,
        WarningCode::loads_disagree,
        WarningCode::loads_not_used,
        WarningCode::machine_pose,
        WarningCode::object_on_soil,
        WarningCode::object_taken_out,
        WarningCode::payload_disagrees,
        WarningCode::registration_beyond_prior,
        WarningCode::scans_do_not_fit,
        WarningCode::sensor_place_doubtful,
        WarningCode::sensor_place_inferred,
        WarningCode::systematic_errors,
        WarningCode::zone_partly_unseen}},
      {WarningCode::frame,
       {WarningCode::object_taken_out, WarningCode::scans_do_not_fit,
        WarningCode::zone_partly_unseen}}};
  for (const Cause& cause : causes) {
    const bool is_there = std::any_of(warnings.begin(), warnings.end(), [&](const Warning& w) {
      return w.code == cause.code && w.ends_trust;
    });
    if (!is_there) continue;
    const auto is_effect = [&](const Warning& w) { return cause.effects.count(w.code) > 0; };
    warnings.erase(std::remove_if(warnings.begin(), warnings.end(), is_effect), warnings.end());
  }
  return warnings;
}

std::optional<Warning> check_no_data(const ScanOutline& seen, const Scan& scan) {
  if (seen.no_data.empty()) return std::nullopt;
  constexpr std::uint64_t counted = 1 << 16;  // points: of more a sample is looked at
  std::string heights;
  for (const double height : seen.no_data) {
    heights += (heights.empty() ? "" : " or ") + number_text(height);
  }
  return Warning{WarningCode::outliers,
                 name_of(scan) + ": " + readable(100.0 * seen.no_data_share, 2) +
                     " % of the points, " + (seen.points > counted ? "about " : "") +
                     std::to_string(seen.no_data_points) + ", have z = " + heights +
                     ", which stands for no data: they were left out",
                 false};
}

std::optional<Warning> check_outline(const ScanOutline& seen, const Scan& scan) {
  auto units = doubt_of_extent(*seen.extent, seen.density, scan.unit);
  if (units) units->message = name_of(scan) + ": " + units->message;
  return units ? units : not_up(seen, scan);
}

std::vector<Warning> check_outlines(const OutlinedPair& pair) {
  std::vector<Warning> found = pair.scans.before.doubts;
  found.insert(found.end(), pair.scans.after.doubts.begin(), pair.scans.after.doubts.end());
  const auto add = [&found](std::optional<Warning> warning) {
    if (warning) found.push_back(std::move(*warning));
  };
  add(check_no_data(pair.before, pair.scans.before));
  add(check_no_data(pair.after, pair.scans.after));
  add(too_small(pair));
  add(other_units(pair));
  add(coarse_heights(pair));
  const auto before = not_up(pair.before, pair.scans.before);
  add(before ? before : not_up(pair.after, pair.scans.after));
  add(not_in_view(pair));
  return found;
}

std::vector<Warning> check_registration(const ScanPair& scans, const RegisteredPair& pair,
                                        const AreaChange& area) {
  const Alignment& found = pair.surfaces.alignment;
  const double above = height_above(pair, area);
  if (std::abs(above) > most_above) {
    return {{WarningCode::registration_beyond_prior,
             name_of(scans.after) + ": lies " + readable(std::abs(above), 3) + " m " +
                 (above > 0.0 ? "above " : "below ") + name_of(scans.before) + ", must be within " +
                 number_text(most_above) +
                 " m: are heights in the same unit and datum? Else give its transform by "
                 "`after_frame`",
             true}};
  }
  const Displacement moved = displacement_by(pair.correction, found.centre);
  if (!moved.is_beyond_prior()) return {};
  std::string message = "the scan after was moved against the scan before by " +
                        readable(moved.shift, 2) + " m and " + degrees(moved.turn) +
                        ", more than one standpoint explains";
  if (!leaves_difference(pair.surfaces)) {
    return {{WarningCode::registration_beyond_prior,
             message +
                 "; it was brought back by the ground that did not change, which then fits to " +
                 readable(1000.0 * found.residual_sd, 2) + " mm"}};
  }
  return {{WarningCode::registration_beyond_prior,
           message + ", and the ground that did not change still differs by " +
               readable(1000.0 * found.residual_sd, 2) +
               " mm: give the transform of the scan after by `after_frame`",
           true}};
}

std::vector<Warning> check_tilt(const ScanPair& scans, const SurfacePair& surfaces,
                                const VolumeChange& change, const AreaChange& area) {
  constexpr double noted = 5.0 * degree;      // ours
  constexpr double doubtful = 12.0 * degree;  // ours: walls that overhang by less cost under 0.4 %
  constexpr double largest = 17.0 * degree;   // ours: slopes of 15 degrees are dug
  constexpr double upright = 93.0 * degree;   // ours: from pits that were tilted by a known angle
  if (scans.before.site_from_scan != Eigen::Matrix4d::Identity()) return {};
  const double tilt = tilt_of_stable(surfaces.before.height, area.zone);
  if (!(tilt > noted)) return {};
  const Walls walls = walls_of(change, area, surfaces.after.height);
  const bool may_overhang = walls.angle + tilt > upright || (tilt > doubtful && !walls.resolved);
  const bool ends = tilt > largest || may_overhang;
  return {{WarningCode::tilted,
           "the ground lies at " + degrees(tilt) + " to the plane z = 0" +
               (ends ? ", and walls of " + degrees(walls.angle) +
                           " may overhang there, which hides soil"
                     : ", of which the volumes are free") +
               ": if the scanner was not level, " + give_frames,
           ends}};
}

std::vector<Warning> check_machine(std::uint64_t machine_points, const VolumeChange& change) {
  constexpr double most_hidden = 0.05;  // ours, of a zone's cells: a heap's top is not guessed
  constexpr double least_volume = 0.1;  // ours, of its kind
  if (machine_points == 0) return {};
  for (const ChangeZone& zone : change.zones) {
    const bool is_dig = zone.kind == ZoneKind::dig;
    if (!is_dig && zone.kind != ZoneKind::dump) continue;
    const double all = is_dig ? change.excavated.value : change.dumped.value;
    if (zone.unknown_share < most_hidden || std::abs(zone.volume.value) < least_volume * all) {
      continue;
    }
    return {{WarningCode::machine_pose,
             readable(100.0 * zone.unknown_share, 2) + " % of the " + (is_dig ? "hole" : "heap") +
                 " are unseen with the machine taken out, " + std::to_string(machine_points) +
                 " points: its pose is wrong, or it hides what counts; scan with the machine aside",
             true}};
  }
  return {};
}

std::vector<Warning> check_curvature(const SurfacePair& surfaces, const AreaChange& area) {
  constexpr double longest = 15.0;  // [m], ours: cameras stand nearer
  constexpr double round = 0.35;    // ours: of the mean curvature, by which both differ from it
  constexpr double smooth = 0.15;   // ours: of the sagitta
  const Bowl bowl = bowl_of_stable(surfaces.before.height, area.zone);
  const double mean = 0.5 * (bowl.across + bowl.along);
  const double apart = std::hypot(0.5 * (bowl.across - bowl.along), bowl.twist);
  if (!(std::abs(mean) * longest > 1.0) || apart > round * std::abs(mean) ||
      bowl.rest_sd > smooth * bowl.sagitta) {
    return {};
  }
  return {
      {WarningCode::curved_ground,
       "the ground is part of a ball of " + readable(1.0 / std::abs(mean), 2) +
           " m radius, as where ranges are read as depths or depths as ranges: lengths are wrong "
           "by another factor in each part of the scan"}};
}

std::vector<Warning> check_volumes(const VolumeChange& change, double unit) {
  std::vector<Warning> found;
  const bool is_dig = change.excavated.value > 0.0;
  auto units = is_dig ? doubt_of_volume(change.excavated.value, "a hole", unit)
                      : doubt_of_volume(change.dumped.value, "a heap", unit);
  if (units) found.push_back(std::move(*units));
  return found;
}

std::vector<Warning> check_slopes(const std::vector<const SurfacePair*>& pairs,
                                  const VolumeChange& change) {
  constexpr double loose = 1.19;       // ours: tan 50 degrees; loose soil stands at 28 to 45
  constexpr double gentle = 1.0;       // ours: tan 45 degrees
  constexpr double steeper = 1.1;      // ours
  constexpr double least_lost = 0.03;  // ours, of the hole
  const double heap = steepness(pairs, change, ZoneKind::dump);
  const double hole = steepness(pairs, change, ZoneKind::dig);
  const bool lost = lost_beside_heap(change) > least_lost * change.excavated.value;
  if (!(heap > loose && hole < gentle) && !(lost && heap > steeper * hole)) return {};
  return {
      {WarningCode::looks_swapped,
       "the heap is as steep as " + degrees(std::atan(heap)) + ", the hole " +
           degrees(std::atan(hole)) + (lost ? ", and ground beside the heap fell" : "") +
           ", as if hole and heap were exchanged: check the order of BEFORE and AFTER, and if z "
           "points down, " +
           give_frames,
       true}};
}

void refuse_swapped(const VolumeChange& change, const std::string& names, double unit) {
  const auto refuse = [&](const std::string& message) {
    const auto units = doubt_of_volume(change.excavated.value, "a hole", unit);
    throw Error(ErrorKind::bad_file,
                names + ": " + message + (units ? "; " + units->message : std::string()));
  };
  for (const Warning& warning : change.warnings) {
    if (warning.code == WarningCode::looks_swapped) refuse(warning.message);
  }
  constexpr double much_lost = 0.2;  // ours, of the hole
  const double lost = lost_beside_heap(change);
  if (change.excavated.value > 0.0 && lost > much_lost * change.excavated.value) {
    refuse("before and after are probably swapped: the ground fell by " + readable(lost) +
           " m^3 beside what would be the heap, and by " + readable(change.excavated.value) +
           " m^3 where the hole would be; exchange BEFORE and AFTER, or if z points down, " +
           give_frames);
  }
  constexpr double least = 0.2;  // ours, of what moved at the dig
  if (change.areas.size() != 2) return;
  const Balance dig = balance_of(change.areas[0]);
  const Balance dump = balance_of(change.areas[1]);
  if (!(dump.fell > dump.rose) || dump.fell < least * std::max(dig.fell, dig.rose)) return;
  const bool both = dig.rose > dig.fell;
  refuse("before and after are probably swapped" + std::string(both ? "" : " in the dump area") +
         ": there the ground fell by " + readable(dump.fell) + " m^3 and rose by " +
         readable(dump.rose) + " m^3; exchange `dump_before` and `dump_after`" +
         (both ? ", BEFORE and AFTER; or if z points down, " + std::string(give_frames) : ""));
}

}  // namespace excavplan
