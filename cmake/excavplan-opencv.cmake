# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# Targets opencv_core and opencv_imgcodecs, also where only the packages of these two modules are
# installed: on Debian OpenCV's own CMake package comes with libopencv-dev alone, which is 1 GB.
# Sets OpenCV_FOUND.

find_package(OpenCV 4 QUIET CONFIG COMPONENTS core imgcodecs)
if(NOT TARGET opencv_core)
  find_path(EXCAVPLAN_OPENCV_INCLUDE opencv2/imgcodecs.hpp PATH_SUFFIXES opencv4)
  find_library(EXCAVPLAN_OPENCV_CORE opencv_core)
  find_library(EXCAVPLAN_OPENCV_IMGCODECS opencv_imgcodecs)
  mark_as_advanced(EXCAVPLAN_OPENCV_INCLUDE EXCAVPLAN_OPENCV_CORE EXCAVPLAN_OPENCV_IMGCODECS)
  include(FindPackageHandleStandardArgs)
  find_package_handle_standard_args(OpenCV NAME_MISMATCHED
    REASON_FAILURE_MESSAGE "install its modules core and imgcodecs"
    REQUIRED_VARS EXCAVPLAN_OPENCV_CORE EXCAVPLAN_OPENCV_IMGCODECS EXCAVPLAN_OPENCV_INCLUDE)
  if(OpenCV_FOUND)
    add_library(opencv_core UNKNOWN IMPORTED)
    set_target_properties(opencv_core PROPERTIES
      IMPORTED_LOCATION ${EXCAVPLAN_OPENCV_CORE}
      INTERFACE_INCLUDE_DIRECTORIES ${EXCAVPLAN_OPENCV_INCLUDE})
    add_library(opencv_imgcodecs UNKNOWN IMPORTED)
    set_target_properties(opencv_imgcodecs PROPERTIES
      IMPORTED_LOCATION ${EXCAVPLAN_OPENCV_IMGCODECS}
      INTERFACE_LINK_LIBRARIES opencv_core)
  endif()
endif()
