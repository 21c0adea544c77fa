// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/method_inputs.hpp"

#include <cmath>

#include <excavplan/paper/paper_change.hpp>

namespace excavplan::tools {
namespace {

PaperOptions paper_options(const MethodInputs& inputs) {
  PaperOptions options;
  if (inputs.voxels == "cubes") options.voxels = PaperVoxels::cubes;
  if (inputs.outliers == "none") {
    options.outlier_neighbours = 0;
    return options;
  }
  const std::string what = "--paper-outliers";
  const auto parts = split(inputs.outliers, ',');
  if (parts.size() != 2) {
    usage_error(what + ": '" + inputs.outliers + "' is neither NEIGHBOURS,DEVIATIONS nor none");
  }
  const double neighbours = parse_quantity(what, parts[0], Quantity::ratio);
  options.outlier_deviations = parse_quantity(what, parts[1], Quantity::ratio);
  if (!(neighbours >= 1.0 && neighbours <= 10000.0) || neighbours != std::floor(neighbours)) {
    usage_error(what + ": '" + parts[0] + "' is not a number of neighbours, 1 to 10000");
  }
  if (!(options.outlier_deviations > 0.0)) {
    usage_error(what + ": '" + parts[1] + "' is not above 0");
  }
  options.outlier_neighbours = static_cast<int>(neighbours);
  return options;
}

OtherVolumes paper_volumes([[maybe_unused]] const PaperOptions& options) {
#ifdef EXCAVPLAN_PAPER
  return paper_change(options);
#else
  return nullptr;
#endif
}

}  // namespace

bool MethodInputs::uses(const std::string& word) const { return compare || method == word; }

void declare_method(Arguments& arguments, MethodInputs& inputs) {
  arguments.choice("method", inputs.method, {"surface", "paper"},
                   "surface: signed change of one height map; paper: the pipeline as published");
  arguments.only_if(
      {[&inputs] { return inputs.uses("paper"); }, "they are of --method paper"}, [&] {
        arguments.choice(
            "paper-voxels", inputs.voxels, {"columns", "cubes"},
            "of --method paper: one point a cell of the base plane, or one a cubic voxel");
        arguments.text(
            "paper-outliers", "NEIGHBOURS,DEVIATIONS|none", inputs.outliers,
            "of --method paper: points whose mean distance to their neighbours is this many "
            "standard deviations above the mean of all are removed");
      });
  arguments.flag("compare-methods", inputs.compare, "show the results of both methods");
}

void check_method(const MethodInputs& inputs) {
  if (!inputs.uses("paper") || paper_volumes({})) return;
  usage_error(
      "--method paper and --compare-methods need the Point Cloud Library, which this program was "
      "built without: build it where libpcl-dev is installed, or run estimate-density-paper of the "
      "package excavplan-paper");
}

void declare_dug_path(Arguments& arguments, MethodInputs& inputs) {
  arguments.option("dug-path", inputs.dug_path,
                   "the path that was dug: the law is then one of digs along it");
  arguments.option("dug-start", inputs.dug_start, Quantity::length,
                   "x at which that path enters the ground: measures the soil that fell back into "
                   "the cut; needs scans in the site frame");
}

void apply_method(const MethodInputs& inputs, const Machine& machine, DensityOptions& options) {
  if (inputs.dug_start && !inputs.dug_path) usage_error("--dug-start needs --dug-path");
  if (inputs.dug_path) options.dug_path = DugPath{machine, *inputs.dug_path, inputs.dug_start};
  if (inputs.method == "paper") options.method = VolumeMethod::paper;
  options.paper = paper_volumes(paper_options(inputs));
}

BothEstimates estimate(const MethodInputs& inputs, const DigScans& scans, const DensityLaw& law,
                       const DensityOptions& options) {
  if (inputs.compare) return estimate_by_both(scans, law, options);
  BothEstimates one;
  const bool by_paper = options.method == VolumeMethod::paper;
  (by_paper ? one.paper : one.surface) = estimate_density(scans, law, options);
  return one;
}

}  // namespace excavplan::tools
