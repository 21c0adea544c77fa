// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/density_fit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <nlopt.hpp>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "soil/density_forms.hpp"

namespace excavplan {
namespace {

constexpr double largest_r = 0.95;  // of a fit

void check_samples(const std::vector<BulkingSample>& samples) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto [k, d] = samples[i];
    if (!(k > 0.0 && std::isfinite(k)) || !(d >= 0.0 && d <= 100.0)) {
      throw Error(ErrorKind::bad_input,
                  "sample " + std::to_string(i + 1) + ": bulking factor " + number_text(k) +
                      " at " + number_text(d) +
                      " %; the factor must be positive and the density in 0 .. 100 %");
    }
  }
  constexpr double most_bulking = 5.0;  // ours; blocks give about 2
  const auto all = [&](const auto& holds) {
    return !samples.empty() && std::all_of(samples.begin(), samples.end(), holds);
  };
  if (all([](const BulkingSample& s) { return s.density_percent <= 1.0; })) {
    throw Error(ErrorKind::bad_input,
                "no density of the samples is above 1 %; they must be in percent, not fractions");
  }
  if (all([](const BulkingSample& s) { return s.bulking_factor > most_bulking; })) {
    throw Error(ErrorKind::bad_input,
                "every bulking factor of the samples is above " + number_text(most_bulking) +
                    "; they must be ratios, not in percent, and not those of the densities");
  }
}

/// Least squares y = offset + slope x by centred sums.
struct Regression {
  double slope = 0.0;
  double offset = 0.0;
  double squared_residuals = 0.0;
};

Regression regress(const std::vector<double>& x, const std::vector<double>& y) {
  const auto count = static_cast<double>(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / count;
    mean_y += y[i] / count;
  }
  double sum_xx = 0.0;
  double sum_xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum_xx += (x[i] - mean_x) * (x[i] - mean_x);
    sum_xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  Regression fit;
  fit.slope = sum_xy / sum_xx;
  fit.offset = mean_y - fit.slope * mean_x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double residual = y[i] - mean_y - fit.slope * (x[i] - mean_x);
    fit.squared_residuals += residual * residual;
  }
  return fit;
}

/// Sets r2 and residual_sd of a fitted form from its error in d.
template <typename Form>
void rate(const std::vector<BulkingSample>& samples, Form& form) {
  double mean = 0.0;
  for (const BulkingSample& s : samples) {
    mean += s.density_percent / static_cast<double>(samples.size());
  }
  double unexplained = 0.0;
  double total = 0.0;
  for (const BulkingSample& s : samples) {
    const double error = s.density_percent - density_of_bulking(form, s.bulking_factor);
    unexplained += error * error;
    total += (s.density_percent - mean) * (s.density_percent - mean);
  }
  const double freedom =
      static_cast<double>(samples.size()) - static_cast<double>(parameters_of(form));
  form.r2 = total > 0.0 ? std::max(0.0, 1.0 - unexplained / total) : 0.0;
  form.residual_sd = std::sqrt(unexplained / freedom);
}

/// k = B + A x with x = 1 / (1 - r d / 100), which is linear once r is fixed.
class HyperbolaFit {
 public:
  explicit HyperbolaFit(const std::vector<BulkingSample>& samples) : x_(samples.size()) {
    for (const BulkingSample& s : samples) {
      k_.push_back(s.bulking_factor);
      d_.push_back(s.density_percent / 100.0);
    }
  }

  Regression at(double r) {
    for (std::size_t i = 0; i < d_.size(); ++i) x_[i] = 1.0 / (1.0 - r * d_[i]);
    return regress(x_, k_);
  }

  /// The best r, by a scan and then a local search.
  double best_r() {
    constexpr int steps = 190;
    constexpr double step = (largest_r - smallest_r) / steps;
    double r = smallest_r;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= steps; ++i) {
      const double tried = std::min(smallest_r + i * step, largest_r);
      const double squared = at(tried).squared_residuals;
      if (squared < least) {
        least = squared;
        r = tried;
      }
    }
    nlopt::opt search(nlopt::LN_SBPLX, 1);
    search.set_min_objective(&HyperbolaFit::objective, this);
    search.set_lower_bounds(std::max(r - step, smallest_r));
    search.set_upper_bounds(std::min(r + step, largest_r));
    search.set_initial_step(0.3 * step);
    search.set_xtol_abs(1e-13);
    search.set_maxeval(2000);
    std::vector<double> position = {r};
    try {
      search.optimize(position, least);
    } catch (const nlopt::roundoff_limited&) {
      // `position` holds the best point found.
    }
    return position[0];
  }

 private:
  static double objective(const std::vector<double>& r, std::vector<double>&, void* self) {
    return static_cast<HyperbolaFit*>(self)->at(r[0]).squared_residuals;
  }

  std::vector<double> d_;
  std::vector<double> k_;
  std::vector<double> x_;
};

// ---- What a law file holds ----------------------------------------------------------------------

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

DensityLine fit_line(const std::vector<BulkingSample>& samples) {
  check_samples(samples);
  std::vector<double> k;
  std::vector<double> d;
  for (const BulkingSample& s : samples) {
    k.push_back(s.bulking_factor);
    d.push_back(s.density_percent);
  }
  if (std::set<double>(k.begin(), k.end()).size() < 3) {
    throw Error(ErrorKind::bad_input,
                "a density line needs samples of at least 3 different bulking factors");
  }
  const Regression fit = regress(k, d);
  if (!(fit.slope > 0.0)) {
    throw Error(ErrorKind::bad_input, "no density line fits: the slope is " +
                                          number_text(fit.slope) +
                                          " %, but the bulking factor must grow with density");
  }
  DensityLine line;
  line.a = fit.slope;
  line.b = fit.offset;
  rate(samples, line);
  return line;
}

DensityClosedForm fit_closed_form(const std::vector<BulkingSample>& samples) {
  check_samples(samples);
  std::set<double> densities;
  for (const BulkingSample& s : samples) densities.insert(s.density_percent);
  if (densities.size() < 4) {
    throw Error(ErrorKind::bad_input,
                "a closed density law needs samples of at least 4 different densities, there are " +
                    std::to_string(densities.size()));
  }
  HyperbolaFit hyperbola(samples);
  DensityClosedForm form;
  form.r = hyperbola.best_r();
  const Regression fit = hyperbola.at(form.r);
  form.A = fit.slope;
  form.B = fit.offset;
  if (!(form.A > 0.0)) {
    throw Error(ErrorKind::bad_input, "no closed density law fits: A is " + number_text(form.A) +
                                          ", but the bulking factor must grow with density");
  }
  rate(samples, form);
  return form;
}

std::vector<DensityFit> fit_density_forms(const std::vector<BulkingSample>& samples,
                                          const std::string& key_ending) {
  std::vector<DensityFit> fits;
  for (const DensityForm& form :
       {DensityForm(fit_line(samples)), DensityForm(fit_closed_form(samples))}) {
    fits.push_back({key_of(form) + key_ending, form});
  }
  return fits;
}

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
