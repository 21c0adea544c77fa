// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/density/other_volumes.hpp>
#include <excavplan/paper/paper_options.hpp>

namespace excavplan {

/// The paper's method on scans that were not cropped by hand, for DensityOptions::paper
/// (docs/methods.md#the-papers-method).
///
/// Volumes as published, on PCL's filters, each in its area: that of the options or, in a whole
/// scene, the extent of the zones that the change of the surface found there. Where both overlap,
/// soil counts in the area of its zone. Zones, height change and warnings of the result are those
/// of the surface; no standard deviation is known, all are NaN.
///
/// What it returns throws Error (bad_input) if an option is out of range, a cloud has no finite
/// point, or the extent of an area exceeds 2^31 voxels.
OtherVolumes paper_change(const PaperOptions& options = {});

}  // namespace excavplan
