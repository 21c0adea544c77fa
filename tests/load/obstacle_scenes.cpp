// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// obstacle_scenes [SCENES [FIRST]]: motions of whole cycles in scenes that rays saw, judged on the
// true shapes. Fails on a trusted motion nearer than 0.1 m to a shape that at least three rays hit,
// or if more than 5 % of the clear scenes whose swing was seen are refused or not trusted.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "support/obstacle_judge.hpp"

int main(int argc, char** argv) {
  using namespace excavplan::test;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const long scenes = argc > 1 ? std::atol(argv[1]) : 1000;
  const long first = argc > 2 ? std::atol(argv[2]) : 0;
  const ObstacleJudge judge;
  long trusted = 0, hits = 0, clear = 0, alarms = 0, blocked = 0;
  for (long i = 0; i < scenes; ++i) {
    const SceneVerdict verdict = judge.judge(static_cast<std::uint64_t>(first + i));
    trusted += verdict.trusted ? 1 : 0;
    hits += verdict.hits() ? 1 : 0;
    clear += verdict.clear ? 1 : 0;
    alarms += verdict.is_false_alarm() ? 1 : 0;
    blocked += verdict.in_the_way ? 1 : 0;
    if (verdict.hits() || verdict.is_false_alarm()) {
      std::printf("scene %ld: %s\n", first + i, verdict.text.c_str());
    }
  }
  std::printf(
      "%ld scenes, %ld with something in the way of the motion for level ground; %ld trusted, of "
      "these %ld hit something; %ld clear and seen, of these %ld refused or not trusted\n",
      scenes, blocked, trusted, hits, clear, alarms);
  return hits == 0 && static_cast<double>(alarms) <= 0.05 * static_cast<double>(clear) ? 0 : 1;
}
