// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/efficiency/run_comparison.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/check.hpp"
#include "base/random.hpp"
#include "efficiency/student.hpp"

namespace excavplan {
namespace {

constexpr std::size_t most_divisions = 200000;  // that are all looked at; ours
constexpr std::size_t random_divisions = 50000;
constexpr std::size_t few_runs = 10;
constexpr double rounding = 1e-9;  // of a statistic

struct Moments {
  double mean = 0.0;
  double variance = 0.0;  ///< of one
  double count = 0.0;
};

Moments moments(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, squares / (n - 1.0), n};
}

std::vector<double> logarithms(const std::vector<double>& runs, const char* which) {
  require(runs.size() >= 2, std::string("the ") + which + " set has " +
                                std::to_string(runs.size()) + " run, a comparison needs 2 or more");
  std::vector<double> list;
  for (const double run : runs) {
    require(run > 0.0 && std::isfinite(run),
            std::string("efficiency of a run in the ") + which + " set", run, "above 0 and finite");
    list.push_back(std::log(run));
  }
  return list;
}

/// Standard error of the difference of the means.
double standard_error(const Moments& a, const Moments& b) {
  return std::sqrt(a.variance / a.count + b.variance / b.count);
}

/// Difference of the means in standard errors; infinite where neither scatters.
double statistic(const Moments& a, const Moments& b) {
  const double difference = b.mean - a.mean;
  const double error = standard_error(a, b);
  if (difference == 0.0) return 0.0;
  if (error > rounding * std::abs(difference)) return difference / error;
  return std::copysign(std::numeric_limits<double>::infinity(), difference);
}

WelchTest welch_test(const Moments& a, const Moments& b) {
  const double t = statistic(a, b);
  if (std::isinf(t)) return {t, std::nan(""), 0.0};
  const auto part = [](const Moments& set) {
    return std::pow(set.variance / set.count, 2) / (set.count - 1.0);
  };
  const double freedom = std::pow(standard_error(a, b), 4) / (part(a) + part(b));
  return {t, freedom, t == 0.0 ? 1.0 : student_two_sided(t, freedom)};
}

/// Number of ways to choose; `most_divisions` + 1 for more than that.
std::size_t ways_to_choose(std::size_t n, std::size_t k) {
  std::size_t ways = 1;
  for (std::size_t i = 1; i <= std::min(k, n - k); ++i) {
    ways = ways * (n - std::min(k, n - k) + i) / i;
    if (ways > most_divisions) return most_divisions + 1;
  }
  return ways;
}

/// Counts divisions of the runs that differ as much as the observed one.
class DivisionCount {
 public:
  explicit DivisionCount(double observed) : least_(std::abs(observed) * (1.0 - rounding)) {}

  void add(const std::vector<double>& first, const std::vector<double>& second) {
    ++looked_at_;
    if (std::abs(statistic(moments(first), moments(second))) >= least_) ++as_far_;
  }
  PermutationTest result(bool is_exact) const {
    // The observed division is one of the random ones (Davison and Hinkley 1997, eq. 4.11).
    const double own = is_exact ? 0.0 : 1.0;
    return {(static_cast<double>(as_far_) + own) / (static_cast<double>(looked_at_) + own),
            is_exact, looked_at_};
  }

 private:
  double least_;
  std::size_t looked_at_ = 0;
  std::size_t as_far_ = 0;
};

void add_all_divisions(DivisionCount& count, const std::vector<double>& all, std::size_t chosen) {
  std::vector<bool> in_first(all.size(), false);
  std::fill_n(in_first.begin(), chosen, true);
  std::vector<double> first;
  std::vector<double> second;
  do {
    first.clear();
    second.clear();
    for (std::size_t i = 0; i < all.size(); ++i) (in_first[i] ? first : second).push_back(all[i]);
    count.add(first, second);
  } while (std::prev_permutation(in_first.begin(), in_first.end()));
}

void add_random_divisions(DivisionCount& count, std::vector<double> all, std::size_t chosen) {
  Random random(1);
  const auto middle = static_cast<std::ptrdiff_t>(chosen);
  for (std::size_t draw = 0; draw < random_divisions; ++draw) {
    for (std::size_t i = 0; i < chosen; ++i) {
      std::swap(all[i], all[i + random.index(all.size() - i)]);
    }
    count.add({all.begin(), all.begin() + middle}, {all.begin() + middle, all.end()});
  }
}

PermutationTest permutation_test(const std::vector<double>& first,
                                 const std::vector<double>& second) {
  std::vector<double> all = first;
  all.insert(all.end(), second.begin(), second.end());
  DivisionCount count(statistic(moments(first), moments(second)));
  const bool is_exact = ways_to_choose(all.size(), first.size()) <= most_divisions;
  if (is_exact) {
    add_all_divisions(count, all, first.size());
  } else {
    add_random_divisions(count, std::move(all), first.size());
  }
  return count.result(is_exact);
}

RunSet summary(const std::vector<double>& runs, const Moments& logs) {
  const Moments plain = moments(runs);
  return {runs.size(), plain.mean, std::sqrt(plain.variance), std::exp(logs.mean)};
}

}  // namespace

SetComparison compare_runs(const std::vector<double>& first, const std::vector<double>& second) {
  constexpr double confidence = 0.95;
  const std::vector<double> first_logs = logarithms(first, "first");
  const std::vector<double> second_logs = logarithms(second, "second");
  const Moments a = moments(first_logs);
  const Moments b = moments(second_logs);
  SetComparison result;
  result.first = summary(first, a);
  result.second = summary(second, b);
  result.welch = welch_test(a, b);
  result.permutation = permutation_test(first_logs, second_logs);
  result.by_permutation = std::min(first.size(), second.size()) < few_runs;
  const double freedom = result.welch.degrees_of_freedom;
  const double reach =
      std::isfinite(freedom) ? student_quantile(confidence, freedom) * standard_error(a, b) : 0.0;
  const auto percent = [](double log_ratio) { return 100.0 * std::expm1(log_ratio); };
  result.gain_percent = percent(b.mean - a.mean);
  result.gain_low_percent = percent(b.mean - a.mean - reach);
  result.gain_high_percent = percent(b.mean - a.mean + reach);
  return result;
}

}  // namespace excavplan
