// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/change/blocks.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/normal_equations.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_check.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

// Ours, found on simulated heaps of loose soil and of blocks (docs/methods.md#blocks).
constexpr double coarse_window = 0.30;           // [m]
constexpr Eigen::Index least_coarse_radius = 2;  // 5 x 5 cells
constexpr double least_window_share = 0.6;       // of a window's cells, known and in the patch
constexpr double steepness_margin = 10.0 * degree;
constexpr int fewest_cells = 30;
/// Ours: with larger cells the window is wider than a metre, and the relief of the ground counts as
/// rough [m].
constexpr double largest_cell = 0.2;
/// Ours: a window of as many smaller cells tells no more of blocks [m].
constexpr double finest_cell = 0.01;
constexpr double loose_roughness = 0.020;  // loose soil has less about a window of 0.3 m [m]
constexpr double block_roughness = 0.040;  // blocks have more
constexpr double heap_level = 0.5;         // quantile of the windows that represents a heap
constexpr double pit_level = 0.3;          // and a pit, with many windows on its walls
constexpr double longest_lag = 0.6;        // [m]
constexpr double size_per_lag = 1.6;       // mean edge / lag of the largest bend of a heap
constexpr double size_doubt = 0.2;         // relative sd of the size
constexpr double thinning = 0.79;          // voids = packed voids (1 - thinning size / depth)
constexpr double largest_size = 0.9;       // over the depth of the heap
constexpr double share_doubt = 0.1;        // sd of the share of blocks

/// A smooth surface over a window and the scatter of the cells about it.
struct WindowFit {
  double gx = 0.0;  // gradient in the middle
  double gy = 0.0;
  double variance = 0.0;       // of the residuals [m^2]
  double gradient_gain = 0.0;  // variance of a gradient per variance of a cell [1/m^2]
};

/// One patch of one map.
struct Patch {
  const HeightMap& map;
  const Mask& mask;
  double noise_sd;

  /// NaN outside of the map or the patch.
  double height(Eigen::Index row, Eigen::Index col) const {
    const bool inside = row >= 0 && col >= 0 && row < mask.rows() && col < mask.cols();
    return inside && mask(row, col) ? map.z(row, col) : std::numeric_limits<double>::quiet_NaN();
  }
};

/// Least squares of 1, x, y (terms = 3) or up to the squares (terms = 6), which follow the crest
/// of a heap; nothing where too little of the window is known.
template <int terms>
std::optional<WindowFit> fit_window(const Patch& patch, Cell at, Eigen::Index radius) {
  NormalEquations<terms> equations;
  int count = 0;
  const double middle = patch.map.z(at.row, at.col);
  for (Eigen::Index j = -radius; j <= radius; ++j) {
    for (Eigen::Index i = -radius; i <= radius; ++i) {
      const double z = patch.height(at.row + i, at.col + j) - middle;
      if (std::isnan(z)) continue;
      const auto x = static_cast<double>(j);
      const auto y = static_cast<double>(i);
      typename NormalEquations<terms>::Vector basis;
      if constexpr (terms == 3) {
        basis << 1.0, x, y;
      } else {
        basis << 1.0, x, y, x * x, x * y, y * y;
      }
      equations.add(basis, z);
      ++count;
    }
  }
  const auto width = static_cast<double>(2 * radius + 1);
  if (count < least_window_share * width * width || count <= terms) return std::nullopt;
  const auto surface = equations.solution();
  const double cell_size = patch.map.cell_size;
  return WindowFit{surface(1) / cell_size, surface(2) / cell_size,
                   std::max(0.0, equations.squares_about(surface)) / (count - terms),
                   0.5 * (equations.variance(1) + equations.variance(2)) / (cell_size * cell_size)};
}

/// Statistics of the cells of one kind of ground, over all maps.
struct Findings {
  std::vector<double> fine;  // variances about the surface of a window, less the noise [m^2]
  std::vector<double> coarse;
  double angle_squares = 0.0;  // corrected for noise
  double steep = 0.0;
  double steep_by_noise = 0.0;
  double holes = 0.0;
  double holes_around = 0.0;  // expected from the rest of the map
  double cells = 0.0;         // of the patches, holes included
};

Eigen::Vector3d normal_of(const WindowFit& fit) {
  return Eigen::Vector3d(-fit.gx, -fit.gy, 1.0).normalized();
}

