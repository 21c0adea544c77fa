// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>

#include "base/text.hpp"

namespace excavplan {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int patience = 500;              // for a program to end by itself [ms]; ours
constexpr std::size_t most_notes = 65536;  // kept of standard error [byte]; ours
constexpr int pipe_size = 1 << 20;         // asked for, so that a request fits [byte]; ours

std::string reason(int error) { return std::generic_category().message(error); }

/// Process groups that run, for end_all().
struct Running {
  std::mutex mutex;
  std::set<pid_t> groups;
  bool closed = false;
};
Running& running() {
  static auto* const all = new Running;  // outlives what is destroyed at the end
  return *all;
}

/// A write into a pipe whose reader has gone is an error here, not the end of this program.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    ::sigemptyset(&pipe_);
    ::sigaddset(&pipe_, SIGPIPE);
    sigset_t waiting;
    ::sigpending(&waiting);
    was_pending_ = ::sigismember(&waiting, SIGPIPE) == 1;
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoPipeSignal() {
    const timespec now = {0, 0};
    if (!was_pending_) {
      while (::sigtimedwait(&pipe_, nullptr, &now) < 0 && errno == EINTR) {
      }
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;

 private:
  sigset_t pipe_{};
  sigset_t before_{};
  bool was_pending_ = false;
};

/// Both ends of a pipe, closed at the end.
struct Pipe {
  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw ChildFailure("it cannot be started: " + reason(errno));
    }
  }
  ~Pipe() {
    for (const int end : ends) {
      if (end >= 0) ::close(end);
    }
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int take(std::size_t end) { return std::exchange(ends[end], -1); }

  std::array<int, 2> ends = {-1, -1};
};

/// In the new process, where only what is safe in a signal handler may be called.
[[noreturn]] void become(char* const* words, const std::array<int, 3>& streams, int failure) {
  ::setpgid(0, 0);
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  // First above the standard streams, so that none is overwritten before it is copied.
  std::array<int, 3> high = {};
  for (std::size_t i = 0; i < streams.size(); ++i) high[i] = ::fcntl(streams[i], F_DUPFD, 3);
  for (int i = 0; i < 3; ++i) ::dup2(high[static_cast<std::size_t>(i)], i);
#ifdef SYS_close_range
  constexpr unsigned on_exec = 4;  // CLOSE_RANGE_CLOEXEC, which older headers lack
  ::syscall(SYS_close_range, 3U, ~0U, on_exec);
#endif
  for (const int copy : high) ::fcntl(copy, F_SETFD, FD_CLOEXEC);
  ::execvp(words[0], words);
  const int error = errno;
  const ssize_t said = ::write(failure, &error, sizeof error);
  ::_exit(said == sizeof error ? 127 : 126);
}

}  // namespace

std::vector<std::string> words_of(const std::string& command) {
  std::vector<std::string> words;
  bool in_word = false;
  char quote = 0;
  for (const char c : command) {
    const bool ends_quote = quote != 0 && c == quote;
    const bool begins_quote = quote == 0 && (c == '"' || c == '\'');
    const bool parts = quote == 0 && (c == ' ' || c == '\t');
    if (!parts && !in_word) words.emplace_back();
    in_word = !parts;
    if (ends_quote || begins_quote) {
      quote = begins_quote ? c : '\0';
    } else if (!parts) {
      words.back() += c;
    }
  }
  if (quote != 0) throw ChildFailure(std::string("a quotation lacks its end, ") + quote);
  if (words.empty() || words.front().empty()) throw ChildFailure("it names no program");
  return words;
}

ChildProcess::ChildProcess(const std::vector<std::string>& words) {
  try {
    start(words);
  } catch (...) {
    end();
    throw;
  }
}

ChildProcess::~ChildProcess() { end(); }

void ChildProcess::start(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  Pipe to;
  Pipe from;
  Pipe errors;
  Pipe failure;
  {
    Running& all = running();
    const std::lock_guard lock(all.mutex);
    if (all.closed) throw ChildFailure("it cannot be started: this program is about to end");
    pid_ = ::fork();
    if (pid_ < 0) throw ChildFailure("it cannot be started: " + reason(errno));
    if (pid_ == 0) {
      become(arguments.data(), {to.ends[0], from.ends[1], errors.ends[1]}, failure.ends[1]);
    }
    ::setpgid(pid_, pid_);  // also here: whichever is first
    all.groups.insert(pid_);
  }
  pipes_ = {to.take(1), from.take(0), errors.take(0)};
  for (const int end : pipes_) ::fcntl(end, F_SETFL, O_NONBLOCK);
#ifdef F_SETPIPE_SZ
  for (const int end : {pipes_[input], pipes_[output]}) ::fcntl(end, F_SETPIPE_SZ, pipe_size);
#endif
  ::close(failure.take(1));
  int error = 0;
  ssize_t got = 0;
  while ((got = ::read(failure.ends[0], &error, sizeof error)) < 0 && errno == EINTR) {
  }
  if (got == sizeof error) {
    throw ChildFailure("the program " + in_quotes(words.front()) +
                       " cannot be started: " + reason(error));
  }
}

