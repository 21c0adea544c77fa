// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/ground_state.hpp>
#include <excavplan/site/site_event.hpp>
#include <excavplan/site/site_settings.hpp>

namespace excavplan {

/// Compacts the loose soil under the tracks of a machine that stood there, as compact() does, in
/// cells that were not seen at this time: where they were, the surface is known. Nothing of a
/// machine whose body is not known.
void compact_under_tracks(const SiteSettings& settings, const BasePose& base, double time,
                          GroundState& ground);

}  // namespace excavplan
