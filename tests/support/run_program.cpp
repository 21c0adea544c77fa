// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/run_program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace excavplan::test {

std::string content_of(const std::string& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

int exit_code(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

pid_t started(const std::string& name, std::vector<std::string> arguments,
              const std::function<void()>& redirect) {
  std::string program = std::string(EXCAVPLAN_BIN) + "/" + name;
  std::vector<char*> words = {program.data()};
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    ::signal(SIGINT, SIG_DFL);  // which a shell ignores in what it runs in the background
    redirect();
    ::execv(program.c_str(), words.data());
    ::_exit(127);
  }
  return child;
}

ProgramResult run_program(const std::string& name, const std::vector<std::string>& arguments,
                          const std::string& input) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out");
  const std::string err = folder.file("err");
  const pid_t child = started(name, arguments, [&] {
    constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    ::dup2(::open(input.c_str(), O_RDONLY), STDIN_FILENO);
    ::dup2(::open(out.c_str(), flags, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), flags, 0600), STDERR_FILENO);
  });
  int status = 0;
  ::waitpid(child, &status, 0);
  return {exit_code(status), content_of(out), content_of(err)};
}

ProgramResult interrupted(const std::string& name, const std::vector<std::string>& words,
                          const std::string& sign) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0) {
    throw std::runtime_error("no terminal to be had");
  }
  const std::string other_end = ::ptsname(terminal);
  const pid_t child = started(name, words, [&] {
    ::dup2(::open("/dev/null", O_RDWR), STDOUT_FILENO);
    ::dup2(::open(other_end.c_str(), O_WRONLY | O_NOCTTY), STDERR_FILENO);
  });
  ProgramResult result;
  bool sent = false;
  std::array<char, 1024> buffer{};
  for (ssize_t got; (got = ::read(terminal, buffer.data(), buffer.size())) > 0;) {
    result.err.append(buffer.data(), static_cast<std::size_t>(got));
    if (!sent && result.err.find(sign) != std::string::npos) sent = ::kill(child, SIGINT) == 0;
  }
  ::close(terminal);
  int status = 0;
  ::waitpid(child, &status, 0);
  result.code = exit_code(status);
  return result;
}

}  // namespace excavplan::test
