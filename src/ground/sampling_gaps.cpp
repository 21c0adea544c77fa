// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/sampling_gaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/hole_filling.hpp"
#include "ground/plane_fit.hpp"
#include "ground/slopes.hpp"
#include "ground/window.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
constexpr Index widest_gap = 24;  // ours [cell]

/// Known cells with an unknown one among the eight around.
Mask thin_cells(const Mask& known) {
  Mask thin = Mask::Constant(known.rows(), known.cols(), false);
  for_each_cell(known, [&](Cell at) {
    if (!known(at.row, at.col)) return;
    for_each_around(known, at, 1, [&](Cell n) {
      if (!known(n.row, n.col)) thin(at.row, at.col) = true;
    });
  });
  return thin;
}

/// Steps to the next known cell in a direction; more than the widest gap if there is none.
Index steps_to_known(const Mask& known, Cell at, Cell step) {
  for (Index i = 1; i <= widest_gap; ++i) {
    at = {at.row + step.row, at.col + step.col};
    if (at.row < 0 || at.col < 0 || at.row >= known.rows() || at.col >= known.cols()) break;
    if (known(at.row, at.col)) return i;
  }
  return widest_gap + 1;
}

/// True if known cells lie before and behind the cell, in one of four directions.
bool is_enclosed(const Mask& known, Cell at) {
  static constexpr std::array<Cell, 4> directions = {{{0, 1}, {1, 0}, {1, 1}, {1, -1}}};
  return std::any_of(directions.begin(), directions.end(), [&](Cell step) {
    const Index ahead = steps_to_known(known, at, step);
    if (ahead > widest_gap) return false;
    return ahead + steps_to_known(known, at, {-step.row, -step.col}) <= widest_gap;
  });
}

/// Those of the cells that known ones touch, also through others of them.
std::vector<Cell> held_by_known(const Mask& known, const std::vector<Cell>& cells) {
  constexpr int free = -1;
  Eigen::ArrayXXi label = known.select(Eigen::ArrayXXi::Zero(known.rows(), known.cols()), -2);
  for (const Cell at : cells) label(at.row, at.col) = free;
  std::vector<Cell> held;
  for (const Cell at : cells) {
    if (label(at.row, at.col) != free) continue;
    bool touches = false;
    const std::vector<Cell> patch = mark_connected(label, at, 1, [](Cell) { return true; });
    for (const Cell cell : patch) {
      for_each_neighbour(label, cell, [&](Cell n) { touches |= label(n.row, n.col) == 0; });
    }
    if (touches) held.insert(held.end(), patch.begin(), patch.end());
  }
  return held;
}

/// Mean square of the known heights around a cell about their best plane; NaN if they are too few.
double scatter_around(const Eigen::ArrayXXd& z, const Mask& known, Cell at, Index radius) {
  constexpr double fewest = 6.0;  // ours
  PlaneFit fit;
  const double middle = z(at.row, at.col);
  for_each_around(z, at, radius, [&](Cell n) {
    if (!known(n.row, n.col)) return;
    fit.add(static_cast<double>(n.col - at.col), static_cast<double>(n.row - at.row),
            z(n.row, n.col) - middle);
  });
  if (fit.count() < fewest) return std::numeric_limits<double>::quiet_NaN();
  return fit.squares_about(fit.plane()) / (fit.count() - 3.0);
}

/// Sampling of one zone.
struct Sampling {
  double cells = 0.0;
  double known = 0.0;
  double points = 0.0;
  double distance = 0.0;  // sum over the cells to the nearest known one [cell]

  /// Of the points, or of the lines that they form [cell].
  double spacing() const {
    if (known == 0.0) return 0.0;
    return std::max(std::sqrt(known / points), 4.0 * distance / cells);
  }
};

std::vector<Sampling> sampling_of(const Surface& surface, const Mask& known,
                                  const Eigen::ArrayXXi& zone, std::size_t count) {
  const Eigen::ArrayXXd distance = distance_to(known);
  std::vector<Sampling> zones(count);
  for_each_cell(zone, [&](Cell at) {
    if (zone(at.row, at.col) < 0 || std::isnan(surface.height.z(at.row, at.col))) return;
    Sampling& sampling = zones[static_cast<std::size_t>(zone(at.row, at.col))];
    sampling.cells += 1.0;
    sampling.known += known(at.row, at.col) ? 1.0 : 0.0;
    sampling.points += surface.points(at.row, at.col);
    sampling.distance += distance(at.row, at.col);
  });
  return zones;
}

