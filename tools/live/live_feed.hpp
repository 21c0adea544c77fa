// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace excavplan::tools {

/// What a page server shows: a page, the steps that are added to it, and a state that replaces the
/// one before. One thread uses it.
class LiveFeed {
 public:
  virtual ~LiveFeed() = default;

  /// Looks for what is new, at little cost where nothing is. Never throws Error.
  virtual void refresh() = 0;
  /// HTML. @param stream  address of the events that it follows, beside which it states how many
  /// steps it has
  virtual std::string page(const std::string& stream) = 0;
  /// Rises where a page cannot be brought up to date by steps, but must be loaded anew.
  virtual int edition() const = 0;
  virtual std::size_t steps() const = 0;
  virtual const std::string& step(std::size_t i) const = 0;  ///< in one line
  virtual int state_version() const = 0;                     ///< rises with each state
  virtual const std::string& state() const = 0;              ///< in one line
};

}  // namespace excavplan::tools
