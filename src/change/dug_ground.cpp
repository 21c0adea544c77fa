// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/dug_ground.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

constexpr std::size_t fewest = 20;    // cells
constexpr double fallen_share = 0.2;  // of the cut
constexpr double least_cover = 0.5;   // of a cell that counts as swept

/// What lies on the floor [m].
struct OnFloor {
  double mean = 0.0;
  double sd = 0.0;
};

class SweptFloor {
 public:
  SweptFloor(const KnownGround& known, const Eigen::ArrayXXd& lowest, const HeightMap& before,
             const HeightMap& after, const ChangedGround& ground)
      : known_(known),
        lowest_(lowest),
        change_(after.z - before.z - ground.datum),
        hidden_(after.z.isNaN() && !before.z.isNaN()),
        zone_(ground.zone) {}

  bool is_swept(Cell at) const {
    return known_.cover(at.row, at.col) > least_cover && known_.cut(at.row, at.col) > 0.0;
  }
  bool is_hidden(Cell at) const { return hidden_(at.row, at.col); }
  bool is_seen(Cell at) const { return !std::isnan(change_(at.row, at.col)); }
  double floor(Cell at) const { return lowest_(at.row, at.col); }

  OnFloor on_floor() const {
    std::vector<double> seen;
    std::vector<double> depths;
    for_each_cell(change_, [&](Cell at) {
      if (!is_swept(at)) return;
      depths.push_back(-floor(at));
      if (is_seen(at)) seen.push_back(change_(at.row, at.col) - floor(at));
    });
    if (seen.size() < fewest) {
      const double depth = depths.empty() ? 0.0 : median(depths);
      return {fallen_share * depth, fallen_share * depth};
    }
    const Spread spread = robust_spread(std::move(seen));
    return {std::max(0.0, spread.middle), spread.sd};
  }

  /// -1 if no ground was seen to fall along the path.
  int largest_zone() const {
    std::vector<double> fell;
    for_each_cell(change_, [&](Cell at) {
      const int zone = zone_(at.row, at.col);
      if (zone < 0 || !is_swept(at) || !is_seen(at)) return;
      fell.resize(std::max(fell.size(), static_cast<std::size_t>(zone) + 1));
      fell[static_cast<std::size_t>(zone)] -= change_(at.row, at.col);
    });
    const auto most = std::max_element(fell.begin(), fell.end());
    return most == fell.end() || !(*most > 0.0) ? -1 : static_cast<int>(most - fell.begin());
  }

 private:
  const KnownGround& known_;
  const Eigen::ArrayXXd& lowest_;
  const Eigen::ArrayXXd change_;
  const Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> hidden_;
  const Eigen::ArrayXXi& zone_;
};

}  // namespace

Eigen::ArrayXXi dug_before(const KnownGround& known) {
  constexpr double least = 0.01;     // ours [m]
  constexpr Eigen::Index reach = 2;  // ours: floors are not covered everywhere
  Eigen::ArrayXXi dug = Eigen::ArrayXXi::Zero(known.loose.rows(), known.loose.cols());
  for_each_cell(known.loose, [&](Cell at) {
    if (!(known.loose(at.row, at.col) > least)) return;
    for_each_around(known.loose, at, reach, [&](Cell n) { dug(n.row, n.col) = 1; });
  });
  return dug;
}

Eigen::ArrayXXd lowest_change(const KnownGround& known) {
  Eigen::ArrayXXd lowest = -known.cut;
  if (known.cut.size() > 0 && known.loose.size() > 0) {
    lowest -= known.loose.isNaN().select(0.0, known.loose);
  }
  return lowest;
}

std::vector<double> fill_swept(const KnownGround& known, const Eigen::ArrayXXd& lowest,
                               const HeightMap& before, HeightMap& after, ChangedGround& ground) {
  std::vector<double> variance(ground.zone_is_cut.size(), 0.0);
  if (lowest.size() == 0) return variance;
  const SweptFloor swept(known, lowest, before, after, ground);
  const int zone = swept.largest_zone();
  if (zone < 0) return variance;
  const OnFloor fallen = swept.on_floor();
  double cells = 0.0;
  for_each_cell(after.z, [&](Cell at) {
    if (!swept.is_swept(at) || !swept.is_hidden(at)) return;
    const double change = std::min(0.0, swept.floor(at) + fallen.mean);
    after.z(at.row, at.col) = before.z(at.row, at.col) + ground.datum + change;
    cells += 1.0;
    if (std::abs(change) > 3.0 * ground.noise_sd) ground.zone(at.row, at.col) = zone;
  });
  variance[static_cast<std::size_t>(zone)] = std::pow(cells * fallen.sd, 2);
  return variance;
}

}  // namespace excavplan
