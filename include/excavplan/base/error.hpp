// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace excavplan {

/// What the caller did wrong.
enum class ErrorKind {
  bad_input,  ///< an argument or an option breaks its documented rule
  bad_file,   ///< a file is missing, unreadable or of the wrong format or content
};

/// The only exception that this library throws on purpose.
///
/// It reports what the caller could have prevented; the text names what is wrong, where, its value
/// and the rule. What depends on the site or the machine, such as a pose out of reach or a density
/// out of range, is a value in the result.
///
/// The text is one line that can be shown on a terminal, whatever a file or a name held: control
/// characters, those that turn the direction of text and what is not UTF-8 are replaced by `?`.
class Error : public std::runtime_error {
 public:
  static constexpr std::size_t longest_message = 1000;  ///< of what() [byte]; ours

  /// An error of this kind with the text of what(), of which a longer one loses its middle.
  Error(ErrorKind kind, const std::string& message);
  /// What the caller did wrong.
  ErrorKind kind() const noexcept { return kind_; }

 private:
  ErrorKind kind_;
};

}  // namespace excavplan
