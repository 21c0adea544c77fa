# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# Where programs, libraries and data lie relative to each other. Nothing else is compiled in, so an
# installation can move. The build tree is laid out as an installation is: bin beside share.

set(excavplan_data ${CMAKE_INSTALL_FULL_DATADIR}/excavplan)
file(RELATIVE_PATH excavplan_data_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${excavplan_data})
file(RELATIVE_PATH excavplan_data_from_lib ${CMAKE_INSTALL_FULL_LIBDIR} ${excavplan_data})
set(EXCAVPLAN_PYTHON_DIR . CACHE STRING
  "Where the component Python is installed, relative to the prefix: lib/python3/dist-packages of a system")
file(RELATIVE_PATH excavplan_data_from_module
  ${CMAKE_INSTALL_PREFIX}/${EXCAVPLAN_PYTHON_DIR}/excavplan ${excavplan_data})
file(RELATIVE_PATH excavplan_lib_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
if(BUILD_SHARED_LIBS)
  set(CMAKE_INSTALL_RPATH $ORIGIN $ORIGIN/${excavplan_lib_from_bin})
endif()

cmake_path(SET link NORMALIZE ${PROJECT_BINARY_DIR}/bin/${excavplan_data_from_bin})
cmake_path(GET link PARENT_PATH link_folder)
file(MAKE_DIRECTORY ${link_folder})
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/data ${link} SYMBOLIC)
