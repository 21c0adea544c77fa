// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// @file
/// Which requests a page server answers.

namespace excavplan::tools {

/// Of a request, its head alone.
struct RequestHead {
  bool only_reads = false;  ///< GET or HEAD
  std::string target;       ///< "/events?token=..."
  std::vector<std::string> hosts, origins;
};

/// Where a request arrived, and what it must bring.
struct ServedAt {
  std::vector<std::string> hosts;  ///< "127.0.0.1:8080"
  std::string token;
};

struct RequestAnswer {
  int status = 200;   ///< of HTTP; 200: it may be answered
  std::string path;   ///< "/"
  std::string query;  ///< "token=...&steps=3"
};
RequestAnswer check(const RequestHead& request, const ServedAt& at);

/// The value of a name in a query; empty if it is not there.
std::string value_in(const std::string& query, const std::string& name);

/// 128 random bits of the system, in hexadecimal digits.
std::string random_token();

}  // namespace excavplan::tools
