// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulators.hpp"

#include <stdexcept>
#include <utility>

namespace excavplan::python {
namespace {

/// What Python raised in a call: an Error is passed to the library, all else ends the call.
template <typename Ask>
auto asked(Call& call, const Ask& ask) -> decltype(ask()) {
  try {
    return ask();
  } catch (const py::error_already_set& error) {
    const Locked locked;
    if (is_error(error)) throw error_of(error);
    call.fail(std::current_exception());
    throw std::runtime_error("its code in Python raised an exception");
  } catch (const py::builtin_exception&) {
    call.fail(std::current_exception());
    throw;
  }
}

}  // namespace

void refuse_missing_dig() {
  throw py::type_error(
      "a SoilSimulator must define dig(self, terrain, path, options); SoilSimulator itself has no "
      "digs");
}

DigResult SimulatorInPython::dig(const Terrain& terrain, const DigPath& path,
                                 const DigOptions& options) const {
  const Locked locked;
  const py::function own = py::get_override(static_cast<const SoilSimulator*>(this), "dig");
  if (!own) refuse_missing_dig();
  const py::object result = called(own, terrain, path, options);
  if (!py::isinstance<DigResult>(result)) {
    throw py::type_error("SoilSimulator.dig() must return a DigResult, not " +
                         std::string(Py_TYPE(result.ptr())->tp_name));
  }
  return result.cast<DigResult>();
}

std::string SimulatorInPython::identity() const {
  const Locked locked;
  const py::function own = py::get_override(static_cast<const SoilSimulator*>(this), "identity");
  return own ? std::string(py::str(called(own))) : std::string();
}

SimulatorInCall::SimulatorInCall(py::object simulator, std::shared_ptr<Call> call)
    : object_(std::move(simulator)), simulator_(nullptr), call_(std::move(call)) {
  if (!py::isinstance<SoilSimulator>(object_)) {
    throw py::type_error("a simulator must be a SoilSimulator, not " +
                         std::string(Py_TYPE(object_.ptr())->tp_name));
  }
  simulator_ = object_.cast<const SoilSimulator*>();
}

SimulatorInCall::~SimulatorInCall() {
  const Locked locked;
  object_ = py::object();
}

DigResult SimulatorInCall::dig(const Terrain& terrain, const DigPath& path,
                               const DigOptions& options) const {
  return asked(*call_, [&] { return simulator_->dig(terrain, path, options); });
}

std::string SimulatorInCall::identity() const {
  return asked(*call_, [&] { return simulator_->identity(); });
}

SimulatorKind simulator_kind(const py::object& simulator, const std::shared_ptr<Call>& call) {
  if (simulator.is_none()) return default_simulator();
  if (py::isinstance<py::str>(simulator)) return simulator_of_word(simulator.cast<std::string>());
  if (PyCallable_Check(simulator.ptr()) == 0 || py::isinstance<SoilSimulator>(simulator)) {
    throw py::type_error(
        "simulator: expected a word such as 'height-map' or a class that is called with machine, "
        "soil and density_percent");
  }
  const std::string name =
      py::str(py::getattr(simulator, "name", py::getattr(simulator, "__name__", py::str("own"))));
  const auto make = [call, maker = shared(simulator)](
                        const Machine& machine, const SoilKind& soil,
                        double density) -> std::unique_ptr<const SoilSimulator> {
    const Locked locked;
    return asked(*call, [&] {
      return std::make_unique<SimulatorInCall>(called(*maker, machine, soil, density), call);
    });
  };
  return {name, name, make};
}

bool is_in_python(const SoilSimulator& simulator) {
  return dynamic_cast<const SimulatorInPython*>(&simulator) != nullptr;
}

unsigned threads_with(const py::object& simulator, unsigned threads) {
  return simulator.is_none() || py::isinstance<py::str>(simulator) ? threads : 1;
}

}  // namespace excavplan::python
