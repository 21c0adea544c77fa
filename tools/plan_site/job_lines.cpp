// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_site/job_lines.hpp"

#include <cmath>
#include <utility>

#include "base/text.hpp"
#include "machine/dig_path_text.hpp"

namespace excavplan::tools {
namespace {

/// To the centimetre, however far the origin is.
std::string place_text(double x, double y) {
  return "x = " + decimals(x, 2) + " m, y = " + decimals(y, 2) + " m";
}

std::string dump_text(const JobStep& step) {
  if (step.keeps_load) return "none: the bucket keeps its load";
  return place_text(step.dump.x(), step.dump.y()) + ", z = " + decimals(step.dump.z(), 2) + " m" +
         (step.truck ? ", truck " + std::to_string(*step.truck) : "");
}

/// "26 (18 .. 38), sd: played jobs 15 %, density 8 %"
std::string figure_text(const EstimatedFigure& figure, const std::string& unit, double scale,
                        bool is_whole = false) {
  const auto shown = [&](double value) {
    return is_whole ? std::to_string(std::llround(std::ceil(value))) : readable(scale * value, 3);
  };
  const auto interval = figure.interval();
  const EstimateSpread& spread = figure.spread;
  std::string from;
  const std::pair<const char*, double> parts[] = {
      {"volume", spread.volume},       {"density", spread.density}, {"played jobs", spread.played},
      {"unlike those", spread.unlike}, {"fuel model", spread.fuel}, {"truck fill", spread.fill}};
  for (const auto& [name, part] : parts) {
    if (part < 0.005) continue;
    from += (from.empty() ? "; sd: " : ", ") + std::string(name) + " " + readable(100.0 * part, 2) +
            " %";
  }
  return shown(figure.value) + (unit.empty() ? "" : " " + unit) + ", 95 %: " + shown(interval[0]) +
         " .. " + shown(interval[1]) + from;
}

/// "; fuel 3.9, machine 43, truckloads 80"
std::string cost_parts(const JobCost& cost) {
  std::string parts;
  for (const auto& [name, part] :
       {std::pair("fuel", cost.fuel), {"machine", cost.machine}, {"truckloads", cost.truckloads}}) {
    if (part > 0.0)
      parts += (parts.empty() ? "; " : ", ") + std::string(name) + " " + readable(part, 3);
  }
  return parts;
}

}  // namespace

std::vector<std::string> estimate_lines(const JobEstimate& estimate, const JobOutline& job,
                                        const std::optional<JobCost>& cost) {
  const double volume = job.shape.volume.value;
  std::vector<std::string> lines = {
      "design       " + readable(volume, 3) + " m3 of bank, density " +
          readable(job.density.percent, job.density.sd_percent) + " %",
      "loose        " + figure_text(estimate.swollen, "m3", 1.0),
      "mass         " + figure_text(estimate.mass, "t", 1e-3),
      "digs         " + figure_text(estimate.digs, "", 1.0, true),
      "time         " + figure_text(estimate.time, "min", 1.0 / 60.0),
      "fuel         " + figure_text(estimate.fuel, "L", 1.0),
      "truckloads   " + figure_text(estimate.truckloads, "", 1.0, true) + ", of " +
          readable(1e-3 * job.truck_mass, 3) + " t",
      "reference    R " + readable(1e-3 * estimate.reference_energy, 3) + " kJ per m3, " +
          readable(estimate.reference_digs, 3) + " digs of " +
          readable(estimate.dig.payload_mass, 3) + " kg, " +
          readable(estimate.reference_time / 60.0, 3) + " min"};
  if (cost) {
    lines.insert(lines.end() - 1,
                 "cost         " + figure_text(cost->total, "", 1.0) + cost_parts(*cost));
  }
  for (const std::string& each : estimate.unlike) lines.push_back("NOT TRUSTWORTHY: " + each);
  return lines;
}

std::vector<std::string> step_lines(const JobStep& step) {
  std::vector<std::string> lines = {"step         " + std::to_string(step.id) + ", " +
                                    name(step.what) +
                                    (step.reason.empty() ? "" : ": " + step.reason)};
  lines.push_back((step.what == JobAction::move ? "go to        " : "machine at   ") +
                  place_text(step.base.x, step.base.y) + ", heading " +
                  decimals(step.base.heading, 3) + " rad");
  if (step.dumps_first)
    lines.push_back("dump first   what passes left in the bucket, at " +
                    place_text(step.dump.x(), step.dump.y()));
  if (step.path.poses.empty()) return lines;
  const ForetoldStep& foretold = step.predicted;
  lines.push_back("path         " + path_text(step.path.parameters, step.path.start_x) + ", lane " +
                  readable(step.lane, 2) + " m" + (step.path.meets_floor ? ", to the floor" : ""));
  lines.push_back("dump         " + dump_text(step));
  lines.push_back("foretold     " + readable(foretold.payload_mass) + " kg, " +
                  readable(foretold.energy / 1000.0) + " kJ, " + readable(foretold.time) + " s");
  return lines;
}

std::vector<std::string> progress_lines(const JobProgress& progress) {
  const auto millimetres = [](double length) {
    return std::isnan(length) ? "not seen" : readable(1000.0 * length) + " mm";
  };
  return {"left         " + readable(progress.left_volume) + " of " +
              readable(progress.design_volume) + " m3, " + readable(100.0 * progress.seen) +
              " % seen" + (progress.is_finished ? ", finished" : ""),
          "deviation    rms " + millimetres(progress.rms) + ", 95 % within " +
              millimetres(progress.p95),
          "so far       " + std::to_string(progress.digs) + " digs, " +
              std::to_string(progress.finishing_passes) + " finishing passes, " +
              std::to_string(progress.moves) + " moves, " + std::to_string(progress.scans) +
              " scans, " + std::to_string(progress.stalls) + " stalls, " +
              readable(progress.payload_mass) + " kg"};
}

}  // namespace excavplan::tools
