// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

/// @file
/// Whole files, read and written. Private to the project.

namespace excavplan {

// The largest files that are read whole, by what they hold [byte]; ours.
constexpr std::uint64_t most_settings_bytes = std::uint64_t{1} << 26;  ///< JSON of ours
constexpr std::uint64_t most_foreign_bytes = std::uint64_t{1} << 20;   ///< JSON, YAML of others
constexpr std::uint64_t most_table_bytes = std::uint64_t{1} << 28;     ///< logs and samples
constexpr std::uint64_t most_image_bytes = std::uint64_t{1} << 26;
constexpr std::uint64_t most_journal_bytes = std::uint64_t{1} << 30;  ///< digs of a search

/// The whole content of a regular file of at most so many bytes.
/// @throws Error (bad_file) if it is larger, changes its size or cannot be read to its end
std::string read_file(const std::string& path, std::uint64_t most_bytes = most_settings_bytes);

/// Writes a file whole or not at all: beside it first, to the disk, then renamed over it. A file
/// that a link leads to is replaced where it lies, its mode stays; a pipe or a device is written
/// to, and so is an open_descriptor() from where it stands.
/// @throws Error (bad_file) with the reason if that fails; the old file then remains and no other,
/// unless the error says that it was replaced: the disk failed when all was written
void write_file(const std::string& path, const std::string& content);
/// Hands on a content too large to hold, part by part.
using ContentSource = std::function<void(const std::function<void(std::string_view)>& append)>;
/// The same; what the source throws leaves the old file.
void write_file(const std::string& path, const ContentSource& content);
/// The same for what is written again and again or can be computed again: it is not flushed, so a
/// loss of power, unlike a kill, may cost it.
void write_journal(const std::string& path, const std::string& content);

/// Of a folder whose files are ours alone: as write_file(), but what lies at the path is replaced
/// whatever it is, and no link is followed.
void write_own_file(const std::string& path, const std::string& content);
/// Of such a file that grows: writes from a byte of it on, and ends it behind the text. A kill may
/// leave a part of the text.
void write_own_tail(const std::string& path, std::uint64_t from, std::string_view text);
/// As read_file(), but a link is refused.
std::string read_own_file(const std::string& path, std::uint64_t most_bytes = most_settings_bytes);

/// The file that this process has open and a path leads to, as /dev/stdout and /dev/fd/3 do.
/// @throws Error (bad_file) if the links of the path cannot be followed
std::optional<int> open_descriptor(const std::string& path);

/// A name beside a path for its content until that is whole: NAME.part-HOST-THREAD-LETTERS, with
/// eight random letters, as machines of one name may share a folder. Cut where it would be too long
/// for a file system.
std::string unfinished_name(const std::string& path);
/// Whether a path has the form of these names. Allocates nothing.
bool is_unfinished(std::string_view path) noexcept;

/// For a check before long work: leaves the file as it is.
/// @throws Error (bad_file) if write_file() would fail, a full disk apart
void require_writable(const std::string& path);

/// Makes a folder and those above it. @throws Error (bad_file) unless it is there then
void make_folder(const std::string& path);

/// A name that is valid on every file system.
std::string file_name_part(const std::string& name);

}  // namespace excavplan
