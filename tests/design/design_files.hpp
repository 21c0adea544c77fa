// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <excavplan/design/design_file.hpp>
#include <excavplan/ground/map_files.hpp>

#include "base/scalar.hpp"
#include "base/text.hpp"

/// @file One surface written in every format.

namespace excavplan::test {

/// A file that is gone with its owner.
class DesignFile {
 public:
  DesignFile(const std::string& ending, const std::string& content)
      : path_(testing::TempDir() + "excavplan_design_" + std::to_string(::getpid()) + "." +
              ending) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~DesignFile() { std::filesystem::remove(path_); }
  DesignFile(const DesignFile&) = delete;
  DesignFile& operator=(const DesignFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Points and triangles, in metres.
struct PlainMesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A trench of 15 x 1 x 0.5 m below level ground at 0, with walls of 0.5 horizontal per vertical
/// that end at the ground, turned and away from the origin.
inline PlainMesh battered_trench(const Eigen::Vector2d& at) {
  const double turn = 0.3;
  const Eigen::Vector2d along(std::cos(turn), std::sin(turn)), left(-along.y(), along.x());
  PlainMesh mesh;
  for (const double out : {0.0, 0.25}) {
    for (const auto& [l, w] : {std::pair{0.0, 1.0}, {1.0, 1.0}, {1.0, -1.0}, {0.0, -1.0}}) {
      const Eigen::Vector2d place =
          at + (15.0 * l + out * (2.0 * l - 1.0)) * along + w * (0.5 + out) * left;
      mesh.points.emplace_back(place.x(), place.y(), 2.0 * out - 0.5);
    }
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 1}, {4, 1, 0}, {5, 6, 2},
                    {5, 2, 1}, {6, 7, 3}, {6, 3, 2}, {7, 4, 0}, {7, 0, 3}};
  return mesh;
}
/// Its volume: a prism, two end wedges and four corners that make a pyramid.
inline constexpr double trench_volume = 15.0 * (0.5 + 0.125) + 0.125 + 0.5 * 0.25 / 3.0;

inline PlainMesh scaled(PlainMesh mesh, double factor) {
  for (Eigen::Vector3d& point : mesh.points) point *= factor;
  return mesh;
}

struct FileUnit {
  const char* name;
  double length;  ///< [m]
  const char* land_xml;
  int dxf;
};
inline constexpr std::array<FileUnit, 4> file_units = {
    {{"metre", 1.0, "<Metric linearUnit=\"meter\"/>", 6},
     {"millimetre", 0.001, "<Metric linearUnit=\"millimeter\"/>", 4},
     {"foot", 0.3048, "<Imperial linearUnit=\"foot\"/>", 2},
     {"US survey foot", 1200.0 / 3937.0, "<Imperial linearUnit=\"USSurveyFoot\"/>", 21}}};

inline std::string words(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : " ") + number_text(number);
  return text;
}

inline std::string land_xml(const PlainMesh& mesh, const FileUnit& unit) {
  std::string text = "<?xml version=\"1.0\"?>\n<LandXML version=\"1.2\">\n<Units>" +
                     std::string(unit.land_xml) +
                     "</Units>\n<Surfaces>\n<Surface name=\"trench\">\n<Definition "
                     "surfType=\"TIN\">\n<Pnts>\n";
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Eigen::Vector3d& p = mesh.points[i];
    text +=
        "<P id=\"" + std::to_string(10 + 7 * i) + "\">" + words({p.y(), p.x(), p.z()}) + "</P>\n";
  }
  text += "</Pnts>\n<Faces>\n";
  for (const auto& f : mesh.triangles) {
    text += "<F>" + words({10.0 + 7 * f[0], 10.0 + 7 * f[1], 10.0 + 7 * f[2]}) + "</F>\n";
  }
  return text + "</Faces>\n</Definition>\n</Surface>\n</Surfaces>\n</LandXML>\n";
}

