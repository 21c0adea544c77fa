// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/scans/scan_surface.hpp>

namespace excavplan {

/// Checksum of the files and clouds of a scan, by which a site knows it again: of their bytes,
/// whatever the frame they are said to be in. @throws Error (bad_file) if a file cannot be read
std::string scan_digest(const Scan& scan);

}  // namespace excavplan
