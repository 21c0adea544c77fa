// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <pybind11/pybind11.h>

#include <excavplan/simulation/simulators.hpp>

#include "calls.hpp"

/// @file
/// Simulators written in Python, as the library takes them.

namespace excavplan::python {

/// A subclass of SoilSimulator in Python.
class SimulatorInPython : public SoilSimulator {
 public:
  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options) const override;
  std::string identity() const override;
};

/// A simulator as one call of the library uses it: what its Python code raises ends the call, but
/// for excavplan.Error, which is the failure of one dig as in C++.
class SimulatorInCall : public SoilSimulator {
 public:
  /// @throws TypeError unless the object is a SoilSimulator
  SimulatorInCall(py::object simulator, std::shared_ptr<Call> call);
  ~SimulatorInCall() override;
  SimulatorInCall(const SimulatorInCall&) = delete;
  SimulatorInCall& operator=(const SimulatorInCall&) = delete;

  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options) const override;
  std::string identity() const override;

 private:
  py::object object_;
  const SoilSimulator* simulator_;
  std::shared_ptr<Call> call_;
};

/// The kind that an argument means: None, a word, or a class in Python that is called with machine,
/// soil and density.
SimulatorKind simulator_kind(const py::object& simulator, const std::shared_ptr<Call>& call);
/// Whether it is of a class in Python.
bool is_in_python(const SoilSimulator& simulator);
/// @throws TypeError that tells to define dig()
[[noreturn]] void refuse_missing_dig();
/// The threads of a call with such a simulator: one where it is in Python, as its digs would wait
/// for each other and an object with a state of its own would be dug with by several at once.
unsigned threads_with(const py::object& simulator, unsigned threads);

}  // namespace excavplan::python
