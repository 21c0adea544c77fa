// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/relief_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/normal_equations.hpp"
#include "base/statistics.hpp"
#include "ground/window.hpp"

namespace excavplan {
namespace {

// All ours.
constexpr double within = 0.2;              // cells of one piece lie as near as this [m]
constexpr double share_within = 0.5;        // of the cells as near, so that noise makes no piece
constexpr std::size_t fewest_of_side = 12;  // cells
constexpr double common_sd = 0.004;         // of the rise of a side, which its cells share [m]
constexpr double bend_share = 0.1;          // of a rise: sides are curved and cells have edges
constexpr double widest_piece = 0.2;        // prior of shift and growth [m]
constexpr double told = 0.02;               // a growth is told apart by as little [m]
constexpr double most_sds = 3.0;

/// Cells of a piece that face one way.
struct Side {
  Eigen::Vector2d slope;
  double rise;
  double variance;
};

struct Piece {
  std::vector<std::size_t> cells = {};  ///< numbers of ReliefCells
  std::vector<Side> sides = {};
};

Side side_of(const std::vector<const ReliefCell*>& cells, double cell_noise) {
  Side side = {Eigen::Vector2d::Zero(), 0.0, 0.0};
  std::vector<double> rises;
  for (const ReliefCell* each : cells) {
    side.slope += each->slope;
    rises.push_back(each->rise);
  }
  const auto count = static_cast<double>(cells.size());
  side.slope /= count;
  side.rise = median(rises);
  side.variance = 1.57 * cell_noise * cell_noise / count + common_sd * common_sd +
                  std::pow(bend_share * side.rise, 2);
  return side;
}

std::vector<Side> sides_of(const Piece& piece, const std::vector<ReliefCell>& cells,
                           double cell_noise) {
  std::array<std::vector<const ReliefCell*>, 4> facing;
  for (const std::size_t number : piece.cells) {
    const Eigen::Vector2d& slope = cells[number].slope;
    const bool along_x = std::abs(slope.x()) > std::abs(slope.y());
    const bool rises = (along_x ? slope.x() : slope.y()) > 0.0;
    facing[(along_x ? 0U : 2U) + (rises ? 1U : 0U)].push_back(&cells[number]);
  }
  std::vector<Side> sides;
  for (const auto& each : facing) {
    if (each.size() >= fewest_of_side) sides.push_back(side_of(each, cell_noise));
  }
  return sides;
}

/// Least squares of the shift of sides, and of their growth where it may not be 0.
class ShiftOfSides {
 public:
  explicit ShiftOfSides(bool may_grow) {
    equations_.add(Eigen::Vector3d::UnitX(), 0.0, 1.0 / (widest_piece * widest_piece));
    equations_.add(Eigen::Vector3d::UnitY(), 0.0, 1.0 / (widest_piece * widest_piece));
    const double growth_sd = may_grow ? widest_piece : 1e-3 * common_sd;
    equations_.add(Eigen::Vector3d::UnitZ(), 0.0, 1.0 / (growth_sd * growth_sd));
  }
  void add(const Side& side) { equations_.add(row_of(side), side.rise, 1.0 / side.variance); }

  Eigen::Vector3d solution() const { return equations_.solution(); }
  double growth_sd() const { return std::sqrt(equations_.variance(2)); }

  /// The farthest that a side lies away from it [standard deviations].
  static double farthest(const std::vector<Side>& sides, const Eigen::Vector3d& solution) {
    double sds = 0.0;
    for (const Side& side : sides) {
      const double away = side.rise - row_of(side).dot(solution);
      sds = std::max(sds, std::abs(away) / std::sqrt(side.variance));
    }
    return sds;
  }

 private:
  static Eigen::Vector3d row_of(const Side& side) { return {side.slope.x(), side.slope.y(), 1.0}; }

  NormalEquations<3> equations_;
};

/// Its sides tell shift from growth.
bool bears_witness(const Piece& piece) {
  ShiftOfSides fit(true);
  for (const Side& side : piece.sides) fit.add(side);
  return fit.growth_sd() < told;
}

std::vector<Piece> pieces_of(const std::vector<ReliefCell>& cells, const HeightMap& grid) {
  Eigen::ArrayXXd marked = Eigen::ArrayXXd::Zero(grid.z.rows(), grid.z.cols());
  for (const ReliefCell& each : cells) marked(each.cell.row, each.cell.col) = 1.0;
  const AreaSums sums(marked);
  const auto radius = static_cast<Eigen::Index>(std::ceil(within / grid.cell_size));
  const double least = share_within * std::pow(2.0 * static_cast<double>(radius) + 1.0, 2);
  constexpr int none = -2;
  constexpr int not_yet = -1;
  Eigen::ArrayXXi label = Eigen::ArrayXXi::Constant(grid.z.rows(), grid.z.cols(), none);
  for_each_cell(label, [&](Cell at) {
    if (sums.around(at, radius) >= least) label(at.row, at.col) = not_yet;
  });
  std::vector<Piece> pieces;
  for_each_cell(label, [&](Cell at) {
    if (label(at.row, at.col) != not_yet) return;
    mark_connected(label, at, static_cast<int>(pieces.size()), [](Cell) { return true; });
    pieces.emplace_back();
  });
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int number = label(cells[i].cell.row, cells[i].cell.col);
    if (number >= 0) pieces[static_cast<std::size_t>(number)].cells.push_back(i);
  }
  return pieces;
}

/// Leaves out the piece that fits the others least until all show one shift.
void keep_one_shift(std::vector<Piece>& pieces) {
  while (pieces.size() > 1) {
    ShiftOfSides fit(false);
    for (const Piece& piece : pieces) {
      for (const Side& side : piece.sides) fit.add(side);
    }
    const Eigen::Vector3d shift = fit.solution();
    const auto away = [&](const Piece& piece) {
      return ShiftOfSides::farthest(piece.sides, shift);
    };
    const auto worst =
        std::max_element(pieces.begin(), pieces.end(),
                         [&](const Piece& a, const Piece& b) { return away(a) < away(b); });
    if (away(*worst) < most_sds) return;
    pieces.erase(worst);
  }
}

std::size_t cells_in(const std::vector<Piece>& pieces) {
  std::size_t count = 0;
  for (const Piece& piece : pieces) count += piece.cells.size();
  return count;
}

}  // namespace

Mask relief_that_agrees(const std::vector<ReliefCell>& cells, const HeightMap& grid,
                        double cell_noise) {
  Mask agrees = Mask::Constant(grid.z.rows(), grid.z.cols(), false);
  std::vector<Piece> pieces = pieces_of(cells, grid);
  for (Piece& piece : pieces) piece.sides = sides_of(piece, cells, cell_noise);
  pieces.erase(std::remove_if(pieces.begin(), pieces.end(),
                              [](const Piece& piece) { return !bears_witness(piece); }),
               pieces.end());
  const std::size_t witnesses = cells_in(pieces);
  keep_one_shift(pieces);
  if (pieces.size() < 2 || 2 * cells_in(pieces) <= witnesses) return agrees;
  for (const Piece& piece : pieces) {
    for (const std::size_t i : piece.cells) agrees(cells[i].cell.row, cells[i].cell.col) = true;
  }
  return agrees;
}

}  // namespace excavplan
