// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "soil/density_forms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double lowest_raw_percent = -1000.0;  // instead of minus infinity
constexpr double most_residual_sd = 1e3;        // [%]

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

}  // namespace

// ---- What the law and its file need of a form ---------------------------------------------------

std::vector<std::string> density_form_keys() {
  std::vector<std::string> keys;
  for_each_alternative(DensityForm(),
                       [&](const auto& form) { keys.emplace_back(RowOf<decltype(form)>::key); });
  return keys;
}

std::string key_of(const DensityForm& form) {
  return std::visit([](const auto& f) { return RowOf<decltype(f)>::key; }, form);
}

std::size_t parameters_of(const DensityForm& form) {
  return std::visit([](const auto& f) { return RowOf<decltype(f)>::parameters.size(); }, form);
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

}  // namespace excavplan
