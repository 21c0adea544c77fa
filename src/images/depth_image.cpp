// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/images/depth_image.hpp>

#include <cmath>
#include <cstdint>
#include <string>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "base/statistics.hpp"
#include "base/table.hpp"
#include "base/text.hpp"
#include "images/depth_png.hpp"

namespace excavplan {
namespace {

void require_valid(const DepthIntrinsics& intrinsics) {
  const auto require = [](bool holds, const char* name, double value, const char* rule) {
    excavplan::require(holds && std::isfinite(value), std::string("depth image: ") + name, value,
                       rule);
  };
  require(intrinsics.fx > 0.0, "fx", intrinsics.fx, "> 0");
  require(intrinsics.fy > 0.0, "fy", intrinsics.fy, "> 0");
  require(true, "cx", intrinsics.cx, "finite");
  require(true, "cy", intrinsics.cy, "finite");
  require(intrinsics.depth_unit > 0.0, "depth_unit", intrinsics.depth_unit, "> 0");
  require(intrinsics.min_depth >= 0.0, "min_depth", intrinsics.min_depth, ">= 0");
  require(intrinsics.max_depth > intrinsics.min_depth, "max_depth", intrinsics.max_depth,
          "> min_depth");
}

/// Refuses bad intrinsics once, then turns counts into depths and pixels into points.
class Camera {
 public:
  explicit Camera(const DepthIntrinsics& intrinsics) : intrinsics_(intrinsics) {
    require_valid(intrinsics);
  }
  bool sees(std::uint16_t count) const {
    const double z = count * intrinsics_.depth_unit;
    return count > 0 && z >= intrinsics_.min_depth && z <= intrinsics_.max_depth;
  }
  Eigen::Vector3d point(double u, double v, double z) const {
    return {(u - intrinsics_.cx) / intrinsics_.fx * z, (v - intrinsics_.cy) / intrinsics_.fy * z,
            z};
  }
  Eigen::Vector3d point_of_counts(double u, double v, double counts) const {
    return point(u, v, counts * intrinsics_.depth_unit);
  }

 private:
  DepthIntrinsics intrinsics_;
};

void require_size(const DepthPng& image, const std::string& path, std::size_t width,
                  std::size_t height, const std::string& as_in) {
  if (image.width == width && image.height == height) return;
  throw Error(ErrorKind::bad_file, path + ": found " + std::to_string(image.width) + " x " +
                                       std::to_string(image.height) + " pixels, expected " +
                                       std::to_string(width) + " x " + std::to_string(height) +
                                       " as in " + as_in);
}

std::vector<DepthPng> read_frames(const std::vector<std::string>& paths,
                                  const DepthIntrinsics& intrinsics) {
  constexpr std::size_t most_frames = 10000;
  constexpr std::size_t most_pixels = 500000000;  // of all frames, which are held at once; ours
  if (paths.empty() || paths.size() > most_frames) {
    throw Error(ErrorKind::bad_input,
                "depth images: " + std::to_string(paths.size()) + " frames, must be 1 to 10000");
  }
  std::vector<DepthPng> frames;
  for (const std::string& path : paths) {
    frames.push_back(read_depth_png(path));
    const DepthPng& first = frames.front();
    require_size(frames.back(), path, first.width, first.height, paths.front());
    if (intrinsics.width > 0) {
      require_size(frames.back(), path, static_cast<std::size_t>(intrinsics.width),
                   static_cast<std::size_t>(intrinsics.height), "the intrinsics");
    }
    if (paths.size() * first.pixels() > most_pixels) {
      throw Error(ErrorKind::bad_input, "depth images: " + std::to_string(paths.size()) +
                                            " frames of " + std::to_string(first.pixels()) +
                                            " pixels, must be at most " +
                                            std::to_string(most_pixels) + " in all");
    }
  }
  return frames;
}

}  // namespace

Cloud depth_image_to_cloud(const std::string& image_path, const DepthIntrinsics& intrinsics) {
  return average_depth_images({image_path}, intrinsics).cloud;
}

AveragedDepth average_depth_images(const std::vector<std::string>& image_paths,
                                   const DepthIntrinsics& intrinsics) {
  const Camera camera(intrinsics);
  const std::vector<DepthPng> frames = read_frames(image_paths, intrinsics);
  const DepthPng& first = frames.front();
  AveragedDepth average;
  average.cloud.width = first.width;
  average.cloud.height = first.height;
  average.cloud.points.reserve(first.pixels());
  average.frames.reserve(first.pixels());
  std::vector<double> counts;
  for (std::size_t pixel = 0; pixel < first.pixels(); ++pixel) {
    counts.clear();
    for (const DepthPng& frame : frames) {
      const std::uint16_t count = frame.count(pixel);
      if (camera.sees(count)) counts.push_back(count);
    }
    const RobustMean mean = robust_mean(counts, 1.0);
    const bool is_known =
        mean.count > 0 && 2 * static_cast<std::size_t>(mean.count) >= frames.size();
    const auto column = static_cast<double>(pixel % first.width);
    const auto line = pixel / first.width;
    const auto row = static_cast<double>(line);
    average.frames.push_back(is_known ? mean.count : 0);
    average.cloud.points.push_back(is_known ? camera.point_of_counts(column, row, mean.value)
                                            : Eigen::Vector3d::Constant(nan));
  }
  return average;
}

Eigen::Vector3d point_at_pixel(const Cloud& cloud, const DepthIntrinsics& intrinsics, double u,
                               double v) {
  const Camera camera(intrinsics);
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorKind::bad_input,
                "pixel (" + number_text(u) + ", " + number_text(v) + ") " + what);
  };
  const auto width = static_cast<double>(cloud.width);
  const auto height = static_cast<double>(cloud.height);
  if (width * height != static_cast<double>(cloud.points.size())) {
    refuse("is of a cloud whose width x height is not the number of its points");
  }
  if (!(u >= -0.5 && u < width - 0.5 && v >= -0.5 && v < height - 0.5)) {
    refuse("is outside the image of " + std::to_string(cloud.width) + " x " +
           std::to_string(cloud.height));
  }
  std::vector<double> depths;
  for (double row = std::round(v) - 2.0; row <= std::round(v) + 2.0; ++row) {
    for (double column = std::round(u) - 2.0; column <= std::round(u) + 2.0; ++column) {
      if (row < 0.0 || column < 0.0 || row >= height || column >= width) continue;
      const double z = cloud.points[static_cast<std::size_t>(row * width + column)].z();
      if (std::isfinite(z)) depths.push_back(z);
    }
  }
  if (depths.size() < 3) {
    refuse("has " + std::to_string(depths.size()) +
           " pixels with a depth within 2 of it, must be 3 or more");
  }
  return camera.point(u, v, mean_median(depths));
}

KnownPoints read_known_points(const std::string& path, const Cloud& cloud,
                              const DepthIntrinsics& intrinsics) {
  const Table table = Table::read(path);
  if (!table.has("u_px")) return read_known_points(path);
  KnownPoints points;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto value = [&](const char* name) { return table.column(name)[i]; };
    points.in_scan.push_back(point_at_pixel(cloud, intrinsics, value("u_px"), value("v_px")));
    points.in_site.emplace_back(value("x_m"), value("y_m"), value("z_m"));
  }
  return points;
}

}  // namespace excavplan
