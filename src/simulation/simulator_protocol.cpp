// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/simulator_protocol.hpp"

#include <algorithm>
#include <array>

#include <excavplan/base/error.hpp>

#include "base/base64.hpp"
#include "base/json.hpp"

namespace excavplan {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* answer_name = "its answer";

// ---- requests -----------------------------------------------------------------------------------

Json joints_json(const Machine& machine) {
  const double lengths[] = {machine.boom_length, machine.arm_length, machine.bucket_length};
  Json joints = Json::object();
  for (std::size_t i = 0; i < machine.limits.size(); ++i) {
    const JointLimits& limits = machine.limits[i];
    const LinkMass& link = machine.links[i];
    joints[name(static_cast<Joint>(i))] = {{"lower_rad", limits.lower},
                                           {"upper_rad", limits.upper},
                                           {"speed_rad_per_s", limits.speed},
                                           {"acceleration_rad_per_s2", limits.acceleration},
                                           {"torque_n_m", limits.torque},
                                           {"length_m", lengths[i]},
                                           {"mass_kg", link.mass},
                                           {"center_along_m", link.along},
                                           {"center_across_m", link.across}};
  }
  return joints;
}

Json machine_json(const Machine& machine) {
  const Bucket& bucket = machine.bucket;
  Json profile = Json::array();
  for (const Eigen::Vector2d& corner : bucket.profile) {
    profile.push_back({corner.x(), corner.y()});
  }
  Json teeth;
  if (bucket.teeth) {
    teeth = {{"count", bucket.teeth->count},
             {"width_m", bucket.teeth->width},
             {"thickness_m", bucket.teeth->thickness},
             {"length_m", bucket.teeth->length},
             {"angle_rad", bucket.teeth->angle}};
  }
  return {{"name", machine.name},
          {"boom_pin_m", {machine.boom_pin.x(), machine.boom_pin.y()}},
          {"track_front_m", machine.track_front},
          {"joints", joints_json(machine)},
          {"bucket",
           {{"profile_m", profile},
            {"width_outside_m", bucket.width_outside},
            {"width_inside_m", bucket.width_inside},
            {"edge_thickness_m", bucket.edge_thickness},
            {"edge_angle_rad", bucket.edge_angle},
            {"teeth", teeth}}}};
}

Json state_json(const SoilState& state) {
  return {{"void_ratio", state.void_ratio},
          {"dry_density_kg_m3", state.dry_density},
          {"bulk_density_kg_m3", state.bulk_density},
          {"cohesion_pa", state.cohesion},
          {"adhesion_pa", state.adhesion},
          {"friction_angle_rad", state.friction_angle},
          {"tool_friction_angle_rad", state.tool_friction_angle}};
}

Json ground_json(const ForeignDig& dig) {
  const HeightMap& bank = dig.bank();
  const auto layer = [](const Eigen::ArrayXXd& values) {
    return base64_of(values.data(), static_cast<std::size_t>(values.size()));
  };
  return {{"rows", bank.z.rows()},    {"cols", bank.z.cols()},
          {"cell_m", bank.cell_size}, {"origin_m", {bank.origin.x(), bank.origin.y()}},
          {"bank_m", layer(bank.z)},  {"loose_m", layer(dig.loose())}};
}

// ---- answers ------------------------------------------------------------------------------------

/// An answer of this type, or what the program cannot do.
std::variant<JsonObject, ForeignRefusal> opened(const std::string& line, const char* type) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::bad_file, std::string(answer_name) + ": " + in_quotes(line) + " is " +
                                         why + "; notes belong on standard error");
  };
  if (line.empty() || line.front() != '{') refuse("no JSON object");
  JsonObject answer = JsonObject::of_others(answer_name, line);
  const std::string found = answer.text("type");
  constexpr std::size_t longest_message = 4000;
  if (found == "error") {
    ForeignRefusal refusal{answer.text("message", longest_message)};
    if (refusal.message.empty()) answer.fail("message", "is empty");
    return refusal;
  }
  if (found != type) {
    answer.fail("type", "is " + in_quotes(found) + ", expected '" + type + "' or 'error'");
  }
  return answer;
}

template <std::size_t count>
void read_parts(JsonObject& object, const char* key, std::array<double, count>& parts) {
  if (!object.has(key)) return;
  const std::vector<double> numbers = object.numbers(key, count);
  std::copy(numbers.begin(), numbers.end(), parts.begin());
}

EnergyLedger read_energy(JsonObject object) {
  EnergyLedger energy;
  energy.total = object.number("total_j");
  read_parts(object, "by_phase_j", energy.by_phase);
  read_parts(object, "by_joint_j", energy.by_joint);
  energy.lift = object.number_or("lift_j", 0.0);
  object.done();
  return energy;
}

