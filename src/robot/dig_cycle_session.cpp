// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/dig_cycle_session.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <excavplan/planning/standing_ground.hpp>
#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "recording/times.hpp"
#include "robot/cycle_site.hpp"
#include "robot/live_scan.hpp"
#include "robot/message_clock.hpp"
#include "robot/recent_joints.hpp"
#include "robot/recent_transforms.hpp"

namespace excavplan {
namespace {

using Frames = std::vector<LiveFrame>;
using Time = std::optional<std::int64_t>;  // [ns]

// Of a joint that stands still [rad]: what MoveIt allows by default between joint states and the
// first point of a trajectory (trajectory_execution/allowed_start_tolerance).
constexpr double most_turn = 0.01;

double seconds(std::int64_t from, std::int64_t to) {
  return 1e-9 * (static_cast<double>(to) - static_cast<double>(from));
}

std::vector<Warning> ending_trust(const std::vector<Warning>& all) {
  std::vector<Warning> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some),
               [](const Warning& warning) { return warning.ends_trust; });
  return some;
}

/// A dig that was planned, and for which density.
struct DigForetold {
  PlannedDig dig;
  double density_percent;
};

std::string count_text(std::size_t found, std::size_t wanted) {
  return std::to_string(found) + " of " + std::to_string(wanted);
}

}  // namespace

const char* name(CycleStage stage) {
  constexpr std::array<const char*, 4> names = {"before", "digging", "after", "done"};
  return names[static_cast<std::size_t>(stage)];
}

struct DigCycleSession::State {
  explicit State(DigCycleSettings given) : settings(std::move(given)), density(settings.density) {
    if (!settings.site.empty()) site.emplace(settings);
  }

  Time time_of(const RobotMessage& message, std::int64_t stamp);
  void come(const RobotMessage& message, Time time);
  void mark(Time time);
  void take_points(LiveFrame frame, Time time);
  void take_joints(const std::vector<std::pair<std::string, double>>& positions, Time time);
  std::optional<JointSample> sample(const std::string& joint, Time at) const;
  std::string joint_problem(Time at) const;
  std::string moving_problem() const;
  std::string start_problem(const JointMotion& motion) const;
  std::optional<MachinePosture> posture(Time at) const;
  void settle(Frames& frames, bool all);
  void settle_postures(Frames& frames, bool all) const;
  std::string early_text() const;
  std::vector<Warning> scan_warnings(const CycleEstimate& answer, bool averaged) const;
  Scan scan_of(Frames& frames, const char* which, bool& averaged);
  GroundScan ground_scan(Frames& frames, const char* which, bool& averaged);
  double seconds_of(const Frames& frames) const;
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
  std::optional<FrontJoints> start() const;
  void add_motion(const Terrain& ground, CyclePlan& answer) const;
  Time scan_time() const;
  void add_age(CyclePlan& answer) const;

  DigCycleSettings settings;
  CycleStage stage = CycleStage::before;
  Frames recent, before, after;  ///< recent: since the last dig
  RecentTransforms transforms;
  RecentJoints joints;                         ///< of the settings' names
  std::map<std::string, MessageClock> clocks;  ///< by topic
  Time now;                                    ///< when the newest message came
  Time marked;                                 ///< when the dig began or ended
  std::size_t early = 0;                       ///< messages of points from before that
  GroundDensity density;
  bool density_is_stated = true;
  bool last_refused = false;              ///< the last estimate was not to be trusted
  std::optional<DigForetold> planned;     ///< the last plan
  std::string plan_id;                    ///< of its motion; empty: none, or it has begun
  std::optional<DigForetold> driven;      ///< what was planned when the last dig began
  std::optional<CycleSite> site;          ///< of the settings
  std::optional<CycleEstimate> surveyed;  ///< what the site answered to the last dig
};

/// When a message with this stamp was measured.
Time DigCycleSession::State::time_of(const RobotMessage& message, std::int64_t stamp) {
  return clocks[message.topic].time(stamp, message.received);
}

