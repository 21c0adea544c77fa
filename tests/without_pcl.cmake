# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.24)

# Without PCL the paper's own method is left out, and nothing else: configures SOURCE into BUILD as on
# a machine that has neither PCL nor what compressed recordings need, and compares the targets.

function(run)
  execute_process(COMMAND ${ARGV} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${BUILD})
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE} -B ${BUILD} -D CMAKE_CXX_COMPILER=${CXX}
  -D EXCAVPLAN_TESTS=ON -D EXCAVPLAN_TOOLS=ON -D CMAKE_DISABLE_FIND_PACKAGE_PCL=ON
  -D EXCAVPLAN_WITH_SQLITE3=OFF -D EXCAVPLAN_WITH_LZ4=OFF -D EXCAVPLAN_WITH_ZSTD=OFF
  -D EXCAVPLAN_WITH_BZ2=OFF)
if(NOT output MATCHES "without excavplan::paper.*libpcl-dev")
  message(SEND_ERROR "nothing is said of what is left out:\n${output}")
endif()
run(${CMAKE_COMMAND} --build ${BUILD} --target help)
foreach(target excavplan_planning excavplan_clouds excavplan_recordings excavplan_images
    excavplan_survey excavplan_robot calibrate-density simulate-dig plan-path build-path-library
    machine-kit run-experiment measure-efficiency inspect-cloud estimate-density depth-to-cloud)
  if(NOT output MATCHES "[\n ]${target}(:|\n)")
    message(SEND_ERROR "${target} needs PCL")
  endif()
endforeach()
foreach(target excavplan_paper paper_test)
  if(output MATCHES "[\n ]${target}(:|\n)")
    message(SEND_ERROR "${target} is not left out")
  endif()
endforeach()
file(REMOVE_RECURSE ${BUILD})