/// Four numbers for each step, in one list.
std::vector<ForeignLoad> read_loads(JsonObject& answer) {
  constexpr std::size_t each = 4;
  const std::vector<double> numbers = answer.numbers("loads");
  if (numbers.size() % each != 0) {
    answer.fail("loads", "has " + std::to_string(numbers.size()) + " numbers, must be 4 a step");
  }
  std::vector<ForeignLoad> loads;
  for (std::size_t i = 0; i < numbers.size(); i += each) {
    loads.push_back({{numbers[i], numbers[i + 1]}, numbers[i + 2], numbers[i + 3]});
  }
  return loads;
}

Eigen::ArrayXXd read_layer(JsonObject& ground, const char* key, const AnswerSize& size) {
  Eigen::ArrayXXd layer(size.rows, size.cols);
  if (!read_base64(ground.text(key, longest_answer), layer.data(),
                   static_cast<std::size_t>(layer.size()))) {
    ground.fail(key, "is not the base64 of " + std::to_string(layer.size()) +
                         " numbers of 8 bytes, a layer of " + std::to_string(size.rows) +
                         " rows and " + std::to_string(size.cols) + " columns");
  }
  return layer;
}

}  // namespace

std::string hello_request() {
  return json_text({{"type", "hello"}, {"protocol", simulator_protocol}});
}

std::string prepare_request(const ForeignModel& model) {
  return json_text({{"type", "prepare"},
                    {"machine", machine_json(model.machine)},
                    {"soil",
                     {{"name", model.soil.name},
                      {"density_percent", model.density_percent},
                      {"specific_gravity", model.soil.specific_gravity},
                      {"water_content", model.soil.water_content},
                      {"angle_of_repose_rad", model.soil.angle_of_repose},
                      {"bank", state_json(model.bank)},
                      {"loose", state_json(model.loose)}}}});
}

std::string dig_request(const ForeignDig& dig, std::uint64_t id) {
  Json poses = Json::array();
  for (const DigPose& pose : dig.path().poses) {
    poses.push_back({{"phase", name(pose.phase)},
                     {"x_m", pose.bucket.x},
                     {"z_m", pose.bucket.z},
                     {"floor_angle_rad", pose.bucket.floor_angle},
                     {"joints_rad", {pose.joints(0), pose.joints(1), pose.joints(2)}}});
  }
  return json_text({{"type", "dig"},
                    {"id", id},
                    {"give_up_below_kg_per_j", dig.options().give_up_below},
                    {"ground", ground_json(dig)},
                    {"poses", poses}});
}

std::variant<ForeignSimulator, ForeignRefusal> read_hello(const std::string& line) {
  auto opened_answer = opened(line, "hello");
  if (auto* refusal = std::get_if<ForeignRefusal>(&opened_answer)) return *refusal;
  auto& answer = std::get<JsonObject>(opened_answer);
  const double protocol = answer.number("protocol");
  if (protocol != simulator_protocol) {
    answer.fail("protocol", "is " + plain_number(protocol) + ", this program speaks protocol " +
                                std::to_string(simulator_protocol));
  }
  ForeignSimulator simulator;
  simulator.name = answer.text("name");
  if (const auto fault = fault_of_name(simulator.name)) answer.fail("name", "is " + *fault);
  simulator.mass_tolerance = answer.number_or("mass_tolerance", 0.0, 0.0, most_mass_tolerance);
  answer.done();
  return simulator;
}

ForeignRefusal read_ready(const std::string& line) {
  auto opened_answer = opened(line, "ready");
  if (auto* refusal = std::get_if<ForeignRefusal>(&opened_answer)) return *refusal;
  std::get<JsonObject>(opened_answer).done();
  return {};
}

std::variant<ForeignAnswer, ForeignRefusal> read_dug(const std::string& line,
                                                     const AnswerSize& size) {
  auto opened_answer = opened(line, "dug");
  if (auto* refusal = std::get_if<ForeignRefusal>(&opened_answer)) return *refusal;
  auto& answer = std::get<JsonObject>(opened_answer);
  const double id = answer.number("id");
  if (id != static_cast<double>(size.id)) {
    answer.fail("id", "is " + plain_number(id) + ", expected that of the question, " +
                          std::to_string(size.id));
  }
  ForeignAnswer result;
  result.payload = answer.number("payload_kg");
  result.given_up = answer.has("given_up") && answer.flag("given_up");
  if (answer.has("loads")) result.loads = read_loads(answer);
  if (answer.has("energy")) result.energy = read_energy(answer.object("energy"));
  JsonObject ground = answer.object("ground");
  result.bank = read_layer(ground, "bank_m", size);
  result.loose = read_layer(ground, "loose_m", size);
  ground.done();
  answer.done();
  return result;
}

}  // namespace excavplan
