// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "clouds/file_stream.hpp"
#include "clouds/point_stream.hpp"

/// @file Points and faces of a PLY file. Private to the library.

namespace excavplan {

/// Takes the corners of a face as numbers from 0, as the file has them.
using FaceVisitor = std::function<void(const std::vector<double>& corners)>;

/// Where the parts of a file go; faces are skipped where none takes them.
struct MeshSink {
  PointSink& points;
  FaceVisitor face;
};

/// Whether a file begins as PLY.
bool is_ply(FileStream& file);
/// Reads a file as read_cloud() does, with the same errors. @throws Error (bad_file)
void stream_ply_mesh(FileStream& file, const MeshSink& to);

}  // namespace excavplan
