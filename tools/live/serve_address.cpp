// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page_server.hpp"

#include <arpa/inet.h>

#include <charconv>

#include "frame/tool.hpp"

namespace excavplan::tools {
namespace {

bool is_address(const std::string& host) {
  in6_addr ignored{};
  return ::inet_pton(AF_INET, host.c_str(), &ignored) == 1 ||
         ::inet_pton(AF_INET6, host.c_str(), &ignored) == 1;
}

}  // namespace

ServeAddress parse_serve(const std::string& text) {
  ServeAddress address;
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && colon > 0) {
    address.host = text.substr(0, colon);
    const bool is_bracketed = address.host.front() == '[' && address.host.back() == ']';
    if (is_bracketed) address.host = address.host.substr(1, address.host.size() - 2);
    if (address.host == "localhost") address.host = ServeAddress{}.host;
  }
  const char* const from = text.data() + (colon == std::string::npos ? 0 : colon + 1);
  const char* const to = text.data() + text.size();
  const auto [end, error] = std::from_chars(from, to, address.port);
  if (error != std::errc{} || end != to || from == to || !is_address(address.host)) {
    usage_error("--serve: '" + text +
                "' is not PORT or ADDRESS:PORT such as 8080 or 127.0.0.1:8080");
  }
  return address;
}

}  // namespace excavplan::tools