void judge_cell(const Patch& patch, Cell cell, double repose, Findings& found) {
  const auto radius =
      std::max(least_coarse_radius,
               static_cast<Eigen::Index>(std::lround(0.5 * coarse_window / patch.map.cell_size)));
  const auto fine = fit_window<3>(patch, cell, 1);
  const auto coarse = fit_window<6>(patch, cell, radius);
  if (!fine || !coarse) return;
  const double noise = patch.noise_sd * patch.noise_sd;
  found.fine.push_back(fine->variance - noise);
  found.coarse.push_back(coarse->variance - noise);

  const Eigen::Vector3d wide = normal_of(*coarse);
  const double angle = std::acos(std::clamp(normal_of(*fine).dot(wide), -1.0, 1.0));
  const double upright =
      wide.z() * wide.z();  // on steep ground the normal turns less with the gradient
  const double gradient_noise = noise * std::max(0.0, fine->gradient_gain - coarse->gradient_gain);
  found.angle_squares += angle * angle - gradient_noise * upright * (1.0 + upright);

  const double limit = std::tan(repose + steepness_margin);
  if (std::hypot(fine->gx, fine->gy) > limit) found.steep += 1.0;
  const double gentle = std::min(std::hypot(coarse->gx, coarse->gy), std::tan(repose));
  const double slope_noise = std::sqrt(noise * fine->gradient_gain);
  if (slope_noise > 0.0) found.steep_by_noise += normal_cdf((gentle - limit) / slope_noise);
}

void look_at(const Patch& patch, double repose, Findings& found) {
  double inside = 0.0;
  double unseen_inside = 0.0;
  double outside = 0.0;
  double unseen_outside = 0.0;
  for_each_cell(patch.map.z, [&](Cell cell) {
    const bool unseen = std::isnan(patch.map.z(cell.row, cell.col));
    const bool in_patch = patch.mask(cell.row, cell.col);
    (in_patch ? inside : outside) += 1.0;
    if (unseen) (in_patch ? unseen_inside : unseen_outside) += 1.0;
    if (in_patch && !unseen) judge_cell(patch, cell, repose, found);
  });
  found.cells += inside;
  found.holes += unseen_inside;
  if (outside > 0.0) found.holes_around += inside * unseen_outside / outside;
}

double root(double variance) { return std::sqrt(std::max(0.0, variance)); }

double ramp(double value, double none, double full) {
  return std::clamp((value - none) / (full - none), 0.0, 1.0);
}

GroundTexture texture_of(const Findings& found, double level) {
  GroundTexture texture;
  texture.cells = static_cast<int>(found.fine.size());
  if (texture.cells < fewest_cells) return texture;
  const double count = texture.cells;
  texture.fine_roughness = root(quantile(found.fine, level));
  texture.coarse_roughness = root(quantile(found.coarse, level));
  texture.steep_share = std::max(0.0, (found.steep - found.steep_by_noise) / count);
  texture.normal_dispersion = root(found.angle_squares / count);
  texture.hole_share = std::max(0.0, (found.holes - found.holes_around) / found.cells);
  constexpr double rough = 0.5 * (loose_roughness + block_roughness);
  texture.rough_share =
      static_cast<double>(std::count_if(found.coarse.begin(), found.coarse.end(),
                                        [](double variance) { return variance > rough * rough; })) /
      count;
  return texture;
}

double score_of_heap(const GroundTexture& texture) {
  return 0.5 * ramp(texture.coarse_roughness, loose_roughness, block_roughness) +
         0.2 * ramp(texture.steep_share, 0.1, 0.3) +
         0.2 * ramp(texture.normal_dispersion, 15.0 * degree, 28.0 * degree) +
         0.1 * ramp(texture.hole_share, 0.05, 0.3);
}

double score_of_pit(const GroundTexture& texture) {
  return ramp(texture.coarse_roughness, loose_roughness, block_roughness);
}

/// Second differences of the height over three cells in a row, all within one patch.
void add_bends(const Patch& patch, Eigen::Index lag, std::vector<double>& bends) {
  for_each_cell(patch.map.z, [&](Cell cell) {
    const double middle = patch.height(cell.row, cell.col);
    for (const auto& [row, col] : {std::array<Eigen::Index, 2>{lag, 0}, {0, lag}}) {
      const double bend = patch.height(cell.row - row, cell.col - col) +
                          patch.height(cell.row + row, cell.col + col) - 2.0 * middle;
      if (!std::isnan(bend)) bends.push_back(std::abs(bend));
    }
  });
}

