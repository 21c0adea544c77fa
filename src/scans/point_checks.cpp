// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/point_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/non_finite.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "clouds/points_by_cell.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

/// What a surface tells of its heights; zero where it has none.
Eigen::ArrayXXf known(const Eigen::ArrayXXf& values, const Surface& surface) {
  const Eigen::ArrayXXd& z = surface.height.z;
  if (values.size() != z.size()) return Eigen::ArrayXXf::Zero(z.rows(), z.cols());
  return z.isNaN().select(0.0F, values);
}

/// -1 in the hole, 1 in spill and heap, 0 elsewhere.
Eigen::ArrayXXi parts_of(const VolumeChange& change, const AreaChange& area) {
  Eigen::ArrayXXi part = Eigen::ArrayXXi::Zero(area.zone.rows(), area.zone.cols());
  for_each_cell(part, [&](Cell at) {
    const int zone = area.zone(at.row, at.col);
    if (zone < 0) return;
    const ZoneKind kind = change.zones[static_cast<std::size_t>(zone)].kind;
    if (kind != ZoneKind::other) part(at.row, at.col) = kind == ZoneKind::dig ? -1 : 1;
  });
  return part;
}

double ratio(double part, double all) { return all > 0.0 ? part / all : 0.0; }

/// Parts with the ground beside them whose doubt grew: the lower of its two surfaces may be the
/// ground before.
Eigen::ArrayXXi with_doubt_beside(Eigen::ArrayXXi part, const Eigen::ArrayXXf& growth) {
  std::vector<Cell> front;
  for_each_cell(part, [&](Cell at) {
    if (part(at.row, at.col) != 0) front.push_back(at);
  });
  for (std::size_t next = 0; next < front.size(); ++next) {
    const int here = part(front[next].row, front[next].col);
    for_each_neighbour(part, front[next], [&](Cell n) {
      if (part(n.row, n.col) != 0 || !(growth(n.row, n.col) > 0.0F)) return;
      part(n.row, n.col) = here;
      front.push_back(n);
    });
  }
  return part;
}

/// Volumes that points put in doubt [m^3].
struct DoubtfulVolume {
  double hole = 0.0;
  double soil = 0.0;  ///< spill and heap
  double in_before = 0.0;
  double in_after = 0.0;

  double& of(int part) { return part < 0 ? hole : soil; }
  double sum() const { return hole + soil; }
  const char* scan() const { return in_after > in_before ? "after" : "before"; }
  double share_of(const VolumeChange& change) const {
    return std::abs(ratio(hole, change.before.value) + ratio(soil, change.after.value));
  }
};

// Of doubt that is new after the dig, ours: nothing grows on dug soil, so that either surface may
// be it, and points of another time also lie where the scan sees none of its own.
constexpr double weight_of_new = 3.0;

void add_overlays(const SurfacePair& surfaces, const Eigen::ArrayXXi& parts,
                  DoubtfulVolume& doubt) {
  const Eigen::ArrayXXf of_before = known(surfaces.before.doubt, surfaces.before);
  const Eigen::ArrayXXf of_after = known(surfaces.after.doubt, surfaces.after);
  const Eigen::ArrayXXi part = with_doubt_beside(parts, of_after - of_before);
  const double cell_area = std::pow(surfaces.after.height.cell_size, 2);
  for_each_cell(part, [&](Cell at) {
    if (part(at.row, at.col) == 0) return;
    const double before = cell_area * static_cast<double>(of_before(at.row, at.col));
    const double after = cell_area * static_cast<double>(of_after(at.row, at.col));
    const double grown = std::max(0.0, after - before);
    doubt.of(part(at.row, at.col)) += before + after + (weight_of_new - 1.0) * grown;
    doubt.in_before += before;
    doubt.in_after += after;
  });
}

/// Of the points about the height of their cell, in the median of the cells of one part [m]; NaN
/// where none tells.
double scatter_of(const Surface& surface, const Eigen::ArrayXXi& parts, int part) {
  if (surface.points.size() != parts.size() || surface.variance.size() != parts.size()) return nan;
  std::vector<double> squares;
  for_each_cell(parts, [&](Cell at) {
    if (parts(at.row, at.col) != part) return;
    const int points = std::min(surface.points(at.row, at.col), most_points_of_cell);
    const double square = points * surface.variance(at.row, at.col);
    if (!std::isnan(square)) squares.push_back(square);
  });
  return squares.empty() ? nan : std::sqrt(quantile(std::move(squares), 0.5));
}

/// Cells by their number of points, and those with one point at least of a kind.
struct CellsWithKind {
  std::array<double, most_points_of_cell + 1> of_points{};
  double with = 0.0;

