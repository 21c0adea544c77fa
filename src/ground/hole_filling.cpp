// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/hole_filling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

namespace excavplan {
namespace {

constexpr int unvisited = -2;
constexpr int outside = -3;
constexpr int known = -1;

/// A sum of heights whose square is one term of the energy.
struct Term {
  std::array<std::pair<Eigen::Index, Eigen::Index>, 4> offset;  // row, col
  std::array<double, 4> weight;
  int cells;
};

std::vector<Term> terms_of(Filling filling) {
  const double slope = filling == Filling::membrane ? 1.0 : std::sqrt(0.05);  // ours, of curvature
  std::vector<Term> terms = {{{{{0, 0}, {0, 1}}}, {slope, -slope}, 2},
                             {{{{0, 0}, {1, 0}}}, {slope, -slope}, 2}};
  if (filling == Filling::membrane) return terms;
  const double twist = std::sqrt(2.0);
  terms.push_back({{{{0, -1}, {0, 0}, {0, 1}}}, {1.0, -2.0, 1.0}, 3});
  terms.push_back({{{{-1, 0}, {0, 0}, {1, 0}}}, {1.0, -2.0, 1.0}, 3});
  terms.push_back({{{{0, 0}, {0, 1}, {1, 0}, {1, 1}}}, {twist, -twist, -twist, twist}, 4});
  return terms;
}

/// The linear system of a filling: `stiffness` x = - `coupling` of the known cells of the rim.
struct System {
  Eigen::SparseMatrix<double> stiffness;
  Eigen::SparseMatrix<double> coupling;
  std::vector<Cell> rim;
};

/// Numbers the cells of a grid in the order in which they are visited.
class Numbering {
 public:
  Numbering(const Eigen::ArrayXXd& grid, const std::vector<Cell>& unknown)
      : number_(Eigen::ArrayXXi::Constant(grid.rows(), grid.cols(), free)) {
    for (std::size_t i = 0; i < unknown.size(); ++i) {
      number_(unknown[i].row, unknown[i].col) = static_cast<int>(i);
    }
  }
  bool is_unknown(Cell cell) const { return number_(cell.row, cell.col) >= 0; }
  int unknown(Cell cell) const { return number_(cell.row, cell.col); }
  int rim(Cell cell) {
    int& number = number_(cell.row, cell.col);
    if (number == free) {
      rim_.push_back(cell);
      number = -1 - static_cast<int>(rim_.size());
    }
    return -2 - number;
  }
  std::vector<Cell> rim_cells() && { return std::move(rim_); }

 private:
  static constexpr int free = -1;
  Eigen::ArrayXXi number_;  // of unknown cells from 0 up, of rim cells from -2 down
  std::vector<Cell> rim_;
};

/// Calls `visit` with the cells of every term that reaches an unknown cell and no cell that is
/// neither known nor to be filled.
template <typename Visit>
void for_each_term(const Eigen::ArrayXXd& z, const std::vector<Cell>& unknown,
                   const Numbering& numbering, Filling filling, Visit visit) {
  const auto inside = [&](Cell at) {
    return at.row >= 0 && at.col >= 0 && at.row < z.rows() && at.col < z.cols();
  };
  for (const Term& term : terms_of(filling)) {
    for (const Cell cell : unknown) {
      for (int anchor = 0; anchor < term.cells; ++anchor) {
        const auto& from = term.offset[static_cast<std::size_t>(anchor)];
        std::array<Cell, 4> cells{};
        bool usable = true;
        for (int i = 0; i < term.cells && usable; ++i) {
          const auto& offset = term.offset[static_cast<std::size_t>(i)];
          const Cell at = {cell.row + offset.first - from.first,
                           cell.col + offset.second - from.second};
          cells[static_cast<std::size_t>(i)] = at;
          // Every term is counted once: from the first of its cells that is unknown.
          usable = inside(at) &&
                   (numbering.is_unknown(at) ? i >= anchor : !std::isnan(z(at.row, at.col)));
        }
        if (usable) visit(term, cells);
      }
    }
  }
}

System system_of(const Eigen::ArrayXXd& z, const std::vector<Cell>& unknown, Filling filling) {
  Numbering numbering(z, unknown);
  std::vector<Eigen::Triplet<double>> stiffness;
  std::vector<Eigen::Triplet<double>> coupling;
  const auto add = [&](const Term& term, const std::array<Cell, 4>& cells) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(term.cells); ++i) {
      if (!numbering.is_unknown(cells[i])) continue;
      for (std::size_t j = 0; j < static_cast<std::size_t>(term.cells); ++j) {
        const double product = term.weight[i] * term.weight[j];
        if (numbering.is_unknown(cells[j])) {
          stiffness.emplace_back(numbering.unknown(cells[i]), numbering.unknown(cells[j]), product);
        } else {
          coupling.emplace_back(numbering.unknown(cells[i]), numbering.rim(cells[j]), product);
        }
      }
    }
  };
  for_each_term(z, unknown, numbering, filling, add);
  System system;
  system.rim = std::move(numbering).rim_cells();
  const auto count = static_cast<Eigen::Index>(unknown.size());
  system.stiffness.resize(count, count);
  system.stiffness.setFromTriplets(stiffness.begin(), stiffness.end());
  system.coupling.resize(count, static_cast<Eigen::Index>(system.rim.size()));
  system.coupling.setFromTriplets(coupling.begin(), coupling.end());
  return system;
}

