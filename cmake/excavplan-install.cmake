# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# Installs the libraries as components of find_package(excavplan), the pkg-config files and the data.
# Of cmake --install, the component Runtime is what programs need (tools, data, shared libraries),
# Development what compiling against the libraries needs beside it.

include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/excavplan)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH pkgconfig_prefix ${CMAKE_INSTALL_PREFIX}/${pkgconfig_dir} ${CMAKE_INSTALL_PREFIX})

# excavplan_install(NAME SUMMARY text REQUIRES_PUBLIC packages... REQUIRES packages... LINKS flags...
# RUNTIME component): library, headers, CMake targets and pkg-config file of one component. Compiling
# against it needs the pkg-config packages REQUIRES_PUBLIC, linking also REQUIRES and LINKS. A shared
# library is installed with RUNTIME, by default Runtime.
function(excavplan_install name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "SUMMARY;RUNTIME" "REQUIRES_PUBLIC;REQUIRES;LINKS")
  if(NOT arg_RUNTIME)
    set(arg_RUNTIME Runtime)
  endif()
  install(TARGETS excavplan_${name} EXPORT excavplan-${name}-targets
    LIBRARY COMPONENT ${arg_RUNTIME} NAMELINK_COMPONENT Development
    ARCHIVE COMPONENT Development
    FILE_SET HEADERS COMPONENT Development)
  install(EXPORT excavplan-${name}-targets NAMESPACE excavplan:: DESTINATION ${package_dir}
    COMPONENT Development)

  set(library excavplan_${name})
  set(summary ${arg_SUMMARY})
  list(JOIN arg_REQUIRES_PUBLIC " " requires)
  list(JOIN arg_REQUIRES " " requires_private)
  list(JOIN arg_LINKS " " links_private)
  set(links "")
  if(NOT BUILD_SHARED_LIBS)  # a static library needs them at every link, not only with --static
    string(APPEND requires " ${requires_private}")
    set(requires_private "")
    set(links ${links_private})
    set(links_private "")
  endif()
  configure_file(${PROJECT_SOURCE_DIR}/cmake/excavplan.pc.in excavplan-${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/excavplan-${name}.pc DESTINATION ${pkgconfig_dir}
    COMPONENT Development)
endfunction()

excavplan_install(planning
  SUMMARY "Soil, machine, simulation and planning of digs"
  REQUIRES_PUBLIC eigen3 REQUIRES nlopt LINKS -lpthread -ldl)
excavplan_install(clouds
  SUMMARY "Point clouds in and out, height maps, terrain and efficiency from them"
  REQUIRES_PUBLIC excavplan-planning REQUIRES zlib)
excavplan_install(design
  SUMMARY "Design surfaces of jobs, their cut and fill"
  REQUIRES_PUBLIC excavplan-clouds REQUIRES expat)
get_target_property(recordings_links excavplan_recordings EXCAVPLAN_LINKS)
if(NOT recordings_links)
  set(recordings_links "")
endif()
excavplan_install(recordings
  SUMMARY "Scans from rosbag2, MCAP and ROS 1 recordings"
  REQUIRES_PUBLIC excavplan-clouds REQUIRES excavplan-images LINKS ${recordings_links})
excavplan_install(images
  SUMMARY "Clouds from depth images"
  REQUIRES_PUBLIC excavplan-clouds REQUIRES libpng)
excavplan_install(survey
  SUMMARY "Density from scans, and experiments"
  REQUIRES_PUBLIC excavplan-clouds)
excavplan_install(jobs
  SUMMARY "A whole job from its design, and its trial against hidden truth"
  REQUIRES_PUBLIC excavplan-survey excavplan-design)
if(TARGET excavplan_paper)
  set(runtime Runtime)
  if(EXCAVPLAN_PAPER_APART)
    set(runtime Paper)
  endif()
  excavplan_install(paper
    SUMMARY "The paper's own way to measure volumes"
    REQUIRES_PUBLIC excavplan-survey
    REQUIRES pcl_filters pcl_search pcl_octree pcl_common
    RUNTIME ${runtime})
endif()
excavplan_install(results
  SUMMARY "Results as JSON, and as maps of the ground"
  REQUIRES_PUBLIC excavplan-jobs excavplan-recordings)
set(requires "")
if(excavplan_with_cairo)
  set(requires cairo fontconfig)
endif()
excavplan_install(figures
  SUMMARY "Results as figures"
  REQUIRES_PUBLIC excavplan-results REQUIRES ${requires})
excavplan_install(robot
  SUMMARY "Dig cycle and job of a robot from its messages"
  REQUIRES_PUBLIC excavplan-jobs REQUIRES excavplan-recordings excavplan-results)

configure_package_config_file(cmake/excavplan-config.cmake.in excavplan-config.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(excavplan-config-version.cmake COMPATIBILITY SameMinorVersion)
install(
  FILES
    ${PROJECT_BINARY_DIR}/excavplan-config.cmake
    ${PROJECT_BINARY_DIR}/excavplan-config-version.cmake
  DESTINATION ${package_dir} COMPONENT Development)
install(DIRECTORY data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/excavplan COMPONENT Runtime)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT Runtime)
# Beside the documents the folder data, to which they refer, as in a clone.
file(RELATIVE_PATH data_from_documents ${CMAKE_INSTALL_FULL_DOCDIR} ${excavplan_data})
set(data_link ${PROJECT_BINARY_DIR}/documents/data)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/documents)
file(CREATE_LINK ${data_from_documents} ${data_link} SYMBOLIC)
install(FILES README.md CONTRIBUTING.md CHANGELOG.md SECURITY.md ${data_link}
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT Documentation)
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT Documentation
  PATTERN "Doxyfile.in" EXCLUDE)

# What `cmake --install` wrote, as it lists that itself.
if(PROJECT_IS_TOP_LEVEL)
  add_custom_target(uninstall COMMAND ${CMAKE_COMMAND}
    -D BUILD=${PROJECT_BINARY_DIR}
    -P ${PROJECT_SOURCE_DIR}/cmake/excavplan-uninstall.cmake)
endif()
