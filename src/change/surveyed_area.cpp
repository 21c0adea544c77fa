// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/surveyed_area.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <excavplan/base/error.hpp>

#include "change/dug_ground.hpp"
#include "change/relief.hpp"
#include "change/shadow_filling.hpp"
#include "change/systematic_errors.hpp"
#include "change/zone_filling.hpp"
#include "ground/grid_cells.hpp"
#include "ground/sampling_gaps.hpp"
#include "ground/sight_lines.hpp"
#include "ground/slopes.hpp"
#include "ground/too_few_cells.hpp"

namespace excavplan {
namespace {

constexpr Eigen::Index fewest_known_cells = 100;
constexpr double gentle = 0.5;  // ours: unseen soil beyond the edge of a scan lies steeper [-]
constexpr double steep_face =
    1.0;  // ours: on gentler faces the cells are averages of enough points [-]
/// Error of the position of a steep face in a lattice of points, as a share of its spacing and the
/// same along the whole face; ours, from pits with upright walls under simulated cameras.
constexpr double face_place = 0.15;

/// Of what lies within a cell of the border between a hole and soil beside it, the share that each
/// may hide of the other; ours, from simulated digs that leave soil at the edge of the hole.
constexpr double hidden_at_border = 0.1;

/// What filled a cell that the scan after does not show.
enum FilledBy : int { nothing = 0, sight = 1, path = 2 };

/// Sums the difference over each zone: area, volume, place.
void sum_zones(Area& area, const Eigen::ArrayXXi& filled) {
  const HeightMap& grid = area.grid;
  const ChangedGround& ground = area.ground;
  const double cell_area = grid.cell_size * grid.cell_size;
  for_each_cell(ground.zone, [&](Cell cell) {
    const int index = ground.zone(cell.row, cell.col);
    if (index < 0) return;
    ZoneSum& zone = area.zones[static_cast<std::size_t>(index)];
    const Eigen::Vector2d place(grid.x(cell.col), grid.y(cell.row));
    const double half = 0.5 * grid.cell_size;
    if (zone.area == 0.0) zone.extent = {place.x(), place.y(), place.x(), place.y()};
    zone.extent = {std::min(zone.extent.x_min, place.x() - half),
                   std::min(zone.extent.y_min, place.y() - half),
                   std::max(zone.extent.x_max, place.x() + half),
                   std::max(zone.extent.y_max, place.y() + half)};
    zone.volume += cell_area * ground.difference(cell.row, cell.col);
    zone.area += cell_area;
    zone.centre += cell_area * place;
    if (area.unknown(cell.row, cell.col) != 0) zone.unknown += cell_area;
    if (filled(cell.row, cell.col) == sight) zone.shadow += cell_area;
    if (filled(cell.row, cell.col) == path) zone.swept += cell_area;
  });
  for (std::size_t i = 0; i < area.zones.size(); ++i) {
    if (area.zones[i].area > 0.0) area.zones[i].centre /= area.zones[i].area;
    area.zones[i].is_cut = ground.zone_is_cut[i];
  }
}

/// Noise of each cell: that of stable ground, or more where its points scatter more.
Eigen::ArrayXXd noise_of_cells(const Eigen::ArrayXXd& variance, const Area& area) {
  const double stable = area.noise.white;
  const auto& z = area.ground.difference;
  if (variance.size() == 0) return Eigen::ArrayXXd::Constant(z.rows(), z.cols(), stable);
  return (variance > stable).select(variance, stable);  // also where it is NaN
}

/// How regularly points lie: 0 for random points, whose counts in two cells differ by the square
/// root of their sum; towards 1 for a lattice, as of a camera.
double regularity_of(const Surface& scan, const Eigen::ArrayXXi& zone) {
  const Eigen::ArrayXXi& points = scan.points;
  const Eigen::ArrayXXd& z = scan.height.z;
  double squares = 0.0;
  double sums = 0.0;
  for_each_cell(points, [&](Cell at) {
    if (at.row == 0 || zone(at.row, at.col) >= 0 || zone(at.row - 1, at.col) >= 0) return;
    const double one = points(at.row - 1, at.col);
    const double two = points(at.row, at.col);
    if (std::isnan(z(at.row - 1, at.col)) || std::isnan(z(at.row, at.col))) return;
    squares += (one - two) * (one - two);
    sums += one + two;
  });
  return sums > 0.0 ? std::max(0.0, 1.0 - squares / sums) : 0.0;
}

/// Error of each zone by the steep faces of a scan: their area seen from the side times the error
/// of their position. Random points err independently in each cell, which the noise of the cells
/// contains; rows of points along a face have the same error.
void sum_faces(Area& area, const Surface& scan) {
  if (scan.points.size() == 0) return;
  const std::size_t zones = area.zones.size();
  std::vector<double> faces(zones, 0.0);
  std::vector<double> points(zones, 0.0);
  const Gradient gradient = gradient_of(scan.height);
  const double regularity = regularity_of(scan, area.ground.zone);
  const double cell_size = area.grid.cell_size;
  const double least = std::max(steep_face, 2.0 * area.ground.noise_sd / cell_size);
  for_each_cell(area.ground.zone, [&](Cell at) {
    const int index = area.ground.zone(at.row, at.col);
    if (index < 0) return;
    const auto i = static_cast<std::size_t>(index);
    points[i] += scan.points(at.row, at.col);
    const double slope = std::hypot(gradient.x(at.row, at.col), gradient.y(at.row, at.col));
    if (slope > least) faces[i] += slope * cell_size * cell_size;
  });
  for (std::size_t i = 0; i < zones; ++i) {
    if (faces[i] == 0.0 || points[i] == 0.0) continue;
    const double spacing = std::sqrt(area.zones[i].area / points[i]);
    area.zones[i].faces += regularity * std::pow(face_place * spacing * faces[i], 2);
  }
}

/// Error of each zone by what lies between the points of a sparse scan.
void sum_between(Area& area, const Surface& scan) {
  const std::vector<double> variance =
      variance_between_points(scan, area.ground.zone, area.zones.size());
  if (scan.points.size() == 0) return;
  const double irregularity = 1.0 - regularity_of(scan, area.ground.zone);
  for (std::size_t i = 0; i < area.zones.size(); ++i)
    area.zones[i].faces += irregularity * variance[i];
}

/// Error of zones that touch: a cell on their border takes in soil that was lost and soil that was
/// gained, and shows the difference.
void sum_borders(Area& area) {
  const auto& zone = area.ground.zone;
  const auto& difference = area.ground.difference;
  const double cell_area = area.grid.cell_size * area.grid.cell_size;
  std::vector<double> hidden(area.zones.size(), 0.0);
  for_each_cell(zone, [&](Cell at) {
    const int index = zone(at.row, at.col);
    if (index < 0) return;
    for_each_neighbour(zone, at, [&](Cell n) {
      const int other = zone(n.row, n.col);
      if (other < 0 || other == index) return;
      const auto is_layer = [&](int i) {
        return area.ground.zone_is_layer[static_cast<std::size_t>(i)];
      };
      if (is_layer(index) || is_layer(other)) return;  // hides next to nothing
      const double step = std::abs(difference(at.row, at.col) - difference(n.row, n.col));
      if (step > 0.0) hidden[static_cast<std::size_t>(index)] += cell_area * step;
    });
  });
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    area.zones[i].faces += std::pow(hidden_at_border * hidden[i], 2);
  }
}

/// Soil of rises beyond the edge of the survey, by how they fall towards it.
class BeyondEdge {
 public:
  explicit BeyondEdge(const Area& area) : area_(area), z_(area.ground.difference) {
    const double of_mean = area.noise.white / 9.0 + area.noise.correlated;
    least_ = sure_by * std::sqrt(of_mean);
  }

