// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/density_law.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <nlopt.hpp>

#include "base/json.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr const char* file_format = "excavplan-density-law";
constexpr double lowest_raw_percent = -1000.0;  // where the closed form runs to minus infinity
constexpr double two_sided_95_percent = 1.96;   // standard deviations
constexpr double smallest_r = 1e-6;
constexpr double largest_r = 0.95;

/// k - B of the closed form, kept where the law gives at least lowest_raw_percent.
double bounded_excess(const DensityClosedForm& form, double bulking_factor) {
  return std::max(bulking_factor - form.B, form.A / (1.0 - form.r * lowest_raw_percent / 100.0));
}

DensityLine read_line(JsonObject file) {
  DensityLine line;
  line.a = file.number("a", 1e-6, 1e6);
  line.b = file.number("b", -1e6, 1e6);
  line.r2 = file.number("r2", 0.0, 1.0);
  line.residual_sd = file.number("residual_sd_percent", 0.0, 1e3);
  file.done();
  return line;
}

DensityClosedForm read_closed_form(JsonObject file) {
  DensityClosedForm form;
  form.A = file.number("A", 1e-6, 1e9);
  form.B = file.number("B", -1e9, 1e9);
  form.r = file.number("r", smallest_r, 1.0 - smallest_r);
  form.r2 = file.number("r2", 0.0, 1.0);
  form.residual_sd = file.number("residual_sd_percent", 0.0, 1e3);
  file.done();
  return form;
}

nlohmann::ordered_json to_object(const DensityLine& line) {
  return {{"a", line.a}, {"b", line.b}, {"r2", line.r2}, {"residual_sd_percent", line.residual_sd}};
}

