// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/machine/machine.hpp>

namespace excavplan {

/// How steep soil can stand in the bucket, as tangents.
struct HoldingSlopes {
  double face = 0.0;  ///< of the face above the lip while the bucket digs
  double heap = 0.0;  ///< of the heap above top edge and side plates
};

/// Volume of loose soil that the bucket can hold [m^3], with the line from its pin to its tip at
/// angle `phi3` [rad] and the soil ahead `support` above the tip [m], 0 if the bucket is clear of
/// the ground (`docs/methods.md#bucket`).
/// @throws Error (bad_input) as require_machine(), or if an argument is not finite
double bucket_capacity(const Machine& machine, double phi3, double support,
                       const HoldingSlopes& slopes);

}  // namespace excavplan