/// The sum over some cells of a filled hole as a weighted sum over its rim.
struct Functional {
  std::vector<Cell> rim;
  Eigen::VectorXd weight;
};

Functional functional_of(const Eigen::ArrayXXd& z, const std::vector<Cell>& hole,
                         const Eigen::VectorXd& summed, Filling filling) {
  System system = system_of(z, hole, filling);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(system.stiffness);
  Functional functional;
  functional.weight = -(system.coupling.transpose() * factor.solve(summed));
  functional.rim = std::move(system.rim);
  return functional;
}

/// A move of the grid onto itself: one of the eight symmetries of the square, then a shift.
struct Place {
  int symmetry;
  Cell from;
  Cell to;
  Cell operator()(Cell cell) const {
    Eigen::Index row = cell.row - from.row;
    Eigen::Index col = cell.col - from.col;
    if ((symmetry & 1) != 0) row = -row;
    if ((symmetry & 2) != 0) col = -col;
    if ((symmetry & 4) != 0) std::swap(row, col);
    return {to.row + row, to.col + col};
  }
};

/// Heights of cells moved to a place; false if one is unknown there.
bool heights_at(const Eigen::ArrayXXd& z, const std::vector<Cell>& cells, const Place& place,
                Eigen::VectorXd& heights) {
  heights.resize(static_cast<Eigen::Index>(cells.size()));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell at = place(cells[i]);
    if (at.row < 0 || at.col < 0 || at.row >= z.rows() || at.col >= z.cols()) return false;
    const double height = z(at.row, at.col);
    if (std::isnan(height)) return false;
    heights(static_cast<Eigen::Index>(i)) = height;
  }
  return true;
}

/// Distance of heights from the planes: least squares on (1, row, col) of the cells.
class RimRelief {
 public:
  explicit RimRelief(const std::vector<Cell>& cells) : plane_(cells.size(), 3) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      plane_.row(static_cast<Eigen::Index>(i)) << 1.0, static_cast<double>(cells[i].row),
          static_cast<double>(cells[i].col);
    }
    const Eigen::Vector3d mean = plane_.colwise().mean();
    plane_.rightCols<2>().rowwise() -= mean.tail<2>().transpose();
    factor_.compute(plane_.transpose() * plane_);
  }
  /// Mean square about the best plane.
  double operator()(const Eigen::VectorXd& heights) const {
    const Eigen::Vector3d plane = factor_.solve(plane_.transpose() * heights);
    return (heights - plane_ * plane).squaredNorm() / static_cast<double>(heights.size());
  }

 private:
  Eigen::Matrix<double, Eigen::Dynamic, 3> plane_;
  Eigen::LDLT<Eigen::Matrix3d> factor_;
};

}  // namespace

