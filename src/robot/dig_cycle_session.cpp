// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/dig_cycle_session.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <excavplan/planning/standing_ground.hpp>
#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "recording/times.hpp"
#include "robot/cycle_site.hpp"
#include "robot/live_robot.hpp"

namespace excavplan {
namespace {

using Frames = std::vector<LiveFrame>;
using Time = LiveTime;

std::vector<Warning> ending_trust(const std::vector<Warning>& all) {
  std::vector<Warning> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some),
               [](const Warning& warning) { return warning.ends_trust; });
  return some;
}

LiveSettings live_settings(const DigCycleSettings& settings) {
  return {settings.machine, settings.site_frame, settings.site_from_scan, settings.machine_in_view,
          settings.oldest_joints};
}

}  // namespace

const char* name(CycleStage stage) {
  constexpr std::array<const char*, 4> names = {"before", "digging", "after", "done"};
  return names[static_cast<std::size_t>(stage)];
}

struct DigCycleSession::State {
  /// A dig that was planned, and for which density.
  struct DigForetold {
    PlannedDig dig;
    double density_percent;
  };

  explicit State(DigCycleSettings given)
      : settings(std::move(given)), robot(live_settings(settings)), density(settings.density) {
    if (!settings.site.empty()) site.emplace(settings);
  }

  void mark(Time time);
  void take_points(LiveFrame frame);
  std::string early_text() const;
  std::vector<Warning> scan_warnings(const CycleEstimate& answer, bool averaged) const;
  GroundScan ground_scan(Frames& frames, const char* which, bool& averaged);
  DensityOptions estimate_options() const;
  CycleEstimate estimate_of_scans(bool& averaged);
  CycleEstimate estimate_on_site(bool& averaged);
  bool is_outdated() const;
  std::optional<Scan> last_scan();
  ScannedTerrain terrain(const std::optional<Scan>& scan) const;
  ScannedTerrain ground_around(const std::optional<Scan>& scan) const;
  HeightMap ground_at_tracks(const Scan& scan) const;
  PlanOptions plan_options(const std::optional<Scan>& scan) const;
  std::vector<Warning> plan_on_scan(const std::optional<Scan>& scan, CyclePlan& answer) const;
  std::vector<Warning> plan_with_site(const std::optional<Scan>& scan, CyclePlan& answer);
  std::vector<Warning> look_around(const std::optional<Scan>& scan);
  void add_motion(const Terrain& ground, CyclePlan& answer) const;
  Time scan_time() const;
  void add_age(CyclePlan& answer) const;

  DigCycleSettings settings;
  LiveRobot robot;
  CycleStage stage = CycleStage::before;
  Frames recent, before, after;  ///< recent: since the last dig
  Time marked;                   ///< when the dig began or ended
  std::size_t early = 0;         ///< messages of points from before that
  GroundDensity density;
  bool density_is_stated = true;
  bool last_refused = false;              ///< the last estimate was not to be trusted
  std::optional<DigForetold> planned;     ///< the last plan
  std::string plan_id;                    ///< of its motion; empty: none, or it has begun
  std::optional<DigForetold> driven;      ///< what was planned when the last dig began
  std::optional<CycleSite> site;          ///< of the settings
  std::optional<CycleEstimate> surveyed;  ///< what the site answered to the last dig
};

void DigCycleSession::State::mark(Time time) {
  robot.tell_time(time);
  if (time) marked = time;
}

void DigCycleSession::State::take_points(LiveFrame frame) {
  if (stage == CycleStage::digging) return;
  if (frame.measured && marked && *frame.measured < *marked) {
    ++early;
    return;
  }
  robot.settle(recent, false);
  robot.settle(after, false);
  if (recent.size() == settings.scans) recent.erase(recent.begin());
  recent.push_back(std::move(frame));
  robot.settle_postures(recent, false);
  if (stage == CycleStage::after && recent.size() == settings.scans) {
    after = recent;
    stage = CycleStage::done;
  }
}

GroundScan DigCycleSession::State::ground_scan(Frames& frames, const char* which, bool& averaged) {
  return {robot.scan_of(frames, std::string("scan ") + which, averaged), seconds_of(frames)};
}

DensityOptions DigCycleSession::State::estimate_options() const {
  DensityOptions options = settings.estimate;
  if (!options.soil.kind) options.soil.kind = settings.soil;
  if (settings.digs_as_planned && driven) {
    options.dug_path = DugPath{settings.machine, driven->dig.parameters, driven->dig.start_x};
  }
  return options;
}

