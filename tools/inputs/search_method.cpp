// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/search_method.hpp"

#include <variant>

#include <excavplan/base/error.hpp>

#include "frame/quantity.hpp"

namespace excavplan::tools {
namespace {

std::string range_option(const DigParameterInfo& info) {
  return std::string(info.option) + "-range";
}

DigBounds bounds_of(const SearchMethodInputs& inputs) {
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

MemeticSearch usual_search() { return std::get<MemeticSearch>(budget_search().method); }

std::variant<MemeticSearch, GeneticAlgorithm> method_of(const SearchMethodInputs& inputs) {
  if (inputs.method == "default") {
    MemeticSearch memetic = usual_search();
    if (inputs.generations != 0) memetic.generations = inputs.generations;
    return memetic;
  }
  GeneticAlgorithm paper = inputs.genetic;
  if (inputs.generations != 0) paper.generations = inputs.generations;
  return paper;
}

}  // namespace

void declare_genetic(Arguments& arguments, GeneticAlgorithm& genetic) {
  arguments.option("population", genetic.population, "paper: individuals of a generation");
  arguments.option("crossover", genetic.crossover, Quantity::ratio,
                   "paper: probability that two parents exchange what lies between two points");
  arguments.option("mutation", genetic.mutation, Quantity::ratio,
                   "paper: probability that a number is drawn anew within its range");
  arguments.option("tournament", genetic.tournament, "paper: individuals drawn for one parent");
  arguments.option("elites", genetic.elites, "paper: best individuals that are kept");
}

void declare_search_method(Arguments& arguments, SearchMethodInputs& inputs) {
  for (std::size_t i = 0; i < inputs.ranges.size(); ++i) {
    const DigParameterInfo& info = dig_parameter_table()[i];
    const std::string example = info.unit == std::string("m") ? "0.2m,0.6m" : "30deg,60deg";
    arguments.text(range_option(info), "FROM,TO", inputs.ranges[i],
                   "search only this range of the " + std::string(info.text) + ", as " + example +
                       " (default: a wide one, by the size of the bucket) [" + info.unit + "]");
  }
  arguments.choice(
      "method", inputs.method, {"default", "paper"},
      "search method; default: global, then refined around the best digs, from the library's dig "
      "on; paper: the paper's genetic algorithm, from random digs on unless --library is given");
  arguments.only_if({[&inputs] { return inputs.method == "paper"; },
                     "the default method has none, --method paper has"},
                    [&] { declare_genetic(arguments, inputs.genetic); });
  arguments.option("generations", inputs.generations,
                   "generations of the search, if --evaluations does not end it before; 0: " +
                       std::to_string(usual_search().generations) + ", with --method paper " +
                       std::to_string(GeneticAlgorithm{}.generations));
}

void declare_evaluations(Arguments& arguments, SearchMethodInputs& inputs,
                         const std::string& usual) {
  arguments.option("evaluations", inputs.evaluations,
                   "largest number of simulated digs per search; 0: " + usual);
}

const OptionNames& search_option_names() {
  static const OptionNames names = {
      {"search: population", "--population"},       {"search: generations", "--generations"},
      {"search: crossover", "--crossover"},         {"search: mutation", "--mutation"},
      {"search: tournament", "--tournament"},       {"search: elites", "--elites"},
      {"search: stop.evaluations", "--evaluations"}};
  return names;
}

void check(const SearchMethodInputs& inputs) {
  if (inputs.evaluations < 0) {
    usage_error("--evaluations: " + std::to_string(inputs.evaluations) + " must be at least 0");
  }
  bounds_of(inputs);
}

void apply(const SearchMethodInputs& inputs, DigSearchOptions& options) {
  options.method = method_of(inputs);
  options.stop.evaluations = inputs.evaluations;
  options.bounds = bounds_of(inputs);
  if (inputs.method == "paper") options.start_rule = StartRule::Kind::least_work;
}

}  // namespace excavplan::tools