  /// Of all points that are of the kind [-], by which as many cells have one in the mean.
  double share() const {
    double low = 0.0;
    double high = with > 0.0 ? 1.0 : 0.0;
    for (int halving = 0; halving < 30; ++halving) {
      const double tried = 0.5 * (low + high);
      double without = 1.0;  // of the cells with so many points
      double expected = 0.0;
      for (const double cells : of_points) {
        expected += cells * (1.0 - without);
        without *= 1.0 - tried;
      }
      (expected < with ? low : high) = tried;
    }
    return high;
  }
};

/// How many of the 25 cells about a cell are higher than `least`, and the sum of their heights [m].
struct HigherAround {
  HigherAround(const Eigen::ArrayXXd& heights, double least)
      : count(Eigen::ArrayXXi::Zero(heights.rows(), heights.cols())),
        sum(Eigen::ArrayXXd::Zero(heights.rows(), heights.cols())) {
    for_each_cell(heights, [&](Cell at) {
      const double here = heights(at.row, at.col);
      if (!(here > least)) return;
      for_each_around(heights, at, 2, [&](Cell n) {
        ++count(n.row, n.col);
        sum(n.row, n.col) += here;
      });
    });
  }

  Eigen::ArrayXXi count;
  Eigen::ArrayXXd sum;
};

/// How much of one part is in doubt by points on the ground of another time that were taken for its
/// surface `upper` [m^3]: amid cells that lie `apart` from that ground, cells whose lowest point is
/// on it tell the share of such points. Hardly any outlier is there, and on a fine grid the points
/// of a cell are too few to show two levels.
///
/// @param apart  of `upper` over the ground of the other time [m]
/// @param noise  of a point on either [m]
double doubt_by_other_time(const Surface& upper, const Eigen::ArrayXXd& apart,
                           const Eigen::ArrayXXi& parts, int part, double noise) {
  constexpr double sure = 8.0;    // of the noise: so far apart are cells around; ours
  constexpr double same = 3.0;    // of the noise: points on one surface; ours
  constexpr int amid = 16;        // of the 25: at a straight rim there are 15; ours
  constexpr double fewest = 5.0;  // cells with such points: fewer are chance; ours
  constexpr double most = 0.75;   // of the points: of more, no height is known; ours
  if (upper.below.size() != upper.height.z.size() || std::isnan(noise)) return 0.0;
  const HigherAround around((parts == part).select(apart, 0.0),
                            std::max(sure * noise, upper.height.cell_size));
  CellsWithKind cells;
  double height = 0.0;
  for_each_cell(parts, [&](Cell at) {
    const int higher = around.count(at.row, at.col);
    const int points = std::min(upper.points(at.row, at.col), most_points_of_cell);
    const double lowest = apart(at.row, at.col) - static_cast<double>(upper.below(at.row, at.col));
    if (higher < amid || points < 1 || std::isnan(lowest)) return;
    height += around.sum(at.row, at.col) / higher;
    cells.of_points[static_cast<std::size_t>(points)] += 1.0;
    cells.with += std::abs(lowest) < same * noise ? 1.0 : 0.0;
  });
  if (cells.with < fewest) return 0.0;
  const double share = std::min(most, cells.share());
  const double lost = height * std::pow(upper.height.cell_size, 2) * share / (1.0 - share);
  return weight_of_new * lost;
}

/// Points of the ground before among those of the soil that lies on it, and of the floor of a hole
/// among those of the ground before: a scan that holds two times.
void add_other_times(const SurfacePair& surfaces, const Eigen::ArrayXXi& parts,
                     const Eigen::ArrayXXd& risen, DoubtfulVolume& doubt) {
  const double before = scatter_of(surfaces.before, parts, 0);
  const double after = scatter_of(surfaces.after, parts, 0);
  const auto with = [](double own, double other) {  // ground without points has none
    return std::hypot(own, std::isnan(other) ? 0.0 : other);
  };
  const double soil = doubt_by_other_time(surfaces.after, risen, parts, 1, with(after, before));
  const double hole = doubt_by_other_time(surfaces.before, -risen, parts, -1, with(before, after));
  doubt.soil += soil;
  doubt.hole += hole;
  doubt.in_after += soil;
  doubt.in_before += hole;
}

std::vector<Warning> warning_of_overlays(const DoubtfulVolume& doubt, const VolumeChange& change) {
  constexpr double noted = 0.01;     // ours, of the bulking factor
  constexpr double doubtful = 0.03;  // ours, likewise
  const double share = doubt.share_of(change);
  if (!(share > noted)) return {};
  return {{WarningCode::two_surfaces,
           std::string("points of the scan ") + doubt.scan() +
               " lie on two surfaces, one above the other, which leaves " +
               readable(doubt.hole, 2) + " m^3 of the hole and " + readable(doubt.soil, 2) +
               " m^3 of spill and heap in doubt: leave out dust, plants and what else is above the "
               "ground, and points that were taken at other times",
           share > doubtful}};
}

