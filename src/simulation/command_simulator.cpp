// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/simulation/foreign_simulators.hpp>

#include "base/check.hpp"
#include "base/child_process.hpp"
#include "base/text.hpp"
#include "simulation/dig_account.hpp"
#include "simulation/simulator_protocol.hpp"

namespace excavplan {
namespace {

constexpr int most_failures = 3;            // in a row; ours
constexpr std::size_t longest_shown = 400;  // of what a program wrote, in a message [byte]
constexpr std::size_t longest_note = 2000;  // of a line on standard error [byte]

/// One running program, and what it is prepared for.
struct Program {
  explicit Program(const std::vector<std::string>& words) : process(words) {}

  ChildProcess process;
  std::string prepared_for;
  std::uint64_t digs = 0;
};

/// The programs of one command: those that wait for a dig, and how often they failed.
class Programs {
 public:
  explicit Programs(SimulatorCommand command) : command_(std::move(command)) {
    require_in("the time limit of a simulator [s]", command_.timeout, 0.001, 1e6);
    about_ = "simulator command " + safe_text(command_.command, longest_shown) + ": ";
    try {
      words_ = words_of(command_.command);
      give_back(started());
    } catch (const ChildFailure& failure) {
      refuse(about_ + failure.what());
    } catch (const Error& error) {
      refuse(about_ + error.what());
    }
  }

  const ForeignSimulator& simulator() const { return simulator_; }

  /// Hands `work` a program that is prepared; one that fails in it is ended. Where one ends that
  /// has dug before, a fresh one is asked the same.
  template <typename Work>
  auto with_program(const std::string& prepare, const Work& work) {
    std::unique_ptr<Program> program = taken(prepare);
    try {
      if (program && program->digs > 0) {
        try {
          return done_by(program, prepare, work);
        } catch (const ChildEnded&) {
          pass_on(program->process.take_notes());
          program.reset();
        }
      }
      if (!program) program = started();
      return done_by(program, prepare, work);
    } catch (const ChildFailure& failure) {
      failed(std::move(program), failure.what());
    } catch (const Error& error) {
      failed(std::move(program), error.what());
    }
  }

  /// Asks, and passes on what the program writes besides.
  /// @throws ChildFailure
  std::string answer(Program& program, const std::string& request) const {
    const std::chrono::duration<double> limit(command_.timeout);
    std::string line = program.process.ask(request, limit, longest_answer);
    pass_on(program.process.take_notes());
    return line;
  }

 private:
  template <typename Work>
  auto done_by(std::unique_ptr<Program>& program, const std::string& prepare, const Work& work) {
    if (program->prepared_for != prepare) make_ready(*program, prepare);
    auto result = work(*program);
    give_back(std::move(program));
    return result;
  }

  std::unique_ptr<Program> started() {
    auto program = std::make_unique<Program>(words_);
    try {
      const auto hello = read_hello(answer(*program, hello_request()));
      if (const auto* refusal = std::get_if<ForeignRefusal>(&hello)) refuse(said(*refusal));
      const auto& simulator = std::get<ForeignSimulator>(hello);
      const std::lock_guard lock(mutex_);
      if (simulator_.name.empty()) simulator_ = simulator;
      if (simulator.name != simulator_.name ||
          simulator.mass_tolerance != simulator_.mass_tolerance) {
        refuse("it says that it is " + in_quotes(simulator.name) + ", and before " +
               in_quotes(simulator_.name));
      }
    } catch (const ChildFailure& failure) {
      throw ChildFailure(failure.what() + last_words(*program));
    }
    return program;
  }

  void make_ready(Program& program, const std::string& prepare) const {
    program.prepared_for.clear();
    const ForeignRefusal refusal = read_ready(answer(program, prepare));
    if (!refusal.message.empty()) refuse(said(refusal));
    program.prepared_for = prepare;
  }