  bool is_edge(Cell at) const {
    bool edge = on_border(z_, at);
    for_each_neighbour(z_, at, [&](Cell n) { edge = edge || is_beyond(n); });
    return edge;
  }

  /// Twice a face as steep as the soil is between the height near the edge and twice that; infinite
  /// where it does not fall so, or was not seen [m^3].
  double volume_at(Cell edge) const {
    const Cell inward = inward_of(edge);
    if (inward.row == 0 && inward.col == 0) return unbounded;
    const double cell = area_.grid.cell_size;
    const double step = cell * std::hypot(inward.row, inward.col);
    const auto mean_at = [&](Eigen::Index steps) {
      return mean_of_seen({edge.row + steps * inward.row, edge.col + steps * inward.col});
    };
    const double at_edge = mean_at(0);
    const double height = std::fmax(at_edge, mean_at(off_rim));
    if (std::isnan(height)) return unbounded;
    if (height < least_) return 0.0;
    const auto most = static_cast<Eigen::Index>(height / gentlest / step) + 2;
    for (Eigen::Index i = 1; i <= most; ++i) {
      const double there = mean_at(off_rim + i);
      if (std::isnan(at_edge + there)) return unbounded;
      const double run = step * static_cast<double>(i);
      if (there >= 2.0 * height) return cell * at_edge * at_edge * run / height;
    }
    return unbounded;
  }

