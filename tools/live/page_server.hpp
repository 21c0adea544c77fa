// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "live/live_feed.hpp"

/// @file
/// A page in a browser that is kept up to date, over HTTP (docs/guide/job.md#live).

namespace excavplan::tools {

struct ServeAddress {
  std::string host = "127.0.0.1";  ///< of IPv4 or IPv6
  std::uint16_t port = 0;          ///< 0: any that is free
};
/// "PORT" on the loopback, "ADDRESS:PORT" or "[ADDRESS]:PORT", "localhost".
/// @throws Error (bad_input) naming --serve
ServeAddress parse_serve(const std::string& text);

/// How long a server goes on, and whom it tells that it has begun.
struct ServeHooks {
  std::function<bool()> is_stopped;
  std::function<void(const std::string& url)> begun;
};

/// Serves the page of a feed at "/" and its events at "/events" until it is stopped. Only GET and
/// HEAD are answered, only under the address that the client reached (no DNS rebinding), without an
/// Origin or with that of the page, and with the token of the URL, which nobody can guess. Nothing
/// of the disk is served.
/// @throws Error (bad_input) naming --serve if it cannot listen, or this build cannot serve
void serve(LiveFeed& feed, const ServeAddress& at, const ServeHooks& hooks);

}  // namespace excavplan::tools