/// Whether the last scan shows the ground as it was before the last dig.
bool DigCycleSession::State::is_outdated() const {
  return stage == CycleStage::digging || (stage == CycleStage::after && recent.empty());
}

/// The last one of the ground; nothing if none came yet.
std::optional<Scan> DigCycleSession::State::last_scan() {
  Frames& seen = is_outdated() ? before : recent;
  bool averaged = true;
  return seen.empty() ? std::nullopt
                      : std::optional(robot.scan_of(seen, "scan of the ground", averaged));
}

/// As a scan shows it, level without one.
ScannedTerrain DigCycleSession::State::terrain(const std::optional<Scan>& scan) const {
  const double cell = settings.plan.cell_size.value_or(usual_cell(settings.machine));
  if (!scan) {
    return {level_planning_ground(settings.machine, cell),
            {{WarningCode::level_ground, "no scan came yet: the ground is taken to be level",
              !settings.level_ground}}};
  }
  ScannedTerrain ground{terrain_from_scan(*scan, planning_extent(settings.machine), cell).terrain,
                        {}};  // its doubts are those of the plan
  if (is_outdated()) {
    ground.warnings.emplace_back(WarningCode::ground_before_dig,
                                 "no scan came since the last dig began: the ground is taken to be "
                                 "as it was before it");
  }
  return ground;
}

/// The same as far as the machine reaches, of which terrain() is a strip; warnings of its own
/// alone.
ScannedTerrain DigCycleSession::State::ground_around(const std::optional<Scan>& scan) const {
  const bool remembers = site && site->knows_ground();
  if (!scan) return {remembers ? site->around() : level_swing_ground(settings.machine), {}};
  Terrain present = swing_terrain_from_scan(*scan, settings.machine).terrain;
  if (settings.surroundings) return with_surroundings(present, *settings.surroundings);
  if (remembers) return with_surroundings(present, site->around());
  return {std::move(present), {}};
}

/// What the machine stands on, as scan and surroundings show it.
HeightMap DigCycleSession::State::ground_at_tracks(const Scan& scan) const {
  HeightMap present = standing_ground_from_scan(scan, settings.machine);
  if (settings.surroundings) return known_from_both(present, settings.surroundings->surface());
  if (site && site->knows_ground()) return known_from_both(present, site->at_tracks());
  return present;
}

void DigCycleSession::State::add_motion(const Terrain& ground, CyclePlan& answer) const {
  const CycleWayOptions way = {robot.start(), settings.whole_cycle, settings.plan.search.objective};
  answer.posture_known = way.start.has_value();
  if (!way.start) {
    answer.warnings.emplace_back(WarningCode::posture_unknown,
                                 robot.joint_problem({}) +
                                     ": the motion begins above the dig, wherever "
                                     "the machine stands");
  } else if (const std::string moving = robot.moving_problem(); !moving.empty()) {
    answer.warnings.emplace_back(WarningCode::not_standing, "the machine may be moving: " + moving);
  }
  const auto refuse = [&](const std::string& why) {
    answer.warnings.emplace_back(WarningCode::no_motion, "the plan has no motion: " + why);
  };
  try {
    const auto motion = plan_motion(settings.machine, ground, answer.plan, way, settings.motion);
    if (const auto* blocked = std::get_if<BlockedWay>(&motion)) {
      refuse("the ground is in the way: " + blocked->message);
    } else {
      const auto& timed = std::get<Trajectory>(motion);
      answer.motion = joint_motion(timed);
      answer.stamp = timed.plan;
      answer.stamp->pose = Eigen::Isometry3d(settings.site_from_scan).inverse();
      answer.warnings.insert(answer.warnings.end(), timed.warnings.begin(), timed.warnings.end());
    }
  } catch (const Error& error) {
    refuse(error.what());
  }
}

/// Of the oldest points in the last scan; nothing: they do not tell.
Time DigCycleSession::State::scan_time() const {
  const Frames& seen = is_outdated() ? before : recent;
  Time oldest;
  for (const LiveFrame& frame : seen) {
    if (frame.time <= 0) return {};
    if (!oldest || frame.time < *oldest) oldest = frame.time;
  }
  return oldest;
}