Holes find_holes(const Eigen::ArrayXXd& z) {
  Holes holes;
  holes.index = z.isNaN().select(Eigen::ArrayXXi::Constant(z.rows(), z.cols(), unvisited), known);
  const auto any = [](Cell) { return true; };
  for_each_cell(z, [&](Cell cell) {
    if (on_border(z, cell) && holes.index(cell.row, cell.col) == unvisited) {
      mark_connected(holes.index, cell, outside, any);
    }
  });
  for_each_cell(z, [&](Cell cell) {
    if (holes.index(cell.row, cell.col) != unvisited) return;
    const int index = static_cast<int>(holes.cells.size());
    holes.cells.push_back(mark_connected(holes.index, cell, index, any));
  });
  holes.index = holes.index.max(known);
  return holes;
}

void fill(Eigen::ArrayXXd& z, const std::vector<Cell>& unknown, Filling filling) {
  if (unknown.empty()) return;
  const System system = system_of(z, unknown, filling);
  Eigen::VectorXd rim(static_cast<Eigen::Index>(system.rim.size()));
  for (std::size_t i = 0; i < system.rim.size(); ++i) {
    rim(static_cast<Eigen::Index>(i)) = z(system.rim[i].row, system.rim[i].col);
  }
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(system.stiffness);
  const Eigen::VectorXd heights = -factor.solve(system.coupling * rim);
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    z(unknown[i].row, unknown[i].col) = heights(static_cast<Eigen::Index>(i));
  }
}

Holes fill_holes(Eigen::ArrayXXd& z) {
  Holes holes = find_holes(z);
  std::vector<Cell> unknown;
  for (const std::vector<Cell>& hole : holes.cells) {
    unknown.insert(unknown.end(), hole.begin(), hole.end());
  }
  fill(z, unknown, Filling::membrane);
  return holes;
}

double error_of_filling(const Eigen::ArrayXXd& z, const std::vector<Cell>& hole,
                        const std::vector<Cell>& summed, const std::vector<Cell>& tried) {
  constexpr double safety = 1.5;           // ours: the errors have long tails
  constexpr std::size_t most_tries = 400;  // ours
  constexpr int fewest_places = 8;         // ours
  constexpr double without_places = 0.5;   // ours: of the rim's relief times the cells
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(hole.size()));
  auto next = summed.begin();
  for (std::size_t i = 0; i < hole.size() && next != summed.end(); ++i) {
    if (next->row != hole[i].row || next->col != hole[i].col) continue;
    sums(static_cast<Eigen::Index>(i)) = 1.0;
    ++next;
  }
  const Functional plate = functional_of(z, hole, sums, Filling::thin_plate);
  const Functional membrane = functional_of(z, hole, sums, Filling::membrane);
  const RimRelief relief(plate.rim);

  Eigen::VectorXd rim;
  Eigen::VectorXd rim_of_membrane;
  Eigen::VectorXd inside;
  const Place here{0, hole[0], hole[0]};
  heights_at(z, plate.rim, here, rim);
  heights_at(z, membrane.rim, here, rim_of_membrane);
  const double own_relief = relief(rim);
  const double spread = plate.weight.dot(rim) - membrane.weight.dot(rim_of_membrane);

  int places = 0;
  double squares = 0.0;
  const std::size_t stride = tried.size() / most_tries + 1;
  for (std::size_t i = 0; i < tried.size(); i += stride) {
    const Place place{static_cast<int>((i / stride) % 8), hole[hole.size() / 2], tried[i]};
    if (!heights_at(z, hole, place, inside) || !heights_at(z, plate.rim, place, rim)) continue;
    const double miss = plate.weight.dot(rim) - sums.dot(inside);
    const double there = relief(rim);
    if (!(there > 0.0)) continue;
    squares += miss * miss / there;
    ++places;
  }
  const double cells = sums.sum();
  const double share = places >= fewest_places ? safety * safety * squares / places
                                               : std::pow(without_places * cells, 2);
  return std::max(share * own_relief, spread * spread);
}

}  // namespace excavplan