 private:
  static constexpr double unbounded = std::numeric_limits<double>::infinity();
  static constexpr double sure_by = 2.0;      // ours: standard deviations of a mean
  static constexpr double gentlest = 0.35;    // ours: 19 degrees, loose soil lies at 28 or steeper
  static constexpr Eigen::Index off_rim = 2;  // cells: those at the edge are seen in part

  bool is_inside(Cell at) const {
    return at.row >= 0 && at.col >= 0 && at.row < z_.rows() && at.col < z_.cols();
  }
  bool is_beyond(Cell at) const { return !is_inside(at) || std::isnan(z_(at.row, at.col)); }

  /// Away from what is beyond, to one of eight cells around; 0 where that is on all sides alike.
  Cell inward_of(Cell at) const {
    Cell sum = {0, 0};
    for (Eigen::Index row = -1; row <= 1; ++row) {
      for (Eigen::Index col = -1; col <= 1; ++col) {
        if (!is_beyond({at.row + row, at.col + col})) continue;
        sum.row -= row;
        sum.col -= col;
      }
    }
    const auto most = std::max(std::abs(sum.row), std::abs(sum.col));
    const auto direction = [&](Eigen::Index part) {
      return 2 * std::abs(part) <= most ? 0 : part > 0 ? 1 : -1;
    };
    return {direction(sum.row), direction(sum.col)};
  }

  /// Of nine cells [m]; NaN where none was seen.
  double mean_of_seen(Cell at) const {
    if (!is_inside(at)) return std::nan("");
    double sum = 0.0;
    double count = 0.0;
    for_each_around(z_, at, 1, [&](Cell n) {
      if (is_beyond(n) || area_.unknown(n.row, n.col) != 0) return;
      sum += z_(n.row, n.col);
      count += 1.0;
    });
    return sum / count;
  }

