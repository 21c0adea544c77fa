// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>
#include <time.h>

#include <cmath>
#include <cstdint>
#include <variant>
#include <vector>

#ifdef EXCAVPLAN_KDL
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#endif

#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/trajectory.hpp>
#include "base/random.hpp"

#include "base/angles.hpp"

/// @file
/// Inverse kinematics in closed form beside the numeric solvers of orocos-kdl (optional), on the
/// same random postures within the limits; and what timing a path costs.

namespace excavplan {
namespace {

const Machine& shipped_machine() {
  static const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  return machine;
}

const std::vector<BucketPose>& random_poses() {
  static const std::vector<BucketPose> poses = [] {
    Random random(1);
    std::vector<BucketPose> drawn;
    for (int n = 0; n < 4096; ++n) {
      JointAngles joints;
      for (int i = 0; i < 3; ++i) {
        const JointLimits& limits = shipped_machine().limits[static_cast<std::size_t>(i)];
        joints[i] = random.uniform(limits.lower, limits.upper);
      }
      drawn.push_back(forward_kinematics(shipped_machine(), joints));
    }
    return drawn;
  }();
  return poses;
}

/// True if the joints hold the pose within 10 um and 10 urad, inside their limits.
bool holds(const JointAngles& joints, const BucketPose& pose) {
  const BucketPose got = forward_kinematics(shipped_machine(), joints);
  return std::hypot(got.x - pose.x, got.z - pose.z) < 1e-5 &&
         std::abs(std::remainder(got.floor_angle - pose.floor_angle, 2.0 * pi)) < 1e-5 &&
         limit_margin(shipped_machine(), joints).margin > -1e-9;
}

JointAngles closed_form(const BucketPose& pose) {
  const auto joints = inverse_kinematics(shipped_machine(), pose);
  const auto* found = std::get_if<JointAngles>(&joints);
  return found != nullptr ? *found : JointAngles::Zero();
}

/// Of this thread [s].
double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Runs a solver over the poses. Reports the share that it gets right, and how many times the time
/// of the closed form it takes, both run in turns.
template <typename Solver>
void solve_poses(benchmark::State& state, const Solver& solve) {
  const std::vector<BucketPose>& poses = random_poses();
  const auto run = [&](const auto& solver) {
    const double begin = processor_time();
    for (const BucketPose& pose : poses) benchmark::DoNotOptimize(solver(pose));
    return processor_time() - begin;
  };
  for (auto _ : state) run(solve);
  double right = 0.0, time = 0.0, closed_form_time = 0.0;
  for (const BucketPose& pose : poses) right += holds(solve(pose), pose) ? 1.0 : 0.0;
  for (int turn = 0; turn < 5; ++turn) {
    time += run(solve);
    closed_form_time += run(closed_form);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(poses.size()));
  state.counters["right"] = right / static_cast<double>(poses.size());
  state.counters["times_closed_form"] = time / closed_form_time;
}

void inverse_kinematics_closed_form(benchmark::State& state) { solve_poses(state, closed_form); }
BENCHMARK(inverse_kinematics_closed_form)
    ->Name("inverse_kinematics_closed_form/poses:4096")
    ->Unit(benchmark::kMicrosecond);

#ifdef EXCAVPLAN_KDL

/// The machine as KDL sees it; a turn about +y, to the left, turns a link down.
class KdlMachine {
 public:
  KdlMachine() : lower_(3), upper_(3), middle_(3) {
    const Machine& m = shipped_machine();
    chain_.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None),
                                   KDL::Frame({m.boom_pin.x(), 0.0, m.boom_pin.y()})));
    for (const double length : {m.boom_length, m.arm_length, m.bucket_length}) {
      chain_.addSegment(
          KDL::Segment(KDL::Joint(KDL::Joint::RotY), KDL::Frame(KDL::Vector(length, 0.0, 0.0))));
    }
    for (unsigned i = 0; i < 3; ++i) {
      lower_(i) = m.limits[i].lower;
      upper_(i) = m.limits[i].upper;
      middle_(i) = 0.5 * (lower_(i) + upper_(i));
    }
  }

  template <typename KdlSolver>
  JointAngles solve(KdlSolver& solver, const BucketPose& pose) const {
    const double turn = pi - shipped_machine().beta() - pose.floor_angle;
    KDL::JntArray joints(3);
    solver.CartToJnt(middle_, {KDL::Rotation::RotY(turn), {pose.x, 0.0, pose.z}}, joints);
    return {joints(0), joints(1), joints(2)};
  }

  const KDL::Chain& chain() const { return chain_; }
  const KDL::JntArray& lower() const { return lower_; }
  const KDL::JntArray& upper() const { return upper_; }

 private:
  KDL::Chain chain_;
  KDL::JntArray lower_, upper_, middle_;
};

/// Levenberg and Marquardt, all directions alike; knows no limits.
void inverse_kinematics_kdl_lma(benchmark::State& state) {
  const KdlMachine machine;
  KDL::ChainIkSolverPos_LMA solver(machine.chain(), Eigen::Matrix<double, 6, 1>::Ones());
  solve_poses(state, [&](const BucketPose& pose) { return machine.solve(solver, pose); });
}
BENCHMARK(inverse_kinematics_kdl_lma)
    ->Name("inverse_kinematics_kdl_lma/poses:4096")
    ->Unit(benchmark::kMicrosecond);

/// Newton and Raphson within the limits.
void inverse_kinematics_kdl_nr_jl(benchmark::State& state) {
  const KdlMachine machine;
  KDL::ChainFkSolverPos_recursive forward(machine.chain());
  KDL::ChainIkSolverVel_pinv velocity(machine.chain());
  KDL::ChainIkSolverPos_NR_JL solver(machine.chain(), machine.lower(), machine.upper(), forward,
                                     velocity);
  solve_poses(state, [&](const BucketPose& pose) { return machine.solve(solver, pose); });
}
BENCHMARK(inverse_kinematics_kdl_nr_jl)
    ->Name("inverse_kinematics_kdl_nr_jl/poses:4096")
    ->Unit(benchmark::kMicrosecond);

#endif

/// The paper's fixed path in about 200 poses; the argument: with cylinders and oil, or joints only.
void time_path(benchmark::State& state) {
  Machine machine = shipped_machine();
  if (state.range(0) == 0) {
    machine.cylinders.reset();
    machine.hydraulics.reset();
  }
  DigPathOptions options;
  options.step = 0.0175;
  const auto path = std::get<DigPath>(make_dig_path(
      machine, paper_fixed_path(), 6.0, [](double) { return 0.0; }, options));
  for (auto _ : state) benchmark::DoNotOptimize(time_dig_path(machine, path));
  state.counters["poses"] = static_cast<double>(path.poses.size());
}
BENCHMARK(time_path)->ArgName("oil")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace excavplan
