// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <excavplan/belief/belief_settings.hpp>
#include <excavplan/belief/believed_density.hpp>
#include <excavplan/belief/dig_evidence.hpp>
#include <excavplan/ground/layered_map.hpp>
#include <excavplan/soil/density_law.hpp>

/// @file
/// What is believed of the density of the ground from dig to dig (docs/methods.md#belief).

namespace excavplan {

/// The density of the ground as a Gaussian process over plan and depth, with the common error of
/// the law, that of the payload's scale and a factor on the soil's strength as further states.
///
/// It is decided by its settings and its digs in their order. Of these only limits depend on the
/// order, each being replaced by the Gaussian of the same two moments when it is added; the rest is
/// exact, and no deviation grows by more evidence. Costs grow with the digs: adding one with its
/// readings in square, predicting with their square for each place.
class DensityBelief {
 public:
  /// Only so many digs are remembered, the oldest are forgotten; ours.
  static constexpr std::size_t most_digs = 200;

  /// @param forgotten  as forgotten() of a belief that is made anew
  /// @throws Error (bad_input) if a setting is out of range, there are too many digs, or as add()
  explicit DensityBelief(const BeliefSettings& settings = {},
                         const std::vector<DigEvidence>& digs = {},
                         std::optional<DigEvidence> forgotten = {});
  DensityBelief(const DensityBelief& other);               ///< a copy has readings of its own
  DensityBelief(DensityBelief&& other) noexcept;           ///< `other` is as one without readings
  DensityBelief& operator=(DensityBelief other) noexcept;  ///< copies or moves
  ~DensityBelief();

  /// Learns from a dig.
  /// @throws Error (bad_input) if a number of it is not finite or out of range; nothing is learnt
  void add(const DigEvidence& dig);
  /// Takes back the last add(), at once after one exactly. @return false: there is none
  bool drop_last();
  /// Sets spread and lengths to the most probable ones by all readings and weak priors about the
  /// default settings.
  void refit();

  const BeliefSettings& settings() const { return settings_; }  ///< as begun or refitted
  /// Oldest first, their banks condensed().
  const std::vector<DigEvidence>& digs() const { return digs_; }
  /// The oldest dig that the last add() made it forget.
  const std::optional<DigEvidence>& forgotten() const { return forgotten_; }

  /// At points of the ground. @throws Error (bad_input) unless they are finite
  BelievedDensity at(const std::vector<GroundPlace>& places) const;
  /// Of parts of the ground, each weighted by its volumes. @throws Error (bad_input) as condensed()
  BelievedMeans means_of(const std::vector<std::vector<BankPart>>& parts) const;
  /// Of one part, for planning; not trustworthy before anything is learnt.
  GroundDensity ground_density(const std::vector<BankPart>& part) const;
  CommonStates common_states() const;  ///< errors that all readings share, as they are believed

  /// Each reading less what was foretold of it by all before it, in standard deviations: normal and
  /// independent where the settings are those of the ground. Without limits.
  std::vector<double> innovations() const;
  /// Logarithm of the probability density of all readings. Without limits.
  double log_likelihood() const;

 private:
  class Dual;
  void rebuild();

  BeliefSettings settings_;
  std::vector<DigEvidence> digs_;
  std::optional<DigEvidence> forgotten_;
  std::unique_ptr<Dual> dual_;
};

/// Layers `density_percent` and `density_sd_percent` at a depth below each cell of a grid.
LayeredMap belief_map(const DensityBelief& belief, const HeightMap& grid, double depth);

}  // namespace excavplan