  const Area& area_;
  const Eigen::ArrayXXd& z_;
  double least_ = 0.0;  // heights below are noise [m]
};

/// Volume that may be missing of zones at the edge of the survey: soil that goes on as it falls
/// there, or where that is not seen meets the ground by a gentle slope.
void sum_beyond_edge(Area& area) {
  const double cell_size = area.grid.cell_size;
  std::vector<double> missing(area.zones.size(), 0.0);
  std::vector<bool> has_edge(area.zones.size(), false);
  const auto& zone = area.ground.zone;
  const BeyondEdge beyond(area);
  for_each_cell(zone, [&](Cell at) {
    if (zone(at.row, at.col) < 0) return;
    const auto index = static_cast<std::size_t>(zone(at.row, at.col));
    if (!area.zones[index].is_cut || !beyond.is_edge(at)) return;
    const double height = area.ground.difference(at.row, at.col);
    const double told = area.zones[index].volume > 0.0 ? beyond.volume_at(at)
                                                       : std::numeric_limits<double>::infinity();
    has_edge[index] = true;
    area.zones[index].beyond_edge += told;
    missing[index] += std::isfinite(told) ? told : cell_size * 0.5 * height * height / gentle;
  });
  for (std::size_t i = 0; i < missing.size(); ++i) {
    area.zones[i].holes += std::pow(missing[i], 2);
    if (area.zones[i].is_cut && !has_edge[i])
      area.zones[i].beyond_edge = std::numeric_limits<double>::infinity();
  }
}

/// Error of zones against a wall, whose face is somewhere in cells that were left out: up to half a
/// cell of the soil along it, which is what their filling holds.
void sum_walls(Area& area, const Eigen::ArrayXXd& before) {
  const double cell_area = area.grid.cell_size * area.grid.cell_size;
  std::vector<double> uncertain(area.zones.size(), 0.0);
  for_each_cell(area.ground.zone, [&](Cell at) {
    const int index = area.ground.zone(at.row, at.col);
    if (index < 0 || !std::isnan(before(at.row, at.col)) || !is_beside_wall(before, at)) return;
    uncertain[static_cast<std::size_t>(index)] +=
        cell_area * std::abs(area.ground.difference(at.row, at.col));
  });
  for (std::size_t i = 0; i < uncertain.size(); ++i) {
    area.zones[i].faces += std::pow(uncertain[i], 2);
  }
}

/// Error of soil by its edge that is too thin to tell from noise and runs out beyond the margin of
/// the zone.
void sum_thin(Area& area, const ChangeOptions& options) {
  constexpr double scattered = 0.3;  // ours: slope of soil that thins out [-]
  const double cell_size = area.grid.cell_size;
  const double least = options.growth * area.ground.smooth_sd;
  const double beyond = least / scattered - zone_margin(options, cell_size, area.ground.smooth_sd);
  if (!(beyond > 0.0)) return;
  const auto& zone = area.ground.zone;
  std::vector<double> edge(area.zones.size(), 0.0);
  for_each_cell(zone, [&](Cell at) {
    if (zone(at.row, at.col) < 0) return;
    for_each_neighbour(zone, at, [&](Cell n) {
      if (zone(n.row, n.col) < 0) edge[static_cast<std::size_t>(zone(at.row, at.col))] += cell_size;
    });
  });
  for (std::size_t i = 0; i < edge.size(); ++i) {
    if (!(area.zones[i].volume > 0.0)) continue;
    area.zones[i].thin = std::pow(edge[i] * 0.5 * beyond * beyond * scattered, 2);
  }
}

/// One area's scans, with motion and objects taken out.
struct Scans {
  HeightMap before;
  HeightMap after;
  Eigen::ArrayXXi mixed;  // 1 where returns after were mixed and dropped
  Surface places;         // sensors of the scan after, and what each saw
  std::optional<SensorPlace> inferred;
  Eigen::ArrayXXd variance_before;  // of each cell [m^2]; both empty where unknown
  Eigen::ArrayXXd variance_after;