/// Mean edge of blocks. The ground is straight within one face, and over many blocks its bends
/// average out: the median bend per lag is largest at a fixed share of the size. Nothing if the
/// maximum lies at the first or the last lag.
std::optional<double> size_of_blocks(const std::vector<Patch>& heap) {
  constexpr double median_of_normal = 0.6745;
  constexpr std::size_t fewest_bends = 50;
  std::vector<double> bend_per_lag;
  const double cell_size = heap.front().map.cell_size;
  const auto last = static_cast<Eigen::Index>(longest_lag / cell_size);
  for (Eigen::Index lag = 1; lag <= last; ++lag) {
    std::vector<double> bends;
    double noise = 0.0;
    for (const Patch& patch : heap) {
      add_bends(patch, lag, bends);
      noise = std::max(noise, patch.noise_sd);
    }
    if (bends.size() < fewest_bends) break;
    const double by_noise = median_of_normal * std::sqrt(6.0) * noise;
    const double bend = root(std::pow(quantile(std::move(bends), 0.5), 2) - by_noise * by_noise);
    bend_per_lag.push_back(bend / static_cast<double>(lag));
  }
  const auto peak = std::max_element(bend_per_lag.begin(), bend_per_lag.end());
  if (bend_per_lag.size() < 3 || peak == bend_per_lag.begin() || peak + 1 == bend_per_lag.end()) {
    return std::nullopt;
  }
  const double curve = *(peak - 1) - 2.0 * *peak + *(peak + 1);
  const double shift = curve < 0.0 ? 0.5 * (*(peak - 1) - *(peak + 1)) / curve : 0.0;
  return size_per_lag * cell_size *
         (static_cast<double>(peak - bend_per_lag.begin()) + 1.0 + shift);
}

/// Masks of what rose in one area, and of the floor of what fell.
struct AreaMasks {
  Mask risen;
  Mask fallen;
};

/// Cells of a pit without its walls. Walls are as wide, from the rim inwards, as half of the cells
/// are less deep than most of the floor.
Mask floor_of(const Mask& pit, const Eigen::ArrayXXd& difference) {
  constexpr double deepest = 0.1;      // quantile of the heights; ours
  constexpr double floor_share = 0.7;  // of that depth; ours
  const Eigen::ArrayXXd from_rim =
      slope_limited(pit.select(std::numeric_limits<double>::infinity(),
                               Eigen::ArrayXXd::Zero(pit.rows(), pit.cols())),
                    1.0);
  std::vector<double> heights;
  std::vector<std::vector<double>> layers;
  for_each_cell(pit, [&](Cell cell) {
    const double height = difference(cell.row, cell.col);
    const double away = from_rim(cell.row, cell.col);
    if (!pit(cell.row, cell.col) || std::isnan(height) || !std::isfinite(away)) return;
    heights.push_back(height);
    const auto layer = static_cast<std::size_t>(away);
    if (layers.size() <= layer) layers.resize(layer + 1);
    layers[layer].push_back(height);
  });
  if (heights.empty()) return pit;
  const double floor_height = floor_share * quantile(std::move(heights), deepest);
  std::size_t first = 1;
  while (first < layers.size() &&
         (layers[first].empty() || quantile(layers[first], 0.5) > floor_height)) {
    ++first;
  }
  return pit && from_rim > static_cast<double>(first) + 1.0;
}

AreaMasks masks_of(const AreaChange& area, const std::vector<ChangeZone>& zones) {
  AreaMasks masks{Mask::Constant(area.zone.rows(), area.zone.cols(), false), {}};
  masks.fallen = masks.risen;
  for_each_cell(area.zone, [&](Cell cell) {
    const int zone = area.zone(cell.row, cell.col);
    if (zone < 0) return;
    const ZoneKind kind = zones[static_cast<std::size_t>(zone)].kind;
    masks.risen(cell.row, cell.col) = kind == ZoneKind::spill || kind == ZoneKind::dump;
    masks.fallen(cell.row, cell.col) = kind == ZoneKind::dig;
  });
  masks.fallen = floor_of(masks.fallen, area.difference.z);
  return masks;
}

