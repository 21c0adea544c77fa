// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "soil/density_forms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <type_traits>

#include <nlopt.hpp>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double lowest_raw_percent = -1000.0;  // instead of minus infinity
constexpr double smallest_r = 1e-6;
constexpr double largest_r = 0.95;        // of a fit
constexpr double most_residual_sd = 1e3;  // [%]

// ---- The table of forms -------------------------------------------------------------------------

/// A parameter of a form: its key in law files and the range it is accepted in.
template <typename Form>
struct Parameter {
  const char* key;
  double Form::*value;
  double lowest;
  double highest;
};

/// A row of the table: one specialisation for each alternative of DensityForm.
template <typename Form>
struct FormRow;

template <>
struct FormRow<DensityLine> {
  static constexpr const char* key = "line";
  static constexpr const char* formula = "d = a k + b";
  static constexpr std::array<Parameter<DensityLine>, 2> parameters = {
      {{"a", &DensityLine::a, 1e-6, 1e6}, {"b", &DensityLine::b, -1e6, 1e6}}};
  static constexpr auto fit = fit_line;

  static double density(const DensityLine& line, double k) { return line.a * k + line.b; }
  static double bulking(const DensityLine& line, double d) { return (d - line.b) / line.a; }
  static double slope(const DensityLine& line, double) { return line.a; }
};

template <>
struct FormRow<DensityClosedForm> {
  static constexpr const char* key = "closed_form";
  static constexpr const char* formula = "k = B + A / (1 - r d / 100)";
  static constexpr std::array<Parameter<DensityClosedForm>, 3> parameters = {
      {{"A", &DensityClosedForm::A, 1e-6, 1e9},
       {"B", &DensityClosedForm::B, -1e9, 1e9},
       {"r", &DensityClosedForm::r, smallest_r, 1.0 - smallest_r}}};
  static constexpr auto fit = fit_closed_form;

  /// k - B, kept where the law gives at least lowest_raw_percent.
  static double bounded_excess(const DensityClosedForm& form, double k) {
    return std::max(k - form.B, form.A / (1.0 - form.r * lowest_raw_percent / 100.0));
  }
  static double density(const DensityClosedForm& form, double k) {
    return 100.0 / form.r * (1.0 - form.A / bounded_excess(form, k));
  }
  static double bulking(const DensityClosedForm& form, double d) {
    const double solids = 1.0 - form.r * d / 100.0;
    if (!(solids > 0.0)) {
      throw Error(ErrorKind::bad_input, "relative density is " + number_text(d) +
                                            " %, must be below 100 / r = " +
                                            number_text(100.0 / form.r) + " % for this law");
    }
    return form.B + form.A / solids;
  }
  static double slope(const DensityClosedForm& form, double k) {
    const double excess = bounded_excess(form, k);
    return 100.0 / form.r * form.A / (excess * excess);
  }
};

template <typename Form>
using RowOf = FormRow<std::decay_t<Form>>;

/// Calls visit(form) with a default form of every alternative, in the order of the variant.
template <typename Visitor, typename... Forms>
void for_each_alternative(const std::variant<Forms...>&, const Visitor& visit) {
  (visit(Forms{}), ...);
}

// ---- Fits ---------------------------------------------------------------------------------------

void check_samples(const std::vector<BulkingSample>& samples) {
  constexpr double largest = 1000.0;  // ours: above any percentage, and its square is finite
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto [k, d] = samples[i];
    if (!(k > 0.0 && k <= largest) || !(d >= 0.0 && d <= 100.0)) {
      throw Error(ErrorKind::bad_input, "sample " + std::to_string(i + 1) + ": bulking factor " +
                                            number_text(k) + " at " + number_text(d) +
                                            " %; the factor must be above 0 and at most " +
                                            number_text(largest) + ", the density in 0 .. 100 %");
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
    const double error = s.density_percent - FormRow<Form>::density(form, s.bulking_factor);
    unexplained += error * error;
    total += (s.density_percent - mean) * (s.density_percent - mean);
  }
  const double freedom =
      static_cast<double>(samples.size()) - static_cast<double>(FormRow<Form>::parameters.size());
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

}  // namespace

// ---- What the law and its file need of a form ---------------------------------------------------

std::vector<std::string> density_form_keys() {
  std::vector<std::string> keys;
  for_each_alternative(DensityForm(),
                       [&](const auto& form) { keys.emplace_back(RowOf<decltype(form)>::key); });
  return keys;
}

DensityForm read_density_form(const std::string& key, JsonObject object) {
  DensityForm read;
  for_each_alternative(DensityForm(), [&](auto form) {
    using Row = RowOf<decltype(form)>;
    if (key != Row::key) return;
    for (const auto& p : Row::parameters) {
      form.*p.value = object.number(p.key, p.lowest, p.highest);
    }
    form.r2 = object.number("r2", 0.0, 1.0);
    form.residual_sd = object.number("residual_sd_percent", 0.0, most_residual_sd);
    form.residual_growth = object.number_or("residual_growth", 0.0, -1.0, 1.0);
    read = form;
  });
  object.done();
  return read;
}

nlohmann::ordered_json density_form_json(const DensityForm& form) {
  return std::visit(
      [](const auto& f) {
        auto object = nlohmann::ordered_json::object();
        for (const auto& p : RowOf<decltype(f)>::parameters) object[p.key] = f.*p.value;
        object["r2"] = f.r2;
        object["residual_sd_percent"] = f.residual_sd;
        if (f.residual_growth != 0.0) object["residual_growth"] = f.residual_growth;
        return object;
      },
      form);
}

void require_form(const DensityForm& form) {
  std::visit(
      [](const auto& f) {
        using Row = RowOf<decltype(f)>;
        const auto check = [](const char* key, double value, double lowest, double highest) {
          if (value >= lowest && value <= highest) return;
          require_in(std::string("density law, ") + Row::key + ": " + key, value, lowest, highest);
        };
        for (const auto& p : Row::parameters) check(p.key, f.*p.value, p.lowest, p.highest);
        check("residual_sd", f.residual_sd, 0.0, most_residual_sd);
        check("residual_growth", f.residual_growth, -1.0, 1.0);
      },
      form);
}

double density_of_bulking(const DensityForm& form, double bulking_factor) {
  return std::visit([&](const auto& f) { return RowOf<decltype(f)>::density(f, bulking_factor); },
                    form);
}

double bulking_of_density(const DensityForm& form, double density_percent) {
  require_form(form);
  require(std::isfinite(density_percent), "relative density", density_percent, "finite");
  return std::visit([&](const auto& f) { return RowOf<decltype(f)>::bulking(f, density_percent); },
                    form);
}

double density_slope(const DensityForm& form, double bulking_factor) {
  return std::visit([&](const auto& f) { return RowOf<decltype(f)>::slope(f, bulking_factor); },
                    form);
}

double residual_sd_at(const DensityForm& form, double density_percent) {
  const double from_middle = std::clamp(density_percent, 0.0, 100.0) / 50.0 - 1.0;
  return std::visit(
      [&](const auto& f) { return f.residual_sd * (1.0 + f.residual_growth * from_middle); }, form);
}

std::string formula(const DensityForm& form) {
  return std::visit([](const auto& f) { return RowOf<decltype(f)>::formula; }, form);
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
  for_each_alternative(DensityForm(), [&](const auto& form) {
    using Row = RowOf<decltype(form)>;
    fits.push_back({Row::key + key_ending, Row::fit(samples)});
  });
  return fits;
}

}  // namespace excavplan
