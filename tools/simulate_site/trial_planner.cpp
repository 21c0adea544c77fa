// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_site/trial_planner.hpp"

#include <excavplan/trial/plain_planners.hpp>

#include "frame/arguments.hpp"

namespace excavplan::tools {

std::vector<std::string> planner_words() {
  std::vector<std::string> words = {"default", "known"};
  for (const PlainPolicy& policy : plain_policies()) words.push_back(policy.word);
  return words;
}

std::unique_ptr<JobPlanner> planner_of(const std::string& word, const HiddenSite& site,
                                       const Machine& machine, std::uint64_t /*threads*/) {
  for (const PlainPolicy& policy : plain_policies()) {
    if (policy.word == word) return plain_planner(policy, site.known, site.first_scan, machine);
  }
  // SiteJob comes here: "default" of site.known, "known" with site.density and site.soil.
  usage_error("planner '" + word + "' is not there yet, must be operator, greedy or fixed");
}

}  // namespace excavplan::tools
