// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/density_figure.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "base/text.hpp"
#include "figures/law_curve.hpp"

namespace excavplan {
namespace {

/// Probability density of a normal distribution cut off at 0 and 100 % [1/%].
class CutNormal {
 public:
  CutNormal(double mean, double sd) : mean_(mean), sd_(std::max(sd, 0.1)) {
    const auto below = [&](double d) {
      return 0.5 * std::erfc((mean_ - d) / (sd_ * std::sqrt(2.0)));
    };
    inside_ = std::max(below(100.0) - below(0.0), 1e-12);
  }
  double operator()(double d) const {
    const double off = (d - mean_) / sd_;
    return std::exp(-0.5 * off * off) / (sd_ * std::sqrt(2.0 * pi) * inside_);
  }

 private:
  double mean_, sd_, inside_ = 1.0;
};

Panel probability_panel(const RelativeDensity& density) {
  Panel panel("", density_label, "probability density [1/%]");
  const CutNormal probability(density.percent, density.sd_percent);
  const auto [low, high] = density.interval_percent;
  Points curve;
  Points inside = {{low, 0.0}};
  constexpr int steps = 400;
  double top = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double d = 100.0 * i / steps;
    curve.emplace_back(d, probability(d));
    top = std::max(top, curve.back().y());
  }
  for (int i = 0; i <= steps; ++i) {
    const double d = low + (high - low) * i / steps;
    inside.emplace_back(d, probability(d));
  }
  inside.emplace_back(high, 0.0);
  panel.polygon(inside, {"none", 0.0, "#a9d3ee"}, "95 % interval");
  panel.line(curve, {colours::blue, 1.3});
  panel.line({{density.percent, 0.0}, {density.percent, probability(density.percent)}},
             {colours::vermilion, 1.2, "none", 1.0, {3.0, 1.5}},
             "estimate " + readable(density.percent, density.sd_percent) + " %");
  panel.view({0.0, 0.0, 100.0, 1.12 * top});
  panel.shape(0.75);
  return panel;
}

Panel law_panel(const DensityEstimate& estimate) {
  Panel panel("", bulking_label, density_label);
  const bool freed = estimate.corrected.has_value();
  const DensityForm& form = freed ? estimate.law.freed_form : estimate.law.form;
  const Measured& k = freed ? *estimate.corrected : *estimate.bulking;
  const RelativeDensity& density = *estimate.density;
  panel.polygon(law_band(form), {"none", 0.0, "#dcdcdc"}, "95 % of digs about the law");
  const Points curve = law_curve(form);
  panel.line(curve, {colours::black, 1.2}, "law " + estimate.law.name);
  const Style style = {colours::vermilion, 1.0};
  const double at = std::clamp(density.raw_percent, -5.0, 105.0);
  if (std::isfinite(k.sd)) panel.interval({k.value - k.sd, at}, {k.value + k.sd, at}, style);
  panel.interval({k.value, density.interval_percent[0]}, {k.value, density.interval_percent[1]},
                 {colours::blue, 1.0}, "95 % interval of the density");
  panel.dots({{k.value, at}}, 1.5, {"#ffffff", 0.6, colours::vermilion},
             std::string(freed ? "corrected" : "measured") + " k = " + readable(k.value, k.sd) +
                 " (± sd)");
  const double width = curve.back().x() - curve.front().x();
  panel.view({std::min(curve.front().x(), k.value) - 0.06 * width, -5.0,
              std::max(curve.back().x(), k.value) + 0.06 * width, 105.0});
  panel.shape(0.75);
  return panel;
}

}  // namespace

Figure density_figure(const DensityEstimate& estimate) {
  Figure figure;
  figure.title = "Relative density of the ground";
  if (!estimate.density || !estimate.bulking) {
    figure.rows = {{Panel("", density_label, "probability density [1/%]")}};
    figure.note = "The density is not known: no dumped soil was measured.";
    return figure;
  }
  figure.rows = {{probability_panel(*estimate.density), law_panel(estimate)}};
  return figure;
}

}  // namespace excavplan