/// @param time  of the message, if it does not tell when it was received
void DigCycleSession::State::come(const RobotMessage& message, Time time) {
  constexpr std::int64_t set_back = 1'000'000'000;  // the clock, not the order of messages; ours
  if (message.received) {
    now = message.received;
    if (marked && *now < later(*marked, -set_back)) marked.reset();
  } else if (time && (!now || *time > *now)) {
    now = time;
  }
}

void DigCycleSession::State::mark(Time time) {
  if (time) marked = now = time;
}

void DigCycleSession::State::take_points(LiveFrame frame, Time time) {
  if (stage == CycleStage::digging) return;
  if (time && marked && *time < *marked) {
    ++early;
    return;
  }
  frame.time = time.value_or(now.value_or(0));
  if (settings.site_frame.empty()) frame.pose = Eigen::Isometry3d(settings.site_from_scan);
  settle(recent, false);
  settle(after, false);
  if (recent.size() == settings.scans) recent.erase(recent.begin());
  recent.push_back(std::move(frame));
  settle_postures(recent, false);
  if (stage == CycleStage::after && recent.size() == settings.scans) {
    after = recent;
    stage = CycleStage::done;
  }
}

void DigCycleSession::State::take_joints(
    const std::vector<std::pair<std::string, double>>& positions, Time time) {
  for (const auto& [name, position] : positions) {
    if (name.empty() || !std::isfinite(position)) continue;
    for (const RobotJoint& joint : settings.machine.robot_joints) {
      if (joint.name == name) joints.add(name, {time.value_or(now.value_or(0)), position});
    }
  }
  for (Frames* frames : {&recent, &before, &after}) settle_postures(*frames, false);
}

/// @param at  nothing: the newest
std::optional<JointSample> DigCycleSession::State::sample(const std::string& joint, Time at) const {
  return joints.nearest(joint, at.value_or(std::numeric_limits<std::int64_t>::max()));
}

/// Why the posture at a time, or now, is not known; empty if it is.
std::string DigCycleSession::State::joint_problem(Time at) const {
  const std::int64_t time = at.value_or(now.value_or(0));
  for (const RobotJoint& joint : settings.machine.robot_joints) {
    if (joint.name.empty()) continue;
    const auto found = sample(joint.name, at);
    if (!found) return "no joint states came of " + joint.name;
    const double away = std::abs(seconds(found->time, time));
    if (away <= settings.oldest_joints) continue;
    return "no joint states of " + joint.name + " came within " +
           plain_number(settings.oldest_joints) + " s, the nearest is " + readable(away) +
           " s away";
  }
  return "";
}

/// Why the machine may be moving; empty if it stands.
std::string DigCycleSession::State::moving_problem() const {
  constexpr std::int64_t span = 500'000'000;  // [ns]; ours
  for (const RobotJoint& joint : settings.machine.robot_joints) {
    if (joint.name.empty()) continue;
    const auto turned = joints.turned(joint.name, span);
    if (!turned) {
      return "the joint states of " + joint.name + " reach back less than " +
             plain_number(seconds(0, span)) + " s: whether it stands still is not known";
    }
    if (*turned <= most_turn) continue;
    return joint.name + " turned by " + readable(*turned) + " rad within the last " +
           plain_number(seconds(0, span)) + " s";
  }
  return "";
}

/// Why the machine does not stand now where a motion begins; empty if it does.
std::string DigCycleSession::State::start_problem(const JointMotion& motion) const {
  const std::optional<FrontJoints> present = start();
  if (!present) return joint_problem({});
  std::size_t sent = 0;
  for (std::size_t i = 0; i < settings.machine.robot_joints.size(); ++i) {
    const RobotJoint& joint = settings.machine.robot_joints[i];
    if (joint.name.empty()) continue;
    const double stands = joint.from_ours((*present)[static_cast<Eigen::Index>(i)]);
    const double off = std::abs(stands - motion.points.front().positions[sent++]);
    if (off <= most_turn) continue;
    return joint.name + " stands " + readable(off) + " rad from there";
  }
  return "";
}

