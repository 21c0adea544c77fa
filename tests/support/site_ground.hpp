// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/site_draft.hpp"

/// @file
/// Families of scenes by what lies on a site, one function for each: further soil, tracks, things.

namespace excavplan::scenes {

// ---- More soil, other soil --------------------------------------------------------------------

void second_heap(Draft& d);

/// A shallow dig away from pit and ridge, whose soil lies in the heap.
void add_scrape(Draft& d, Dig scrape);

void second_scrape(Draft& d);

/// As narrow and as shallow as the rut of a track.
void scrape_like_rut(Draft& d);

/// Steeper than loose soil, as cohesive soil stands.
void steep_heap(Draft& d);

/// Ground that breaks into blocks.
void hard_second_heap(Draft& d);

/// One lump of soil, along the swing or off it.
void lump(Draft& d);

/// Across a ridge of loose soil that an earlier dig left; that soil lies in the heap too.
void over_old_spill(Draft& d);

void two_pits(Draft& d);

void two_pits_two_heaps(Draft& d);

void two_heaps_alike(Draft& d);

/// Along an arc from the pit to the heap.
void clods(Draft& d);

// ---- Tracks and texture -----------------------------------------------------------------------

void ruts_joined(Draft& d);

void rut_shallow(Draft& d);

void ruts_apart(Draft& d);

void berms_joined(Draft& d);

/// A half plane whose edge passes near the middle of the scene.
void churned(Draft& d);

// ---- What is no soil --------------------------------------------------------------------------

void set_down(Draft& d, double x, double y);

void crate_on_heap(Draft& d);

void crate_in_pit(Draft& d);

/// Fills the lowest share of the pit up to one level.
void fill_pit(Draft& d);

void water(Draft& d);

void water_even(Draft& d);

void lawn(Draft& d);

void grass(Draft& d);

void pressed(Draft& d);

/// The wall cuts the foot of the heap off.
void heap_at_wall(Draft& d);

// ---- What surveys could always stand ----------------------------------------------------------

void crate_apart(Draft& d);

void steep_ground(Draft& d);

void heap_spread(Draft& d);

void thin_dig(Draft& d);

/// In a pit that was there before.
void dug_again(Draft& d);

// ---- Soil too thin to tell from noise, fallen back, foreign -----------------------------------

/// Up to a tenth of the loose soil lies strewn, 2-20 mm thick: as a layer between hole and heap or
/// about one of them, or as crumbs; points err by 3-10 mm.
void strewn_layer(Draft& d);
void strewn_crumbs(Draft& d);
/// The same by none of it.
void strewn_none(Draft& d);
/// Carried away by wheels: two strips.
void strewn_by_wheels(Draft& d);

/// The bucket left a level floor in uneven ground.
void level_floor(Draft& d);

/// The heap stands at the rim, and its foot slid back into the hole.
void back_over_rim(Draft& d);

/// A ridge that none of the dug soil is, beside the hole or away from it.
void foreign_berm(Draft& d);
/// The bucket rests on the ground in the scan after.
void bucket_rests(Draft& d);
/// A crate stood on the ground of the dig before.
void crate_before(Draft& d);

}  // namespace excavplan::scenes
