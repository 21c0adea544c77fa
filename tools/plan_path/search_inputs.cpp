// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_path/search_inputs.hpp"

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/planning/uncertain_soil.hpp>

#include "frame/quantity.hpp"

namespace excavplan::tools {
namespace {

std::vector<std::string> checkpoints_of_soils(const std::string& checkpoint) {
  std::vector<std::string> files;
  for (std::size_t i = 0; i < most_possible_densities; ++i) {
    files.push_back(checkpoint_of_soil(checkpoint, i));
  }
  return files;
}

StartRule start_rule_of(const std::string& text) {
  if (const auto rule = start_rule_of_word(text)) return *rule;
  return parse_quantity("--start", text, Quantity::length);
}

/// Shows a search on the console. @return whether it may continue
bool report(Console& console, const SearchProgress& p, const DigObjective& objective) {
  console.progress(static_cast<double>(p.evaluations) / p.planned,
                   "generation " + std::to_string(p.generation) + ": best " +
                       worth_text(objective, p.best) + ", mean " + worth_text(objective, p.mean) +
                       ", " + std::to_string(p.evaluations) + " digs, " + readable(p.seconds_left) +
                       " s left");
  return !console.stop_requested();
}

void declare_whole_search(Arguments& arguments, SearchInputs& inputs) {
  declare_search_method(arguments, inputs.method);
  declare_evaluations(arguments, inputs.method,
                      "600, with --density-sd 100 for each of several densities (200 where no "
                      "library has a dig to start from), with --method paper as many as its "
                      "generations take");
  arguments.output(
      "checkpoint", inputs.checkpoint,
      "save the simulated digs in this file; for several densities also in FILE.soil1, "
      "FILE.soil2, ...",
      checkpoints_of_soils);
  arguments.flag("resume", inputs.resume, "continue from the checkpoint if it exists");
  arguments.option("seed", inputs.seed, "seed of the search");
  arguments.threads(inputs.threads, "; the path does not depend on it");
}

}  // namespace

void declare_search(Arguments& arguments, SearchInputs& inputs,
                    const std::function<SearchUse()>& use) {
  const std::string no_search = "nothing is searched without --search";
  declare_goal(arguments, inputs.goal);
  arguments.only_if({[use] { return use() != SearchUse::none; }, no_search}, [&] {
    arguments.text(
        "start", "RULE|LENGTH", inputs.start,
        "where the tip enters the ground: its x; work: where moving boom, arm and bucket takes "
        "least work; margin: farthest from the joint limits; search: found with the path (for a "
        "path of a library: the best of several along the reach) (default: search; with --method "
        "paper work, as the paper searches the three numbers of the path alone)");
  });
  arguments.only_if({[use] { return use() == SearchUse::all; }, no_search},
                    [&] { declare_whole_search(arguments, inputs); });
}

DigSearchOptions search_options(const SearchInputs& inputs, const Machine& machine, SearchUse use,
                                Console& console) {
  DigSearchOptions options = budget_search();
  if (use == SearchUse::all) apply(inputs.method, options);
  if (inputs.start) options.start_rule = start_rule_of(*inputs.start);
  options.seed = inputs.seed;
  options.threads = static_cast<unsigned>(inputs.threads);
  options.objective = objective_of(inputs.goal, {machine});
  options.checkpoint = inputs.checkpoint.value_or("");
  options.resume = inputs.resume;
  options.progress = [&console, objective = options.objective](const SearchProgress& progress) {
    return report(console, progress, objective);
  };
  return options;
}

void check(const SearchInputs& inputs) {
  if (inputs.resume && !inputs.checkpoint) usage_error("--resume needs --checkpoint");
  check(inputs.method);
  objective_of(inputs.goal);
}

}  // namespace excavplan::tools
