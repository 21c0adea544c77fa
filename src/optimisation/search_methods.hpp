// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optimisation/search_log.hpp"

namespace excavplan {

/// What every method gets: options that are checked, start points that are clipped.
struct SearchTask {
  const SearchBox& box;
  std::uint64_t seed;
  std::vector<Eigen::VectorXd> start;
};

/// Each fills the log until its last generation or until the log is stopped.
void run(const GeneticAlgorithm& method, const SearchTask& task, SearchLog& log);
void run(const MemeticSearch& method, const SearchTask& task, SearchLog& log);

}  // namespace excavplan