std::optional<MachinePosture> DigCycleSession::State::posture(Time at) const {
  if (!joint_problem(at).empty()) return {};
  FrontJoints angles = FrontJoints::Zero();
  for (std::size_t i = 0; i < settings.machine.robot_joints.size(); ++i) {
    const RobotJoint& joint = settings.machine.robot_joints[i];
    if (joint.name.empty()) continue;
    angles[static_cast<Eigen::Index>(i)] = joint.to_ours(sample(joint.name, at)->position);
  }
  return MachinePosture{angles[3], angles.head<3>()};
}

/// Where the motion begins: sensors of joints that stand at a limit read a little beyond it.
std::optional<FrontJoints> DigCycleSession::State::start() const {
  constexpr double most_beyond = 0.02;  // ours [rad]
  const std::optional<MachinePosture> present = posture({});
  if (!present) return {};
  FrontJoints start;
  start << present->joints, present->swing;
  for (std::size_t i = 0; i < settings.machine.limits.size(); ++i) {
    const JointLimits& limits = settings.machine.limits[i];
    double& angle = start[static_cast<Eigen::Index>(i)];
    const double inside = std::clamp(angle, limits.lower, limits.upper);
    if (std::abs(angle - inside) < most_beyond) angle = inside;
  }
  return start;
}

/// Finds poses that are not known yet; `all`: an error where one stays unknown.
void DigCycleSession::State::settle(Frames& frames, bool all) {
  const auto known = [](const LiveFrame& frame) { return frame.pose.has_value(); };
  if (std::all_of(frames.begin(), frames.end(), known)) return;
  const TransformTree tree = transforms.tree();
  for (LiveFrame& frame : frames) {
    if (frame.pose) continue;
    try {
      const MessageHeader& header = frame.header;
      frame.pose = Eigen::Isometry3d(settings.site_from_scan) *
                   tree.lookup(settings.site_frame, header.frame, header.stamp);
      frame.from_sensor = tree.is_leaf(header.frame);
    } catch (const Error&) {
      if (all) throw;
    }
  }
}

/// Finds postures that are not known yet, once the joint states reach the time of the points;
/// `all`: by those that came.
void DigCycleSession::State::settle_postures(Frames& frames, bool all) const {
  if (!settings.machine_in_view) return;
  const RobotJoints& robot = settings.machine.robot_joints;
  for (LiveFrame& frame : frames) {
    if (frame.posture) continue;
    const bool reached = std::all_of(robot.begin(), robot.end(), [&](const RobotJoint& joint) {
      return joint.name.empty() || joints.reaches(joint.name, frame.time);
    });
    if (reached || all) frame.posture = posture(frame.time);
  }
}

Scan DigCycleSession::State::scan_of(Frames& frames, const char* which, bool& averaged) {
  settle(frames, true);
  settle_postures(frames, true);
  LiveScan live = merged(frames);
  averaged = averaged && (live.averaged || frames.size() == 1);
  Scan scan;
  scan.name = std::string("scan ") + which;
  scan.clouds = {std::make_shared<const Cloud>(std::move(live.cloud))};
  scan.z_is_up = !settings.site_frame.empty() || !settings.site_from_scan.isIdentity(0.0);
  if (settings.machine_in_view) {
    const LiveFrame& first = frames.front();
    require(first.posture.has_value(),
            scan.name + ": the machine is in view, but " + joint_problem(first.time));
    scan.machine = std::make_shared<const MachineFront>(settings.machine, *first.posture);
  }
  return scan;
}

/// When they were measured, since 1970; else by the clock of the computer [s].
double DigCycleSession::State::seconds_of(const Frames& frames) const {
  std::int64_t newest = 0;
  for (const LiveFrame& frame : frames) newest = std::max(newest, frame.time);
  if (newest > 0) return 1e-9 * static_cast<double>(newest);
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since_1970).count();
}

