# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.24)

# An installation that has moved, used by a foreign project: installs BUILD, a build of SOURCE of
# this TYPE with libraries (SHARED or not) in LIBDIR; moves it, builds PROGRAM against it with CMake
# and, where there is one, with pkg-config; runs these programs and a tool. They see neither the
# environment nor, where the system allows to hide them, SOURCE and BUILD.

function(run)
  execute_process(COMMAND ${ARGV} WORKING_DIRECTORY /
    OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\n${output}\nended with ${result}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# A mount namespace in which both folders are empty.
set(hidden unshare --map-root-user --mount
  sh -c "mount -t tmpfs none '${SOURCE}' && { test ! -e '${BUILD}' || mount -t tmpfs none '${BUILD}'; } && exec \"$@\"" sh)
execute_process(COMMAND ${hidden} true RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
if(NOT result EQUAL 0)
  message(STATUS "no mount namespaces here: ${SOURCE} and ${BUILD} stay in sight")
  set(hidden "")
endif()

# alone(PREFIX words...): runs a program with the libraries of PREFIX.
function(alone prefix)
  run(${hidden} env -i LD_LIBRARY_PATH=${prefix}/${LIBDIR} ${ARGN})
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(check_program program)
  alone(${WORK}/moved ${program})
  message(STATUS "${program}: ${output}")
  if(NOT output MATCHES "boom")
    message(FATAL_ERROR "${program} planned nothing")
  endif()
  run(env LD_LIBRARY_PATH=${WORK}/moved/${LIBDIR} ldd ${program})
  if(output MATCHES "libpcl|libopencv|libvtk|libboost|libsqlite3|liblz4|libzstd|libbz2")
    message(FATAL_ERROR "${program} must load neither PCL nor OpenCV nor what recordings need:\n${output}")
  endif()
endfunction()

# The tools find their libraries by themselves; one that reads no scans loads none for recordings.
function(check_tool prefix)
  run(${hidden} env -i ${prefix}/bin/plan-path --density 40 --json --quiet)
  if(NOT output MATCHES "\"source\": *\"library\"")
    message(FATAL_ERROR "${prefix}/bin/plan-path: ${output}")
  endif()
  run(ldd ${prefix}/bin/build-path-library)
  if(output MATCHES "libsqlite3|liblz4|libzstd|libbz2")
    message(FATAL_ERROR "${prefix}/bin/build-path-library:\n${output}")
  endif()
endfunction()

# ---- The README shows this program to the letter.
file(READ ${PROGRAM} program)
string(FIND "${program}" "#include" start)
string(SUBSTRING "${program}" ${start} -1 program)
file(READ ${SOURCE}/README.md readme)
string(FIND "${readme}" "${program}" shown)
if(shown EQUAL -1)
  message(FATAL_ERROR "README.md does not show ${PROGRAM} as it is")
endif()

# ---- Install: the two components are all there is.
string(SHA1 name ${BUILD})
set(WORK /tmp/excavplan-consumer-${name})
file(REMOVE_RECURSE ${WORK})
file(GLOB manifests ${BUILD}/install_manifest*.txt)  # of installations that are no test
file(COPY ${manifests} DESTINATION ${WORK}/manifests-before)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/first --component Runtime)
check_tool(${WORK}/first)
if(EXISTS ${WORK}/first/include OR EXISTS ${WORK}/first/${LIBDIR}/cmake)
  message(FATAL_ERROR "headers or CMake files are in the component Runtime")
endif()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/first --component Development)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/rest --component Unspecified)
if(EXISTS ${WORK}/rest)
  message(FATAL_ERROR "some files are in neither Runtime nor Development: see ${WORK}/rest")
endif()

