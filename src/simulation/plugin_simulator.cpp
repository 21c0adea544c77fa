// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/simulation/simulator_plugin.h>
#include <excavplan/base/error.hpp>
#include <excavplan/simulation/foreign_simulators.hpp>

#include "base/check.hpp"
#include "base/files.hpp"
#include "base/text.hpp"
#include "simulation/dig_account.hpp"
#include "simulation/foreign_dig.hpp"

namespace excavplan {
namespace {

constexpr std::size_t longest_plugin_text = 400;  // of a library's text in a message [byte]
constexpr const char* entry_name = "excavplan_simulator_entry";

// ---- the library --------------------------------------------------------------------------------

/// A loaded library; it stays loaded.
struct Library {
  std::string name;  ///< of the simulator, with the digest of the file
  double mass_tolerance = 0.0;
  const excavplan_simulator* functions = nullptr;

  bool one_thread() const { return functions->threads == EXCAVPLAN_ONE_THREAD; }
  bool reentrant() const { return functions->threads == EXCAVPLAN_REENTRANT; }
};

/// Held by all calls into libraries that bear one thread: some share what they use.
std::mutex& one_thread() {
  static std::mutex mutex;
  return mutex;
}

[[noreturn]] void refuse_file(const std::string& file, const std::string& why) {
  throw Error(ErrorKind::bad_file, file + ": " + why);
}

std::string last_loader_error() {
  const char* text = ::dlerror();
  return text == nullptr ? "no reason given" : safe_text(text, longest_plugin_text);
}

const excavplan_simulator* entry_of(const std::string& file) {
  // With its folder, so that the loader searches for it nowhere else.
  const std::string path = std::filesystem::absolute(file).string();
  void* const handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) refuse_file(file, "cannot be loaded: " + last_loader_error());
  using Entry = const excavplan_simulator* (*)(std::uint32_t);
  const auto entry = reinterpret_cast<Entry>(::dlsym(handle, entry_name));
  if (entry == nullptr) {
    refuse_file(file, std::string("is no simulator: it lacks the function ") + entry_name);
  }
  const excavplan_simulator* const simulator = entry(EXCAVPLAN_SIMULATOR_VERSION);
  const std::string own = std::to_string(EXCAVPLAN_SIMULATOR_VERSION);
  if (simulator == nullptr) {
    refuse_file(file, "does not know version " + own + " of simulator_plugin.h");
  }
  if (simulator->version != EXCAVPLAN_SIMULATOR_VERSION) {
    refuse_file(file, "is made for version " + std::to_string(simulator->version) +
                          " of simulator_plugin.h, this program takes version " + own);
  }
  constexpr std::size_t first_size =  // of version 1: what is appended may be missing
      offsetof(excavplan_simulator, destroy) + sizeof simulator->destroy;
  if (simulator->size < first_size) {
    refuse_file(file, "describes itself in " + std::to_string(simulator->size) +
                          " bytes, version " + own + " has at least " + std::to_string(first_size));
  }
  return simulator;
}

Library load(const std::string& file) {
  const std::string digest = checksum_text(read_file(file, most_table_bytes));
  Library library;
  library.functions = entry_of(file);
  const excavplan_simulator& described = *library.functions;
  if (described.create == nullptr || described.dig == nullptr || described.destroy == nullptr) {
    refuse_file(file, "lacks one of create, dig and destroy");
  }
  if (described.threads > EXCAVPLAN_REENTRANT) {
    refuse_file(file, "threads is " + std::to_string(described.threads) + ", must be 0, 1 or 2");
  }
  library.mass_tolerance = described.mass_tolerance;
  if (!(library.mass_tolerance >= 0.0 && library.mass_tolerance <= most_mass_tolerance)) {
    refuse_file(file, "mass_tolerance is " + number_text(library.mass_tolerance) +
                          ", must be in 0 .. " + number_text(most_mass_tolerance));
  }
  const std::string name = described.name == nullptr ? "" : described.name;
  if (const auto fault = fault_of_name(name)) refuse_file(file, "name is " + *fault);
  library.name = name + " (library " + digest + ")";
  return library;
}

// ---- what it is given ---------------------------------------------------------------------------

void set(double (&pair)[2], const Eigen::Vector2d& value) {
  pair[0] = value.x();
  pair[1] = value.y();
}

/// The machine as the library sees it.
class PluginMachine {
 public:
  explicit PluginMachine(const Machine& machine) {
    value_.size = sizeof value_;
    value_.name = machine.name.c_str();
    set(value_.boom_pin, machine.boom_pin);
    value_.track_front_x = machine.track_front;
    const double lengths[] = {machine.boom_length, machine.arm_length, machine.bucket_length};
    for (std::size_t i = 0; i < machine.limits.size(); ++i) {
      const JointLimits& limits = machine.limits[i];
      const LinkMass& link = machine.links[i];
      value_.joint[i] = {{limits.lower, limits.upper},
                         limits.speed,
                         limits.acceleration,
                         limits.torque,
                         lengths[i],
                         link.mass,
                         {link.along, link.across}};
    }
    const Bucket& bucket = machine.bucket;
    for (const Eigen::Vector2d& corner : bucket.profile) {
      profile_.insert(profile_.end(), {corner.x(), corner.y()});
    }
    value_.profile = profile_.data();
    value_.profile_corners = bucket.profile.size();
    value_.width_outside = bucket.width_outside;
    value_.width_inside = bucket.width_inside;
    value_.edge_thickness = bucket.edge_thickness;
    value_.edge_angle = bucket.edge_angle;
    if (!bucket.teeth) return;
    value_.teeth = static_cast<std::size_t>(bucket.teeth->count);
    value_.tooth_size[0] = bucket.teeth->width;
    value_.tooth_size[1] = bucket.teeth->thickness;
    value_.tooth_size[2] = bucket.teeth->length;
    value_.tooth_angle = bucket.teeth->angle;
  }

