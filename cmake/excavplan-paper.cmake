# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# excavplan::paper, the paper's own way to measure volumes, where PCL is found (AUTO), always (ON) or
# never (OFF).

option(EXCAVPLAN_PAPER_APART
  "Link excavplan::paper to a tool of its own, estimate-density-paper, and not to estimate-density" OFF)
set(EXCAVPLAN_PCL AUTO CACHE STRING "Build excavplan::paper on PCL: AUTO, ON or OFF")
set_property(CACHE EXCAVPLAN_PCL PROPERTY STRINGS AUTO ON OFF)
if(NOT EXCAVPLAN_PCL)
  return()
endif()
set(required QUIET)
if(NOT EXCAVPLAN_PCL STREQUAL "AUTO")
  set(required REQUIRED)
endif()
find_package(PCL 1.12 ${required} COMPONENTS common kdtree octree search sample_consensus filters)
if(NOT TARGET pcl_filters)
  message(STATUS "without excavplan::paper and --method paper, which need PCL (libpcl-dev)")
  return()
endif()

excavplan_library(paper paper)
# Named targets, not ${PCL_LIBRARIES}: that would write some fifty foreign names into our package.
# Never pcl_io: it loads VTK and 73 shared libraries.
target_link_libraries(excavplan_paper
  PUBLIC excavplan_survey
  PRIVATE pcl_common pcl_octree pcl_search pcl_filters)
# For programs that do without it.
target_compile_definitions(excavplan_paper INTERFACE $<BUILD_INTERFACE:EXCAVPLAN_PAPER>)
if(NOT EXCAVPLAN_PAPER_APART)
  set(excavplan_paper excavplan_paper)
endif()
