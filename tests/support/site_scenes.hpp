// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "support/site_ground.hpp"
#include "support/site_sensing.hpp"

/// @file
/// All families of scenes of what a site brings.

namespace excavplan::scenes {

/// A family of scenes, how one of them is made, and what an estimate may say of it.
struct Family {
  std::string name;
  void (*shape)(Draft&);
  /// Warnings that are a right reason to end trust; "refused": an error is.
  std::vector<std::string> reasons = {};
  /// What a reading may be of that holds the truth.
  std::vector<ChangeKind> causes = {};
};

const std::vector<Family>& families();

/// A scene of the family: another for every seed, and for equal seeds another in every family.
/// @param points in a cloud, where the family leaves them open
SiteScene site_scene(const Family& family, std::uint64_t seed, std::size_t points);

}  // namespace excavplan::scenes