GroundScan DigCycleSession::State::ground_scan(Frames& frames, const char* which, bool& averaged) {
  return {scan_of(frames, which, averaged), seconds_of(frames)};
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
  return seen.empty() ? std::nullopt : std::optional(scan_of(seen, "of the ground", averaged));
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
  const CycleWayOptions way = {start(), settings.whole_cycle, settings.plan.search.objective};
  answer.posture_known = way.start.has_value();
  if (!way.start) {
    answer.warnings.emplace_back(WarningCode::posture_unknown,
                                 joint_problem({}) +
                                     ": the motion begins above the dig, wherever "
                                     "the machine stands");
  } else if (const std::string moving = moving_problem(); !moving.empty()) {
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
  if (!scanned || !now) return;
  answer.scan_age = std::max(0.0, seconds(*scanned, *now));
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
  const RecordedTopic topic = {message.topic, message.type, 1, 0, 0};
  const RecordedMessage raw = {topic, 0, message.is_cdr ? Serialization::cdr : Serialization::ros1,
                               message.bytes, "message"};
  const std::string& from = message.topic;
  const MessageUse use = use_of(message.type);
  switch (use) {
    case MessageUse::points: {
      LiveFrame frame;
      frame.header = decode_header(from, raw);
      frame.points = decode_points(from, raw);
      const Time time = state_->time_of(message, frame.header.stamp);
      state_->come(message, time);
      return state_->take_points(std::move(frame), time);
    }
    case MessageUse::transforms: {
      auto transforms = decode_transforms(from, raw);
      for (const StampedTransform& transform : transforms) {
        state_->come(message, transform.is_static ? Time() : transform.stamp);
      }
      return state_->transforms.add(std::move(transforms));
    }
    case MessageUse::joints: {
      const auto positions = decode_joints(from, raw);
      const Time time = state_->time_of(message, decode_header(from, raw).stamp);
      state_->come(message, time);
      return state_->take_joints(positions, time);
    }
    default:
      throw Error(ErrorKind::bad_file, from + ": found a message of " + message.type +
                                           ", expected points, transforms or joint states");
  }
}

void DigCycleSession::start_dig(Time time) {
  State& state = *state_;
  const bool is_known = state.site && state.site->knows_ground();
  require(state.stage == CycleStage::digging || !state.recent.empty() || is_known,
          "the dig begins, but no scan came before it");
  if (state.stage == CycleStage::digging) return;  // told twice
  state.settle(state.recent, true);
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
  const std::size_t early = session.early_scans();
  return std::string(name(session.stage())) + ' ' +
         count_text(session.scans(), session.scans_wanted()) +
         (early == 0 ? "" : ", " + std::to_string(early) + " too early");
}

CycleEstimate DigCycleSession::State::estimate_of_scans(bool& averaged) {
  DigScans scans;
  scans.before = scan_of(before, "before", averaged);
  scans.after = scan_of(after, "after", averaged);
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
  if (time) state.now = time;
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
  answer.trustworthy = answer.plan.trustworthy && answer.plan.dig &&
                       std::none_of(answer.warnings.begin(), answer.warnings.end(),
                                    [](const Warning& warning) { return warning.ends_trust; });
  state.planned.reset();
  if (answer.plan.dig) state.planned = DigForetold{*answer.plan.dig, answer.density.percent};
  state.plan_id = answer.stamp ? answer.stamp->id : "";
  return answer;
}

void DigCycleSession::confirm_start(CyclePlan& plan, Time time) {
  if (time) state_->now = time;
  if (plan.motion.points.empty()) return;
  std::vector<Warning> doubts = doubts_of(plan.stamp);
  if (const std::string problem = plan.posture_known ? state_->start_problem(plan.motion) : "";
      !problem.empty()) {
    doubts.emplace_back(WarningCode::start_left,
                        "the machine may stand where the motion does not begin: " + problem);
  }
  if (!doubts.empty()) plan.trustworthy = false;
  plan.warnings.insert(plan.warnings.end(), doubts.begin(), doubts.end());
}

std::vector<Warning> DigCycleSession::doubts_of(const std::optional<PlanStamp>& stamp, Time time) {
  const State& state = *state_;
  if (time) state_->now = time;
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
  if (stamp->expires && state.now && *state.now > *stamp->expires) {
    refuse(
        WarningCode::stale_plan,
        "its scan became too old " + readable(seconds(*stamp->expires, *state.now), 3) + " s ago");
  }
  return doubts;
}

}  // namespace excavplan
