// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/job_map.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <excavplan/design/cut_and_fill.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "base/plan_geometry.hpp"
#include "base/statistics.hpp"
#include "design/design_checks.hpp"
#include "ground/window.hpp"

namespace excavplan {
namespace {

constexpr double least_seen = 0.99;  // of a finished design; ours

using Eigen::ArrayXXd;
using Eigen::Vector2d;

constexpr double flattest_face = 0.15;   // of a batter; ours [rad]
constexpr double wide_wall = 0.15;       // of a wall, so that it is none of the floor; ours [m]
constexpr double least_faces = 0.1;      // share of the design; ours
constexpr double of_no_floor = 0.005;    // share of cells taken for floor at each end; ours
constexpr double around_rim = 0.1;       // of a cell, where ground is compared; ours [m]
constexpr double share_of_design = 0.5;  // of a cell that is one of the design
const double steepest = CutOptions{}.steepest;

/// The cells whose middle lies in a polygon.
template <typename Visit>
void for_each_inside(const SitePolygon& polygon, const HeightMap& grid, Visit visit) {
  for_each_cell(grid.z, [&](Cell at) {
    if (is_inside(polygon, {grid.x(at.col), grid.y(at.row)})) visit(at);
  });
}

/// Those that it touches, as a cable or a pole may be narrower than a cell.
template <typename Visit>
void for_each_touched(const SitePolygon& polygon, const HeightMap& grid, Visit visit) {
  for_each_cell(grid.z, [&](Cell at) {
    if (is_near(polygon, {grid.x(at.col), grid.y(at.row)}, 0.5 * grid.cell_size)) visit(at);
  });
}

/// The design less its rim and its steep faces. @param share  of each cell that is in the design
Mask counting(const HeightMap& target, const ArrayXXd& share, double edge_margin) {
  const double cell = target.cell_size;
  const Mask asks_nothing = share >= share_of_design && target.z.isNaN();
  ArrayXXd gentle = asks_nothing.select(0.0, share);
  for_each_cell(target.z, [&](Cell at) {
    for_each_neighbour(target.z, at, [&](Cell next) {
      const double rise = std::abs(target.z(at.row, at.col) - target.z(next.row, next.col));
      if (rise > std::tan(steepest) * cell) gentle(at.row, at.col) = 0.0;
    });
  });
  return inner_cells(gentle, cell, edge_margin);
}

/// Whether a cell that counts is of a face which a dig along the heading does not make by itself;
/// those that rise along it count if `is_any`.
bool is_face(const HeightMap& target, Cell at, double heading, bool is_any) {
  const auto& z = target.z;
  if (on_border(z, at)) return false;
  const Vector2d aside(-std::sin(heading), std::cos(heading));
  const Vector2d slope = Vector2d(z(at.row, at.col + 1) - z(at.row, at.col - 1),
                                  z(at.row + 1, at.col) - z(at.row - 1, at.col)) /
                         (2.0 * target.cell_size);
  return (is_any ? slope.norm() : std::abs(slope.dot(aside))) > std::tan(flattest_face);
}

/// Share of such cells.
double share_of_faces(const JobMap& map, double heading, bool is_any) {
  int faces = 0;
  int count = 0;
  for_each_cell(map.counts, [&](Cell at) {
    if (!map.counts(at.row, at.col)) return;
    ++count;
    if (is_face(map.target, at, heading, is_any)) ++faces;
  });
  return count > 0 ? static_cast<double>(faces) / count : 0.0;
}

/// Of the cells that count and are no face; a few of them along edges of faces do not tell.
AcrossLine floor_of(const JobMap& map, const JobFrame& frame) {
  std::vector<double> beside;
  for_each_cell(map.counts, [&](Cell at) {
    if (map.counts(at.row, at.col) && !is_face(map.target, at, frame.heading, true))
      beside.push_back(frame.of({map.target.x(at.col), map.target.y(at.row)}).y());
  });
  if (beside.empty()) return {frame.right, frame.left};
  return {quantile(beside, of_no_floor), quantile(beside, 1.0 - of_no_floor)};
}

/// A bucket's lane does not reach into walls that are too steep to count: only its floor has lanes.
/// @param rim  of the floor that does not count [m]
void keep_to_floor(const JobMap& map, double rim, JobFrame& frame) {
  Eigen::AlignedBox1d floor;
  for_each_cell(map.counts, [&](Cell at) {
    if (map.counts(at.row, at.col))
      floor.extend(frame.of({map.target.x(at.col), map.target.y(at.row)}).tail<1>());
  });
  if (floor.isEmpty()) return;
  const double right = floor.min()(0) - rim, left = floor.max()(0) + rim;
  if (right - frame.right > wide_wall) frame.right = right;
  if (frame.left - left > wide_wall) frame.left = left;
}

/// Where the design does not lie below the ground, it asks for nothing; each cell by the mean
/// around it, since a scan has noise.
ArrayXXd below_ground(const ArrayXXd& design, const HeightMap& ground) {
  const ArrayXXd over = ground.z - design;
  const AreaSums sums(without_nan(over, 0.0));
  const AreaSums known((!over.isNaN()).cast<double>());
  const auto radius = static_cast<Eigen::Index>(std::floor(around_rim / ground.cell_size + 1e-9));
  ArrayXXd below = design;
  for_each_cell(design, [&](Cell at) {
    if (known.around(at, radius) > 0.0 && !(sums.around(at, radius) > 0.0))
      below(at.row, at.col) = std::nan("");
  });
  return below;
}

}  // namespace

void require_job_settings(const JobSettings& settings) {
  require_job(settings.design);
  require_machine(settings.site.machine);
  require_soil(settings.site.soil);
  require(settings.design.start.has_value(), "job: the machine's start is not told");
  require(settings.site.machine.swing && settings.site.machine.engine,
          "job: machine " + settings.site.machine.name + " states no swing or no engine");
  require_in("job: density [%]", settings.density_percent, 0.0, 100.0);
  require_in("job: price of a second [W]", settings.time_price, 0.0, 1e6);
}

Scan first_scan(const JobDesign& design) {
  require(!design.scan_file.empty(), "job " + design.name + " names no first scan");
  Scan scan;
  scan.files = {design.scan_file};
  scan.z_is_up = true;
  return scan;
}

ArrayXXd raised(const ArrayXXd& design, const HeightMap& grid, const Eigen::Vector3d& over) {
  ArrayXXd heights = design;
  for_each_cell(design, [&](Cell at) {
    double& height = heights(at.row, at.col);
    height = height + over.x() + over.y() * grid.x(at.col) + over.z() * grid.y(at.row);
  });
  return heights;
}

double surface_of(const Terrain& ground, Cell at) {
  return ground.bank.z(at.row, at.col) + ground.loose(at.row, at.col);
}

double above_design(const JobMap& map, const Terrain& ground, Cell at) {
  return surface_of(ground, at) - map.target.z(at.row, at.col);
}

JobMap map_of(const JobSettings& settings, const HeightMap& ground) {
  const JobDesign& design = settings.design;
  JobMap map;
  map.target = ground;
  map.before = ground.z;
  const DesignCover cover = cover_of(settings.surface, ground);
  map.target.z =
      below_ground((cover.share >= share_of_design).select(cover.height, std::nan("")), ground);
  map.counts = counting(map.target, cover.share, design.edge_margin);
  map.beyond = area_beyond(settings.surface, cover, ground) / (ground.cell_size * ground.cell_size);
  map.dump = Mask::Constant(ground.z.rows(), ground.z.cols(), false);
  for (const DumpArea& area : design.dump_areas) {
    for_each_inside(area.polygon, ground, [&](Cell at) { map.dump(at.row, at.col) = true; });
  }
  map.forbidden = ArrayXXd::Constant(ground.z.rows(), ground.z.cols(), -infinity);
  for (const KeepOut& area : design.keep_out) {
    for_each_touched(area.polygon, ground, [&](Cell at) {
      double& level = map.forbidden(at.row, at.col);
      const double highest = ground.z(at.row, at.col) - area.depth.value_or(-infinity);
      level = std::max(level, std::isnan(highest) ? infinity : highest);
    });
  }
  for (const JobObstacle& obstacle : design.obstacles) {
    for_each_touched(obstacle.polygon, ground,
                     [&](Cell at) { map.forbidden(at.row, at.col) = infinity; });
  }
  map.untouched = map.forbidden == infinity;
  map.dump = map.dump && !map.untouched;
  return map;
}

bool JobFrame::has_faces_across() const { return faces_across > least_faces; }

Vector2d JobFrame::place(double along, double beside) const {
  return PlanFrame(origin, heading).place(along, beside);
}

Vector2d JobFrame::of(const Vector2d& place) const { return PlanFrame(origin, heading).of(place); }

JobFrame frame_of(const JobSettings& settings, const JobMap& map, double turned) {
  const BasePose& start = *settings.design.start;
  JobFrame frame;
  frame.origin = {start.x, start.y};
  frame.heading = wrapped(start.heading + turned);
  Eigen::AlignedBox2d box;
  for_each_cell(map.target.z, [&](Cell at) {
    if (std::isnan(map.target.z(at.row, at.col))) return;
    box.extend(frame.of({map.target.x(at.col), map.target.y(at.row)}));
  });
  if (box.isEmpty()) refuse("job: the design covers no cell of the ground");
  const double half = 0.5 * map.target.cell_size;  // of cells at the rim, half of them are within
  frame.near = box.min().x() - half;
  frame.far = box.max().x() + half;
  frame.right = box.min().y() - half;
  frame.left = box.max().y() + half;
  keep_to_floor(map, settings.design.edge_margin + half, frame);
  frame.is_battered = share_of_faces(map, frame.heading, true) > least_faces;
  frame.faces_across = share_of_faces(map, frame.heading, false);
  frame.floor = floor_of(map, frame);
  return frame;
}

AcrossLine across_below(const JobMap& map, const JobFrame& frame, double height) {
  Eigen::AlignedBox1d box;
  for_each_cell(map.target.z, [&](Cell at) {
    if (map.target.z(at.row, at.col) < height)
      box.extend(frame.of({map.target.x(at.col), map.target.y(at.row)}).tail<1>());
  });
  const double half = 0.5 * map.target.cell_size;
  if (box.isEmpty()) return {frame.right, frame.left};
  return {box.min()(0) - half, box.max()(0) + half};
}

JobFrame reversed(const JobFrame& frame) {
  JobFrame back = frame;
  back.heading = wrapped(frame.heading + pi);
  back.near = -frame.far;
  back.far = -frame.near;
  back.right = -frame.left;
  back.left = -frame.right;
  back.floor = {-frame.floor.left, -frame.floor.right};
  return back;
}

std::vector<double> above_design_around(const JobMap& map, const Terrain& ground, Cell cell) {
  std::vector<double> above;
  const auto add = [&](Cell at) {
    const double one = map.counts(at.row, at.col) ? above_design(map, ground, at) : std::nan("");
    if (!std::isnan(one)) above.push_back(one);
  };
  add(cell);
  for_each_neighbour(map.counts, cell, add);
  return above;
}

JobProgress measured(JobProgress progress, const JobMap& map, const MeasuredGround& now,
                     double tolerance) {
  progress.left_volume = 0.0;
  const double area = map.target.cell_size * map.target.cell_size;
  std::vector<double> errors;
  double squares = 0.0;
  int cells = 0;
  int seen = 0;
  int beyond = 0;
  for_each_cell(map.target.z, [&](Cell at) {
    if (std::isnan(map.target.z(at.row, at.col))) return;
    ++cells;
    const double error = above_design(map, now.terrain, at);
    if (std::isnan(error)) return;
    progress.left_volume += area * std::max(0.0, error);
    if (std::isnan(now.seen(at.row, at.col))) return;
    ++seen;
    if (!map.counts(at.row, at.col)) return;
    errors.push_back(std::abs(error));
    squares += error * error;
    if (std::abs(error) > 2.0 * tolerance) ++beyond;
  });
  progress.seen = cells > 0 ? seen / (cells + map.beyond) : 0.0;
  progress.rms = progress.p95 = progress.beyond_twice = std::nan("");
  if (errors.empty()) return progress;
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  progress.rms = std::sqrt(squares / count);
  progress.p95 = errors[static_cast<std::size_t>(0.95 * (count - 1.0))];
  progress.beyond_twice = beyond / count;
  progress.is_finished = progress.p95 <= tolerance && progress.beyond_twice <= most_beyond_twice &&
                         progress.seen >= least_seen;
  return progress;
}

}  // namespace excavplan
