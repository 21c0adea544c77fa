// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/search_inputs.hpp"

#include <variant>

#include <excavplan/ceilings.hpp>
#include <excavplan/error.hpp>
#include <excavplan/planning/uncertain_soil.hpp>

#include "shared/quantity.hpp"

namespace excavplan::tools {
namespace {

std::string range_option(const DigParameterInfo& info) {
  return std::string(info.option) + "-range";
}

DigBounds bounds_of(const SearchInputs& inputs) {
  DigBounds bounds;
  for (std::size_t i = 0; i < inputs.ranges.size(); ++i) {
    if (!inputs.ranges[i]) continue;
    const DigParameterInfo& info = dig_parameter_table()[i];
    const std::string option = "--" + range_option(info);
    const std::vector<std::string> ends = split(*inputs.ranges[i], ',');
    if (ends.size() != 2) usage_error(option + ": '" + *inputs.ranges[i] + "' is not FROM,TO");
    bounds.lower.*info.field = parse_quantity(option, ends[0], quantity_of(info.unit));
    bounds.upper.*info.field = parse_quantity(option, ends[1], quantity_of(info.unit));
  }
  return bounds;
}

std::variant<MemeticSearch, GeneticAlgorithm> method_of(const SearchInputs& inputs) {
  if (inputs.method == "default") {
    auto memetic = std::get<MemeticSearch>(budget_search().method);
    if (inputs.generations != 0) memetic.generations = inputs.generations;
    return memetic;
  }
  GeneticAlgorithm paper;
  paper.population = inputs.population.value_or(paper.population);
  if (inputs.generations != 0) paper.generations = inputs.generations;
  return paper;
}

std::vector<std::string> checkpoints_of_soils(const std::string& checkpoint) {
  std::vector<std::string> files;
  for (std::size_t i = 0; i < most_possible_densities; ++i) {
    files.push_back(checkpoint_of_soil(checkpoint, i));
  }
  return files;
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

void declare_method(Arguments& arguments, SearchInputs& inputs) {
  for (std::size_t i = 0; i < inputs.ranges.size(); ++i) {
    const DigParameterInfo& info = dig_parameter_table()[i];
    const std::string example = info.unit == std::string("m") ? "0.2m,0.6m" : "30deg,60deg";
    arguments.text(range_option(info), "FROM,TO", inputs.ranges[i],
                   "search only this range of the " + std::string(info.text) + ", as " + example +
                       " (default: a wide one, by the size of the bucket) [" + info.unit + "]");
  }
  arguments.choice(
      "method", inputs.method, {"default", "paper"},
      "search method; default: global, then refined around the best digs; paper: the paper's "
      "genetic algorithm");
  arguments.only_if({[&inputs] { return inputs.method == "paper"; },
                     "the default method has none, --method paper has"},
                    [&] {
                      arguments.option("population", inputs.population,
                                       "population of --method paper (default: " +
                                           std::to_string(GeneticAlgorithm{}.population) + ")");
                    });
  arguments.option(
      "generations", inputs.generations,
      "generations of the search, 0 for as many as --evaluations allows, or the paper's");
  arguments.option(
      "evaluations", inputs.evaluations,
      "largest number of simulated digs per search; 0: 600, with --density-sd 100 for each of "
      "several densities (200 where no library has a dig to start from), with --method paper "
      "as many as its generations take");
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
        "path of a library: the best of several along the reach)");
  });
  arguments.only_if({[use] { return use() == SearchUse::all; }, no_search},
                    [&] { declare_method(arguments, inputs); });
}

StartRule start_rule_of(const SearchInputs& inputs) {
  if (const auto rule = start_rule_of_word(inputs.start)) return *rule;
  return parse_quantity("--start", inputs.start, Quantity::length);
}

DigSearchOptions search_options(const SearchInputs& inputs, Console& console) {
  DigSearchOptions options;
  options.method = method_of(inputs);
  options.stop.evaluations = inputs.evaluations;
  options.seed = inputs.seed;
  options.threads = static_cast<unsigned>(inputs.threads);
  options.objective = objective_of(inputs.goal);
  options.bounds = bounds_of(inputs);
  options.start_rule = start_rule_of(inputs);
  options.checkpoint = inputs.checkpoint.value_or("");
  options.resume = inputs.resume;
  options.progress = [&console, objective = options.objective](const SearchProgress& progress) {
    return report(console, progress, objective);
  };
  return options;
}

void check(const SearchInputs& inputs) {
  if (inputs.resume && !inputs.checkpoint) usage_error("--resume needs --checkpoint");
  if (inputs.evaluations < 0) {
    usage_error("--evaluations: " + std::to_string(inputs.evaluations) + " must be at least 0");
  }
  objective_of(inputs.goal);
  bounds_of(inputs);
}

}  // namespace excavplan::tools
