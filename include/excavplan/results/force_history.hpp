// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/sensing/scene.hpp>

namespace excavplan {

/// The loads of a simulated dig as CSV, a row per step; columns: docs/formats.md#force-history.
/// @param scene  with the history of its dig
std::string force_history_csv(const Machine& machine, const DigScene& scene);

}  // namespace excavplan
