// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/optimisation/search_analysis.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "optimisation/search_log.hpp"
#include "optimisation/search_points.hpp"
#include "optimisation/sound_evaluation.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A feasible point of the history, in shares of the box from the best.
struct Point {
  VectorXd away;
  double fitness;
  int place;
};

/// One of each feasible point, best first.
std::vector<Point> feasible_points(const SearchBox& box, const SearchResult& result) {
  const UnitCube cube(box);
  std::vector<Point> points;
  for (std::size_t i = 0; i < result.history.size(); ++i) {
    const SearchRecord& record = result.history[i];
    if (!record.outcome.ok() || record.source != SearchRecord::Source::simulated) continue;
    points.push_back(
        {cube.share(record.point - result.best), record.outcome.fitness, static_cast<int>(i)});
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const Point& a, const Point& b) { return a.fitness > b.fitness; });
  return points;
}

double distance(const Point& a, const Point& b) { return (a.away - b.away).cwiseAbs().maxCoeff(); }

std::optional<int> second_basin(const std::vector<Point>& points, double radius) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto near = [&](const Point& other) { return distance(points[i], other) <= radius; };
    const auto end = points.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::none_of(points.begin(), end, near)) return points[i].place;
  }
  return std::nullopt;
}

/// The points from the best on that are linked to it, all of at least this fitness.
std::vector<Point> linked(const std::vector<Point>& points, double least, double step) {
  std::vector<Point> found = {points.front()};
  std::vector<Point> others;
  for (std::size_t i = 1; i < points.size() && points[i].fitness >= least; ++i) {
    others.push_back(points[i]);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Point from = found[i];
    const auto far = std::stable_partition(
        others.begin(), others.end(), [&](const Point& p) { return distance(p, from) > step; });
    found.insert(found.end(), far, others.end());
    others.erase(far, others.end());
  }
  return found;
}

/// c + g d + d' H d / 2
struct Quadratic {
  double c;
  VectorXd g;
  MatrixXd h;
};

std::optional<Quadratic> fit(const std::vector<Point>& points) {
  const Index n = points.front().away.size();
  const Index terms = (n + 1) * (n + 2) / 2;
  const auto count = static_cast<Index>(points.size());
  if (count < 2 * terms) return std::nullopt;
  MatrixXd a(count, terms);
  VectorXd b(count);
  for (Index row = 0; row < count; ++row) {
    const Point& point = points[static_cast<std::size_t>(row)];
    a(row, 0) = 1.0;
    a.row(row).segment(1, n) = point.away.transpose();
    Index term = n + 1;
    for (Index i = 0; i < n; ++i) {
      for (Index j = i; j < n; ++j) {
        a(row, term++) = (i == j ? 0.5 : 1.0) * point.away(i) * point.away(j);
      }
    }
    b(row) = point.fitness;
  }
  const auto solver = a.colPivHouseholderQr();
  if (solver.rank() < terms) return std::nullopt;
  const VectorXd x = solver.solve(b);
  Quadratic q{x(0), x.segment(1, n), MatrixXd(n, n)};
  Index term = n + 1;
  for (Index i = 0; i < n; ++i) {
    for (Index j = i; j < n; ++j) q.h(i, j) = q.h(j, i) = x(term++);
  }
  return q;
}

std::vector<ParameterRange> fitted_ranges(const SearchBox& box, const VectorXd& best,
                                          const std::vector<Point>& points, double least) {
  const auto q = fit(points);
  if (!q) return {};
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(q->h);
  if (eigen.eigenvalues().maxCoeff() >= 0.0) return {};
  const MatrixXd inverse = -q->h.inverse();
  const VectorXd top = inverse * q->g;
  const double spare = q->c + 0.5 * q->g.dot(top) - least;
  if (!(spare > 0.0)) return {};
  std::vector<ParameterRange> ranges;
  for (Index i = 0; i < best.size(); ++i) {
    const double scale = box.upper(i) - box.lower(i);
    const double centre = best(i) + scale * top(i);
    const double half = scale * std::sqrt(2.0 * spare * inverse(i, i));
    ranges.push_back({std::clamp(centre - half, box.lower(i), box.upper(i)),
                      std::clamp(centre + half, box.lower(i), box.upper(i))});
  }
  return ranges;
}

/// Every point has as many numbers as the box.
void check(const SearchBox& box, const SearchResult& result) {
  const auto fits = [&](const VectorXd& point) {
    return point.size() == box.lower.size() && point.allFinite();
  };
  bool holds = fits(box.lower) && fits(box.upper) && fits(result.best);
  for (const SearchRecord& record : result.history) holds = holds && fits(record.point);
  if (!holds) refuse("explain: box, best point and history must be finite and of one dimension");
}

void average(RepeatedEvaluation& point, const Evaluation* outcomes) {
  double sum = 0.0;
  for (int i = 0; i < point.repeats; ++i) {
    if (!outcomes[i].ok()) continue;
    sum += outcomes[i].fitness;
    ++point.ok;
  }
  point.mean = point.ok > 0 ? sum / point.ok : nan;
  double squares = 0.0;
  for (int i = 0; i < point.repeats; ++i) {
    if (outcomes[i].ok()) squares += std::pow(outcomes[i].fitness - point.mean, 2);
  }
  point.sd = point.ok > 1 ? std::sqrt(squares / (point.ok - 1)) : nan;
}

}  // namespace