/// How old the scan is, and until when the motion holds.
void DigCycleSession::State::add_age(CyclePlan& answer) const {
  const Time scanned = scan_time();
  const Time now = robot.now();
  if (!scanned || !now) return;
  answer.scan_age = std::max(0.0, seconds_between(*scanned, *now));
  if (*answer.scan_age > settings.oldest_scan) {
    answer.warnings.emplace_back(WarningCode::scan_old,
                                 "the scan of the ground is " + readable(*answer.scan_age, 3) +
                                     " s old: people and machines may have moved since");
  }
  if (!answer.stamp) return;
  constexpr double longest = 1e9;
  answer.stamp->scanned = scanned;
  answer.stamp->expires =
      later(*scanned, static_cast<std::int64_t>(1e9 * std::min(longest, settings.oldest_scan)));
}

std::string DigCycleSession::State::early_text() const {
  return std::to_string(early) + " messages of points were measured before the dig was over";
}

/// Of the scans before and after the dig.
std::vector<Warning> DigCycleSession::State::scan_warnings(const CycleEstimate& answer,
                                                           bool averaged) const {
  std::vector<Warning> warnings;
  const bool is_known = site && answer.before == 0;
  if (answer.before < answer.after && !is_known) {
    warnings.emplace_back(WarningCode::fewer_scans,
                          "the scan before the dig has " + count_text(answer.before, answer.after) +
                              " messages: the dig began before more came");
  }
  if (!averaged) {
    warnings.emplace_back(WarningCode::not_averaged,
                          "the messages of a scan are not of one organised size with one pose: "
                          "their points were joined");
  }
  if (early > 0) warnings.emplace_back(WarningCode::early_points, early_text() + " and left out");
  const bool stamped = std::all_of(after.begin(), after.end(),
                                   [](const LiveFrame& frame) { return frame.header.stamp != 0; });
  if (marked && !stamped) {
    warnings.emplace_back(
        WarningCode::not_stamped,
        "points of the scan after have no stamp: whether they were measured after "
        "the dig is not known");
  }
  return warnings;
}

DigCycleSession::DigCycleSession(DigCycleSettings settings) {
  check(settings);
  state_ = std::make_unique<State>(std::move(settings));
}
DigCycleSession::~DigCycleSession() = default;
DigCycleSession::DigCycleSession(DigCycleSession&&) noexcept = default;
DigCycleSession& DigCycleSession::operator=(DigCycleSession&&) noexcept = default;

void DigCycleSession::take(const RobotMessage& message) {
  State& state = *state_;
  std::optional<LiveFrame> points = state.robot.take(message);
  if (is_set_back(message, state.marked)) state.marked.reset();
  if (points) return state.take_points(std::move(*points));
  for (Frames* frames : {&state.recent, &state.before, &state.after}) {
    state.robot.settle_postures(*frames, false);
  }
}

void DigCycleSession::start_dig(Time time) {
  State& state = *state_;
  const bool is_known = state.site && state.site->knows_ground();
  require(state.stage == CycleStage::digging || !state.recent.empty() || is_known,
          "the dig begins, but no scan came before it");
  if (state.stage == CycleStage::digging) return;  // told twice
  state.robot.settle(state.recent, true);
  state.before = std::move(state.recent);
  state.recent.clear();
  state.after.clear();
  state.driven = std::exchange(state.planned, std::nullopt);
  state.plan_id.clear();
  state.surveyed.reset();
  if (state.site) state.site->begin_dig();
  state.stage = CycleStage::digging;
  state.early = 0;
  state.marked.reset();
  state.mark(time);
}

void DigCycleSession::end_dig(Time time) {
  require(state_->stage == CycleStage::digging, "the dig is over, but none had begun");
  state_->stage = CycleStage::after;
  state_->mark(time);
}

CycleStage DigCycleSession::stage() const { return state_->stage; }
std::size_t DigCycleSession::scans() const { return state_->recent.size(); }
std::size_t DigCycleSession::scans_wanted() const { return state_->settings.scans; }
std::size_t DigCycleSession::early_scans() const { return state_->early; }
const GroundDensity& DigCycleSession::density() const { return state_->density; }

std::string describe(const DigCycleSession& session) {
  return std::string(name(session.stage())) + ' ' +
         scans_text(session.scans(), session.scans_wanted(), session.early_scans());
}

CycleEstimate DigCycleSession::State::estimate_of_scans(bool& averaged) {
  DigScans scans;
  scans.before = robot.scan_of(before, "scan before", averaged);
  scans.after = robot.scan_of(after, "scan after", averaged);
  CycleEstimate answer;
  answer.estimate = estimate_density(scans, settings.law, estimate_options());
  answer.before = before.size();
  answer.warnings = answer.estimate.warnings;
  const std::optional<GroundDensity> found = answer.estimate.ground_density();
  answer.adopted = answer.estimate.trustworthy && found;
  if (answer.adopted) density = *found;
  return answer;
}

