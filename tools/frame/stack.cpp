// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/stack.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>

namespace excavplan::tools {
namespace {

/// Whether so many bytes are left for this process.
bool can_have(std::size_t bytes) {
  void* const memory =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return memory != MAP_FAILED && ::munmap(memory, bytes) == 0;
}

/// From the top down, as a stack grows.
[[gnu::noinline]] void touch_stack() {
  std::array<volatile char, stack_reserve> bytes;
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  for (std::size_t left = bytes.size(); left >= page; left -= page) bytes[left - 1] = 0;
}

}  // namespace

bool hold_stack() {
  rlimit limit{};
  const bool is_small =
      ::getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < 2 * stack_reserve;
  if (is_small || !can_have(stack_reserve)) return false;
  touch_stack();
  return true;
}

}  // namespace excavplan::tools
