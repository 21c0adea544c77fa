// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "support/tool_answers.hpp"

/// @file
/// Whether a figure is well formed and shows what it says.

namespace excavplan::test {

/// What is wrong with the tags of an XML text, empty if nothing: enough to catch a figure that no
/// browser would draw.
std::string xml_fault(const std::string& text);

void expect_figure(const std::string& file, const Words& texts);

}  // namespace excavplan::test
