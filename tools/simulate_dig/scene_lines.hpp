// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/sensing/scene.hpp>

namespace excavplan::tools {

/// A simulated dig for people. @param scene  with the history of its dig
std::vector<std::string> scene_lines(const Machine& machine, const DigScene& scene);

}  // namespace excavplan::tools