CycleEstimate DigCycleSession::State::estimate_on_site(bool& averaged) {
  CycleEstimate answer;
  std::optional<GroundScan> first;
  if (site->needs_before() && !before.empty()) {
    first = ground_scan(before, "before", averaged);
    answer.before = before.size();
  }
  const GroundScan last = ground_scan(after, "after", averaged);
  SiteEvent event;
  event.scan = last.scan;
  event.time = last.time;
  event.options = estimate_options();
  if (event.options.dug_path)
    event.foretold = ForetoldDig{driven->density_percent, driven->dig.energy};
  SiteUpdate update = site->survey(std::move(event), first);
  answer.warnings = update.warnings;
  answer.estimate = std::move(*update.estimate);
  answer.estimate.trustworthy = update.trustworthy;
  update.estimate.reset();
  answer.adopted = update.trustworthy && update.density.has_value();
  if (answer.adopted) {
    density = GroundDensity(update.density->percent, update.density->sd_percent);
    density.soil = settings.soil.name;
  }
  answer.site = std::move(update);
  return answer;
}

CycleEstimate DigCycleSession::estimate() {
  State& state = *state_;
  state.last_refused = state.stage != CycleStage::before;
  require(state.stage == CycleStage::done,
          state.stage == CycleStage::after
              ? "the scan after the dig has " +
                    count_text(state.recent.size(), state.settings.scans) + " messages" +
                    (state.early == 0 ? "" : "; " + state.early_text())
              : std::string("no dig has been scanned: it is the time ") + name(state.stage) +
                    (state.stage == CycleStage::before ? " the first dig" : ""));
  bool averaged = true;
  CycleEstimate answer;
  if (state.surveyed) {
    answer = *state.surveyed;
  } else {
    answer = state.site ? state.estimate_on_site(averaged) : state.estimate_of_scans(averaged);
    answer.after = state.after.size();
    const std::vector<Warning> more = state.scan_warnings(answer, averaged);
    answer.warnings.insert(answer.warnings.end(), more.begin(), more.end());
  }
  if (state.site) state.surveyed = answer;
  state.last_refused = !answer.adopted;
  if (answer.adopted) state.density_is_stated = false;
  return answer;
}

PlanOptions DigCycleSession::State::plan_options(const std::optional<Scan>& scan) const {
  using Clock = std::chrono::steady_clock;
  PlanOptions options = settings.plan;
  if (scan) options.standing_on = ground_at_tracks(*scan);
  if (!std::isfinite(settings.search_seconds)) return options;
  const auto begin = Clock::now();
  options.search.progress = [=, own = options.search.progress,
                             most = settings.search_seconds](const SearchProgress& progress) {
    const bool in_time = std::chrono::duration<double>(Clock::now() - begin).count() < most;
    return (!own || own(progress)) && in_time;
  };
  return options;
}

/// @return warnings of the ground
std::vector<Warning> DigCycleSession::State::plan_on_scan(const std::optional<Scan>& scan,
                                                          CyclePlan& answer) const {
  const ScannedTerrain ground = terrain(scan);
  answer.plan =
      plan_dig(settings.machine, settings.soil, density, ground.terrain, plan_options(scan));
  return ground.warnings;
}

/// The site takes in the first scan of the session. @return what is doubtful about its ground
std::vector<Warning> DigCycleSession::State::look_around(const std::optional<Scan>& scan) {
  if (site->is_current()) return {};
  if (stage != CycleStage::before) {
    return {{WarningCode::ground_before_dig,
             "the site took no scan in since the last dig began: its ground is as before it"}};
  }
  if (scan) return site->look_around({*scan, seconds_of(recent)});
  if (!site->knows_ground()) return {};
  return {{WarningCode::scan_old,
           "no scan came yet: the ground is as the site remembers it, and people and machines may "
           "have moved since"}};
}

/// @return warnings of the ground
std::vector<Warning> DigCycleSession::State::plan_with_site(const std::optional<Scan>& scan,
                                                            CyclePlan& answer) {
  std::vector<Warning> doubts = look_around(scan);
  if (!site->knows_ground()) return plan_on_scan(scan, answer);
  std::optional<Terrain> present;
  if (scan) {
    present = terrain(scan).terrain;
    const std::vector<Warning> more = ending_trust(present->doubts);
    doubts.insert(doubts.end(), more.begin(), more.end());
  }
  PlanOptions options = plan_options(scan);
  if (!scan) options.standing_on = site->at_tracks();
  SitePlan next = site->plan(options, settings.density, present);
  answer.plan = std::move(next.plan);
  density = next.density;
  density_is_stated = !site->has_density();
  return doubts;
}

