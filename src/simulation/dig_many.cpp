// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/dig_many.hpp>

#include "base/parallel.hpp"

namespace excavplan {

std::vector<DigResult> dig_many(const SoilSimulator& simulator, const Terrain& terrain,
                                const std::vector<DigPath>& paths, const DigOptions& options,
                                unsigned threads) {
  std::vector<DigResult> results(paths.size());
  parallel_for(paths.size(), threads,
               [&](std::size_t i) { results[i] = simulator.dig(terrain, paths[i], options); });
  return results;
}

}  // namespace excavplan