inline std::string group(int code, const std::string& value) {
  return "  " + std::to_string(code) + "\n" + value + "\n";
}
inline std::string dxf_place(const Eigen::Vector3d& p, int corner) {
  return group(10 + corner, number_text(p.x())) + group(20 + corner, number_text(p.y())) +
         group(30 + corner, number_text(p.z()));
}
inline std::string dxf(const std::string& entities, int unit, const std::string& blocks = "") {
  return group(0, "SECTION") + group(2, "HEADER") + group(9, "$INSUNITS") +
         group(70, std::to_string(unit)) + group(0, "ENDSEC") + group(0, "SECTION") +
         group(2, "BLOCKS") + blocks + group(0, "ENDSEC") + group(0, "SECTION") +
         group(2, "ENTITIES") + entities + group(0, "ENDSEC") + group(0, "EOF");
}
inline std::string dxf_faces(const PlainMesh& mesh) {
  std::string text;
  for (const auto& f : mesh.triangles) {
    text += group(0, "3DFACE") + group(8, "0");
    for (int corner = 0; corner < 4; ++corner) {
      text += dxf_place(mesh.points[f[static_cast<std::size_t>(std::min(corner, 2))]], corner);
    }
  }
  return text;
}
inline std::string dxf_polyface(const PlainMesh& mesh) {
  std::string text = group(0, "POLYLINE") + group(8, "0") + group(70, "64") + group(71, "3");
  for (const Eigen::Vector3d& p : mesh.points) {
    text += group(0, "VERTEX") + group(8, "0") + dxf_place(p, 0) + group(70, "192");
  }
  for (const auto& f : mesh.triangles) {
    text += group(0, "VERTEX") + group(8, "0") + dxf_place({0, 0, 0}, 0) + group(70, "128") +
            group(71, std::to_string(f[0] + 1)) + group(72, "-" + std::to_string(f[1] + 1)) +
            group(73, std::to_string(f[2] + 1));
  }
  return text + group(0, "SEQEND");
}

inline std::string ply_head(const PlainMesh& mesh, const std::string& encoding) {
  return "ply\nformat " + encoding + " 1.0\nelement vertex " + std::to_string(mesh.points.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
         std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\n" +
         "end_header\n";
}
inline std::string ply_text(const PlainMesh& mesh) {
  std::string text = ply_head(mesh, "ascii");
  for (const Eigen::Vector3d& p : mesh.points) text += words({p.x(), p.y(), p.z()}) + "\n";
  for (const auto& f : mesh.triangles) {
    text += words({3.0, 1.0 * f[0], 1.0 * f[1], 1.0 * f[2]}) + "\n";
  }
  return text;
}
inline std::string ply_binary(const PlainMesh& mesh) {
  std::string bytes = ply_head(mesh, "binary_little_endian");
  for (const Eigen::Vector3d& p : mesh.points) {
    for (const double number : p) put(number, bytes);
  }
  for (const auto& f : mesh.triangles) {
    put(std::uint8_t{3}, bytes);
    for (const std::uint32_t corner : f) put(static_cast<std::int32_t>(corner), bytes);
  }
  return bytes;
}
inline std::string obj(const PlainMesh& mesh) {
  std::string text = "# a trench\no trench\n";
  for (const Eigen::Vector3d& p : mesh.points) text += "v " + words({p.x(), p.y(), p.z()}) + "\n";
  for (const auto& f : mesh.triangles) {
    text += "f " + std::to_string(f[0] + 1) + "/1/1 " + std::to_string(f[1] + 1) + " -" +
            std::to_string(mesh.points.size() - f[2]) + "\n";
  }
  return text;
}
inline std::string stl_text(const PlainMesh& mesh) {
  std::string text = "solid trench\n";
  for (const auto& f : mesh.triangles) {
    text += "facet normal 0 0 1\n outer loop\n";
    for (const std::uint32_t corner : f) {
      const Eigen::Vector3d& p = mesh.points[corner];
      text += "  vertex " + words({p.x(), p.y(), p.z()}) + "\n";
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid trench\n";
}
inline std::string stl_binary(const PlainMesh& mesh) {
  std::string bytes(80, ' ');
  put(static_cast<std::uint32_t>(mesh.triangles.size()), bytes);
  for (const auto& f : mesh.triangles) {
    bytes.append(12, '\0');
    for (const std::uint32_t corner : f) {
      for (const double number : mesh.points[corner]) put(static_cast<float>(number), bytes);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

/// A map as the file of an ending, its lengths in this unit.
inline std::string raster(HeightMap map, const std::string& ending, double unit) {
  map.origin /= unit;
  map.cell_size /= unit;
  map.z /= unit;
  const std::string path =
      testing::TempDir() + "excavplan_raster_" + std::to_string(::getpid()) + "." + ending;
  write_map(path, {map, {{"height_m", "height", map.z}}});
  const std::string content = content_of(path);
  std::filesystem::remove(path);
  return content;
}

}  // namespace excavplan::test
