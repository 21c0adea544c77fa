// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/job_record.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "base/check.hpp"
#include "base/files.hpp"
#include "base/json.hpp"
#include "job/step_json.hpp"

namespace excavplan {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* record_format = "excavplan job";
constexpr int version = 9;
constexpr int numbers_of_pose = 6;

constexpr std::array phases = {DigPhase::approach, DigPhase::penetrate, DigPhase::drag,
                               DigPhase::scoop,    DigPhase::lift,      DigPhase::swing,
                               DigPhase::dump,     DigPhase::back};
Json poses_json(const std::vector<DigPose>& poses) {
  Json list = Json::array();
  for (const DigPose& pose : poses) {
    const BucketPose& bucket = pose.bucket;
    list.push_back({{"phase", name(pose.phase)},
                    {"pose",
                     {bucket.x, bucket.z, bucket.floor_angle, pose.joints[0], pose.joints[1],
                      pose.joints[2]}}});
  }
  return list;
}

std::vector<DigPose> read_poses(std::vector<JsonObject> list) {
  std::vector<DigPose> poses;
  poses.reserve(list.size());
  for (JsonObject& each : list) {
    DigPose pose;
    pose.phase = of_word(each, "phase", phases);
    const std::vector<double> numbers = each.numbers("pose", numbers_of_pose);
    pose.bucket = {numbers[0], numbers[1], numbers[2]};
    pose.joints = {numbers[3], numbers[4], numbers[5]};
    poses.push_back(pose);
  }
  return poses;
}

Json path_json(const DigPath& path) {
  return {{"angle_rad", path.parameters.penetration_angle},
          {"penetration_m", path.parameters.penetration_length},
          {"drag_m", path.parameters.drag_length},
          {"start_x_m", path.start_x},
          {"ground_z_m", path.ground_z},
          {"grade_rad", path.drag_grade},
          {"floor", path.meets_floor},
          {"heel_clearance_rad", path.heel_clearance},
          {"overcut_m", path.overcut},
          {"approach", poses_json(path.approach)},
          {"poses", poses_json(path.poses)}};
}

DigPath read_path(JsonObject object) {
  DigPath path;
  path.parameters = {object.number("angle_rad"), object.number("penetration_m"),
                     object.number("drag_m")};
  path.start_x = object.number("start_x_m");
  path.ground_z = object.number("ground_z_m");
  path.drag_grade = object.number("grade_rad");
  path.meets_floor = object.flag("floor");
  path.heel_clearance = object.number("heel_clearance_rad");
  path.overcut = object.number("overcut_m");
  path.approach = read_poses(object.objects("approach"));
  path.poses = read_poses(object.objects("poses"));
  object.done();
  return path;
}

Json base_json(const BasePose& base) { return {base.x, base.y, base.z, base.heading}; }

BasePose read_base(JsonObject& object) {
  const std::vector<double> numbers = object.numbers("base", 4);
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

Json joints_json(const FrontJoints& joints) { return {joints[0], joints[1], joints[2], joints[3]}; }

FrontJoints read_joints(JsonObject& object, const char* key) {
  const std::vector<double> numbers = object.numbers(key, 4);
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

Json carried_json(const CarriedLoad& carried) {
  return {{"loose_m3", carried.volume}, {"joints_rad", joints_json(carried.joints)}};
}

CarriedLoad read_carried(JsonObject object) {
  CarriedLoad carried = {object.number("loose_m3", 0.0, 1e6), read_joints(object, "joints_rad")};
  object.done();
  return carried;
}

Json step_json(const JobStep& step) {
  Json json = {{"id", step.id},
               {"what", name(step.what)},
               {"base", base_json(step.base)},
               {"swung_rad", step.swung},
               {"lane_m", step.lane},
               {"dump_m", {step.dump.x(), step.dump.y(), step.dump.z()}},
               {"keeps_load", step.keeps_load},
               {"dumps_first", step.dumps_first},
               {"truck", step.truck.value_or(0)},
               {"payload_kg", step.predicted.payload_mass},
               {"payload_interval_kg", step.predicted.payload_interval},
               {"energy_j", step.predicted.energy},
               {"energy_interval_j", step.predicted.energy_interval},
               {"time_s", step.predicted.time},
               {"trustworthy", step.trustworthy},
               {"warnings", warnings_json(step.warnings)},
               {"reason", step.reason}};
  if (step.carried) json["carried"] = carried_json(*step.carried);
  if (step.digs()) json["path"] = path_json(step.path);
  return json;
}

JobStep read_step(JsonObject object) {
  JobStep step;
  step.id = static_cast<long long>(object.number("id", 0, 1e12));
  step.what = of_word(object, "what", actions);
  step.base = read_base(object);
  step.swung = object.number("swung_rad");
  step.lane = object.number("lane_m");
  const std::vector<double> dump = object.numbers("dump_m", 3);
  step.dump = {dump[0], dump[1], dump[2]};
  step.keeps_load = object.flag("keeps_load");
  step.dumps_first = object.flag("dumps_first");
  if (object.has("carried")) step.carried = read_carried(object.object("carried"));
  if (step.dumps_first && !step.carried) object.fail("dumps_first", "has nothing to dump");
  const int truck = static_cast<int>(object.number("truck", 0, 1e9));
  if (truck > 0) step.truck = truck;
  ForetoldStep& foretold = step.predicted;
  foretold.payload_mass = object.number("payload_kg");
  foretold.energy = object.number("energy_j");
  foretold.time = object.number("time_s");
  const std::vector<double> payloads = object.numbers("payload_interval_kg", 2);
  foretold.payload_interval = {payloads[0], payloads[1]};
  const std::vector<double> energies = object.numbers("energy_interval_j", 2);
  foretold.energy_interval = {energies[0], energies[1]};
  step.trustworthy = object.flag("trustworthy");
  step.warnings = read_warnings(object.objects("warnings"));
  step.reason = object.text("reason");
  if (object.has("path")) step.path = read_path(object.object("path"));
  object.done();
  return step;
}

Json planned_json(const PlannedDig& dig) {
  return {dig.payload_mass, dig.payload_volume, dig.energy,    dig.duration,
          dig.fill,         dig.cycle_energy,   dig.cycle_time};
}

PlannedDig read_planned(const std::vector<double>& numbers) {
  PlannedDig dig;
  dig.payload_mass = numbers[0];
  dig.payload_volume = numbers[1];
  dig.energy = numbers[2];
  dig.duration = numbers[3];
  dig.fill = numbers[4];
  dig.cycle_energy = numbers[5];
  dig.cycle_time = numbers[6];
  return dig;
}

Json learning_json(const JobLearning& learning) {
  return {learning.height_bias.mean,  learning.height_bias.variance, learning.payload.mean,
          learning.payload.variance,  learning.energy.mean,          learning.energy.variance,
          learning.payload_scatter,   learning.energy_scatter,       learning.strength.mean,
          learning.strength.variance, learning.floor.mean,           learning.floor.variance,
          learning.datum.sum.x(),     learning.datum.sum.y(),        learning.datum.sum.z(),
          learning.layer_variance,    learning.cycle_variance,       learning.datum.scans};
}

JobLearning read_learning(JsonObject& object) {
  const std::vector<double> numbers = object.numbers("learning", 18);
  if (!(numbers[17] >= 1.0 && numbers[17] <= 1e9))
    object.fail("learning", "ends in no count of scans");
  JobLearning learning;
  learning.height_bias = {numbers[0], numbers[1]};
  learning.payload = {numbers[2], numbers[3]};
  learning.energy = {numbers[4], numbers[5]};
  learning.payload_scatter = numbers[6];
  learning.energy_scatter = numbers[7];
  learning.strength = {numbers[8], numbers[9]};
  learning.floor = {numbers[10], numbers[11]};
  learning.datum.sum = {numbers[12], numbers[13], numbers[14]};
  learning.layer_variance = numbers[15];
  learning.cycle_variance = numbers[16];
  learning.datum.scans = static_cast<int>(numbers[17]);
  return learning;
}

/// Whole numbers of a record, with their keys.
template <typename Record, typename Visit>
void for_each_count(Record& record, Visit visit) {
  visit("passes_here", record.passes_here);
  visit("bench", record.bench);
  visit("fruitless", record.fruitless);
  visit("fruitless_digs", record.fruitless_digs);
  visit("trucks", record.trucks);
  visit("digs", record.progress.digs);
  visit("finishing_passes", record.progress.finishing_passes);
  visit("moves", record.progress.moves);
  visit("scans", record.progress.scans);
  visit("stalls", record.progress.stalls);
}

/// Other numbers likewise.
template <typename Record, typename Visit>
void for_each_number(Record& record, Visit visit) {
  visit("deepest_cut_m", record.deepest_cut);
  visit("truck_load_kg", record.truck_load);
  visit("strength_share", record.signs.energy_share);
  visit("stalls_at", record.signs.stalls_at);
  visit("simulated_strength", record.signs.strength);
  visit("layer_kg_per_m", record.signs.layer);
  visit("seen_before_look", record.seen_before_look);
  visit("first_volume_m3", record.progress.design_volume);
  visit("payload_mass_kg", record.progress.payload_mass);
}

std::string path_of(const std::string& folder) { return folder + "/" + job_file; }
std::string earlier_path(const std::string& folder) { return folder + "/job-before.json"; }

Json record_json(const JobRecord& record) {
  Json json = {{"format", record_format},         {"version", version},
               {"station", record.station},       {"base", base_json(record.base)},
               {"last_step", record.last_step},   {"site_updates", record.site_updates},
               {"wants_scan", record.wants_scan}, {"has_arrived", record.has_arrived}};
  for_each_count(record, [&](const char* key, int value) { json[key] = value; });
  for_each_number(record, [&](const char* key, double value) { json[key] = value; });
  json["learning"] = learning_json(record.learning);
  json["rests_at_rad"] = joints_json(record.rests_at);
  if (record.grounds != record.site_updates) json["grounds"] = record.grounds;
  if (record.off_place > 0.0) json["off_place_m"] = record.off_place;
  if (record.is_sent_again) json["sent_again"] = true;
  if (record.moves_to_dump > 0) json["moves_to_dump"] = record.moves_to_dump;
  if (record.lacks_dump) json["lacks_dump"] = true;
  if (record.scans_not_taken > 0) json["scans_not_taken"] = record.scans_not_taken;
  if (record.carried) json["carried"] = carried_json(*record.carried);
  if (record.present) json["present"] = step_json(*record.present);
  if (record.planned) json["planned"] = planned_json(*record.planned);
  json["barren"] = Json::array();
  for (const DigStart& each : record.barren) {
    json["barren"].push_back(each.lane);
    json["barren"].push_back(each.along);
    json["barren"].push_back(each.turned);
    json["barren"].push_back(each.is_pass ? 1.0 : 0.0);
  }
  json["looks"] = Json::array();
  for (const SensorLook& each : record.looks) {
    for (const double number : {each.from.x(), each.from.y(), each.from.z(), each.azimuth,
                                each.half_sector, each.range, each.steepest})
      json["looks"].push_back(number);
  }
  json["unseen"] = Json::array();
  for (const JobStep& dig : record.unseen) {
    json["unseen"].push_back(step_json(dig));
  }
  return json;
}

JobRecord read_record(const std::string& path) {
  JsonObject object = JsonObject::open_sealed(path, read_own_file(path), record_format, version);
  JobRecord record;
  record.station = static_cast<std::size_t>(object.number("station", 0, 1e6));
  record.base = read_base(object);
  record.last_step = static_cast<long long>(object.number("last_step", 0, 1e12));
  record.site_updates = static_cast<long long>(object.number("site_updates", 0, 1e12));
  record.grounds = record.site_updates;
  if (object.has("grounds"))
    record.grounds = static_cast<long long>(object.number("grounds", 0, 1e12));
  record.wants_scan = object.flag("wants_scan");
  record.has_arrived = object.flag("has_arrived");
  for_each_count(record, [&](const char* key, int& value) {
    value = static_cast<int>(object.number(key, 0, 1e9));
  });
  for_each_number(record,
                  [&](const char* key, double& value) { value = object.number(key, -1e12, 1e12); });
  record.learning = read_learning(object);
  record.rests_at = read_joints(object, "rests_at_rad");
  if (object.has("off_place_m")) record.off_place = object.number("off_place_m", 0, 1e12);
  if (object.has("sent_again")) record.is_sent_again = object.flag("sent_again");
  if (object.has("moves_to_dump"))
    record.moves_to_dump = static_cast<int>(object.number("moves_to_dump", 0, 1e9));
  if (object.has("scans_not_taken"))
    record.scans_not_taken = static_cast<int>(object.number("scans_not_taken", 0, 1e9));
  if (object.has("lacks_dump")) record.lacks_dump = object.flag("lacks_dump");
  if (object.has("carried")) record.carried = read_carried(object.object("carried"));
  if (object.has("present")) record.present = read_step(object.object("present"));
  if (object.has("planned")) record.planned = read_planned(object.numbers("planned", 7));
  const std::vector<double> barren = object.numbers("barren");
  for (std::size_t i = 0; i + 3 < barren.size(); i += 4)
    record.barren.push_back({barren[i], barren[i + 1], barren[i + 2], barren[i + 3] > 0.0});
  const std::vector<double> looks = object.numbers("looks");
  for (std::size_t i = 0; i + 6 < looks.size(); i += 7) {
    record.looks.push_back({{looks[i], looks[i + 1], looks[i + 2]},
                            looks[i + 3],
                            looks[i + 4],
                            looks[i + 5],
                            looks[i + 6]});
  }
  for (JsonObject& each : object.objects("unseen")) {
    record.unseen.push_back(read_step(std::move(each)));
  }
  object.done();
  return record;
}

}  // namespace

void save_record(const std::string& folder, const JobRecord& record) {
  write_own_file(path_of(folder), sealed_text(record_json(record)));
}

JobRecord load_record(const std::string& folder) { return read_record(path_of(folder)); }

void save_earlier_record(const std::string& folder, const JobRecord& record) {
  write_own_file(earlier_path(folder), sealed_text(record_json(record)));
}

JobRecord earlier_record(const std::string& folder) {
  const std::string path = earlier_path(folder);
  if (!std::filesystem::exists(path)) refuse_undo(folder);
  JobRecord record = read_record(path);
  const JobRecord now = load_record(folder);  // the same, if a change could not be written
  const bool is_earlier =
      record.last_step < now.last_step || record.progress.scans < now.progress.scans;
  if (!is_earlier) refuse_undo(folder);
  return record;
}

void go_to_earlier(const std::string& folder, const JobRecord& earlier) {
  save_record(folder, earlier);
  std::filesystem::remove(earlier_path(folder));
}

void refuse_undo(const std::string& folder) { refuse(folder + ": there is no step to take back"); }

bool holds_record(const std::string& folder) { return std::filesystem::exists(path_of(folder)); }

}  // namespace excavplan
