// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// @file
/// Whole files, read and written. Private to the project.

namespace excavplan {

/// Writes a file whole or not at all: beside it first, then renamed over it. A link, a pipe or a
/// device is written to.
/// @throws Error (bad_file) if that fails; the old file then remains
void write_file(const std::string& path, const std::string& content);

/// For a check before long work: leaves the file as it is.
/// @throws Error (bad_file) if write_file() would fail, a full disk apart
void require_writable(const std::string& path);

/// The whole content of a regular file. @throws Error (bad_file)
std::string read_file(const std::string& path);

/// Makes a folder and those above it. @throws Error (bad_file) unless it is there then
void make_folder(const std::string& path);

/// A name that is valid on every file system.
std::string file_name_part(const std::string& name);

}  // namespace excavplan
