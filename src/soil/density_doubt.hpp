// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/base/warning.hpp>

#include "base/text.hpp"

namespace excavplan {

/// density_as_fraction of a relative density that is told as 0.4 where 40 % are meant.
inline std::optional<Warning> doubt_of_density(double percent) {
  if (!(percent > 0.0 && percent < 1.0)) return std::nullopt;
  return Warning{WarningCode::density_as_fraction, "the density is " + number_text(percent) +
                                                       " %: if that is a fraction, it is " +
                                                       number_text(100.0 * percent) + " %"};
}

}  // namespace excavplan
