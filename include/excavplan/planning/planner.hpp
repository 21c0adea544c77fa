// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/dig_search.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/simulation/dig_ground.hpp>

/// @file
/// All that plans a dig on given ground.
