// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/planner.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double half_width =
    1.5;  // of the ground planned on [m]; ours: the bucket and its windrows

/// True if every cell the bucket passes, and the one ahead of it, is known.
bool known_under(const Terrain& terrain, const Machine& machine, const DigPath& path) {
  double x_min = path.start_x;
  for (const DigPose& pose : path.poses) x_min = std::min(x_min, pose.bucket.x);
  const HeightMap& bank = terrain.bank;
  const auto cells = [&](double from, double to, double origin, Index count) {
    const auto begin = static_cast<Index>(std::floor((from - origin) / bank.cell));
    const auto end = static_cast<Index>(std::ceil((to - origin) / bank.cell));
    return begin >= 0 && end <= count ? Eigen::seqN(begin, end - begin)
                                      : Eigen::seqN(Index{0}, Index{0});
  };
  const double half = 0.5 * machine.bucket.width_outside;
  // The simulator looks a quarter metre ahead of the lip for support and slope.
  const auto cols = cells(x_min - 0.25, path.start_x + bank.cell, bank.origin.x(), bank.z.cols());
  const auto rows = cells(-half, half, bank.origin.y(), bank.z.rows());
  return cols.size() > 0 && rows.size() > 0 && !bank.z(rows, cols).isNaN().any();
}

SearchBox search_box() {
  SearchBox box{Eigen::VectorXd(3), Eigen::VectorXd(3)};
  for (Index i = 0; i < 3; ++i) {
    const DigParameterInfo& info = dig_parameter_table()[static_cast<std::size_t>(i)];
    box.lower(i) = info.lower;
    box.upper(i) = info.upper;
  }
  return box;
}

DigParameters parameters_of(const Eigen::VectorXd& genes) {
  DigParameters parameters;
  for (Index i = 0; i < 3; ++i) {
    parameters.*dig_parameter_table()[static_cast<std::size_t>(i)].field = genes(i);
  }
  return parameters;
}

Eigen::VectorXd genes_of(const DigParameters& parameters) {
  Eigen::VectorXd genes(3);
  for (Index i = 0; i < 3; ++i) {
    genes(i) = parameters.*dig_parameter_table()[static_cast<std::size_t>(i)].field;
  }
  return genes;
}

/// The two rows of cells on either side of the boom plane.
struct BoomPlaneRows {
  Index first;
  Index count;
};

BoomPlaneRows rows_at_boom_plane(const HeightMap& map) {
  const auto row = static_cast<Index>(std::floor(-map.origin.y() / map.cell - 0.5));
  const Index first = std::clamp<Index>(row, 0, std::max<Index>(0, map.z.rows() - 2));
  return {first, std::min<Index>(2, map.z.rows() - first)};
}

GroundProfile profile_of(const HeightMap& map, const Eigen::ArrayXXd& rows, Index first_row) {
  HeightMap strip{map.origin, map.cell, rows};
  strip.origin.y() += map.cell * static_cast<double>(first_row);
  return [strip](double x) { return height_at(strip, x, 0.0); };
}

struct DigChoice {
  DigParameters parameters;
  std::optional<double> start_x;
};

std::variant<PlannedDig, DigFailure> evaluate_on(const GroundProfile& ground,
                                                 const Machine& machine,
                                                 const SoilSimulator& simulator,
                                                 const Terrain& terrain, const DigChoice& choice) {
  const DigParameters& parameters = choice.parameters;
  const auto laid_out = choice.start_x ? make_dig_path(machine, parameters, *choice.start_x, ground)
                                       : make_dig_path_anywhere(machine, parameters, ground);
  if (const auto* infeasible = std::get_if<Infeasible>(&laid_out)) return DigFailure(*infeasible);
  const DigPath& path = std::get<DigPath>(laid_out);
  if (!known_under(terrain, machine, path)) {
    Infeasible unknown;
    unknown.reason = Infeasible::Reason::unknown_ground;
    unknown.value = path.start_x;
    unknown.message = "the path runs over ground that is unknown or off the map";
    return DigFailure(unknown);
  }
  const DigResult result = simulator.dig(terrain, path);
  if (result.stall) return DigFailure(*result.stall);
  return PlannedDig{parameters,          path.start_x,
                    result.payload_mass, result.payload_volume,
                    result.energy.total, time_dig_path(machine, path).dig_duration()};
}

}  // namespace

std::string describe(const DigFailure& failure) {
  if (const auto* infeasible = std::get_if<Infeasible>(&failure)) return infeasible->message;
  const Stall& stall = std::get<Stall>(failure);
  return std::string("the ") + name(stall.joint) + " stalls in the phase " + name(stall.phase) +
         " after " + std::to_string(stall.travelled) + " m: it would need " +
         std::to_string(std::abs(stall.torque) / 1000.0) + " kN m";
}

Rectangle planning_extent(const Machine& machine) {
  return {machine.track_front - 1.0, -half_width,
          machine.boom_pin.x() + machine.full_length() + 0.5, half_width};
}

Terrain level_planning_ground(const Machine& machine, double cell) {
  return undisturbed(flat_ground(planning_extent(machine), cell));
}

GroundProfile boom_plane_profile(const HeightMap& surface) {
  const BoomPlaneRows rows = rows_at_boom_plane(surface);
  return profile_of(surface, surface.z.middleRows(rows.first, rows.count), rows.first);
}

GroundProfile boom_plane_profile(const Terrain& terrain) {
  const BoomPlaneRows rows = rows_at_boom_plane(terrain.bank);
  return profile_of(terrain.bank,
                    terrain.bank.z.middleRows(rows.first, rows.count) +
                        terrain.loose.middleRows(rows.first, rows.count),
                    rows.first);
}

std::variant<PlannedDig, DigFailure> evaluate_dig(const Machine& machine,
                                                  const SoilSimulator& simulator,
                                                  const Terrain& terrain,
                                                  const DigParameters& parameters,
                                                  std::optional<double> start_x) {
  return evaluate_on(boom_plane_profile(terrain), machine, simulator, terrain,
                     {parameters, start_x});
}

std::optional<DigSearchResult> search_dig(const Machine& machine, const SoilSimulator& simulator,
                                          const Terrain& terrain, const DigSearchOptions& options) {
  const GroundProfile ground = boom_plane_profile(terrain);
  const auto evaluate = [&](const Eigen::VectorXd& genes) {
    return evaluate_on(ground, machine, simulator, terrain, {parameters_of(genes), {}});
  };
  SearchProblem problem{search_box(), [&](const Eigen::VectorXd& genes) -> Evaluation {
                          const auto outcome = evaluate(genes);
                          if (const auto* dig = std::get_if<PlannedDig>(&outcome)) {
                            return dig->efficiency();
                          }
                          return Evaluation::infeasible(0.0,
                                                        describe(std::get<DigFailure>(outcome)));
                        }};
  SearchOptions asked;
  asked.method = options.method;
  asked.stop = options.stop;
  asked.seed = options.seed;
  asked.threads = options.threads;
  asked.progress = options.progress;
  for (const DigParameters& start : options.start) asked.start.push_back(genes_of(start));
  const SearchResult found = search(problem, asked);
  if (!found.feasible()) return std::nullopt;

  DigSearchResult result{{}, found.evaluations, found.infeasible, false};
  result.stopped = found.stopped_by == StopReason::cancelled;
  result.dig = std::get<PlannedDig>(evaluate(found.best));
  return result;
}

}  // namespace excavplan
