// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "shared/drawing.hpp"

/// @file
/// Drawings as image files.

namespace excavplan::tools {

/// ".svg", ".png", ".pdf"
const std::vector<std::string>& image_endings();

/// The content of the file of a name with one of image_endings(), in letters of either size. PNG
/// has 300 dots per inch, PDF no date. Equal drawings give equal bytes, for PNG and PDF on one
/// system with its fonts.
/// @throws Error (bad_input) if PNG or PDF is asked for and the system has no font
std::string image_of(const Drawing& drawing, const std::string& file);

}  // namespace excavplan::tools