nlohmann::ordered_json to_object(const DensityClosedForm& form) {
  return {{"A", form.A},
          {"B", form.B},
          {"r", form.r},
          {"r2", form.r2},
          {"residual_sd_percent", form.residual_sd}};
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

/// One decimal, for messages.
std::string tenths(double value) { return number_text(std::round(value * 10.0) / 10.0); }

std::string thousandths(double value) { return number_text(std::round(value * 1000.0) / 1000.0); }

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

/// Sets r2 and residual_sd of a fitted form from its error in d; `parameters` were fitted.
template <typename Form>
void rate(const std::vector<BulkingSample>& samples, int parameters, Form& form) {
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
  const double freedom = static_cast<double>(samples.size()) - parameters;
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

  /// The best r: a scan finds its neighbourhood, a simplex search the rest.
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

void warn_of_range(const DensityLaw& law, double bulking_factor, RelativeDensity& estimate) {
  const std::string found = "bulking factor " + thousandths(bulking_factor) +
                            " gives a relative density of " + tenths(estimate.raw_percent) +
                            " % by the law '" + law.name + "', ";
  if (estimate.raw_percent > 100.0) {
    estimate.warnings.push_back(
        {"density_above_range",
         found +
             "above 100 %: soil that stayed in blocks with voids between them, or loose soil "
             "that fell back into the hole, raises the factor (Yajima et al. 2026, section 4.2)"});
  } else if (estimate.raw_percent < 0.0) {
    estimate.warnings.push_back(
        {"density_below_range",
         found + "below 0 %: dumped or spilled soil is missing from the scans, it was compacted, "
                 "or the law belongs to another soil"});
  }
}

}  // namespace

DensityLaw load_density_law(const std::string& path) {
  JsonObject file = JsonObject::open(path, file_format);
  file.ignore("sources");
  file.ignore("samples");
  DensityLaw law;
  law.name = file.text("name");
  law.source = file.text("source");
  law.soil = file.text_or("soil", "");
  const std::string use = file.text("use");
  std::map<std::string, DensityForm> forms;
  for (const char* key : {"line", "closed_form", "line_as_measured", "closed_form_as_measured"}) {
    if (!file.has(key)) continue;
    const bool is_line = std::string(key).rfind("line", 0) == 0;
    forms[key] = is_line ? DensityForm(read_line(file.object(key)))
                         : DensityForm(read_closed_form(file.object(key)));
  }
  if (const auto used = forms.find(use); used != forms.end()) {
    law.form = used->second;
    const auto freed = forms.find(use.substr(0, use.find("_as_measured")));
    law.freed_form = freed != forms.end() ? freed->second : law.form;
  } else {
    file.fail("use", "is '" + use +
                         "', must name a form in this file: line, closed_form, line_as_measured "
                         "or closed_form_as_measured");
  }
  file.done();
  return law;
}

DensityLaw density_law_of(const SoilKind& soil) {
  DensityClosedForm form;
  form.A = (1.0 + soil.void_ratio_loose) / (1.0 + soil.void_ratio_max);
  form.r = (soil.void_ratio_max - soil.void_ratio_min) / (1.0 + soil.void_ratio_max);
  form.r2 = 1.0;
  DensityLaw law;
  law.name = soil.name + ", solids conserved";
  law.source = "void ratios of the soil";
  law.form = law.freed_form = form;
  law.soil = soil.name;
  return law;
}

double density_of_bulking(const DensityForm& form, double bulking_factor) {
  if (const auto* line = std::get_if<DensityLine>(&form)) {
    return line->a * bulking_factor + line->b;
  }
  const auto& closed = std::get<DensityClosedForm>(form);
  return 100.0 / closed.r * (1.0 - closed.A / bounded_excess(closed, bulking_factor));
}

double bulking_of_density(const DensityForm& form, double density_percent) {
  if (const auto* line = std::get_if<DensityLine>(&form)) {
    return (density_percent - line->b) / line->a;
  }
  const auto& closed = std::get<DensityClosedForm>(form);
  const double solids = 1.0 - closed.r * density_percent / 100.0;
  if (!(solids > 0.0)) {
    throw Error(ErrorKind::bad_input, "relative density is " + number_text(density_percent) +
                                          " %, must be below 100 / r = " +
                                          number_text(100.0 / closed.r) + " % for this law");
  }
  return closed.B + closed.A / solids;
}

double density_slope(const DensityForm& form, double bulking_factor) {
  if (const auto* line = std::get_if<DensityLine>(&form)) return line->a;
  const auto& closed = std::get<DensityClosedForm>(form);
  const double excess = bounded_excess(closed, bulking_factor);
  return 100.0 / closed.r * closed.A / (excess * excess);
}

RelativeDensity relative_density(const DensityLaw& law, const Measured& bulking_factor) {
  const double k = bulking_factor.value;
  if (!(k > 0.0 && std::isfinite(k)) ||
      !(bulking_factor.sd >= 0.0 && std::isfinite(bulking_factor.sd))) {
    throw Error(ErrorKind::bad_input,
                "bulking factor is " + number_text(k) + " with a standard deviation of " +
                    number_text(bulking_factor.sd) +
                    "; the factor must be finite and positive, its deviation finite and >= 0");
  }
  const double residual_sd =
      std::visit([](const auto& form) { return form.residual_sd; }, law.form);
  RelativeDensity estimate;
  estimate.raw_percent = density_of_bulking(law.form, k);
  estimate.percent = std::clamp(estimate.raw_percent, 0.0, 100.0);
  estimate.sd_percent = std::hypot(density_slope(law.form, k) * bulking_factor.sd, residual_sd);
  const double margin = two_sided_95_percent * estimate.sd_percent;
  estimate.interval_percent = {std::clamp(estimate.raw_percent - margin, 0.0, 100.0),
                               std::clamp(estimate.raw_percent + margin, 0.0, 100.0)};
  estimate.trustworthy = std::abs(estimate.raw_percent - estimate.percent) <= margin;
  warn_of_range(law, k, estimate);
  return estimate;
}

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
  rate(samples, 2, line);
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
  rate(samples, 3, form);
  return form;
}

std::string to_json(const DensityCalibration& calibration) {
  nlohmann::ordered_json file = {{"format", file_format},
                                 {"version", 1},
                                 {"name", calibration.name},
                                 {"source", calibration.source}};
  if (!calibration.soil.empty()) file["soil"] = calibration.soil;
  file["use"] = calibration.use;
  file["line"] = to_object(calibration.line);
  file["closed_form"] = to_object(calibration.closed_form);
  if (calibration.line_as_measured) {
    file["line_as_measured"] = to_object(*calibration.line_as_measured);
  }
  if (calibration.closed_form_as_measured) {
    file["closed_form_as_measured"] = to_object(*calibration.closed_form_as_measured);
  }
  file["samples"] = nlohmann::ordered_json::array();
  for (const DensityCalibration::Sample& sample : calibration.samples) {
    file["samples"].push_back(to_object(sample));
  }
  return file.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace excavplan
