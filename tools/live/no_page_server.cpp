// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/tool.hpp"
#include "live/page_server.hpp"

namespace excavplan::tools {

void serve(LiveFeed& /*feed*/, const ServeAddress& /*at*/, const ServeHooks& /*hooks*/) {
  usage_error("--serve: this build is without Boost.Beast: install libboost-dev and build again");
}

}  // namespace excavplan::tools
