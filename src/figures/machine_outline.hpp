// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/machine/kinematics.hpp>

#include "drawing/drawing.hpp"

namespace excavplan {

/// A machine in the plane of its boom, outlines in the site frame [m]. Pins, track length,
/// cylinders and bucket are those of its file; thickness of boom and arm, tracks, house and cab are
/// schematic, in proportion to it.
struct MachineOutline {
  Points tracks, turntable, house, cab;
  Points boom, arm;
  std::vector<Points> cylinders;  ///< from foot to rod; of the bucket with rocker and link
  Points bucket;                  ///< open, from tip to the top edge
  Points bracket;                 ///< between pins and bucket; empty without a link
  Points pins;                    ///< of boom, arm, bucket, its link and its cylinder
};

MachineOutline machine_outline(const Machine& machine, const JointAngles& joints);

/// The bucket's wall from the tip to the top edge, open at the mouth.
Points bucket_outline(const Machine& machine, const JointAngles& joints);

/// Soil in the bucket, with a level along the mouth, heaped above it where it is more than struck;
/// empty without soil. @param volume  loose [m^3]
Points soil_in_bucket(const Machine& machine, const JointAngles& joints, double volume);

}  // namespace excavplan