/// Mean depth of the heap, weighted by the volume in each cell.
double depth_of_heap(const VolumeChange& change, const std::vector<AreaMasks>& masks) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const Eigen::ArrayXXd& rise = change.areas[i].difference.z;
    for_each_cell(rise, [&](Cell cell) {
      const double rose = rise(cell.row, cell.col);
      if (!masks[i].risen(cell.row, cell.col) || std::isnan(rose)) return;
      sum += rose;
      squares += rose * rose;
    });
  }
  return sum > 0.0 ? squares / sum : 0.0;
}

void check(const HeightMap& after, const AreaChange& area, const std::vector<ChangeZone>& zones) {
  require_map(after, "blocks, map after");
  require_map(area.difference, "blocks, difference");
  require(area.noise_sd >= 0.0 && std::isfinite(area.noise_sd), "blocks: noise of an area",
          area.noise_sd, ">= 0 m");
  const bool fits = area.zone.rows() == after.z.rows() && area.zone.cols() == after.z.cols() &&
                    area.zone.maxCoeff() < static_cast<int>(zones.size());
  if (!fits) refuse("blocks: the zone of an area must have the size of its map and name zones");
}

void check(const std::vector<HeightMap>& after, const VolumeChange& change,
           const BlockOptions& options) {
  require(options.angle_of_repose > 0.0 && options.angle_of_repose < 1.2, "blocks: angle of repose",
          options.angle_of_repose, "in 0 .. 1.2 rad");
  const double noise = options.noise_sd.value_or(0.0);
  require(noise >= 0.0 && std::isfinite(noise), "blocks: noise", noise, ">= 0 m");
  require(options.packed_voids > 0.0 && options.packed_voids < 1.0, "blocks: packed voids",
          options.packed_voids, "in 0 .. 1");
  require_in("blocks: sd of packed voids", options.packed_voids_sd, 0.0, 1.0);
  const double loose = change.after.value + change.after.sd;
  require(std::isfinite(loose), "blocks: volume after and its sd", loose, "finite");
  if (after.empty() || after.size() != change.areas.size()) {
    throw Error(ErrorKind::bad_input, "blocks: there must be one map for each of the " +
                                          std::to_string(change.areas.size()) +
                                          " areas, at least one, there are " +
                                          std::to_string(after.size()));
  }
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (same_grid(after[i], change.areas[i].difference)) continue;
    throw Error(ErrorKind::bad_input, "blocks: each map must be on the grid of its area, map " +
                                          std::to_string(i) + " is not");
  }
  for (std::size_t i = 0; i < after.size(); ++i) check(after[i], change.areas[i], change.zones);
}

std::string tenths(double value) { return number_text(std::round(10.0 * value) / 10.0); }

std::string texture_text(const char* what, const GroundTexture& texture) {
  return std::string(what) + " is rough by " + tenths(1e3 * texture.coarse_roughness) +
         " mm over 0.3 m (loose soil: under " + tenths(1e3 * loose_roughness) + " mm)";
}

std::string steepness_text(const GroundTexture& texture, double repose) {
  return tenths(100.0 * texture.steep_share) + " % of the heap are steeper than " +
         tenths((repose + steepness_margin) / degree) + " deg and its faces are inclined by " +
         tenths(texture.normal_dispersion / degree) +
         " deg to the ground around them (loose soil: under 10 % and 15 deg)";
}

void explain(const BlockOptions& options, BlockReport& report) {
  if (report.heap.score >= 0.5) {
    report.reasons.push_back(texture_text("the heap", report.heap));
    report.reasons.push_back(steepness_text(report.heap, options.angle_of_repose));
  }
  if (report.pit.score >= 0.5) report.reasons.push_back(texture_text("the pit", report.pit));
  if (report.heap.hole_share > 0.05) {
    report.reasons.push_back(tenths(100.0 * report.heap.hole_share) +
                             " % of the heap were not seen, in addition to the share around it");
  }
}