/// Mean scatter of the ground in windows over some cells of a zone, beyond the median of stable
/// ground [m^2].
class ZoneScatter {
 public:
  ZoneScatter(const Surface& surface, const Mask& known, const Eigen::ArrayXXi& zone)
      : z_(surface.height.z), known_(known), zone_(zone) {}

  double operator()(int index, Index radius) const {
    const std::vector<double> inside = values(index, radius);
    std::vector<double> stable = values(-1, radius);
    if (inside.empty()) return 0.0;
    double sum = 0.0;
    for (const double value : inside) sum += value;
    const double usual = stable.empty() ? 0.0 : median(stable);
    return std::max(0.0, sum / static_cast<double>(inside.size()) - usual);
  }

 private:
  std::vector<double> values(int index, Index radius) const {
    constexpr Index most = 1000;  // ours
    const Index count = (zone_ == index).count();
    const Index stride = count / most + 1;
    std::vector<double> found;
    Index number = 0;
    for (Index i = 0; i < zone_.size(); ++i) {
      if (zone_(i) != index || std::isnan(z_(i)) || number++ % stride != 0) continue;
      const double value = scatter_around(z_, known_, {i % zone_.rows(), i / zone_.rows()}, radius);
      if (!std::isnan(value)) found.push_back(value);
    }
    return found;
  }

  const Eigen::ArrayXXd& z_;
  const Mask& known_;
  const Eigen::ArrayXXi& zone_;
};

}  // namespace

void fill_sampling_gaps(Surface& surface) {
  constexpr double most = 0.5;       // ours: share of known cells with an unknown neighbour
  constexpr double nearby = 3.0;     // ours: distances to the nearest known cell
  constexpr Index least_radius = 4;  // ours [cell]
  constexpr double farthest = 0.5;   // ours: from a known cell [m]
  /// From a cell to the nearest known one, over the spacing of lines with the share that is known
  /// nearby, whose farthest cells are half of it away; wider gaps were not seen. Ours.
  constexpr double widest_to_usual = 2.0;
  const Mask known = !surface.height.z.isNaN();
  if (known.all() || !known.any()) return;
  const AreaSums all(known.cast<double>());
  const AreaSums thin(thin_cells(known).cast<double>());
  const Eigen::ArrayXXd distance = distance_to(known);
  std::vector<Cell> gaps;
  for_each_cell(known, [&](Cell at) {
    const double away = distance(at.row, at.col);
    if (known(at.row, at.col) || away > farthest / surface.height.cell_size) return;
    const Index radius = std::max(least_radius, static_cast<Index>(std::ceil(nearby * away)));
    const double points = all.around(at, radius);
    const double width = 2.0 * static_cast<double>(radius) + 1.0;
    const bool is_thin = thin.around(at, radius) >= most * points;
    const bool is_usual = away * points <= widest_to_usual * width * width;
    if (is_thin && is_usual && is_enclosed(known, at)) gaps.push_back(at);
  });
  fill(surface.height.z, held_by_known(known, gaps), Filling::thin_plate);
}

std::vector<double> variance_between_points(const Surface& surface, const Eigen::ArrayXXi& zone,
                                            std::size_t count) {
  constexpr double sparse = 0.45;     // ours [cell]: fewer than five points in a cell
  constexpr double window = 1.5;      // ours [spacing]
  constexpr double of_scatter = 9.0;  // ours, for random points
  constexpr double of_lines = 0.5;    // ours: lines sample faces more evenly
  std::vector<double> variance(count, 0.0);
  if (surface.points.size() == 0) return variance;
  const Mask known = surface.points > 0;
  const std::vector<Sampling> zones = sampling_of(surface, known, zone, count);
  const ZoneScatter scatter(surface, known, zone);
  const double cell_area = surface.height.cell_size * surface.height.cell_size;
  for (std::size_t i = 0; i < count; ++i) {
    const double spacing = zones[i].spacing();
    if (!(spacing > sparse)) continue;
    const auto radius = static_cast<Index>(std::ceil(window * spacing));
    const double near = scatter(static_cast<int>(i), radius);
    const double far = scatter(static_cast<int>(i), 2 * radius);
    if (near == 0.0) continue;
    const bool in_lines = spacing > 1.5;  // ours
    const double width = 2.0 * static_cast<double>(radius) + 1.0;
    const double power = std::clamp(std::log(far / near) / std::log((2.0 * width - 1.0) / width),
                                    1.0, in_lines ? 2.0 : 3.0);
    variance[i] = of_scatter * (in_lines ? of_lines : 1.0) * zones[i].cells * cell_area *
                  cell_area * spacing * spacing * near * std::pow(spacing / width, power);
  }
  return variance;
}

}  // namespace excavplan
