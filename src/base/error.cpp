// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/error.hpp>

#include "base/text.hpp"

namespace excavplan {

Error::Error(ErrorKind kind, const std::string& message)
    : std::runtime_error(safe_text(message, longest_message)), kind_(kind) {}

}  // namespace excavplan
