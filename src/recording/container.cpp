// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/container.hpp"

namespace excavplan {

std::string ros2_type(std::string_view type) {
  std::string out(type);
  const std::size_t slash = out.find('/');
  if (slash != out.npos && out.find('/', slash + 1) == out.npos) out.insert(slash, "/msg");
  return out;
}

}  // namespace excavplan
