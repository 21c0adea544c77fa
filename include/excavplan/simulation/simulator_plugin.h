/* SPDX-FileCopyrightText: 2026 The excavplan authors
 * SPDX-License-Identifier: Apache-2.0 */
#ifndef EXCAVPLAN_SIMULATION_SIMULATOR_PLUGIN_H
#define EXCAVPLAN_SIMULATION_SIMULATOR_PLUGIN_H

/** @file
 * A soil simulator in a shared library of its own, for `--simulator FILE.so`: plain C, which C and
 * C++ compile. Guide: docs/simulators.md#shared-library.
 *
 * All numbers are SI and radians. Frame: x forward from the swing axis of the machine, y left, z
 * up. Moments in the boom plane turn from +x to +z. Arrays of joints hold boom, arm, bucket.
 * Structs of excavplan and their arrays are valid during the call that gets them. A later header of
 * the same version may append members to structs that begin with their size; no member moves, and
 * the other structs stay as they are. */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Version of this interface. excavplan refuses a library of another one. */
#define EXCAVPLAN_SIMULATOR_VERSION 1u

/** Joint of the machine. */
typedef struct excavplan_joint {
  double limits[2];      /**< lowest and highest angle [rad] */
  double speed;          /**< highest [rad/s] */
  double acceleration;   /**< highest [rad/s^2] */
  double torque;         /**< highest [N m] */
  double length;         /**< of the link: to the next pin, of the bucket to the tip [m] */
  double mass;           /**< of the link [kg] */
  double mass_centre[2]; /**< along the line to the next pin, and across it to the left [m] */
} excavplan_joint;

/** The excavator. */
typedef struct excavplan_machine {
  size_t size;              /**< of this struct [byte] */
  const char* name;         /**< "zx120" */
  double boom_pin[2];       /**< x, z [m] */
  double track_front_x;     /**< foremost part of the undercarriage [m] */
  excavplan_joint joint[3]; /**< boom, arm, bucket */
  const double* profile;    /**< corners of the cavity: along, across, along, .. from bucket pin
                               to tip, counter-clockwise; tip first, heel second [m] */
  size_t profile_corners;   /**< number of these corners */
  double width_outside;     /**< the bucket cuts so wide [m] */
  double width_inside;      /**< and holds so wide [m] */
  double edge_thickness;    /**< of the lip [m] */
  double edge_angle;        /**< wedge angle of the lip [rad] */
  size_t teeth;             /**< their number; 0: none */
  double tooth_size[3];     /**< width, thickness, length of one [m] */
  double tooth_angle;       /**< between its faces [rad] */
} excavplan_machine;

/** Soil in one state. */
typedef struct excavplan_soil_state {
  double void_ratio;          /**< [-] */
  double dry_density;         /**< [kg/m^3] */
  double bulk_density;        /**< moist [kg/m^3] */
  double cohesion;            /**< [Pa] */
  double adhesion;            /**< to steel [Pa] */
  double friction_angle;      /**< [rad] */
  double tool_friction_angle; /**< to steel [rad] */
} excavplan_soil_state;

/** The soil. */
typedef struct excavplan_soil {
  size_t size;                /**< of this struct [byte] */
  const char* name;           /**< "loam" */
  double relative_density;    /**< of the undisturbed soil, 0 .. 1 */
  double specific_gravity;    /**< of the grains [-] */
  double water_content;       /**< water per dry mass [-] */
  double angle_of_repose;     /**< of loose soil [rad] */
  excavplan_soil_state bank;  /**< undisturbed */
  excavplan_soil_state loose; /**< of all soil that has moved */
} excavplan_soil;

/** Phase of a pose. */
enum { EXCAVPLAN_PENETRATE = 1, EXCAVPLAN_DRAG = 2, EXCAVPLAN_SCOOP = 3, EXCAVPLAN_LIFT = 4 };

/** The bucket at one point of the path. */
typedef struct excavplan_pose {
  int32_t phase;      /**< one of the above */
  double tip[2];      /**< x, z of the tip of the teeth, y is 0 [m] */
  double floor_angle; /**< of the bucket's floor, positive with the heel above the tip [rad] */
  double joint[3];    /**< angles, positive down and in [rad] */
} excavplan_pose;