  /// One that waits, prepared for this if there is such; null if none does.
  std::unique_ptr<Program> taken(const std::string& prepare) {
    const std::lock_guard lock(mutex_);
    if (failures_ >= most_failures) {
      refuse("it failed " + std::to_string(failures_) +
             " times in a row and is not started again; the last time: " + last_failure_);
    }
    if (waiting_.empty()) return nullptr;
    std::size_t at = waiting_.size() - 1;
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      if (waiting_[i]->prepared_for == prepare) at = i;
    }
    std::unique_ptr<Program> program = std::move(waiting_[at]);
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(at));
    return program;
  }

  void give_back(std::unique_ptr<Program> program) {
    const std::lock_guard lock(mutex_);
    failures_ = 0;
    waiting_.push_back(std::move(program));
  }

  [[noreturn]] void failed(std::unique_ptr<Program> program, const std::string& why) {
    const std::string text = program ? why + last_words(*program) : why;
    program.reset();
    const std::lock_guard lock(mutex_);
    ++failures_;
    last_failure_ = text;
    refuse(text);
  }

  std::string last_words(Program& program) const {
    const std::string notes = program.process.take_notes();
    pass_on(notes);
    if (notes.empty()) return {};
    const std::size_t end = notes.find_last_not_of("\r\n");
    const std::string whole = notes.substr(0, end == notes.npos ? 0 : end + 1);
    const std::size_t from = whole.size() > longest_shown ? whole.size() - longest_shown : 0;
    return "; on standard error it wrote last: " + safe_text(whole.substr(from), longest_shown);
  }

  void pass_on(const std::string& notes) const {
    if (!command_.on_note) return;
    for (std::size_t from = 0; from < notes.size();) {
      const std::size_t end = std::min(notes.find('\n', from), notes.size());
      command_.on_note(safe_text(notes.substr(from, end - from), longest_note));
      from = end + 1;
    }
  }

  static std::string said(const ForeignRefusal& refusal) {
    return "it says: " + safe_text(refusal.message, longest_shown);
  }

  const SimulatorCommand command_;
  std::string about_;
  std::vector<std::string> words_;
  std::mutex mutex_;  ///< of all below
  ForeignSimulator simulator_;
  std::vector<std::unique_ptr<Program>> waiting_;
  int failures_ = 0;
  std::string last_failure_;
};

/// Digs by a program.
class CommandSimulator : public SoilSimulator {
 public:
  CommandSimulator(std::shared_ptr<Programs> programs, const std::string& name,
                   const Machine& machine, const SoilKind& soil, double density_percent)
      : programs_(std::move(programs)),
        model_(machine, soil, density_percent),
        identity_(simulator_identity(name, machine, soil, density_percent)),
        prepare_(prepare_request(model_)) {}

  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options) const override {
    const ForeignDig dig(model_, terrain, path, options);
    const auto answer = programs_->with_program(prepare_, [&](Program& program) {
      const AnswerSize size = {++program.digs, dig.bank().z.rows(), dig.bank().z.cols()};
      return read_dug(programs_->answer(program, dig_request(dig, size.id)), size);
    });
    if (const auto* refusal = std::get_if<ForeignRefusal>(&answer)) {
      refuse("it says: " + safe_text(refusal->message, longest_shown));
    }
    return dig.result(std::get<ForeignAnswer>(answer), programs_->simulator().mass_tolerance);
  }

  std::string identity() const override { return identity_; }

 private:
  std::shared_ptr<Programs> programs_;
  ForeignModel model_;
  std::string identity_;
  std::string prepare_;
};

}  // namespace

SimulatorKind command_simulator(const SimulatorCommand& command) {
  const auto programs = std::make_shared<Programs>(command);
  const std::string name = programs->simulator().name + " (program)";
  return {name, name,
          [programs, name](const Machine& machine, const SoilKind& soil, double density_percent) {
            return std::make_unique<const CommandSimulator>(programs, name, machine, soil,
                                                            density_percent);
          }};
}

void end_simulator_programs() { ChildProcess::end_all(); }

}  // namespace excavplan
