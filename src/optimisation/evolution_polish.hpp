// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>

#include <Eigen/Core>

#include "base/random.hpp"
#include "optimisation/search_log.hpp"
#include "optimisation/search_points.hpp"

namespace excavplan {

/// A (1+1) evolution strategy from a point already evaluated, in one strand: the covariance of its
/// steps grows along steps that succeeded, shrinks along those that fail badly (Igel, Suttorp and
/// Hansen 2006; Arnold and Hansen 2010) and across constraints that were met (Arnold and Hansen,
/// "A (1+1)-CMA-ES for constrained optimisation", 2012), so that it goes along a cliff instead of
/// stopping there. Steps out of the box end at its faces. The constraint that a point breaks is
/// told by the whole part of its violation.
class EvolutionPolish {
 public:
  /// @param step  standard deviation of the first steps, of the box
  EvolutionPolish(const UnitCube& cube, const SearchRecord& start, int place, double step,
                  std::uint64_t seed);

  /// Goes on until the strand has used up its evaluations or the steps are too short to matter.
  void operator()(SearchLog::Strand& strand);

 private:
  struct Step {
    Eigen::VectorXd drawn;  ///< standard normal, as far as the box allows
    Eigen::VectorXd taken;  ///< in units of the step length
    Eigen::VectorXd to;
  };

  Step draw();
  void meet(const Step& step, double violation);
  void succeed(const Step& step, const Evaluation& outcome);
  void fail(const Step& step, const Evaluation& outcome);
  /// Steps along `direction`, in units of the drawn ones, become longer by share > 0, else shorter.
  void change_along(const Eigen::VectorXd& direction, const Eigen::VectorXd& drawn, double share);
  void adapt_length(bool succeeded);

  const UnitCube& cube_;
  Random random_;
  int place_;
  Eigen::VectorXd at_;  ///< in the cube
  Evaluation outcome_;
  double length_;                               ///< of the steps
  Eigen::MatrixXd shape_;                       ///< of the steps: taken = shape_ · drawn
  Eigen::VectorXd path_;                        ///< of the steps that succeeded, faded
  double success_ = 0.0;                        ///< share of steps that succeeded, faded
  std::vector<double> earlier_;                 ///< fitness of the points before
  std::map<int, Eigen::VectorXd> constraints_;  ///< steps that met each, faded
};

}  // namespace excavplan
