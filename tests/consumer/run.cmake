# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.24)

# Installs BUILD into WORK, then builds and runs the foreign project beside this file against that
# installation: through CMake and, where there is one, through pkg-config.

function(run)
  execute_process(COMMAND ${ARGV} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\n${output}\nended with ${result}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(check_program program)
  run(${CMAKE_COMMAND} -E env EXCAVPLAN_DATA=${WORK}/prefix/share/excavplan ${program})
  message(STATUS "${program}: ${output}")
  run(ldd ${program})
  if(output MATCHES "libpcl|libopencv|libvtk|libboost")
    message(FATAL_ERROR "${program} must load neither PCL nor OpenCV:\n${output}")
  endif()
endfunction()

# The README shows this program: to the letter.
file(READ ${CMAKE_CURRENT_LIST_DIR}/main.cpp program)
string(FIND "${program}" "#include" start)
string(SUBSTRING "${program}" ${start} -1 program)
file(READ ${CMAKE_CURRENT_LIST_DIR}/../../README.md readme)
string(FIND "${readme}" "${program}" shown)
if(shown EQUAL -1)
  message(FATAL_ERROR "README.md does not show tests/consumer/main.cpp as it is")
endif()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build
  -D CMAKE_PREFIX_PATH=${WORK}/prefix -D CMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${FLAGS}")
file(STRINGS ${WORK}/build/CMakeCache.txt heavy REGEX "^(PCL|OpenCV)_DIR")
if(heavy)
  message(FATAL_ERROR "the component planning must not look for PCL or OpenCV: ${heavy}")
endif()
run(${CMAKE_COMMAND} --build ${WORK}/build)
check_program(${WORK}/build/controller)

find_program(pkg_config NAMES pkg-config pkgconf)
if(pkg_config)
  run(${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${WORK}/prefix/${LIBDIR}/pkgconfig
    ${pkg_config} --cflags --libs excavplan-planning)
  separate_arguments(flags UNIX_COMMAND "${FLAGS} ${output}")
  run(${CXX} -std=c++17 ${CMAKE_CURRENT_LIST_DIR}/main.cpp ${flags} -o ${WORK}/by-pkg-config)
  check_program(${WORK}/by-pkg-config)
endif()
