// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "drawing/drawing.hpp"

/// @file
/// Drawings as image files.

namespace excavplan {

/// ".svg", ".png", ".pdf"
const std::vector<std::string>& image_endings();

/// For a check before long work.
/// @throws Error (bad_input) if a file of this name is PNG or PDF and the system has no font or the
/// library was built without cairo
void require_fonts(const std::string& file);

/// The content of the file of a name with one of image_endings(), in letters of either size. PNG
/// has 300 dots per inch, PDF no date. Equal drawings give equal bytes, for PNG and PDF on one
/// system with its fonts.
/// @throws Error (bad_input) as require_fonts(), or if the image has more than 32767 dots a side
std::string image_of(const Drawing& drawing, const std::string& file);

}  // namespace excavplan
