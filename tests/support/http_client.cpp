// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/http_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace excavplan::test {

HttpClient::HttpClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    ::close(socket_);
    throw std::runtime_error("no server at port " + std::to_string(port));
  }
}

HttpClient::~HttpClient() { ::close(socket_); }

void HttpClient::send(const std::string& bytes) const {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return;  // it has ended
    sent += static_cast<std::size_t>(count);
  }
}

const std::string& HttpClient::until(const std::string& sign) {
  std::array<char, 65536> part{};
  while (sign.empty() || come_.find(sign) == std::string::npos) {
    const ssize_t count = ::recv(socket_, part.data(), part.size(), 0);
    if (count <= 0) break;
    come_.append(part.data(), static_cast<std::size_t>(count));
  }
  return come_;
}

std::string answer_to(std::uint16_t port, const std::string& lines) {
  HttpClient client(port);
  client.send(lines + "\r\n\r\n");
  return client.all();
}

ServedUrl parts_of(const std::string& url) {
  const std::size_t host = url.find("//") + 2, path = url.find('/', host);
  ServedUrl parts;
  parts.host = url.substr(host, path - host);
  parts.query = url.substr(path + 2);
  parts.port = static_cast<std::uint16_t>(std::stoi(parts.host.substr(parts.host.find(':') + 1)));
  return parts;
}

}  // namespace excavplan::test
