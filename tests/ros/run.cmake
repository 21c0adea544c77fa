# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.24)

# The nodes of ROS 1: installs BUILD, a build of SOURCE, builds ros/ros1/excavplan_ros against it with
# catkin and runs master_test.py, which starts a master. Skipped where ROS 1 is not installed.

function(run)
  execute_process(COMMAND ${ARGV} WORKING_DIRECTORY ${WORK}
    OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\n${output}\nended with ${result}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(python /usr/bin/python3)
execute_process(COMMAND ${python} -c
    "import rospy, actionlib, rosmaster, roslaunch, genmsg, gencpp, catkin, em, sensor_msgs.msg, tf2_msgs.msg, trajectory_msgs.msg"
  OUTPUT_QUIET ERROR_VARIABLE missing RESULT_VARIABLE result)
if(NOT result EQUAL 0 OR NOT EXISTS /usr/bin/roscore OR NOT EXISTS /usr/include/ros/ros.h
   OR NOT EXISTS /usr/include/actionlib/server/simple_action_server.h)
  message(STATUS "skipped: ROS 1 is not installed, see the ros packages of scripts/packages-check-all.txt ${missing}")
  return()
endif()

string(SHA1 name ${BUILD})
set(WORK /tmp/excavplan-ros-${name})
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/excavplan --component Development)
if(SHARED)
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/excavplan --component Runtime)
endif()
run(${CMAKE_COMMAND} -S ${SOURCE}/ros/ros1/excavplan_ros -B ${WORK}/build -D CMAKE_BUILD_TYPE=Release
  -D CMAKE_PREFIX_PATH=${WORK}/excavplan -D PYTHON_EXECUTABLE=${python}
  -D CATKIN_ENABLE_TESTING=OFF -D CMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
run(${CMAKE_COMMAND} -E env --unset=LD_PRELOAD
  ${python} -B ${SOURCE}/tests/ros/master_test.py
  ${WORK}/build/devel/lib/excavplan_ros
  ${WORK}/build/devel/lib/python3/dist-packages
  ${BUILD}/bin ${SOURCE}/data)
message(STATUS "${output}")
file(REMOVE_RECURSE ${WORK})