/// What outliers that are not told from the ground raise.
void add_outliers(const SurfacePair& surfaces, const Eigen::ArrayXXi& part, DoubtfulVolume& doubt) {
  const Eigen::ArrayXXf of_before = known(surfaces.before.outlier_bias, surfaces.before);
  const Eigen::ArrayXXf of_after = known(surfaces.after.outlier_bias, surfaces.after);
  const double cell_area = std::pow(surfaces.after.height.cell_size, 2);
  for_each_cell(part, [&](Cell at) {
    if (part(at.row, at.col) == 0) return;
    const double before = cell_area * static_cast<double>(of_before(at.row, at.col));
    const double after = cell_area * static_cast<double>(of_after(at.row, at.col));
    doubt.of(part(at.row, at.col)) += after - before;
    doubt.in_before += std::abs(before);
    doubt.in_after += std::abs(after);
  });
}

std::vector<Warning> warning_of_outliers(const DoubtfulVolume& doubt, const VolumeChange& change) {
  constexpr double noted = 0.01;     // ours, of the bulking factor
  constexpr double doubtful = 0.02;  // ours: twice the error of a good survey
  const double share = doubt.share_of(change);
  if (!(share > noted)) return {};
  const bool are_above = (doubt.sum() > 0.0) == (doubt.in_after > doubt.in_before);
  return {{WarningCode::outliers,
           std::string("points of the scan ") + doubt.scan() + " lie off the ground, " +
               (are_above ? "above" : "below") +
               " it in the main; where it is uneven they are not told from it, which may change "
               "the bulking factor by " +
               readable(100.0 * share, 2) +
               " %: scan again without dust, rain or vibration, or clean the cloud",
           share > doubtful}};
}

/// Rounded heights of several cells are the same.
bool are_rounded(const std::vector<double>& sorted) {
  constexpr double same = 1e-6;  // [m]
  std::size_t alike = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) alike += sorted[i] - sorted[i - 1] < same ? 1 : 0;
  return 2 * alike > sorted.size();
}

/// A floor that a limit of heights cuts: cells of the hole whose lowest points lie at one height,
/// as no noise leaves them. Nothing of rounded heights, which do.
std::optional<Warning> floor_cut(const Surface& after, const Eigen::ArrayXXi& part) {
  constexpr std::size_t blunders = 2;    // below the floor; ours
  constexpr std::ptrdiff_t fewest = 20;  // ours
  constexpr double least_noise = 2e-3;   // [m], ours: less hides no volume that counts
  constexpr double edge = 0.25;          // ours, of the noise
  constexpr double floor = 2.0;          // ours, likewise
  constexpr double most = 0.25;  // ours: noise leaves some 0.03 of the cells so near the lowest
  if (after.below.size() != after.height.z.size()) return {};
  std::vector<double> lowest;
  for_each_cell(part, [&](Cell at) {
    const double here =
        after.height.z(at.row, at.col) - static_cast<double>(after.below(at.row, at.col));
    if (part(at.row, at.col) >= 0 || std::isnan(here)) return;
    lowest.push_back(here);
  });
  std::sort(lowest.begin(), lowest.end());
  const double noise = scatter_of(after, part, -1);
  if (lowest.size() <= blunders || !(noise >= least_noise) || are_rounded(lowest)) return {};
  const auto up_to = [&](double height) {
    return std::upper_bound(lowest.begin(), lowest.end(), lowest[blunders] + height) -
           lowest.begin();  // cells
  };
  const auto at_edge = up_to(edge * noise);
  if (at_edge < fewest ||
      static_cast<double>(at_edge) < most * static_cast<double>(up_to(floor * noise))) {
    return {};
  }
  return Warning{WarningCode::floor_cut,
                 "the lowest points of " + std::to_string(at_edge) + " cells of the hole lie at " +
                     readable(lowest[blunders], 4) +
                     " m, as where a limit of heights or depths cuts "
                     "the floor off: what lies deeper is missing; widen the limit"};
}

}  // namespace

std::vector<Warning> check_points(const std::vector<const SurfacePair*>& pairs,
                                  const VolumeChange& change) {
  DoubtfulVolume overlays;
  DoubtfulVolume outliers;
  std::vector<Warning> floors;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i] == nullptr) continue;
    const AreaChange& area = change.areas[i];
    const Eigen::ArrayXXi parts = parts_of(change, area);
    add_overlays(*pairs[i], parts, overlays);
    add_other_times(*pairs[i], parts, area.difference.z, overlays);
    add_outliers(*pairs[i], parts, outliers);
    if (auto cut = floor_cut(pairs[i]->after, parts)) floors.push_back(std::move(*cut));
  }
  std::vector<Warning> found = warning_of_overlays(overlays, change);
  for (const auto& more : {warning_of_outliers(outliers, change), floors}) {
    found.insert(found.end(), more.begin(), more.end());
  }
  return found;
}

}  // namespace excavplan
