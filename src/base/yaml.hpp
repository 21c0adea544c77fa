// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

/// @file The part of YAML in which robots' tools write messages and calibrations. Private to the
/// project.

namespace excavplan {

/// Reads one document of maps, lists and scalars, in block or flow form (YAML 1.2.2, chapters 7 and
/// 8). Comments, %-directives and tags are skipped. Anchors, aliases, scalars of several lines and
/// more than 64 levels are refused, and so is a second document.
/// @throws Error (bad_file) naming `name`, the line, what was found and what was expected
nlohmann::json parse_yaml(const std::string& name, const std::string& text);

}  // namespace excavplan
