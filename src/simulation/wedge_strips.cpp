// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/wedge_strips.hpp"

#include <algorithm>

#include "earth/each_processor.hpp"

namespace excavplan {
namespace {

constexpr std::size_t strips_at_once = 8;

/// So many strips.
struct Ground {
  std::size_t count;
  const double* width;
  const double* bank;
  const double* loose;
  const double* pile;
};

/// Where so many strips are to be found, from the soil in their column.
struct FoundGround {
  std::size_t count;
  const double* in_column;
  double* width;
  double* bank;
  double* loose;
  double* pile;
};

EXCAVPLAN_FOR_EACH_PROCESSOR
void piles_in(const StripColumn& column, std::size_t count, double* __restrict pile) {
  const double* __restrict bank = column.bank;
  const double* __restrict lay = column.lay;
  const double* __restrict lies = column.lies;
  const double* __restrict cover = column.cover;
  const double share = column.passed;
  const double line = column.line;
  for (std::size_t i = 0; i < count; ++i) {
    const double passed = share * cover[i];
    const double over = line - bank[i];
    const double left = std::min(over < 0.0 ? 0.0 : over, lay[i]);
    const double pushed = std::max(0.0, lies[i] - lay[i] + passed * (lay[i] - left));
    pile[i] = lay[i] > 0.0 ? pushed : lies[i];
  }
}

EXCAVPLAN_FOR_EACH_PROCESSOR
void strips_in(const StripColumn& column, double cell, const FoundGround& found) {
  const double* __restrict in_column = found.in_column;
  double* __restrict width = found.width;
  double* __restrict bank = found.bank;
  double* __restrict loose = found.loose;
  double* __restrict pile = found.pile;
  const std::size_t count = found.count;
  const double* __restrict top = column.bank;
  const double* __restrict lay = column.lay;
  const double* __restrict cover = column.cover;
  const double tip = column.tip;
  for (std::size_t i = 0; i < count; ++i) {
    const double depth = top[i] - tip;
    const double all = depth + lay[i] + in_column[i];
    const bool any = all > 0.0;  // not on unknown ground
    width[i] = cover[i] * cell;
    bank[i] = any ? std::max(0.0, depth) : 0.0;
    loose[i] = any ? std::min(lay[i], std::max(0.0, depth + lay[i])) : 0.0;
    pile[i] = any ? std::min(in_column[i], all) : 0.0;
  }
}

EXCAVPLAN_FOR_EACH_PROCESSOR
void begin_wedges(const Ground& ground, const LayerTerms& layers, double cell,
                  double* __restrict cells_left, double* __restrict piled) {
  const double* __restrict bank = ground.bank;
  const double* __restrict loose = ground.loose;
  const double* __restrict pile = ground.pile;
  const double bank_length = layers.bank.n.cot_failure;
  const double loose_length = layers.loose.n.cot_failure;
  for (std::size_t i = 0; i < ground.count; ++i) {
    const double ahead = bank[i] * bank_length + loose[i] * loose_length;
    const double cells = bank[i] + loose[i] > 0.0 ? ahead / cell : 0.0;
    cells_left[i] = cells;
    piled[i] = std::min(1.0, cells) * pile[i];
  }
}

/// On the face, of a layer of depth t under a surcharge, per metre of width [N/m].
inline double passive(const FaceTerms& of, double t, double surcharge) {
  return t * (of.soil.unit_weight * t * of.n.gamma + of.soil.cohesion * of.n.c +
              surcharge * of.n.q + of.adhesion * of.n.ca);
}
inline double along(const FaceTerms& of, double pushed, double stuck) {
  return pushed * of.n.sin_face + stuck * of.n.cot_rake;
}
inline double across(const FaceTerms& of, double pushed, double stuck) {
  return pushed * of.n.cos_face - stuck;
}

/// Forces of as many strips as a loop takes at once.
struct Forces {
  using Each = double[strips_at_once];
  Each bank, loose, pile, shear;  ///< along
  Each bank_across, loose_across, pile_across;
  Each weight;
};

inline void add(const Forces& forces, const Ground& ground, std::size_t i, StripSums& sums) {
  sums.along += forces.bank[i];
  sums.along += forces.loose[i];
  sums.along += forces.pile[i];
  sums.along += forces.shear[i];
  sums.across += forces.bank_across[i];
  sums.across += forces.loose_across[i];
  sums.across += forces.pile_across[i];
  sums.on_face += forces.weight[i];
  sums.bank_depth += ground.width[i] * ground.bank[i];
  sums.loose_depth += ground.width[i] * ground.loose[i];
}

EXCAVPLAN_FOR_EACH_PROCESSOR
void push_strips(const Ground& ground, const double* piled, const LayerTerms& layers,
                 const WedgeTerms& wedge, StripSums& sums) {
  const FaceTerms in_bank = layers.bank;
  const FaceTerms in_loose = layers.loose;
  const WedgeTerms all = wedge;
  const double dug_weight = all.dug.soil.unit_weight;
  Forces force;
  for (std::size_t i = 0; i < strips_at_once; ++i) {
    const double b = ground.bank[i];
    const double l = ground.loose[i];
    const double w = ground.width[i];
    // What was pushed up over the top of the wedge, as an even layer on all of it; what lies over
    // the face is in the bucket, and payload. Where nothing else is cut, all of it.
    const double ahead = b * in_bank.n.cot_failure + l * in_loose.n.cot_failure;
    const double over = b * in_bank.n.cot_rake + l * in_loose.n.cot_rake;
    const double even = piled[i] * all.cell / (ahead + over);
    const double p = b + l > 0.0 ? even : ground.pile[i];

    const double above = in_loose.soil.unit_weight * l;
    const double bank_pushed = w * passive(in_bank, b, dug_weight * p + above);
    const double bank_stuck = w * in_bank.adhesion * b;
    force.bank[i] = all.fade * along(in_bank, bank_pushed, bank_stuck);
    force.bank_across[i] = all.fade * across(in_bank, bank_pushed, bank_stuck);
    const double loose_pushed = w * passive(in_loose, l, dug_weight * p);
    const double loose_stuck = w * in_loose.adhesion * l;
    force.loose[i] = all.fade * along(in_loose, loose_pushed, loose_stuck);
    force.loose_across[i] = all.fade * across(in_loose, loose_pushed, loose_stuck);
    const double pile_pushed = w * dug_weight * p * p * all.dug.n.gamma;
    force.pile[i] = all.fade * along(all.dug, pile_pushed, 0.0);
    force.pile_across[i] = all.fade * across(all.dug, pile_pushed, 0.0);

    // What is not pushed up is sheared off and lifted to where it lies in the bucket.
    const double shear_in_bank =
        in_bank.soil.cohesion +
        (above + 0.5 * in_bank.soil.unit_weight * b) * in_bank.shear_at_rest;
    const double shear_in_loose = in_loose.soil.cohesion + 0.5 * above * in_loose.shear_at_rest;
    const double lifted = in_bank.soil.unit_weight * b + above + dug_weight * ground.pile[i];
    const double lift = std::max(0.0, all.rise - 0.5 * (b + l + ground.pile[i]));
    force.shear[i] =
        w * (1.0 - all.fade) * (b * shear_in_bank + l * shear_in_loose + lifted * lift);

    const double bank_over = 0.5 * b * b * in_bank.n.cot_rake;
    const double loose_over = l * (b * in_bank.n.cot_rake + 0.5 * l * in_loose.n.cot_rake);
    force.weight[i] =
        w * (in_bank.soil.unit_weight * bank_over + in_loose.soil.unit_weight * loose_over);
  }
  for (std::size_t i = 0; i < ground.count; ++i) add(force, ground, i, sums);
}

}  // namespace

FaceTerms::FaceTerms(const RestingSoil& state, const EarthmovingFactors& factors, bool packed)
    : soil(state),
      n(factors),
      adhesion(packed ? state.cohesion : state.adhesion),
      friction(packed ? state.friction_angle : state.tool_friction_angle),
      shear_at_rest(state.rest.pressure * state.rest.tangent) {}

WedgeStrips::WedgeStrips(std::size_t count)
    : count_(count), room_(count + strips_at_once), numbers_(room_ * arrays) {}

const double* WedgeStrips::find_piles(const StripColumn& column) {
  piles_in(column, count_, at(in_column));
  return at(in_column);
}

void WedgeStrips::find(const StripColumn& column, double cell) {
  strips_in(column, cell, {count_, at(in_column), at(width), at(bank), at(loose), at(pile)});
}

void WedgeStrips::begin(std::size_t first, std::size_t count, const LayerTerms& layers,
                        double cell) {
  begin_wedges({count, at(width) + first, at(bank) + first, at(loose) + first, at(pile) + first},
               layers, cell, at(cells_left) + first, at(piled) + first);
}

double WedgeStrips::longest() const {
  return *std::max_element(at(cells_left), at(cells_left) + count_);
}

void WedgeStrips::add(const PiledColumns& columns, std::size_t count) {
  add_piles(columns, count, at(cells_left), at(piled));
}

void WedgeStrips::push(std::size_t first, std::size_t count, const LayerTerms& layers,
                       const WedgeTerms& wedge, StripSums& sums) const {
  for (const std::size_t end = first + count; first < end; first += strips_at_once) {
    push_strips({std::min(strips_at_once, end - first), at(width) + first, at(bank) + first,
                 at(loose) + first, at(pile) + first},
                at(piled) + first, layers, wedge, sums);
  }
}

}  // namespace excavplan