CyclePlan DigCycleSession::plan(Time time) {
  State& state = *state_;
  state.robot.tell_time(time);
  const std::optional<Scan> scan = state.last_scan();
  const DigCycleSettings& settings = state.settings;
  CyclePlan answer;
  const std::vector<Warning> of_ground =
      state.site ? state.plan_with_site(scan, answer) : state.plan_on_scan(scan, answer);
  answer.density = state.density;
  answer.density_is_stated = state.density_is_stated;
  answer.previous_density = state.last_refused;
  answer.warnings = settings.warnings;
  answer.warnings.insert(answer.warnings.end(), of_ground.begin(), of_ground.end());
  if (state.last_refused) {
    answer.warnings.emplace_back(WarningCode::previous_density,
                                 "the density by the last dig is not known or not to be trusted: "
                                 "planned for the previous one, " +
                                     plain_number(state.density.percent) + " %");
  }
  answer.warnings.insert(answer.warnings.end(), answer.plan.warnings.begin(),
                         answer.plan.warnings.end());
  if (answer.plan.stopped) {
    const std::string stopped =
        "the search was stopped after " + std::to_string(answer.plan.evaluations) + " digs";
    answer.warnings.emplace_back(WarningCode::search_stopped,
                                 stopped + ": there may be a better dig");
    if (!answer.plan.dig) answer.plan.reason = stopped + " that could not be done";
  }
  if (answer.plan.dig) {
    const ScannedTerrain around = state.ground_around(scan);
    answer.warnings.insert(answer.warnings.end(), around.warnings.begin(), around.warnings.end());
    state.add_motion(around.terrain, answer);
  }
  if (scan) state.add_age(answer);
  answer.trustworthy =
      answer.plan.trustworthy && answer.plan.dig && !any_ends_trust(answer.warnings);
  state.planned.reset();
  if (answer.plan.dig)
    state.planned = DigCycleSession::State::DigForetold{*answer.plan.dig, answer.density.percent};
  state.plan_id = answer.stamp ? answer.stamp->id : "";
  return answer;
}

void DigCycleSession::confirm_start(CyclePlan& plan, Time time) {
  state_->robot.tell_time(time);
  if (plan.motion.points.empty()) return;
  std::vector<Warning> doubts = doubts_of(plan.stamp);
  if (const std::string problem =
          plan.posture_known ? state_->robot.start_problem(plan.motion) : "";
      !problem.empty()) {
    doubts.emplace_back(WarningCode::start_left,
                        "the machine may stand where the motion does not begin: " + problem);
  }
  if (!doubts.empty()) plan.trustworthy = false;
  plan.warnings.insert(plan.warnings.end(), doubts.begin(), doubts.end());
}

std::vector<Warning> DigCycleSession::doubts_of(const std::optional<PlanStamp>& stamp, Time time) {
  const State& state = *state_;
  state_->robot.tell_time(time);
  constexpr double same = 1e-6;  // of a pose that was written and read
  std::vector<Warning> doubts;
  const auto refuse = [&](WarningCode code, const std::string& why) {
    doubts.emplace_back(code, "the motion is not to be driven: " + why);
  };
  if (!stamp) {
    refuse(WarningCode::foreign_plan, "it does not state its plan");
    return doubts;
  }
  const Eigen::Isometry3d pose = Eigen::Isometry3d(state.settings.site_from_scan).inverse();
  if (stamp->id != state.plan_id) {
    refuse(WarningCode::foreign_plan,
           "it is of plan " + in_quotes(stamp->id) +
               (state.plan_id.empty() ? ", and none is waiting here"
                                      : ", the last plan here is " + state.plan_id));
  } else if (!((stamp->pose.translation() - pose.translation()).norm() <= same &&
               (stamp->pose.linear() - pose.linear()).norm() <= same)) {
    refuse(WarningCode::foreign_plan, "the machine stood elsewhere when it was planned");
  }
  const Time now = state.robot.now();
  if (stamp->expires && now && *now > *stamp->expires) {
    refuse(WarningCode::stale_plan, "its scan became too old " +
                                        readable(seconds_between(*stamp->expires, *now), 3) +
                                        " s ago");
  }
  return doubts;
}

}  // namespace excavplan