  const excavplan_machine* get() const { return &value_; }

 private:
  std::vector<double> profile_;
  excavplan_machine value_ = {};
};

excavplan_soil_state state_of(const SoilState& state) {
  return {state.void_ratio, state.dry_density,    state.bulk_density,       state.cohesion,
          state.adhesion,   state.friction_angle, state.tool_friction_angle};
}

excavplan_soil soil_of(const ForeignModel& model) {
  excavplan_soil soil = {};
  soil.size = sizeof soil;
  soil.name = model.soil.name.c_str();
  soil.relative_density = model.bank.relative_density;
  soil.specific_gravity = model.soil.specific_gravity;
  soil.water_content = model.soil.water_content;
  soil.angle_of_repose = model.soil.angle_of_repose;
  soil.bank = state_of(model.bank);
  soil.loose = state_of(model.loose);
  return soil;
}

std::vector<excavplan_pose> poses_of(const DigPath& path) {
  std::vector<excavplan_pose> poses;
  poses.reserve(path.poses.size());
  for (const DigPose& pose : path.poses) {
    poses.push_back({static_cast<std::int32_t>(pose.phase),
                     {pose.bucket.x, pose.bucket.z},
                     pose.bucket.floor_angle,
                     {pose.joints(0), pose.joints(1), pose.joints(2)}});
  }
  return poses;
}

/// Calls a function of the library. @throws Error (bad_input) with its text if it fails
template <typename Call>
void call(const Library& library, const Call& function) {
  std::array<char, 1024> error = {};
  int code = 0;
  if (library.one_thread()) {
    const std::lock_guard lock(one_thread());
    code = function(error.data(), error.size());
  } else {
    code = function(error.data(), error.size());
  }
  if (code == 0) return;
  error.back() = '\0';
  const std::string text = safe_text(error.data(), longest_plugin_text);
  refuse("it says: " + (text.empty() ? "error " + std::to_string(code) : text));
}

// ---- the simulator ------------------------------------------------------------------------------

/// An instance of the library's simulator.
class Instance {
 public:
  Instance(const Library& library, const ForeignModel& model) : library_(library) {
    const PluginMachine machine(model.machine);
    const excavplan_soil soil = soil_of(model);
    call(library, [&](char* error, std::size_t size) {
      return library.functions->create(library.functions->context, machine.get(), &soil, &made_,
                                       error, size);
    });
  }
  ~Instance() {
    std::unique_lock<std::mutex> lock;
    if (library_.one_thread()) lock = std::unique_lock(one_thread());
    library_.functions->destroy(made_);
  }
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  void dig(const excavplan_dig& dig, excavplan_result& result) const {
    call(library_, [&](char* error, std::size_t size) {
      return library_.functions->dig(made_, &dig, &result, error, size);
    });
  }

