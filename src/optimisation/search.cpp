// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/optimisation/search.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/error.hpp>

#include "base/text.hpp"
#include "optimisation/search_methods.hpp"

namespace excavplan {
namespace {

using Eigen::VectorXd;

void require(bool holds, const std::string& rule, double value) {
  if (!holds) {
    throw Error(ErrorKind::bad_input, "search: " + rule + ", got " + number_text(value));
  }
}

void require_evaluations(const std::string& what, double count) {
  require(count <= most_evaluations, what + " must be <= " + std::to_string(most_evaluations),
          count);
}

void require_count(const std::string& what, int count, int least) {
  require(count >= least, what + " must be >= " + std::to_string(least), count);
  require_evaluations(what, count);
}

void check(const SearchProblem& problem) {
  const SearchBox& box = problem.box;
  require(box.lower.size() > 0 && box.lower.size() == box.upper.size(),
          "the box needs as many lower as upper bounds, at least one",
          static_cast<double>(box.lower.size()));
  for (Eigen::Index i = 0; i < box.lower.size(); ++i) {
    require(
        std::isfinite(box.lower(i)) && std::isfinite(box.upper(i)) && box.lower(i) <= box.upper(i),
        "bounds must be finite and lower <= upper", box.lower(i));
    require(std::isfinite(box.upper(i) - box.lower(i)), "bounds must be a finite distance apart",
            box.lower(i));
  }
  require(problem.step.size() == 0 || problem.step.size() == box.lower.size(),
          "there must be as many steps as bounds or none",
          static_cast<double>(problem.step.size()));
  for (const double step : problem.step) {
    require(std::isfinite(step) && step >= 0.0, "steps must be finite and >= 0", step);
  }
  if (!problem.objective) throw Error(ErrorKind::bad_input, "search: the objective is empty");
}

void check(const GeneticAlgorithm& method, const SearchTask&) {
  require_count("population", method.population, 2);
  require(method.generations >= 1, "generations must be >= 1", method.generations);
  require_evaluations("population x generations", 1.0 * method.population * method.generations);
  require_count("tournament", method.tournament, 1);
  require(method.crossover >= 0.0 && method.crossover <= 1.0, "crossover must be in 0 .. 1",
          method.crossover);
  require(method.mutation >= 0.0 && method.mutation <= 1.0, "mutation must be in 0 .. 1",
          method.mutation);
  require(method.elites >= 0 && method.elites < method.population,
          "elites must be in 0 .. population - 1 = " + std::to_string(method.population - 1),
          method.elites);
}

void check(const MemeticSearch& method, const SearchTask& task) {
  require(method.first_generation >= (task.start.empty() ? 1 : 0),
          task.start.empty() ? "first_generation must be >= 1 without given points"
                             : "first_generation must be >= 0",
          method.first_generation);
  require_count("first_generation", method.first_generation, 0);
  require(method.generations >= 0, "generations must be >= 0", method.generations);
  require_count("generation_size", method.generation_size, 1);
  require_evaluations("generations x generation_size",
                      1.0 * method.generations * method.generation_size);
  require(method.immigrants >= 0.0 && method.immigrants <= 1.0, "immigrants must be in 0 .. 1",
          method.immigrants);
  require(method.basins >= 0, "basins must be >= 0", method.basins);
  require_count("polish_evaluations", method.polish_evaluations, 0);
  require(method.restarts >= 0, "restarts must be >= 0", method.restarts);
  require(method.basin_radius > 0.0, "basin_radius must be > 0", method.basin_radius);
}

void check(const SearchOptions& options) {
  require_count("stop.evaluations", options.stop.evaluations, 0);
  require(options.stop.stall >= 0, "stop.stall must be >= 0", options.stop.stall);
  require(options.stop.seconds >= 0.0, "stop.seconds must be >= 0", options.stop.seconds);
  require(!options.stop.target || std::isfinite(*options.stop.target), "stop.target must be finite",
          options.stop.target.value_or(0.0));
  require(options.checkpoint_interval >= 0.0, "checkpoint_interval must be >= 0",
          options.checkpoint_interval);
}

std::vector<VectorXd> clipped(const std::vector<VectorXd>& points, const SearchBox& box) {
  std::vector<VectorXd> inside;
  for (const VectorXd& point : points) {
    require(point.size() == box.lower.size(), "a start needs as many numbers as the box has bounds",
            static_cast<double>(point.size()));
    for (const double number : point)
      require(std::isfinite(number), "a start must be finite", number);
    inside.emplace_back(point.cwiseMax(box.lower).cwiseMin(box.upper));
  }
  return inside;
}

/// Evaluations a method makes at most; a double, for the products know no bounds.
double planned_evaluations(const GeneticAlgorithm& method, const SearchTask& task) {
  const double first = std::max<double>(method.population, static_cast<double>(task.start.size()));
  return first + (method.generations - 1.0) * (method.population - method.elites);
}

double planned_evaluations(const MemeticSearch& method, const SearchTask& task) {
  const auto given = static_cast<double>(task.start.size());
  const double of_given = std::min<double>(given, method.basins);
  const double polishes =
      method.basins > 0 ? 1.0 * method.restarts + method.basins + of_given + method.generations
                        : 0.0;
  return given + method.first_generation + polishes * method.polish_evaluations +
         1.0 * method.generations * method.generation_size;
}

}  // namespace

SearchResult search(const SearchProblem& problem, const SearchOptions& options) {
  check(problem);
  check(options);
  const SearchTask task{problem.box, options.seed, clipped(options.start, problem.box)};
  return std::visit(
      [&](const auto& method) {
        check(method, task);
        SearchLog log(problem, options, planned_evaluations(method, task));
        run(method, task, log);
        return log.finish();
      },
      options.method);
}

}  // namespace excavplan
