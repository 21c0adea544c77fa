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
#include <stdexcept>
#include <thread>
#include <utility>

#include <pybind11/pybind11.h>

#include <excavplan/base/error.hpp>

/// @file
/// Calls of the library that take long or call Python back.

namespace excavplan::python {

namespace py = pybind11;

/// Whether it is excavplan.Error.
bool is_error(const py::error_already_set& error);
/// What such an exception says, in C++.
Error error_of(const py::error_already_set& error);

// ---- an interpreter that ends -------------------------------------------------------------------
//
// Up to Python 3.13 it ends threads that ask for its lock, also amid Python code, by unwinding
// their stack (pthread_exit), which frames of C++ and destructors cannot bear. Here such a thread
// stops at the first frame of C++ instead and waits for the end of the process.

/// Whether the interpreter is ending.
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

/// What `ask` gives, which may ask for the lock; it holds no object whose destructor needs the
/// lock.
template <typename Ask>
auto or_stay(const Ask& ask) -> decltype(ask()) {
  try {
    return ask();
  } catch (...) {
    stay_if_ending();
    throw;
  }
}

/// Whether this thread has the lock of the interpreter.
inline bool has_lock() {
  const PyThreadState* const own = PyGILState_GetThisThreadState();
  return own != nullptr && own == py::detail::get_thread_state_unchecked();
}

/// With the lock of the interpreter, in any thread, for as long as it lives.
class Locked {
 public:
  Locked() {
    if (!has_lock()) stay_if_ending();
    or_stay([this] { lock_.emplace(); });
  }

 private:
  std::optional<py::gil_scoped_acquire> lock_;
};

/// Without it.
class Unlocked {
 public:
  Unlocked() : state_(PyEval_SaveThread()) {}
  ~Unlocked() {
    or_stay([this] { PyEval_RestoreThread(state_); });
  }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* state_;
};

/// What a function of Python returns. @throws py::error_already_set
template <typename... Arguments>
py::object called(const py::object& function, const Arguments&... arguments) {
  const py::tuple given = py::make_tuple(arguments...);
  PyObject* const result =
      or_stay([&] { return PyObject_CallObject(function.ptr(), given.ptr()); });
  if (result == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(result);
}

// ---- calls of the library -----------------------------------------------------------------------

/// Whether this thread answers signals.
inline bool is_main_thread() {
  const py::module_ threading = py::module_::import("threading");
  return called(threading.attr("current_thread")).is(called(threading.attr("main_thread")));
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
  /// @throws std::runtime_error (RuntimeError) while the interpreter is ending
  template <typename Work>
  auto run(const Work& work) -> decltype(work()) {
    if (is_ending()) throw std::runtime_error("excavplan cannot be called while Python is ending");
    std::optional<decltype(work())> result;
    std::exception_ptr thrown;
    const auto between_signals = std::chrono::milliseconds(50);
    const bool answers_signals = is_main_thread();
    {
      const Unlocked unlocked;
      auto answer = std::async(std::launch::async, [&] {
        try {
          result.emplace(work());
        } catch (...) {
          thrown = std::current_exception();
        }
      });
      while (answers_signals && answer.wait_for(between_signals) != std::future_status::ready) {
        const Locked locked;
        if (PyErr_CheckSignals() != 0) fail(std::make_exception_ptr(py::error_already_set()));
      }
      answer.wait();
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
            const Locked locked;
            delete last;
          }};
}

/// Tells a callback, if there is one, of the state of a call. @return false: it shall stop
template <typename State>
bool goes_on(Call& call, const py::object& callback, const State& state) {
  if (is_ending()) return false;
  const Locked locked;
  if (callback.is_none()) return true;
  try {
    const py::object answer = called(callback, state);
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
