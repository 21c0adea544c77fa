# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.24)

# The nodes of ROS 2, which Debian does not have: their syntax against the headers of SOURCE and those
# that stub_headers.py writes. With a name misspelt one must not compile. What reads their parameters is
# run.

set(folder ${SOURCE}/ros/ros2/excavplan_ros/src)
function(compile file result)
  execute_process(
    COMMAND ${CXX} -std=c++17 -fsyntax-only -Wall -Wextra -Werror -isystem ${WORK}
      -I ${SOURCE}/include -I ${SOURCE}/ros/ros2/excavplan_ros/src -isystem ${EIGEN} ${file}
    RESULT_VARIABLE code ERROR_VARIABLE errors)
  set(${result} ${code} PARENT_SCOPE)
  set(errors "${errors}" PARENT_SCOPE)
endfunction()

execute_process(COMMAND ${PYTHON} -B ${SOURCE}/tests/ros/stub_headers.py
  ${SOURCE}/ros/ros2/excavplan_ros ${WORK} COMMAND_ERROR_IS_FATAL ANY)
foreach(node excavplan_node excavplan_job_node)
  compile(${folder}/${node}.cpp result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${node}:\n${errors}")
  endif()
endforeach()
file(READ ${folder}/excavplan_job_node.cpp text)
string(REPLACE "goal->canceled(result)" "goal->cancelled(result)" text "${text}")
file(WRITE ${WORK}/wrong.cpp "${text}")
compile(${WORK}/wrong.cpp result)
if(result EQUAL 0)
  message(FATAL_ERROR "the stubs take a name that they do not have")
endif()
execute_process(
  COMMAND ${CXX} -std=c++17 -Wall -Wextra -Werror -isystem ${WORK}
    -I ${SOURCE}/ros/ros2/excavplan_ros/src ${SOURCE}/tests/ros/parameters_test.cpp
    -o ${WORK}/parameters_test
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/parameters_test COMMAND_ERROR_IS_FATAL ANY)
# Both packages offer the same services and the same action.
foreach(offer srv/DigAndPlan.srv srv/Estimate.srv srv/Plan.srv srv/StepDone.srv action/DoStep.action)
  file(READ ${SOURCE}/ros/ros1/excavplan_ros/${offer} one)
  file(READ ${SOURCE}/ros/ros2/excavplan_ros/${offer} two)
  if(NOT one STREQUAL two)
    message(SEND_ERROR "${offer} differs between ros1 and ros2")
  endif()
endforeach()