void ChildProcess::write_some(const std::string& line, std::size_t& written) {
  const NoPipeSignal guard;
  const ssize_t sent = ::write(pipes_[input], line.data() + written, line.size() - written);
  if (sent >= 0) {
    written += static_cast<std::size_t>(sent);
  } else if (errno != EAGAIN && errno != EINTR) {  // it reads no more; it may have answered
    ::close(std::exchange(pipes_[input], -1));
    written = line.size();
  }
}

bool ChildProcess::read_some(Stream stream, std::string& to) {
  std::array<char, 65536> buffer;
  const ssize_t got = ::read(pipes_[stream], buffer.data(), buffer.size());
  if (got < 0) return errno == EAGAIN || errno == EINTR;
  to.append(buffer.data(), static_cast<std::size_t>(got));
  if (stream == notes && to.size() > most_notes) to.erase(0, to.size() - most_notes);
  return got > 0;
}

/// Until there is something to do; reads the notes. @return false if the time is up
bool ChildProcess::wait(bool writes, Clock::time_point until) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    if (left <= 0) return false;
    std::array<pollfd, 3> streams = {{{writes ? pipes_[input] : -1, POLLOUT, 0},
                                      {pipes_[output], POLLIN, 0},
                                      {pipes_[notes], POLLIN, 0}}};
    constexpr long longest_wait = 3600000;
    const int ready = ::poll(streams.data(), streams.size(),
                             static_cast<int>(std::min<long>(left, longest_wait)));
    if (ready <= 0) continue;
    if (streams[notes].revents != 0 && !read_some(notes, notes_)) {
      ::close(std::exchange(pipes_[notes], -1));
    }
    if (streams[input].revents != 0 || streams[output].revents != 0) return true;
  }
}

std::string ChildProcess::ask(const std::string& line, std::chrono::duration<double> limit,
                              std::size_t longest) {
  const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(limit);
  const std::string request = line + '\n';
  if (pipes_[input] < 0 || !read_some(output, read_)) throw ChildEnded(how_it_ended());
  if (!read_.empty()) {
    throw ChildFailure("it wrote to its standard output without being asked: " + in_quotes(read_));
  }
  std::size_t written = 0;
  std::size_t looked_at = 0;
  while (true) {
    if (!wait(written < request.size(), until)) {
      throw ChildFailure("it gave no answer within " + number_text(limit.count()) + " s");
    }
    const bool open = read_some(output, read_);
    const std::size_t end = read_.find('\n', looked_at);
    looked_at = read_.size();
    if (std::min(end, read_.size()) > longest) {
      throw ChildFailure("its answer has more than " + std::to_string(longest) + " bytes");
    }
    if (end != read_.npos) {
      if (written < request.size()) throw ChildFailure("it answered before it had the question");
      std::string answer = read_.substr(0, end);
      read_.erase(0, end + 1);
      if (!answer.empty() && answer.back() == '\r') answer.pop_back();
      return answer;
    }
    if (!open) throw ChildEnded(how_it_ended());
    if (written < request.size()) write_some(request, written);
  }
}

std::string ChildProcess::take_notes() {
  while (pipes_[notes] >= 0) {
    const std::size_t had = notes_.size();
    if (!read_some(notes, notes_) || notes_.size() == had) break;
    if (notes_.size() >= most_notes) break;
  }
  return std::exchange(notes_, {});
}

/// Without taking its exit status: its number, and that of its group, remain its own.
bool ChildProcess::ended_within(int milliseconds) const {
  for (int waited = 0;; waited += 2) {
    siginfo_t info{};
    const int asked = ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT | WNOHANG);
    if (asked != 0 ? errno != EINTR : info.si_pid == pid_) return true;
    if (waited >= milliseconds) return false;
    ::poll(nullptr, 0, 2);
  }
}

std::string ChildProcess::how_it_ended() {
  if (!ended_within(patience)) return "it closed its standard input or output";
  siginfo_t info{};
  ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT | WNOHANG);
  if (info.si_code == CLD_EXITED)
    return "it ended, with exit code " + std::to_string(info.si_status);
  return "it was ended by signal " + std::to_string(info.si_status);
}

void ChildProcess::end() {
  for (int& end : pipes_) {
    if (end >= 0 && &end != &pipes_[notes]) ::close(std::exchange(end, -1));
  }
  if (pid_ > 0) {
    ended_within(patience);
    Running& all = running();
    const std::lock_guard lock(all.mutex);
    ::kill(-pid_, SIGKILL);
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
    all.groups.erase(pid_);
    pid_ = -1;
  }
  if (pipes_[notes] >= 0) ::close(std::exchange(pipes_[notes], -1));
}

void ChildProcess::end_all() {
  Running& all = running();
  const std::lock_guard lock(all.mutex);
  all.closed = true;
  for (const pid_t group : all.groups) ::kill(-group, SIGKILL);
}

}  // namespace excavplan
