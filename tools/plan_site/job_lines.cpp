// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_site/job_lines.hpp"

#include "base/text.hpp"
#include "machine/dig_path_text.hpp"

namespace excavplan::tools {
namespace {

std::string place_text(const BasePose& base) {
  return "x = " + readable(base.x) + " m, y = " + readable(base.y) + " m, heading " +
         readable(base.heading) + " rad";
}

std::string dump_text(const JobStep& step) {
  if (step.keeps_load) return "none: the bucket keeps its load";
  return "x = " + readable(step.dump.x()) + " m, y = " + readable(step.dump.y()) +
         " m, z = " + readable(step.dump.z()) + " m" +
         (step.truck ? ", truck " + std::to_string(*step.truck) : "");
}

}  // namespace

std::vector<std::string> step_lines(const JobStep& step) {
  std::vector<std::string> lines = {"step         " + std::to_string(step.id) + ", " +
                                    name(step.what) +
                                    (step.reason.empty() ? "" : ": " + step.reason)};
  lines.push_back((step.what == JobAction::move ? "go to        " : "machine at   ") +
                  place_text(step.base));
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
  const auto millimetres = [](double length) { return readable(1000.0 * length) + " mm"; };
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
