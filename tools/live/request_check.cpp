// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "live/request_check.hpp"

#include <algorithm>
#include <random>

namespace excavplan::tools {
namespace {

/// In a time that does not tell how many letters are right.
bool same_secret(const std::string& one, const std::string& other) {
  if (one.size() != other.size()) return false;
  unsigned differs = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    differs |= static_cast<unsigned char>(one[i]) ^ static_cast<unsigned char>(other[i]);
  }
  return differs == 0;
}

/// A page of another site may name this address, but its Origin is that of the other site; and one
/// whose name was turned to this address (DNS rebinding) has its own name as Host.
bool is_own(const RequestHead& request, const ServedAt& at) {
  if (request.hosts.size() != 1 || request.origins.size() > 1) return false;
  const std::string& host = request.hosts.front();
  if (std::find(at.hosts.begin(), at.hosts.end(), host) == at.hosts.end()) return false;
  return request.origins.empty() || request.origins.front() == "http://" + host;
}

}  // namespace

std::string value_in(const std::string& query, const std::string& name) {
  for (std::size_t from = 0; from < query.size();) {
    const std::size_t end = std::min(query.find('&', from), query.size());
    const std::string pair = query.substr(from, end - from);
    if (pair.compare(0, name.size() + 1, name + '=') == 0) return pair.substr(name.size() + 1);
    from = end + 1;
  }
  return {};
}

RequestAnswer check(const RequestHead& request, const ServedAt& at) {
  if (!request.only_reads) return {405, {}, {}};
  if (!is_own(request, at)) return {403, {}, {}};
  RequestAnswer answer;
  const std::size_t mark = std::min(request.target.find('?'), request.target.size());
  answer.path = request.target.substr(0, mark);
  answer.query = request.target.substr(std::min(mark + 1, request.target.size()));
  if (!same_secret(value_in(answer.query, "token"), at.token)) return {403, {}, {}};
  if (answer.path != "/" && answer.path != "/events") answer.status = 404;
  return answer;
}

std::string random_token() {
  std::random_device random("/dev/urandom");
  std::string token;
  for (int digit = 0; digit < 32; ++digit) token += "0123456789abcdef"[random() % 16];
  return token;
}

}  // namespace excavplan::tools
