// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/signals.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <system_error>

#include <excavplan/simulation/foreign_simulators.hpp>

#include "base/files.hpp"

namespace excavplan::tools {
namespace {

constexpr std::array<int, 3> ending = {SIGINT, SIGTERM, SIGHUP};
constexpr int patience = 1500;  // ours [ms]
// A handler can reach nothing else.
std::atomic<int> last_signal{0};
std::array<int, 2> waking = {-1, -1};  // a pipe: a byte for each signal, closed at the end

using Handler = void (*)(int);
std::array<Handler, ending.size()> before = {};
Handler pipe_before = SIG_DFL;

void on_signal(int signal) {
  const int reason = errno;
  last_signal = signal;
  while (::write(waking[1], "", 1) < 0 && errno == EINTR) {
  }
  errno = reason;
}

/// Waits so long [ms], -1: for ever. @return false if the program is at its end
bool wait_for_signal(int milliseconds) {
  pollfd pipe = {waking[0], POLLIN, 0};
  while (true) {
    const int ready = ::poll(&pipe, 1, milliseconds);
    if (ready == 0) return true;
    char byte = 0;
    const ssize_t got = ready < 0 ? -1 : ::read(waking[0], &byte, 1);
    if (got < 0 && errno == EINTR) continue;
    return got == 1;
  }
}

/// Those that are open for writing by the name that write_file() gives a file until it is whole. No
/// other can be opened meanwhile.
void remove_unfinished_files() {
  std::error_code error;
  std::filesystem::directory_iterator file("/proc/self/fd", error);
  const rlimit no_more = {0, 0};
  ::setrlimit(RLIMIT_NOFILE, &no_more);
  for (; !error && file != std::filesystem::directory_iterator(); file.increment(error)) {
    std::error_code closed;
    const std::string path = std::filesystem::read_symlink(file->path(), closed);
    const int descriptor = std::stoi(file->path().filename());
    const int flags = ::fcntl(descriptor, F_GETFL);
    const bool is_own = descriptor > STDERR_FILENO && flags >= 0;
    const bool is_written = is_own && (flags & O_ACCMODE) != O_RDONLY;
    if (!closed && is_written && is_unfinished(path)) ::unlink(path.c_str());
  }
}

[[noreturn]] void end_by(int signal) {
  end_simulator_programs();
  remove_unfinished_files();
  std::signal(signal, SIG_DFL);
  ::kill(::getpid(), signal);
  while (true) ::pause();
}

[[noreturn]] void end_without_memory() {
  try {
    end_simulator_programs();
    remove_unfinished_files();
  } catch (const std::bad_alloc&) {
    // They remain.
  }
  std::cerr << program_invocation_short_name << ": not enough memory\n";
  ::_exit(1);
}

std::terminate_handler terminate_before = nullptr;

/// Also without memory an end in order: some destructors allocate, as nlohmann's of JSON.
[[noreturn]] void on_terminate() {
  try {
    if (const auto exception = std::current_exception()) std::rethrow_exception(exception);
  } catch (const std::bad_alloc&) {
    end_without_memory();
  } catch (...) {
  }
  terminate_before();
  std::abort();
}

}  // namespace

Signals::Signals(bool can_stop) : can_stop_(can_stop) {
  std::signal(SIGXFSZ, SIG_IGN);
  terminate_before = std::set_terminate(on_terminate);
  pipe_before = std::signal(SIGPIPE, SIG_IGN);
  last_signal = 0;
  if (::pipe2(waking.data(), O_CLOEXEC) != 0) return;
  try {
    watcher_ = std::thread([this] { watch(); });
  } catch (const std::system_error&) {
    for (const int end : waking) ::close(end);
    return;  // without pipe or thread signals act as they do by default
  }
  for (std::size_t i = 0; i < ending.size(); ++i) {
    before[i] = std::signal(ending[i], on_signal);
    if (before[i] == SIG_IGN) std::signal(ending[i], SIG_IGN);
  }
}

Signals::~Signals() {
  std::set_terminate(terminate_before);
  end_at_closed_pipe();
  if (watcher_.joinable()) {
    for (std::size_t i = 0; i < ending.size(); ++i) std::signal(ending[i], before[i]);
    ::close(waking[1]);
    watcher_.join();
    ::close(waking[0]);
  }
}

bool Signals::stop_requested() const { return last_signal != 0; }

void Signals::end_at_closed_pipe() const { std::signal(SIGPIPE, pipe_before); }

void Signals::watch() const {
  if (!wait_for_signal(-1)) return;
  if (can_stop_ && !wait_for_signal(patience)) return;
  end_by(last_signal);
}

}  // namespace excavplan::tools
