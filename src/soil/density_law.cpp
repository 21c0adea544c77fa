// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/density_law.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/check.hpp"
#include "base/json.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "soil/density_forms.hpp"

namespace excavplan {
namespace {

/// A law whose density is a fraction, or whose columns were swapped, hardly rises with k.
void require_percent(const JsonObject& file, const std::string& key, const DensityForm& form) {
  constexpr double looser = 1.5;  // ours: most soils are dense below this factor
  constexpr double least = 5.0;   // ours [%]
  const double loose = bulking_of_density(form, 0.0);
  const double rise = density_of_bulking(form, looser * loose);
  if (loose > 0.0 && rise >= least) return;
  file.fail(key, "gives 0 % at a bulking factor of " + number_text(loose) + " and " +
                     number_text(rise) + " % at " + number_text(looser) +
                     " times that, must be a positive factor and 5 % or more: its densities must "
                     "be in percent, and those of a factor");
}

void warn_of_range(const DensityLaw& law, double bulking_factor, RelativeDensity& estimate) {
  const std::string found = "bulking factor " + decimals(bulking_factor, 3) +
                            " gives a relative density of " + decimals(estimate.raw_percent, 1) +
                            " % by the law '" + law.name + "', ";
  if (estimate.raw_percent > 100.0) {
    estimate.warnings.emplace_back(
        WarningCode::density_above_range,
        found +
            "above 100 %: soil that stayed in blocks with voids between them, or loose soil "
            "that fell back into the hole, raises the factor (Yajima et al. 2026, section 4.2)");
  } else if (estimate.raw_percent < 0.0) {
    estimate.warnings.emplace_back(
        WarningCode::density_below_range,
        found +
            "below 0 %: dumped or spilled soil is missing from the scans, it was compacted, "
            "or the law belongs to another soil");
  }
}

}  // namespace

DensityLaw load_density_law(const std::string& path) {
  JsonObject file = JsonObject::open(path, density_law_format);
  file.ignore("sources");
  file.ignore("samples");
  file.ignore("scatter");
  DensityLaw law;
  law.name = file.text("name");
  law.source = file.text("source");
  law.soil = file.text_or("soil", "");
  law.machine = file.text_or("machine", "");
  law.simulator = file.text_or("simulator", "");
  if (file.has("path")) {
    const std::vector<double> numbers = file.numbers("path", 3);
    law.path = {numbers[0], numbers[1], numbers[2]};
  }
  law.any_path = file.has("any_path") && file.flag("any_path");
  const std::string use = file.text("use");
  std::map<std::string, DensityForm> forms;
  std::string found;
  for (const char* ending : {"", as_measured}) {
    for (const std::string& form : density_form_keys()) {
      const std::string key = form + ending;
      if (!file.has(key)) continue;
      forms[key] = read_density_form(form, file.object(key));
      require_percent(file, key, forms[key]);
      found += (found.empty() ? "" : ", ") + key;
    }
  }
  const auto used = forms.find(use);
  if (used == forms.end()) {
    file.fail("use", "is " + in_quotes(use) + ", must name a form in this file: " + found);
  }
  law.form = used->second;
  const auto freed = forms.find(use.substr(0, use.find(as_measured)));
  law.freed_form = freed != forms.end() ? freed->second : law.form;
  file.done();
  return law;
}

DensityLaw density_law_of(const SoilKind& soil) {
  require_soil(soil);
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

void set_error(RelativeDensity& estimate, double sd_percent) {
  const double excess = estimate.raw_percent - estimate.percent;
  estimate.trustworthy = std::abs(excess) <= two_sided_95_percent * sd_percent;
  estimate.sd_percent = std::hypot(sd_percent, excess);
  const double margin = two_sided_95_percent * estimate.sd_percent;
  estimate.interval_percent = {std::clamp(estimate.percent - margin, 0.0, 100.0),
                               std::clamp(estimate.percent + margin, 0.0, 100.0)};
}

RelativeDensity relative_density(const DensityLaw& law, const Measured& bulking_factor) {
  require_form(law.form);
  const double k = bulking_factor.value;
  if (!(k > 0.0 && std::isfinite(k)) ||
      !(bulking_factor.sd >= 0.0 && std::isfinite(bulking_factor.sd))) {
    throw Error(ErrorKind::bad_input,
                "bulking factor is " + number_text(k) + " with a standard deviation of " +
                    number_text(bulking_factor.sd) +
                    "; the factor must be finite and positive, its deviation finite and >= 0");
  }
  RelativeDensity estimate;
  estimate.raw_percent = density_of_bulking(law.form, k);
  estimate.percent = std::clamp(estimate.raw_percent, 0.0, 100.0);
  estimate.sd_given_law_percent = density_slope(law.form, k) * bulking_factor.sd;
  set_error(estimate,
            std::hypot(estimate.sd_given_law_percent, residual_sd_at(law.form, estimate.percent)));
  warn_of_range(law, k, estimate);
  return estimate;
}

}  // namespace excavplan
