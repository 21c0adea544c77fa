// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/console.hpp"

#include <cmath>
#include <iostream>

#include "base/text.hpp"

namespace excavplan::tools {

void Console::progress(double done, const std::string& what) {
  if (quiet_ || !terminal_) return;
  const std::lock_guard lock(mutex_);
  std::cerr << "\r\033[K" << static_cast<int>(std::floor(100.0 * done)) << " %  " << what
            << std::flush;
  line_open_ = true;
}

void Console::note(const std::string& line) {
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  remove_line();
  std::cerr << safe_text(line, longest_line) << '\n';
}

void Console::clear() {
  const std::lock_guard lock(mutex_);
  remove_line();
}

void Console::remove_line() {
  if (line_open_) std::cerr << "\r\033[K" << std::flush;
  line_open_ = false;
}

}  // namespace excavplan::tools
