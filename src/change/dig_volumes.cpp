// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/change/dig_volumes.hpp>

#include <algorithm>

namespace excavplan {

const char* name(ZoneKind kind) {
  switch (kind) {
    case ZoneKind::dig:
      return "dig";
    case ZoneKind::spill:
      return "spill";
    case ZoneKind::dump:
      return "dump";
    case ZoneKind::other:
      break;
  }
  return "other";
}

const char* name(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::hole:
      return "hole";
    case ChangeKind::second_hole:
      return "second_hole";
    case ChangeKind::small_hole:
      return "small_hole";
    case ChangeKind::settled:
      return "settled";
    case ChangeKind::edge:
      return "edge";
    case ChangeKind::heap:
      return "heap";
    case ChangeKind::second_heap:
      return "second_heap";
    case ChangeKind::spill:
      return "spill";
    case ChangeKind::clods:
      return "clods";
    case ChangeKind::small_rises:
      return "small_rises";
    case ChangeKind::lump:
      return "lump";
    case ChangeKind::thing:
      return "thing";
    case ChangeKind::ruts:
      return "ruts";
    case ChangeKind::berms:
      return "berms";
    case ChangeKind::stirred:
      return "stirred";
    case ChangeKind::within_error:
      return "within_error";
    case ChangeKind::in_area:
      return "in_area";
    case ChangeKind::outside_area:
      return "outside_area";
    case ChangeKind::earlier_soil:
      return "earlier_soil";
    case ChangeKind::pressed:
      return "pressed";
    case ChangeKind::water:
      break;
  }
  return "water";
}

bool is_unseen(const Reading& reading) {
  return std::any_of(reading.kinds.begin(), reading.kinds.end(), [](ChangeKind kind) {
    return kind == ChangeKind::pressed || kind == ChangeKind::water;
  });
}

}  // namespace excavplan