  /// Of a cell of after - before - share * before.
  Eigen::ArrayXXd variance_of(double share) const {
    return std::pow(1.0 + share, 2) * variance_before + variance_after;
  }
  /// Of the noise of a cell's difference, what the surface before made; half where nothing tells.
  double share_before(Cell at) const {
    constexpr double half = 0.5;
    if (variance_before.size() == 0) return half;
    const double own = variance_before(at.row, at.col);
    const double share = own / (own + variance_after(at.row, at.col));
    return std::isnan(share) ? half : share;
  }
};

/// Noise of the cells of each zone.
void sum_noise(Area& area, const Eigen::ArrayXXd& noise, const Scans& scans) {
  const double cell_area = area.grid.cell_size * area.grid.cell_size;
  for_each_cell(area.ground.zone, [&](Cell cell) {
    const int index = area.ground.zone(cell.row, cell.col);
    if (index < 0 || area.unknown(cell.row, cell.col) != 0) return;
    const double own = cell_area * cell_area * noise(cell.row, cell.col);
    ZoneSum& zone = area.zones[static_cast<std::size_t>(index)];
    zone.noise += own;
    zone.before += own * scans.share_before(cell);
  });
}

/// Where nothing says where the sensor stood, the scan itself may.
std::optional<SensorPlace> complete_place(Surface& surface) {
  if (!surface.sensors.empty()) return std::nullopt;
  std::optional<SensorPlace> inferred = infer_sensor(surface);
  if (inferred) surface.sensors = {inferred->place()};
  return inferred;
}

Scans prepared(const SurfacePair& pair, const ChangeOptions& options, const Eigen::ArrayXXi& dug,
               std::vector<Object>& objects) {
  if (!same_grid(pair.before.height, pair.after.height)) {
    throw Error(ErrorKind::bad_input,
                "the maps before and after must be on one grid: same origin, cell and size");
  }
  Surface before = pair.before;
  Surface after = pair.after;
  complete_place(before);
  drop_mixed_returns(before);
  const std::optional<SensorPlace> inferred = complete_place(after);
  const Eigen::ArrayXXi mixed = drop_mixed_returns(after);
  Scans scans{before.height,
              realigned(after.height, pair.alignment),
              mixed,
              {{}, {}, {}, after.sensors, after.seen_from},
              inferred,
              {},
              {}};
  const bool told = before.variance.size() == scans.before.z.size() &&
                    after.variance.size() == scans.after.z.size();
  if (told) {
    scans.variance_before = before.variance;
    scans.variance_after = after.variance;
  }
  objects = take_out_objects(scans.before.z, scans.after.z, scans.before.cell_size,
                             options.margin / scans.before.cell_size, dug);
  const Eigen::ArrayXXd difference = scans.after.z - scans.before.z;
  const Eigen::Index known = difference.size() - difference.isNaN().count();
  if (known < fewest_known_cells) {
    throw TooFewCells("the maps before and after share " + std::to_string(known) + " known cells",
                      fewest_known_cells, scans.before.cell_size);
  }
  return scans;
}

/// The change, found where systematic errors are taken off: they would hide what is lower than they
/// are. They are still in its difference.
ChangedGround change_in(const Eigen::ArrayXXd& difference, const Eigen::ArrayXXd& variance,
                        double cell_size, const ChangeOptions& options) {
  constexpr int most_rounds = 4;
  ChangedGround found = find_change(difference, variance, cell_size, options);
  for (int round = 0; round < most_rounds; ++round) {
    ChangedGround flat = found;
    take_systematic_off(flat, cell_size);
    const Eigen::ArrayXXd errors =
        flat.difference.isNaN().select(0.0, found.difference - flat.difference);
    if ((errors == 0.0).all()) break;
    ChangedGround next = find_change(difference - errors, variance, cell_size, options);
    const bool is_settled = (next.zone == found.zone).all();
    found = std::move(next);
    found.difference += errors;
    found.residual += errors;
    if (is_settled) break;
  }
  return found;
}

/// Sums, for each zone, what outliers leave in its volume that are as many as on even ground [m^3].
Eigen::VectorXd outlier_volumes(const SurfacePair& pair, const Area& area) {
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(area.zones.size()));
  const Eigen::ArrayXXf& before = pair.before.outlier_bias;
  const Eigen::ArrayXXf& after = pair.after.outlier_bias;
  const auto cells = area.unknown.size();
  if (before.size() != cells || after.size() != cells) return volumes;
  for_each_cell(area.unknown, [&](Cell at) {
    const int zone = area.ground.zone(at.row, at.col);
    if (zone < 0 || area.unknown(at.row, at.col) != 0) return;
    volumes(zone) += static_cast<double>(after(at.row, at.col) - before(at.row, at.col));
  });
  return volumes * area.grid.cell_size * area.grid.cell_size;
}

struct UnseenFilling {
  Eigen::ArrayXXi by;            ///< FilledBy
  std::vector<double> variance;  ///< of the sum of the filled heights, by zone [m^2]
};

/// Fills what the scan after does not show, as far as path and sensors tell how it lies.
UnseenFilling fill_unseen(Scans& scans, const KnownGround* known, Area& area) {
  UnseenFilling filling;
  filling.variance.assign(area.ground.zone_is_cut.size(), 0.0);
  const auto is_filled = [&] {
    return area.unknown != 0 && !(scans.after.z - scans.before.z).isNaN();
  };
  Eigen::ArrayXXd lowest;
  if (known != nullptr) {
    lowest = lowest_change(*known);
    filling.variance = fill_swept(*known, lowest, scans.before, scans.after, area.ground);
  }
  filling.by = is_filled().select(
      Eigen::ArrayXXi::Constant(area.unknown.rows(), area.unknown.cols(), path), 0);
  if (scans.places.sensors.empty()) return filling;
  const std::vector<double> of_shadows = fill_shadows(
      {scans.before, scans.after, scans.mixed, scans.places, scans.inferred, lowest}, area.ground);
  for (std::size_t i = 0; i < of_shadows.size(); ++i) filling.variance[i] += of_shadows[i];
  filling.by = (is_filled() && filling.by == nothing).select(sight, filling.by).eval();
  return filling;
}