# ---- `uninstall` removes all that the components brought, and nothing else: tried on a copy.
file(GLOB manifests ${BUILD}/install_manifest*.txt)
file(COPY ${manifests} DESTINATION ${WORK}/manifests)
file(REMOVE ${manifests})
file(GLOB manifests ${WORK}/manifests-before/*)
file(COPY ${manifests} DESTINATION ${BUILD})
file(COPY ${WORK}/first DESTINATION ${WORK}/copy${WORK})
file(WRITE ${WORK}/copy${WORK}/first/share/excavplan/soils/own.json "{}")
run(env DESTDIR=${WORK}/copy ${CMAKE_COMMAND} -D BUILD=${WORK}/manifests
  -P ${SOURCE}/cmake/excavplan-uninstall.cmake)
file(GLOB_RECURSE left RELATIVE ${WORK}/copy${WORK}/first ${WORK}/copy/*)
if(NOT left STREQUAL "share/excavplan/soils/own.json")
  message(FATAL_ERROR "after uninstall there is: ${left}")
endif()

# ---- Nothing in it knows where it was built (but debug information), and shared libraries export
# excavplan alone.
execute_process(COMMAND grep -rlF -e ${BUILD}/ -e ${SOURCE}/include -e ${SOURCE}/src -e ${SOURCE}/data
    -e ${SOURCE}/tools -e ${WORK} ${WORK}/first OUTPUT_VARIABLE output RESULT_VARIABLE result)
if(TYPE STREQUAL "Release" AND NOT result EQUAL 1)
  message(FATAL_ERROR "these name the folder they were built in:\n${output}")
endif()
if(SHARED)
  file(GLOB libraries ${WORK}/first/${LIBDIR}/libexcavplan*.so)
  foreach(library IN LISTS libraries)
    run(nm --dynamic --demangle --defined-only ${library})
    string(REGEX MATCHALL "[^\n]+" symbols "${output}")
    list(FILTER symbols EXCLUDE REGEX
      "^[0-9a-f]+ [A-Za-z] (typeinfo for |typeinfo name for |vtable for )?excavplan::")
    if(symbols)
      message(FATAL_ERROR "${library} exports what is not excavplan's:\n${symbols}")
    endif()
    run(objdump -p ${library})
    if(NOT output MATCHES "SONAME +libexcavplan_[a-z]+\\.so\\.[0-9]")
      message(FATAL_ERROR "${library} has no SONAME with a version")
    endif()
  endforeach()
endif()

# ---- Move it, build against it and run.
file(RENAME ${WORK}/first ${WORK}/moved)
check_tool(${WORK}/moved)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -D PROGRAM=${PROGRAM}
  -D CMAKE_PREFIX_PATH=${WORK}/moved -D CMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${FLAGS}")
file(STRINGS ${WORK}/build/CMakeCache.txt heavy REGEX "^(PCL|OpenCV)_DIR")
if(heavy)
  message(FATAL_ERROR "the component planning must not look for PCL or OpenCV: ${heavy}")
endif()
run(${CMAKE_COMMAND} --build ${WORK}/build)
check_program(${WORK}/build/controller)

# ---- The examples are a project of their own.
run(${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${WORK}/examples
  -D CMAKE_PREFIX_PATH=${WORK}/moved -D CMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK}/examples --target 04_own_simulator)
alone(${WORK}/moved ${WORK}/examples/04_own_simulator)

# ---- A simulator as a shared library, of the installed header alone.
run(${CMAKE_COMMAND} -S ${SOURCE}/examples/simulator_plugin -B ${WORK}/plugin
  -D EXCAVPLAN_INCLUDE=${WORK}/moved/include)
run(${CMAKE_COMMAND} --build ${WORK}/plugin)
alone(${WORK}/moved ${WORK}/moved/bin/simulate-dig --density 40
  --simulator ${WORK}/plugin/libcutting_resistance.so)
if(NOT output MATCHES "payload +[0-9]+ kg")
  message(FATAL_ERROR "simulate-dig with the plug-in: ${output}")
endif()

find_program(pkg_config NAMES pkg-config pkgconf)
if(pkg_config)
  run(${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${WORK}/moved/${LIBDIR}/pkgconfig
    ${pkg_config} --cflags --libs excavplan-planning)
  # As a shell splits $(pkg-config ...): at spaces, quotes are left as they are.
  string(STRIP "${output}" output)
  separate_arguments(output)
  separate_arguments(flags UNIX_COMMAND "${FLAGS}")
  run(${CXX} -std=c++17 ${flags} ${PROGRAM} ${output} -o ${WORK}/by-pkg-config)
  check_program(${WORK}/by-pkg-config)
endif()

# ---- Moved once more: tools and shared libraries find their data, a static program by the variable.
file(RENAME ${WORK}/moved ${WORK}/again)
check_tool(${WORK}/again)
set(variable "")
if(NOT SHARED)
  set(variable env EXCAVPLAN_DATA=${WORK}/again/share/excavplan)
endif()
alone(${WORK}/again ${variable} ${WORK}/build/controller)
if(NOT output MATCHES "boom")
  message(FATAL_ERROR "after the second move: ${output}")
endif()
file(REMOVE_RECURSE ${WORK})
