// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

/// @file
/// What a server says to bytes of any kind.

namespace excavplan::test {

/// A connection to a server of this computer.
class HttpClient {
 public:
  explicit HttpClient(std::uint16_t port);
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  void send(const std::string& bytes) const;
  /// Reads until `sign` has come, or the server ends. @return all that has come so far
  const std::string& until(const std::string& sign);
  /// Reads until the server ends.
  const std::string& all() { return until(""); }

 private:
  int socket_;
  std::string come_;
};

/// The answer to one request. @param lines  of its head, without the last
std::string answer_to(std::uint16_t port, const std::string& lines);

/// "127.0.0.1:8080" and "token=..." of a URL.
struct ServedUrl {
  std::uint16_t port = 0;
  std::string host, query;
};
ServedUrl parts_of(const std::string& url);

}  // namespace excavplan::test