const char* name(SearchRecord::Origin origin) {
  using Origin = SearchRecord::Origin;
  switch (origin) {
    case Origin::given:
      return "given";
    case Origin::space_filling:
      return "space filling";
    case Origin::random:
      return "random";
    case Origin::polish:
      return "polish";
    case Origin::crossover:
      return "crossover";
    case Origin::mutation:
      return "mutation";
    case Origin::immigrant:
      return "immigrant";
  }
  return "";
}

const char* name(SearchRecord::Source source) {
  switch (source) {
    case SearchRecord::Source::simulated:
      return "simulated";
    case SearchRecord::Source::cached:
      return "cached";
    case SearchRecord::Source::repair:
      return "repair";
  }
  return "";
}

std::string to_csv(const SearchResult& result) {
  std::string csv = "place,generation,origin,polish,parents,source,status,fitness,violation,reason";
  for (Index i = 0; i < result.best.size(); ++i) csv += ",x" + std::to_string(i + 1);
  csv += "\n";
  for (std::size_t i = 0; i < result.history.size(); ++i) {
    const SearchRecord& record = result.history[i];
    std::string parents;
    for (const int parent : record.parents) {
      parents += (parents.empty() ? "" : ";") + std::to_string(parent);
    }
    csv += std::to_string(i) + "," + std::to_string(record.generation) + "," + name(record.origin) +
           "," + std::to_string(record.polish) + "," + parents + "," + name(record.source) + "," +
           name(record.outcome.status) + "," +
           (record.outcome.ok() ? number_text(record.outcome.fitness) : "") + "," +
           number_text(record.outcome.violation) + "," + csv_field(record.outcome.reason);
    for (const double number : record.point) csv += "," + number_text(number);
    csv += "\n";
  }
  return csv;
}

SearchInsight explain(const SearchBox& box, const SearchResult& result, double share,
                      double radius) {
  SearchInsight insight;
  if (!result.feasible()) return insight;
  check(box, result);
  require_in("explain: share", share, 0.0, 1.0);
  require(radius > 0.0 && std::isfinite(radius), "explain: radius", radius, "above 0 and finite");
  const std::vector<Point> points = feasible_points(box, result);
  if (points.empty()) return insight;
  const double best = points.front().fitness;
  const double least = best - (1.0 - share) * std::abs(best);
  insight.second_basin = second_basin(points, radius);
  const std::vector<Point> worth = linked(points, least, 0.5 * radius);
  for (Index i = 0; i < result.best.size(); ++i) {
    ParameterRange range{result.best(i), result.best(i)};
    for (const Point& point : worth) {
      const double value = result.history[static_cast<std::size_t>(point.place)].point(i);
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
    }
    insight.seen.push_back(range);
  }
  // Twice as far down as asked for: enough points to fit, and no far slope.
  const std::vector<Point> around = linked(points, best - 2.0 * (best - least), 0.5 * radius);
  insight.fitted = fitted_ranges(box, result.best, around, least);
  return insight;
}

std::vector<RepeatedEvaluation> evaluate_again(const SearchResult& result,
                                               const NoisyObjective& objective, int best,
                                               int repeats, unsigned threads) {
  if (best < 1 || repeats < 1) {
    throw Error(ErrorKind::bad_input, "search: best and repeats must be >= 1, got " +
                                          std::to_string(best) + " and " + std::to_string(repeats));
  }
  constexpr int most = 1000000;  // ours
  require_in("search: repeats", repeats, 1, most);
  if (!objective) refuse("search: the objective is empty");
  std::vector<const SearchRecord*> order;
  for (const SearchRecord& record : result.history) {
    if (record.outcome.ok() && record.source == SearchRecord::Source::simulated) {
      order.push_back(&record);
    }
  }
  std::stable_sort(order.begin(), order.end(), [](const SearchRecord* a, const SearchRecord* b) {
    return a->outcome.fitness > b->outcome.fitness;
  });
  order.resize(std::min(order.size(), static_cast<std::size_t>(best)));
  const auto each = static_cast<std::size_t>(repeats);
  std::vector<Evaluation> outcomes(order.size() * each);
  parallel_for(outcomes.size(), threads, [&](std::size_t i) {
    outcomes[i] = sound(caught([&]() -> Evaluation {
      return objective(order[i / each]->point, static_cast<int>(i % each));
    }));
  });
  std::vector<RepeatedEvaluation> points;
  for (std::size_t i = 0; i < order.size(); ++i) {
    points.push_back({order[i]->point, order[i]->outcome.fitness, 0.0, 0.0, 0, repeats});
    average(points.back(), &outcomes[i * each]);
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const RepeatedEvaluation& a, const RepeatedEvaluation& b) {
                     return a.ok > 0 && (b.ok == 0 || a.mean > b.mean);
                   });
  return points;
}

}  // namespace excavplan
