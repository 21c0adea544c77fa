// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/law_figure.hpp"

#include <algorithm>
#include <array>

#include "figures/law_curve.hpp"

namespace excavplan {
namespace {

std::string words_of(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

Style style_of(std::size_t form) {
  const std::array<Style, 4> styles = {{{colours::vermilion, 1.1, "none", 1.0, {4.0, 1.6}},
                                        {colours::green, 1.1, "none", 1.0, {5.0, 1.5, 1.2, 1.5}},
                                        {colours::purple, 1.1, "none", 1.0, {1.2, 1.4}},
                                        {colours::grey, 1.1, "none", 1.0, {2.5, 1.2}}}};
  return styles[form % styles.size()];
}

}  // namespace

Figure law_figure(const DensityCalibration& calibration) {
  Panel panel("", bulking_label, density_label);
  const DensityForm& used = calibration.form(calibration.use);
  panel.polygon(law_band(used), {"none", 0.0, "#dcdcdc"}, "95 % of digs");
  for (std::size_t i = 0; i < calibration.forms.size(); ++i) {
    const DensityFit& fit = calibration.forms[i];
    const bool is_used = fit.key == calibration.use;
    panel.line(law_curve(fit.form), is_used ? Style{colours::blue, 1.4} : style_of(i),
               words_of(fit.key) + (is_used ? " (used)" : ""));
  }
  Points measured;
  Points freed;
  for (const DensityCalibration::Sample& sample : calibration.samples) {
    freed.emplace_back(sample.bulking_factor, sample.density_percent);
    if (sample.bulking_factor_measured > 0.0) {
      measured.emplace_back(sample.bulking_factor_measured, sample.density_percent);
    }
  }
  panel.dots(freed, 1.6, {colours::black, 0.7, "#ffffff"},
             measured.empty() ? "samples" : "digs, without fallback");
  if (!measured.empty()) {
    panel.dots(measured, 1.4, {"#ffffff", 0.4, colours::blue}, "digs, as measured");
  }
  Figure figure;
  figure.title = "Relative density over bulking factor, law " + calibration.name;
  figure.rows = {{panel}};
  return figure;
}

}  // namespace excavplan
