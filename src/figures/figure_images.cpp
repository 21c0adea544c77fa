// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/figures/figure_images.hpp>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/text.hpp"
#include "drawing/render.hpp"
#include "figures/change_figure.hpp"
#include "figures/density_figure.hpp"
#include "figures/dig_figures.hpp"
#include "figures/efficiency_figures.hpp"
#include "figures/ground_figure.hpp"
#include "figures/job_estimate_figure.hpp"
#include "figures/law_figure.hpp"
#include "figures/load_figures.hpp"
#include "figures/reach_figure.hpp"
#include "figures/study_figure.hpp"

namespace excavplan {
namespace {

std::string image_of(const Figure& figure, ImageFormat format) {
  const auto ending = static_cast<std::size_t>(format);
  return image_of(lay_out(figure), "figure" + image_endings()[ending]);
}

Figure figure_of(const DugDig& dug, DigImage what) {
  switch (what) {
    case DigImage::section:
      return section_figure(dug);
    case DigImage::forces:
      return forces_figure(dug);
    case DigImage::torques:
      return torques_figure(dug);
    case DigImage::power:
      return power_figure(dug);
    case DigImage::cylinders:
      return cylinders_figure(dug);
  }
  return {};
}

}  // namespace

std::string change_image(const DensityEstimate& estimate, ImageFormat format) {
  return image_of(height_change_figure({estimate.change, estimate.before, {}, {}}), format);
}

std::string density_image(const DensityEstimate& estimate, ImageFormat format) {
  return image_of(density_figure(estimate), format);
}

std::string law_image(const DensityCalibration& calibration, ImageFormat format) {
  return image_of(law_figure(calibration), format);
}

std::string dig_image(const Machine& machine, const DigScene& scene, DigImage what,
                      ImageFormat format) {
  const DugDig dug = {machine,
                      scene.path,
                      scene.dig,
                      boom_plane_profile(scene.before),
                      boom_plane_profile(scene.after),
                      scene_title(scene)};
  return image_of(figure_of(dug, what), format);
}

std::string dig_image(const Machine& machine, const DigPlan& plan, const PlanSite& site,
                      DigImage what, ImageFormat format) {
  const DigResult dig = rehearse(machine, plan, site);
  const DugDig dug = {machine,
                      plan.path,
                      dig,
                      boom_plane_profile(site.ground),
                      boom_plane_profile(dig.after(site.ground)),
                      plan_title(plan, site)};
  return image_of(figure_of(dug, what), format);
}

std::string job_estimate_image(const JobEstimate& estimate, const std::optional<JobCost>& cost,
                               ImageFormat format) {
  return image_of(job_estimate_figure(estimate, cost), format);
}

std::string ground_image(const HeightMap& ground, ImageFormat format) {
  return image_of(ground_figure(ground), format);
}

std::string reach_image(const Machine& machine, ImageFormat format) {
  return image_of(reach_figure(machine), format);
}

std::string efficiency_image(const std::vector<DigEfficiency>& runs, ImageFormat format) {
  return image_of(runs_figure({runs}), format);
}

std::string study_image(const std::vector<StudyResult>& results, ImageFormat format) {
  return image_of(study_figure(results), format);
}

}  // namespace excavplan
