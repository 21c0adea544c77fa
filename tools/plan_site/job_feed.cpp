// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_site/job_feed.hpp"

#include <utility>

#include <excavplan/base/error.hpp>
#include <excavplan/job/job_order.hpp>

#include "base/json.hpp"
#include "report/job_report.hpp"
#include "results/plan_results.hpp"

namespace excavplan::tools {
namespace {

std::string line_of(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::ordered_json belief_json(const JobBelief& belief) {
  nlohmann::ordered_json json;
  const auto add = [&](const std::string& name, const std::string& unit, const Measured& number) {
    json[name + unit] = number.value;
    json[name + "_sd" + unit] = number.sd;
  };
  add("strength_factor", "", belief.strength);
  add("payload_factor", "", belief.payload);
  add("energy_factor", "", belief.energy);
  add("height_bias", "_m", belief.height_bias);
  return json;
}

}  // namespace

JobFeed::JobFeed(const std::string& folder) : view_(folder, load_order(folder)) {
  begin_edition();
  take_state();
}

void JobFeed::refresh() {
  try {
    if (!view_.refresh() && fault_.empty()) return;
    fault_.clear();
  } catch (const Error& error) {  // of a moment, or the folder is damaged or gone
    if (fault_ == error.what()) return;
    fault_ = error.what();
  }
  if (view_.rewritten() != rewritten_ || !coder_->fits(view_.history())) {
    ++edition_;
    begin_edition();
  }
  take_steps();
  take_state();
}

void JobFeed::begin_edition() {
  rewritten_ = view_.rewritten();
  JobHistory start = view_.history();
  coder_.emplace(start);
  start.events.clear();
  played_.emplace(std::move(start));
  steps_.clear();
  take_steps();
}

void JobFeed::take_steps() {
  const auto& events = view_.history().events;
  while (steps_.size() < events.size()) {
    const JobEvent& event = events[steps_.size()];
    played_->add(event);
    steps_.push_back(line_of({{"event", coder_->next(event, played_->now())},
                              {"row", step_row(event, steps_.size() + 1)}}));
  }
}

void JobFeed::take_state() {
  state_ = line_of(changing_parts(report(), run()));
  ++state_version_;
}

ReportedRun JobFeed::run() const {
  nlohmann::ordered_json json = {{"progress", progress_json(view_.progress())},
                                 {"belief", belief_json(view_.belief())}};
  const auto& next = view_.present();
  json["next"] = next ? job_step_json(*next) : nlohmann::ordered_json();
  ReportedRun run;
  run.tool = "plan-site";
  run.version = EXCAVPLAN_VERSION;
  run.json = json_text(json);
  if (next) run.warnings = next->warnings;
  return run;
}

Report JobFeed::report() const {
  Report report = progress_report(view_.progress(), {});
  report.title = title_of(view_.history().design);
  report.fault = fault_;
  if (const auto& next = view_.present()) {
    report.state += " Next: step " + std::to_string(next->id) + ", " + name(next->what) +
                    (next->reason.empty() ? "." : ": " + next->reason + '.');
  }
  return report;
}

std::string JobFeed::page(const std::string& stream) {
  Report page = report();
  page.job = ReportJob{view_.history(), view_.settings().site.machine};
  page.stream = stream;
  return html_page(page, run());
}

}  // namespace excavplan::tools