/// Error of zones on ground of which no survey shows how it was before.
void sum_guessed(Area& area, const KnownGround& known) {
  if (known.guessed_sd.size() == 0) return;
  const double cell_area = area.grid.cell_size * area.grid.cell_size;
  std::vector<double> guessed(area.zones.size(), 0.0);
  for_each_cell(area.ground.zone, [&](Cell at) {
    const int index = area.ground.zone(at.row, at.col);
    const double sd = known.guessed_sd(at.row, at.col);
    if (index >= 0 && sd > 0.0) guessed[static_cast<std::size_t>(index)] += cell_area * sd;
  });
  for (std::size_t i = 0; i < guessed.size(); ++i) area.zones[i].holes += std::pow(guessed[i], 2);
}

/// The errors that each zone has of its own.
void sum_own_errors(Area& area, const SurfacePair& pair, const Scans& scans,
                    const Eigen::ArrayXXd& variance, const ChangeOptions& options) {
  const Eigen::ArrayXXd noise = noise_of_cells(variance, area);
  area.variance = noise + area.noise.correlated;
  sum_noise(area, noise, scans);
  sum_beyond_edge(area);
  for (const Surface* surface : {&pair.before, &pair.after}) {
    sum_faces(area, *surface);
    sum_between(area, *surface);
  }
  sum_borders(area);
  sum_walls(area, scans.before.z);
  sum_thin(area, options);
}

/// Those that zones share, with what the stable ground predicts of them taken off the volumes.
void predict_errors(Area& area, const HeightMap& before, const Alignment& left) {
  area.errors = ErrorField{before,           area.ground.residual,
                           area.ground.zone, static_cast<int>(area.zones.size()),
                           area.noise,       left}
                    .predict();
  for (std::size_t i = 0; i < area.zones.size(); ++i) {
    area.zones[i].volume -= area.errors.mean(static_cast<Eigen::Index>(i));
  }
}

}  // namespace

Area survey(const SurfacePair& pair, const ChangeOptions& options, const KnownGround* known) {
  Area area;
  const Eigen::ArrayXXi dug = known != nullptr ? dug_before(*known) : Eigen::ArrayXXi();
  Scans scans = prepared(pair, options, dug, area.objects);
  area.place_before = doubt_of_place(pair.before);
  area.place_after = doubt_of_place(pair.after);
  area.grid.origin = scans.before.origin;
  area.grid.cell_size = scans.before.cell_size;
  const Eigen::ArrayXXd difference = scans.after.z - scans.before.z;
  area.inferred = scans.inferred;
  area.unknown = difference.isNaN().cast<int>();
  area.ground = change_in(difference, scans.variance_of(0.0), scans.before.cell_size, options);
  area.parts = part_zones(area.ground, area.grid.cell_size);
  area.zones.resize(area.ground.zone_is_cut.size());
  area.kinds.assign(area.zones.size(), ZoneKind::other);

  const UnseenFilling unseen = fill_unseen(scans, known, area);
  const ZoneFilling filling = fill_zones(scans.before.z, scans.after.z, area.ground);
  const double cell_area = area.grid.cell_size * area.grid.cell_size;
  for (std::size_t i = 0; i < area.zones.size(); ++i) {
    area.zones[i].holes = (filling.variance[i] + unseen.variance[i]) * cell_area * cell_area;
  }
  area.ground.difference = filling.difference;

  Alignment left = pair.alignment;
  const double share = take_relief_off(scans.before, area.ground, left);
  const Systematic systematic = take_systematic_off(area.ground, area.grid.cell_size);
  area.systematic_rms = systematic.rms;
  sum_zones(area, unseen.by);
  if (known != nullptr) {
    area.swept_unseen = (unseen.by == path).cast<int>();
    sum_guessed(area, *known);
  }
  area.noise = find_noise(area.ground.residual, area.grid.cell_size);
  area.noise.white = std::max(area.noise.white, least_noise * least_noise);
  sum_own_errors(area, pair, scans, scans.variance_of(share), options);
  predict_errors(area, scans.before, left);
  area.outliers = outlier_volumes(pair, area);
  area.errors.correlated += systematic.left * cell_area * cell_area;
  area.errors.correlated += area.outliers * area.outliers.transpose();
  return area;
}

}  // namespace excavplan
