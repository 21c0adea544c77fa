// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/density_fit.hpp>

#include <algorithm>
#include <cmath>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/json.hpp"
#include "soil/density_forms.hpp"

namespace excavplan {
namespace {

/// The growth g of a deviation s (1 + g x) along x in -1 .. 1 from its mean squares q below and
/// above 0: (q_above - q_below) / (q_above + q_below) = g / (1 + g^2 / 3). It is at most 1, where
/// the deviation is 0 at one end.
double growth_of(double contrast) {
  constexpr double steepest = 0.75;  // the contrast where g is 1
  const double c = std::clamp(contrast, -steepest, steepest);
  return c == 0.0 ? 0.0 : 1.5 * (1.0 - std::sqrt(1.0 - 4.0 / 3.0 * c * c)) / c;
}

nlohmann::ordered_json to_object(const DensityCalibration::Sample& sample) {
  nlohmann::ordered_json object = {{"density_percent", sample.density_percent},
                                   {"bulking_factor", sample.bulking_factor}};
  if (sample.bulking_factor_measured > 0.0) {
    object["bulking_factor_measured"] = sample.bulking_factor_measured;
    object["fallback_fraction"] = sample.fallback_fraction;
  }
  if (sample.bulking_factor_true > 0.0) object["bulking_factor_true"] = sample.bulking_factor_true;
  return object;
}

nlohmann::ordered_json to_object(const ScatterDigs& digs) {
  return {{"draws", digs.draws},
          {"water_content_share", digs.scatter.water_content},
          {"limit_density_share", digs.scatter.limit_density},
          {"loose_density_share", digs.scatter.loose_density}};
}

}  // namespace

const DensityForm& DensityCalibration::form(const std::string& key) const {
  for (const DensityFit& fit : forms) {
    if (fit.key == key) return fit.form;
  }
  throw Error(ErrorKind::bad_input, "the calibration has no form '" + key + "'");
}

DensityLaw law_of(const DensityCalibration& calibration) {
  DensityLaw law;
  law.name = calibration.name;
  law.source = calibration.source;
  law.form = calibration.form(calibration.use);
  law.freed_form = calibration.form(calibration.use.substr(0, calibration.use.find(as_measured)));
  law.soil = calibration.soil;
  law.machine = calibration.machine;
  law.simulator = calibration.simulator;
  law.path = calibration.path;
  law.any_path = calibration.any_path;
  return law;
}

void set_scatter(DensityForm& form, const std::vector<BulkingSample>& digs) {
  require(!digs.empty(), "scatter of a density law: there is no dig");
  std::array<double, 2> squares = {0.0, 0.0};  // of loose and of dense soil
  std::array<int, 2> counts = {0, 0};
  for (const BulkingSample& dig : digs) {
    const std::size_t half = dig.density_percent < 50.0 ? 0 : 1;
    squares[half] +=
        std::pow(density_of_bulking(form, dig.bulking_factor) - dig.density_percent, 2);
    ++counts[half];
  }
  const double square = (squares[0] + squares[1]) / static_cast<double>(digs.size());
  require(std::isfinite(square), "mean square of the scatter of a density law", square, "finite");
  double growth = 0.0;
  if (counts[0] > 0 && counts[1] > 0 && square > 0.0) {
    const double loose = squares[0] / counts[0];
    const double dense = squares[1] / counts[1];
    growth = growth_of((dense - loose) / (dense + loose));
  }
  std::visit(
      [&](auto& f) {
        f.residual_growth = growth;
        f.residual_sd = std::sqrt(square / (1.0 + growth * growth / 3.0));
      },
      form);
}

std::string to_json(const DensityCalibration& calibration) {
  nlohmann::ordered_json file = {{"format", density_law_format},
                                 {"version", 1},
                                 {"name", calibration.name},
                                 {"source", calibration.source}};
  if (!calibration.soil.empty()) file["soil"] = calibration.soil;
  if (!calibration.machine.empty()) file["machine"] = calibration.machine;
  if (!calibration.simulator.empty()) file["simulator"] = calibration.simulator;
  if (calibration.path) file["path"] = *calibration.path;
  if (calibration.path) file["any_path"] = calibration.any_path;
  if (calibration.scatter.draws > 0) file["scatter"] = to_object(calibration.scatter);
  file["use"] = calibration.use;
  for (const DensityFit& fit : calibration.forms) file[fit.key] = density_form_json(fit.form);
  file["samples"] = nlohmann::ordered_json::array();
  for (const DensityCalibration::Sample& sample : calibration.samples) {
    file["samples"].push_back(to_object(sample));
  }
  require_storable(file, "density calibration");
  return json_text(file, 2) + "\n";
}

}  // namespace excavplan
