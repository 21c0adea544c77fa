/* SPDX-FileCopyrightText: 2026 The excavplan authors
 * SPDX-License-Identifier: Apache-2.0
 *
 * A soil simulator as a shared library, in C:
 *
 *     simulate-dig --density 40 --simulator ./libcutting_resistance.so
 *
 * The rule of thumb that soil resists with a fixed force per area cut, in the direction of the cut.
 * The bucket takes what lies above the line of its tip until it is struck full; the rest falls back
 * into the cut. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <excavplan/simulation/simulator_plugin.h>

/* What stays the same for all digs of an instance. */
struct cutter {
  double half_width;
  double capacity;   /* dry soil that a struck bucket holds [kg] */
  double resistance; /* per area cut [Pa] */
  excavplan_soil_state bank, loose;
  double water_content;
};

static double cavity_area(const excavplan_machine* machine) {
  double area = 0.0;
  for (size_t i = 0; i < machine->profile_corners; ++i) {
    const double* a = machine->profile + 2 * i;
    const double* b = machine->profile + 2 * ((i + 1) % machine->profile_corners);
    area += 0.5 * (a[0] * b[1] - b[0] * a[1]);
  }
  return area;
}

static int create(void* context, const excavplan_machine* machine, const excavplan_soil* soil,
                  void** instance, char* error, size_t error_size) {
  struct cutter* cutter = malloc(sizeof *cutter);
  (void)context;
  if (cutter == NULL) {
    snprintf(error, error_size, "no memory");
    return 1;
  }
  cutter->half_width = 0.5 * machine->width_outside;
  cutter->capacity = cavity_area(machine) * machine->width_inside * soil->loose.dry_density;
  /* 30 kPa in the loosest, 120 kPa in the densest soil: orders of magnitude of digging. */
  cutter->resistance = 30e3 * pow(4.0, soil->relative_density);
  cutter->bank = soil->bank;
  cutter->loose = soil->loose;
  cutter->water_content = soil->water_content;
  *instance = cutter;
  return 0;
}

/* Takes what lies above the line from one pose to the next. Returns its dry mass [kg], with the
 * mean cross-section of the undisturbed ground cut, in `area`. */
static double take(const struct cutter* cutter, const excavplan_dig* dig, excavplan_result* result,
                   const excavplan_pose* from, const excavplan_pose* to, double* area) {
  const double cell = dig->cell;
  double dry = 0.0;
  double volume = 0.0;
  for (size_t col = 0; col < dig->cols; ++col) {
    const double x = dig->origin[0] + cell * ((double)col + 0.5);
    if (!(x >= to->tip[0] && x < from->tip[0])) continue;
    const double level = from->tip[1] + (from->tip[0] - x) / (from->tip[0] - to->tip[0]) *
                                            (to->tip[1] - from->tip[1]);
    for (size_t row = 0; row < dig->rows; ++row) {
      const double y = dig->origin[1] + cell * ((double)row + 0.5);
      double* bank = &result->bank[col * dig->rows + row];
      double* loose = &result->loose[col * dig->rows + row];
      if (isnan(*bank) || fabs(y) >= cutter->half_width) continue;
      const double bank_cut = fmax(0.0, *bank - level);
      const double loose_cut = fmin(*loose, fmax(0.0, *bank + *loose - level));
      *bank -= bank_cut;
      *loose -= loose_cut;
      dry += cell * cell *
             (bank_cut * cutter->bank.dry_density + loose_cut * cutter->loose.dry_density);
      volume += cell * cell * bank_cut;
    }
  }
  const double length = hypot(to->tip[0] - from->tip[0], to->tip[1] - from->tip[1]);
  *area = length > 0.0 ? volume / length : 0.0;
  return dry;
}

/* Lets dry soil [kg] fall back on the cells that were cut. */
static void drop(const struct cutter* cutter, const excavplan_dig* dig, excavplan_result* result,
                 double dry) {
  double cut = 0.0;
  const size_t cells = dig->rows * dig->cols;
  for (size_t i = 0; i < cells; ++i) {
    if (result->bank[i] < dig->bank[i]) cut += dig->bank[i] - result->bank[i];
  }
  const double rise = dry / (dig->cell * dig->cell * cutter->loose.dry_density);
  for (size_t i = 0; i < cells && cut > 0.0; ++i) {
    if (result->bank[i] < dig->bank[i]) {
      result->loose[i] += rise * (dig->bank[i] - result->bank[i]) / cut;
    }
  }
}

static int dig(void* instance, const excavplan_dig* dig, excavplan_result* result, char* error,
               size_t error_size) {
  const struct cutter* cutter = instance;
  const double moist = 1.0 + cutter->water_content;
  double dry = 0.0;
  (void)error;
  (void)error_size;
  for (size_t i = 0; i + 1 < dig->poses; ++i) {
    const excavplan_pose* from = &dig->pose[i];
    const excavplan_pose* to = &dig->pose[i + 1];
    const double length = hypot(to->tip[0] - from->tip[0], to->tip[1] - from->tip[1]);
    double area = 0.0;
    if (to->phase != EXCAVPLAN_LIFT) dry += take(cutter, dig, result, from, to, &area);
    excavplan_load* load = &result->load[i];
    load->carried = moist * fmin(dry, cutter->capacity);
    if (length > 0.0) {
      load->force[0] = -cutter->resistance * area * (to->tip[0] - from->tip[0]) / length;
      load->force[1] = -cutter->resistance * area * (to->tip[1] - from->tip[1]) / length;
    }
    load->force[1] -= 9.80665 * load->carried;
  }
  const double held = fmin(dry, cutter->capacity);
  drop(cutter, dig, result, dry - held);
  result->payload = moist * held;
  result->has = EXCAVPLAN_HAS_LOADS;
  return 0;
}

static const excavplan_simulator simulator = {sizeof(excavplan_simulator),
                                              EXCAVPLAN_SIMULATOR_VERSION,
                                              EXCAVPLAN_REENTRANT,
                                              "cutting resistance 1",
                                              1e-9,
                                              NULL,
                                              create,
                                              dig,
                                              free};

const excavplan_simulator* excavplan_simulator_entry(uint32_t version) {
  return version == EXCAVPLAN_SIMULATOR_VERSION ? &simulator : NULL;
}
