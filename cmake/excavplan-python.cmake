# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# The Python module, where pybind11 and the development files of Python are found (AUTO), always
# (ON) or never (OFF).

set(EXCAVPLAN_PYTHON AUTO CACHE STRING "Build the Python module: AUTO, ON or OFF")
set_property(CACHE EXCAVPLAN_PYTHON PROPERTY STRINGS AUTO ON OFF)
set(excavplan_python_lacks "")
if(NOT EXCAVPLAN_PYTHON)
  set(excavplan_python_lacks "EXCAVPLAN_PYTHON=ON")
else()
  find_package(Python 3.9 COMPONENTS Interpreter Development.Module)
  find_package(pybind11 2.10 CONFIG QUIET)
  if(NOT Python_Development.Module_FOUND)
    set(excavplan_python_lacks "the development files of Python (python3-dev)")
  elseif(NOT pybind11_FOUND)
    set(excavplan_python_lacks "pybind11 (pybind11-dev)")
  endif()
endif()
if(NOT excavplan_python_lacks)
  add_subdirectory(python)
elseif(EXCAVPLAN_PYTHON AND NOT EXCAVPLAN_PYTHON STREQUAL "AUTO")
  message(FATAL_ERROR "the Python module needs ${excavplan_python_lacks}")
elseif(EXCAVPLAN_PYTHON)
  message(STATUS "without the Python module, which needs ${excavplan_python_lacks}")
endif()
if(EXCAVPLAN_TESTS)
  add_subdirectory(tests/python)
endif()
