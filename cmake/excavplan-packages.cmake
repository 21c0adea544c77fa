# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# Debian packages by `cpack` in the build folder: excavplan (tools, data, shared libraries),
# excavplan-paper (what needs PCL), libexcavplan-dev (headers, libraries to link, CMake and pkg-config
# files), python3-excavplan and excavplan-doc.
# scripts/packages makes them in a way that gives the same bytes again.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME excavplan)
set(CPACK_PACKAGE_VENDOR "The excavplan authors")
set(CPACK_PACKAGE_CONTACT "The excavplan authors <excavplan@example.org>")  # no mail is read
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own, the first line of its text
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL Runtime Development Documentation)
set(CPACK_COMPONENTS_GROUPING IGNORE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME excavplan)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS fonts-dejavu-core)  # texts of --plot F.png, F.pdf
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
"soil-adaptive planning of excavation - command line tools
Estimates the density of the ground from scans of a dig and plans the next dig of an excavator.
With machines, soils, laws and path libraries.")

if(TARGET estimate-density-paper)
  list(APPEND CPACK_COMPONENTS_ALL Paper)
  set(CPACK_DEBIAN_PAPER_PACKAGE_NAME excavplan-paper)
  set(CPACK_DEBIAN_PAPER_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PAPER_PACKAGE_DEPENDS "excavplan (= ${PROJECT_VERSION})")  # data
  set(CPACK_COMPONENT_PAPER_DESCRIPTION
"soil-adaptive planning of excavation - the paper's own method
estimate-density-paper, which is estimate-density with --method paper, by the Point Cloud Library.")
endif()

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libexcavplan-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
string(CONCAT CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "excavplan (= ${PROJECT_VERSION}), "  # data
  "libeigen3-dev, libnlopt-dev, libnlopt-cxx-dev, libpng-dev, zlib1g-dev, libexpat1-dev, libsqlite3-dev, liblz4-dev, libzstd-dev, "
  "libbz2-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS  # excavplan::figures, excavplan::paper
  "libcairo2-dev, libfontconfig-dev, libpcl-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"soil-adaptive planning of excavation - C++ development files
Headers, static libraries, CMake and pkg-config files.")

if(TARGET excavplan_python)
  list(APPEND CPACK_COMPONENTS_ALL Python)
  set(next_minor ${Python_VERSION_MINOR})
  math(EXPR next_minor "${next_minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-excavplan)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  string(CONCAT CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "excavplan (= ${PROJECT_VERSION}), "
    "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), "
    "python3 (<< ${Python_VERSION_MAJOR}.${next_minor})")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-numpy)
  # Without them an import as root leaves files that no package removes.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
    ${PROJECT_SOURCE_DIR}/cmake/debian/postinst ${PROJECT_SOURCE_DIR}/cmake/debian/prerm)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"soil-adaptive planning of excavation - Python 3 module
The C++ library of excavplan for Python: import excavplan.")
endif()

set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_NAME excavplan-doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_RECOMMENDS excavplan)  # what the guide runs, and its data
set(CPACK_COMPONENT_DOCUMENTATION_DESCRIPTION
"soil-adaptive planning of excavation - documentation
The guide, methods, formats and examples.")

# Copyright and changelog where the Debian policy (12.5, 12.7) wants them; in no other install.
string(TIMESTAMP today "%a, %d %b %Y %H:%M:%S +0000" UTC)  # heeds SOURCE_DATE_EPOCH
file(WRITE ${PROJECT_BINARY_DIR}/changelog "excavplan (${PROJECT_VERSION}) unstable; urgency=medium

  * Version ${PROJECT_VERSION}; what changed is in CHANGELOG.md of excavplan-doc.

 -- ${CPACK_PACKAGE_CONTACT}  ${today}
")
set(changelog ${PROJECT_BINARY_DIR}/changelog.gz)
execute_process(COMMAND gzip -9nc ${PROJECT_BINARY_DIR}/changelog OUTPUT_FILE ${changelog})
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} key)
  set(folder ${CMAKE_INSTALL_DATAROOTDIR}/doc/${CPACK_DEBIAN_${key}_PACKAGE_NAME})
  install(FILES .reuse/dep5 DESTINATION ${folder} RENAME copyright COMPONENT ${component}
    EXCLUDE_FROM_ALL)
  install(FILES ${changelog} DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()

include(CPack)
