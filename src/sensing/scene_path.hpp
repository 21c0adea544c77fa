// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/sensing/scene.hpp>

/// @file The path of a scene. Private to the project.

namespace excavplan {

/// @throws Error (bad_input) if it cannot be driven, or the heap would reach the dig
DigPath scene_path(const Machine& machine, const SoilKind& soil, const Terrain& ground,
                   const SceneOptions& options);

}  // namespace excavplan
