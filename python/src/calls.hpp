// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <pybind11/pybind11.h>

#include <excavplan/error.hpp>

/// @file
/// Calls of the library that take long or call Python back.

namespace excavplan::python {

namespace py = pybind11;

/// Whether it is excavplan.Error.
bool is_error(const py::error_already_set& error);
/// What such an exception says, in C++.
Error error_of(const py::error_already_set& error);

/// Whether the interpreter is ending: it kills threads that ask for its lock then, through frames
/// of C++ that cannot bear it.
inline bool is_ending() {
#if PY_VERSION_HEX >= 0x030D0000
  return Py_IsFinalizing() != 0;
#else
  return _Py_IsFinalizing() != 0;
#endif
}

/// Waits for the end of the process, if that has come.
inline void stay_if_ending() {
  while (is_ending()) std::this_thread::sleep_for(std::chrono::hours(1));
}

/// Whether this thread answers signals.
inline bool is_main_thread() {
  const py::module_ threading = py::module_::import("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

/// One call of the library. It runs on a thread of its own without the lock of the interpreter,
/// while the caller answers signals: Ctrl-C cancels what can be cancelled, and is raised at its
/// end.
class Call {
 public:
  /// Remembers what Python raised inside of the call, the first time; run() raises it again.
  void fail(std::exception_ptr raised) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!raised_) raised_ = std::move(raised);
    failed_ = true;
  }
  /// What progress callbacks ask: the result is not wanted any more.
  bool failed() const { return failed_; }

  /// What `work` gives, called without the lock of the interpreter.
  template <typename Work>
  auto run(const Work& work) -> decltype(work()) {
    std::optional<decltype(work())> result;
    std::exception_ptr thrown;
    const auto between_signals = std::chrono::milliseconds(50);
    const bool answers_signals = is_main_thread();
    {
      const py::gil_scoped_release release;
      auto answer = std::async(std::launch::async, [&] {
        try {
          result.emplace(work());
        } catch (...) {
          thrown = std::current_exception();
        }
      });
      while (answers_signals && answer.wait_for(between_signals) != std::future_status::ready) {
        const py::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() != 0) fail(std::make_exception_ptr(py::error_already_set()));
      }
      answer.wait();
      stay_if_ending();
    }
    if (raised_) std::rethrow_exception(raised_);
    if (thrown) std::rethrow_exception(thrown);
    return std::move(*result);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr raised_;
  std::atomic<bool> failed_{false};
};

/// An object that any thread may drop, with or without the lock of the interpreter.
inline std::shared_ptr<const py::object> shared(py::object object) {
  return {new py::object(std::move(object)), [](const py::object* last) {
            const py::gil_scoped_acquire acquire;
            delete last;
          }};
}

/// Tells a callback, if there is one, of the state of a call. @return false: it shall stop
template <typename State>
bool goes_on(Call& call, const py::object& callback, const State& state) {
  if (is_ending()) return false;
  const py::gil_scoped_acquire acquire;
  if (callback.is_none()) return true;
  try {
    const py::object answer = callback(py::cast(state));
    return answer.is_none() || py::bool_(answer);
  } catch (const py::error_already_set&) {
    call.fail(std::current_exception());
    return false;
  }
}

/// As Call::run() of what calls nothing back.
template <typename Work>
auto call(const Work& work) -> decltype(work()) {
  return Call().run(work);
}

}  // namespace excavplan::python
