// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <excavplan/scans/scan_surface.hpp>

namespace excavplan::python {

/// What an argument means: a Scan, or what one is made from: a file, a Cloud or points.
/// @param name  for messages, of what has no file
Scan scan_of(const pybind11::object& source, const char* name);

}  // namespace excavplan::python
