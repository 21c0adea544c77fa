// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace excavplan {

/// What a result is doubted for: a code for each row of warning_codes.def, whose name is its
/// code_text().
enum class WarningCode {
#define EXCAVPLAN_WARNING(code, trust) code,
#include <excavplan/base/warning_codes.def>
};

}  // namespace excavplan