 private:
  const Library& library_;
  void* made_ = nullptr;
};

/// Digs by a library.
class PluginSimulator : public SoilSimulator {
 public:
  PluginSimulator(std::shared_ptr<const Library> library, const Machine& machine,
                  const SoilKind& soil, double density_percent)
      : library_(std::move(library)),
        model_(machine, soil, density_percent),
        identity_(simulator_identity(library_->name, machine, soil, density_percent)) {
    waiting_.push_back(std::make_shared<const Instance>(*library_, model_));
  }

  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options) const override {
    const ForeignDig dig(model_, terrain, path, options);
    const std::shared_ptr<const Instance> instance = taken();
    const ForeignAnswer answer = answered(*instance, dig);
    if (!library_->reentrant()) give_back(instance);
    return dig.result(answer, library_->mass_tolerance);
  }

  std::string identity() const override { return identity_; }

 private:
  std::shared_ptr<const Instance> taken() const {
    {
      const std::lock_guard lock(mutex_);
      if (library_->reentrant()) return waiting_.front();
      if (!waiting_.empty()) {
        std::shared_ptr<const Instance> instance = std::move(waiting_.back());
        waiting_.pop_back();
        return instance;
      }
    }
    return std::make_shared<const Instance>(*library_, model_);
  }
  void give_back(const std::shared_ptr<const Instance>& instance) const {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(instance);
  }

  static ForeignAnswer answered(const Instance& instance, const ForeignDig& dig) {
    const HeightMap& bank = dig.bank();
    const std::vector<excavplan_pose> poses = poses_of(dig.path());
    excavplan_dig asked = {};
    asked.size = sizeof asked;
    asked.rows = static_cast<std::size_t>(bank.z.rows());
    asked.cols = static_cast<std::size_t>(bank.z.cols());
    set(asked.origin, bank.origin);
    asked.cell = bank.cell_size;
    asked.bank = bank.z.data();
    asked.loose = dig.loose().data();
    asked.poses = poses.size();
    asked.pose = poses.data();
    asked.give_up_below = dig.options().give_up_below;

    ForeignAnswer answer;
    answer.bank = bank.z;
    answer.loose = dig.loose();
    std::vector<excavplan_load> loads(dig.steps());
    excavplan_result result = {};
    result.size = sizeof result;
    result.bank = answer.bank.data();
    result.loose = answer.loose.data();
    result.load = loads.data();
    instance.dig(asked, result);
    take(result, loads, answer);
    return answer;
  }

  static void take(const excavplan_result& result, const std::vector<excavplan_load>& loads,
                   ForeignAnswer& answer) {
    answer.payload = result.payload;
    answer.given_up = (result.has & EXCAVPLAN_GAVE_UP) != 0;
    if ((result.has & EXCAVPLAN_HAS_LOADS) != 0) {
      for (const excavplan_load& load : loads) {
        answer.loads.push_back({{load.force[0], load.force[1]}, load.moment, load.carried});
      }
    }
    if ((result.has & EXCAVPLAN_HAS_ENERGY) == 0) return;
    EnergyLedger energy;
    energy.total = result.energy;
    energy.lift = result.lift_energy;
    for (std::size_t i = 0; i < 3; ++i) {
      energy.by_phase[i] = result.by_phase[i];
      energy.by_joint[i] = result.by_joint[i];
    }
    answer.energy = energy;
  }

  std::shared_ptr<const Library> library_;
  ForeignModel model_;
  std::string identity_;
  mutable std::mutex mutex_;
  mutable std::vector<std::shared_ptr<const Instance>> waiting_;
};

}  // namespace

SimulatorKind plugin_simulator(const std::string& file) {
  const auto library = std::make_shared<const Library>(load(file));
  return {library->name, library->name,
          [library](const Machine& machine, const SoilKind& soil, double density_percent) {
            return std::make_unique<const PluginSimulator>(library, machine, soil, density_percent);
          }};
}

}  // namespace excavplan
