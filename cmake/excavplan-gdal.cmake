# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# GeoTIFF by GDAL, in a build where its headers are found and EXCAVPLAN_WITH_GDAL is ON. Its library
# is loaded by name when a GeoTIFF is written and not linked: that alone would take some 60 ms at
# every start of a tool.

option(EXCAVPLAN_WITH_GDAL "Write GeoTIFF by GDAL, where it is found" ON)
find_path(EXCAVPLAN_GDAL_INCLUDE gdal.h PATH_SUFFIXES gdal)
find_library(EXCAVPLAN_GDAL_LIBRARY gdal)
mark_as_advanced(EXCAVPLAN_GDAL_INCLUDE EXCAVPLAN_GDAL_LIBRARY)
if(EXCAVPLAN_WITH_GDAL AND EXCAVPLAN_GDAL_INCLUDE AND EXCAVPLAN_GDAL_LIBRARY)
  file(REAL_PATH ${EXCAVPLAN_GDAL_LIBRARY} file)
  string(REGEX MATCH "libgdal\\.so(\\.[0-9]+)?" name ${file})  # that of its interface
  set_source_files_properties(src/ground/geotiff.cpp PROPERTIES
    COMPILE_DEFINITIONS EXCAVPLAN_WITH_GDAL="${name}"
    COMPILE_OPTIONS "-isystem;${EXCAVPLAN_GDAL_INCLUDE}")
elseif(EXCAVPLAN_WITH_GDAL)
  message(STATUS "excavplan::planning without GDAL, which was not found: no GeoTIFF")
endif()