/** What is to be dug: the window of the ground that matters, and a path. Cell (row, col) is at
 * [col * rows + row] of each layer, its smallest corner at origin + cell * (col, row). */
typedef struct excavplan_dig {
  size_t size;                /**< of this struct [byte] */
  size_t rows;                /**< cells along y */
  size_t cols;                /**< cells along x */
  double origin[2];           /**< x, y of the corner of cell (0, 0) [m] */
  double cell;                /**< edge of a cell [m] */
  const double* bank;         /**< top of the undisturbed soil [m]; NaN: unknown */
  const double* loose;        /**< thickness of the loose soil on it [m] */
  size_t poses;               /**< number of poses, at least 2 */
  const excavplan_pose* pose; /**< in the order in which they are visited */
  double give_up_below;       /**< the dig may end early once its payload per energy cannot reach
                                 this [kg/J]; 0: never */
} excavplan_dig;

/** What excavplan_result states. */
enum { EXCAVPLAN_HAS_LOADS = 1, EXCAVPLAN_HAS_ENERGY = 2, EXCAVPLAN_GAVE_UP = 4 };

/** Load of one step, from one pose to the next. */
typedef struct excavplan_load {
  double force[2]; /**< x, z of all soil on the bucket, that in it too, with its weight [N] */
  double moment;   /**< of that force about the tip, from +x to +z [N m] */
  double carried;  /**< soil in the bucket, moist [kg] */
} excavplan_load;

/** What the dig did. excavplan has set all of it: numbers to 0, the ground as it was. */
typedef struct excavplan_result {
  size_t size;          /**< of this struct [byte] */
  uint32_t has;         /**< of the above: loads, energy, or both; and that it gave up */
  double payload;       /**< moist soil in the bucket once it is clear of the ground [kg] */
  double* bank;         /**< rows * cols: the ground afterwards, without the payload [m] */
  double* loose;        /**< likewise [m] */
  excavplan_load* load; /**< poses - 1 of them; the energy follows from them */
  double energy;        /**< of penetrate, drag and scoop [J] */
  double by_phase[3];   /**< its parts: penetrate, drag, scoop [J] */
  double by_joint[3];   /**< its parts: boom, arm, bucket [J] */
  double lift_energy;   /**< of the lift, no part of the energy [J] */
} excavplan_result;

/** How many threads may be in the library at once. */
enum {
  EXCAVPLAN_ONE_THREAD = 0,          /**< one */
  EXCAVPLAN_THREAD_PER_INSTANCE = 1, /**< one in each instance */
  EXCAVPLAN_REENTRANT = 2            /**< any number, also in the dig() of one instance */
};

/** The simulator of a library. Functions return 0, or anything else with a text of at most
 * `error_size` bytes, the end 0 among them, in `error`. No exception may leave them. */
typedef struct excavplan_simulator {
  size_t size;           /**< of this struct [byte] */
  uint32_t version;      /**< EXCAVPLAN_SIMULATOR_VERSION */
  uint32_t threads;      /**< one of the above */
  const char* name;      /**< with its version, "my simulator 3" */
  double mass_tolerance; /**< of the dry mass moved, that the balance may be off, 0 .. 0.2 */
  void* context;         /**< handed to create() */
  /** Prepares digs in one soil. */
  int (*create)(void* context, const excavplan_machine* machine, const excavplan_soil* soil,
                void** instance, char* error, size_t error_size);
  /** Digs. The same arguments give the same result, from any instance. */
  int (*dig)(void* instance, const excavplan_dig* dig, excavplan_result* result, char* error,
             size_t error_size);
  void (*destroy)(void* instance); /**< ends an instance */
} excavplan_simulator;

/** Makes a function visible outside of its library. */
#if defined(__GNUC__)
#define EXCAVPLAN_SIMULATOR_EXPORT __attribute__((visibility("default")))
#else
#define EXCAVPLAN_SIMULATOR_EXPORT
#endif

/** The one function that the library exports. @param version  of excavplan's header
 * @return what lives as long as the library; NULL: not for this version */
EXCAVPLAN_SIMULATOR_EXPORT const excavplan_simulator* excavplan_simulator_entry(uint32_t version);

#ifdef __cplusplus
}
#endif

#endif
