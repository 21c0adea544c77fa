// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace excavplan::tools {

/// Of a thread: twice what any tool was measured to need [byte].
constexpr std::size_t stack_reserve = std::size_t{512} * 1024;

/// Takes the reserve for the main thread, whose stack else grows while the tool works: where memory
/// is limited and used up by then, that ends the program by a signal.
/// @return false if it cannot be had, or stacks are limited to less than twice as much
[[nodiscard]] bool hold_stack();

}  // namespace excavplan::tools
