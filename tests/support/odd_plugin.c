/* SPDX-FileCopyrightText: 2026 The excavplan authors
 * SPDX-License-Identifier: Apache-2.0
 *
 * A simulator as a shared library that is odd in the way ODD. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <excavplan/simulation/simulator_plugin.h>

enum {
  SOUND,
  OTHER_VERSION,
  SMALL,
  NO_DIG,
  TOLERANT,
  NAMELESS,
  NO_DESCRIPTION,
  FAILS,
  NAN_PAYLOAD,
  NAN_GROUND,
  RISEN,
  NOTHING,
  UNBALANCED,
  ONE_AT_A_TIME,
  STRONG,
  GIVES_UP,
  ENDS
};

static int inside = 0; /* calls of dig() that run */

static int create(void* context, const excavplan_machine* machine, const excavplan_soil* soil,
                  void** instance, char* error, size_t size) {
  (void)context, (void)machine, (void)soil;
  *instance = &inside;
  if (ODD == FAILS && soil->relative_density > 0.9) {
    snprintf(error, size, "too\033[31m dense");
    return 7;
  }
  return 0;
}

static int dig(void* instance, const excavplan_dig* asked, excavplan_result* result, char* error,
               size_t size) {
  (void)instance;
  if (ODD == ENDS) exit(0);
  if (ODD == FAILS) {
    memset(error, 'x', size); /* without an end */
    return 1;
  }
  if (ODD == ONE_AT_A_TIME && ++inside != 1) {
    snprintf(error, size, "%d calls at once", inside);
    return 1;
  }
  result->has = EXCAVPLAN_HAS_ENERGY;
  result->energy = 1e4;
  const size_t middle = asked->rows * asked->cols / 2;
  if (ODD == NAN_PAYLOAD) result->payload = NAN;
  if (ODD == NAN_GROUND) result->bank[middle] = NAN;
  if (ODD == RISEN) result->bank[middle] += 0.5;
  if (ODD == NOTHING) result->has = 0;
  if (ODD == UNBALANCED) result->payload = 100.0;
  if (ODD == GIVES_UP) result->has |= EXCAVPLAN_GAVE_UP;
  if (ODD == STRONG) {
    result->has = EXCAVPLAN_HAS_LOADS;
    for (size_t i = 0; i + 1 < asked->poses; ++i) result->load[i].force[0] = i < 5 ? 1e4 : 1e6;
  }
  if (ODD == ONE_AT_A_TIME) {
    double work = 0.0;
    for (int i = 0; i < 2000000; ++i) work += sqrt((double)i);
    result->energy += 1e-30 * work;
    --inside;
  }
  return 0;
}

static void destroy(void* instance) { (void)instance; }

static const excavplan_simulator simulator = {
    ODD == SMALL ? 16 : sizeof(excavplan_simulator),
    ODD == OTHER_VERSION ? EXCAVPLAN_SIMULATOR_VERSION + 1 : EXCAVPLAN_SIMULATOR_VERSION,
    EXCAVPLAN_ONE_THREAD,
    ODD == NAMELESS ? "" : "odd 1",
    ODD == TOLERANT ? 0.9 : 0.0,
    NULL,
    create,
    ODD == NO_DIG ? NULL : dig,
    destroy};

const excavplan_simulator* excavplan_simulator_entry(uint32_t version) {
  (void)version;
  return ODD == NO_DESCRIPTION ? NULL : &simulator;
}