/// Volume of the voids between blocks, with the uncertainty of size and packing.
void estimate_voids(const VolumeChange& change, double depth, const BlockOptions& options,
                    BlockReport& report) {
  if (!report.block_size) {
    report.reasons.emplace_back(
        "blocks too small for the cells, or too few: their size and voids cannot be estimated");
    return;
  }
  const double relative_size = *report.block_size / depth;
  if (!(relative_size < largest_size)) {
    report.reasons.push_back("blocks of " + tenths(100.0 * *report.block_size) + " cm in a heap " +
                             tenths(100.0 * depth) +
                             " cm deep: the voids between them cannot be estimated");
    return;
  }
  const double share = report.heap.rough_share;
  const double thinned = 1.0 - thinning * relative_size;
  const double of_volume = share * options.packed_voids * thinned;
  const double sd = std::hypot(share * thinned * options.packed_voids_sd,
                               share * options.packed_voids * thinning * relative_size * size_doubt,
                               share_doubt * options.packed_voids * thinned);
  const double after = change.after.value;
  report.voids = Measured{after * of_volume, std::hypot(after * sd, change.after.sd * of_volume)};
  report.reasons.push_back("blocks of about " + tenths(100.0 * *report.block_size) +
                           " cm: voids are " + tenths(100.0 * of_volume) + " +- " +
                           tenths(100.0 * sd) + " % of the heap");
}

/// On cells no finer than what is looked for.
BlockReport assess(const std::vector<HeightMap>& after, const VolumeChange& change,
                   const BlockOptions& options) {
  std::vector<AreaMasks> masks;
  for (const AreaChange& area : change.areas) masks.push_back(masks_of(area, change.zones));
  std::vector<Patch> heaps;
  Findings heap;
  Findings pit;
  for (std::size_t i = 0; i < after.size(); ++i) {
    // The difference has the noise of two scans.
    const double noise = options.noise_sd.value_or(change.areas[i].noise_sd / std::sqrt(2.0));
    heaps.push_back({after[i], masks[i].risen, noise});
    look_at(heaps.back(), options.angle_of_repose, heap);
    look_at({after[i], masks[i].fallen, noise}, options.angle_of_repose, pit);
  }
  BlockReport report;
  report.heap = texture_of(heap, heap_level);
  report.pit = texture_of(pit, pit_level);
  report.heap.score = score_of_heap(report.heap);
  report.pit.score = score_of_pit(report.pit);
  report.score = std::max(report.heap.score, report.pit.score);
  report.blocks = report.score >= 0.5;
  explain(options, report);
  if (report.heap.score >= 0.5) {
    report.block_size = size_of_blocks(heaps);
    estimate_voids(change, depth_of_heap(change, masks), options, report);
  }
  return report;
}

Eigen::Index step_over(const HeightMap& map) {
  constexpr double rounding = 1e-9;
  const auto most = static_cast<double>(std::max(map.z.rows(), map.z.cols()));
  return static_cast<Eigen::Index>(
      std::clamp(std::ceil(finest_cell / map.cell_size - rounding), 1.0, most));
}

template <typename Layer>
Layer every(Eigen::Index step, const Layer& layer) {
  return layer(Eigen::seq(0, layer.rows() - 1, step), Eigen::seq(0, layer.cols() - 1, step));
}

/// Larger cells around the middles of some, with the heights and the noise of these.
HeightMap thinned(const HeightMap& map) {
  const Eigen::Index step = step_over(map);
  const double wider = map.cell_size * static_cast<double>(step - 1);
  return {map.origin.array() - 0.5 * wider, map.cell_size + wider, every(step, map.z)};
}

AreaChange thinned(const AreaChange& area) {
  AreaChange some;
  some.difference = thinned(area.difference);
  some.zone = every(step_over(area.difference), area.zone);
  some.noise_sd = area.noise_sd;
  return some;
}

BlockReport assess_thinned(const std::vector<HeightMap>& after, const VolumeChange& change,
                           const BlockOptions& options) {
  std::vector<HeightMap> maps;
  maps.reserve(after.size());
  for (const HeightMap& map : after) maps.push_back(thinned(map));
  VolumeChange some;
  some.after = change.after;
  some.zones = change.zones;
  for (const AreaChange& area : change.areas) some.areas.push_back(thinned(area));
  return assess(maps, some, options);
}

}  // namespace

BlockReport assess_blocks(const std::vector<HeightMap>& after, const VolumeChange& change,
                          const BlockOptions& options) {
  check(after, change, options);
  if (after.front().cell_size > largest_cell) {
    BlockReport unjudged;
    unjudged.reasons.push_back("cells of " + number_text(after.front().cell_size) +
                               " m are too large to detect blocks, at most " +
                               number_text(largest_cell) + " m");
    return unjudged;
  }
  const bool is_fine = std::any_of(after.begin(), after.end(),
                                   [](const HeightMap& map) { return step_over(map) > 1; });
  return is_fine ? assess_thinned(after, change, options) : assess(after, change, options);
}

}  // namespace excavplan
