# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.24)

# The architecture as a test: run with cmake -D ROOT=<source directory> -P layering.cmake

# The rooms of the library from the ground up, and what each may include of the others beside itself
# and base.
set(rooms base optimisation ground change soil belief machine earth simulation sensing calibration planning
  kit clouds design scans logs efficiency images recording density estimating site job watch trial paper experiments results maps drawing
  figures report robot)
set(base_may_use "")
set(optimisation_may_use "")
set(ground_may_use "")
set(change_may_use ground)
set(soil_may_use ground)
set(belief_may_use optimisation ground soil)
set(machine_may_use "")
set(earth_may_use ground soil)
set(simulation_may_use ground soil machine earth)
set(sensing_may_use ground change soil machine simulation)
set(calibration_may_use ground change soil machine simulation sensing)
set(planning_may_use optimisation ground soil machine simulation)
set(kit_may_use soil machine simulation calibration planning)
set(clouds_may_use ground)
set(design_may_use ground soil machine clouds)
set(scans_may_use ground change machine simulation clouds)
set(logs_may_use machine)
set(efficiency_may_use ground change clouds scans logs)
set(images_may_use clouds scans)
set(recording_may_use clouds scans images)
set(density_may_use ground change soil machine simulation calibration scans logs)
set(estimating_may_use ground soil machine planning design efficiency)
set(site_may_use ground change soil belief machine simulation planning scans density)
set(job_may_use ground soil belief machine simulation planning scans design density site)
set(watch_may_use ground job)
set(trial_may_use
  ground change soil belief machine earth simulation sensing planning clouds scans design density site job)
set(paper_may_use change clouds scans density)
set(experiments_may_use
  ground change soil machine simulation sensing calibration planning scans density)
set(results_may_use ground change soil machine simulation sensing calibration planning kit clouds scans
  efficiency recording density estimating experiments job trial)
set(maps_may_use ground change simulation sensing planning)
set(drawing_may_use ground machine)
set(figures_may_use
  ground change soil machine simulation sensing planning kit density estimating job efficiency experiments results drawing)
set(report_may_use
  ground change machine simulation sensing planning density estimating site job trial results drawing figures)
set(robot_may_use ground soil machine simulation planning kit clouds scans recording density site
  job results)

# The rooms of the tools; what lies in the folder of a tool is its own.
set(tool_rooms frame inputs live)
set(frame_may_use "")
set(inputs_may_use frame)
set(live_may_use frame)

# Where a third-party header may be included: in no public header any of them, and in every benchmark,
# which stands beside its peers.
set(third_parties "pcl/" "nlopt" "nlohmann/" "CLI/"
  "png\\.h" "zlib\\.h" "expat\\.h" "sqlite3\\.h" "lz4frame\\.h" "zstd\\.h" "bzlib\\.h" "boost/")
set(third_party_places
  "^(src/paper/paper_method|tests/paper/paper_method_test|tests/bad_files/bad_files_by_pcl)\\.cpp$"
  "^src/(soil|optimisation)/[a-z_]+\\.cpp$"
  "^(src/base/json\\.hpp|src/.*\\.[ch]pp|tools/.*|tests/.*)$"
  "^tools/frame/command_line\\.cpp$"
  "^src/images/depth_png\\.cpp$"
  "^src/clouds/tiff_coding\\.cpp$"
  "^src/design/land_xml\\.cpp$"
  "^(src/recording/sqlite_recording|tests/recording/containers_test)\\.cpp$"
  "^src/recording/compression\\.cpp$" "^src/recording/compression\\.cpp$"
  "^src/recording/compression\\.cpp$" "^tools/live/page_server\\.cpp$")

function(check_third_parties file line)
  foreach(header place IN ZIP_LISTS third_parties third_party_places)
    if(line MATCHES "[<\"]${header}" AND NOT file MATCHES "^benchmarks/|${place}")
      message(SEND_ERROR "${file}: has no place for: ${line}")
    endif()
  endforeach()
endfunction()

function(check_rooms file line)
  if(NOT file MATCHES "^(include/excavplan|src)/([a-z_]+)/")
    set(room "")
  else()
    set(room ${CMAKE_MATCH_2})
    if(NOT room IN_LIST rooms)
      message(SEND_ERROR "${file}: the folder '${room}' is not a room of the design")
    endif()
  endif()
  if(NOT line MATCHES "(<excavplan/|\")([a-z_/.]+)\\.hpp[>\"]")
    return()
  endif()
  set(header ${CMAKE_MATCH_2})
  if(header MATCHES "^([a-z_]+)/")
    set(used ${CMAKE_MATCH_1})
    if(NOT used STREQUAL room AND NOT used STREQUAL base AND NOT used IN_LIST ${room}_may_use)
      message(SEND_ERROR "${file}: must not use the room ${used}: ${line}")
    endif()
  else()
    message(SEND_ERROR "${file}: include headers by their room: ${line}")
  endif()
endfunction()

# A module is a source with its headers, public and private: none reaches itself by its includes.
# collect_uses(FILE LINE): notes the module that the line includes as used by that of the file.
function(module_of file result)
  string(REGEX REPLACE "^(include/excavplan|src)/|\\.[a-z]+$" "" module "${file}")
  set(${result} "${module}" PARENT_SCOPE)
endfunction()
function(collect_uses file line)
  if(line MATCHES "<excavplan/([a-z0-9_/]+)\\.hp?p?>|\"([a-z0-9_/]+)\\.hpp\"")
    set(used "${CMAKE_MATCH_1}${CMAKE_MATCH_2}")
    if(EXISTS ${ROOT}/tools/${used}.hpp)
      set(used tools/${used})
    endif()
    module_of(${file} module)
    if(NOT used STREQUAL module)
      set_property(GLOBAL APPEND PROPERTY uses:${module} ${used})
      set_property(GLOBAL APPEND PROPERTY modules ${module})
    endif()
  endif()
endfunction()
# walk(MODULE trail...): fails where a module on the trail to it is met again.
function(walk module)
  if(module IN_LIST ARGN)
    list(FIND ARGN ${module} start)
    list(SUBLIST ARGN ${start} -1 circle)
    list(JOIN circle " -> " circle)
    message(SEND_ERROR "a circle of modules: ${circle} -> ${module}")
    return()
  endif()
  get_property(is_walked GLOBAL PROPERTY walked:${module})
  if(is_walked)
    return()
  endif()
  get_property(all GLOBAL PROPERTY uses:${module})
  list(REMOVE_DUPLICATES all)
  foreach(used IN LISTS all)
    walk(${used} ${ARGN} ${module})
  endforeach()
  set_property(GLOBAL PROPERTY walked:${module} TRUE)
endfunction()

# Of the tools a file includes the rooms below its own, a tool all of them and no other tool.
function(check_tool_rooms file line)
  string(REGEX MATCH "^tools/([a-z_]+)/" folder ${file})
  set(room ${CMAKE_MATCH_1})
  if(NOT line MATCHES "\"([a-z_]+)/([a-z_]+)\\.hpp\"")
    return()
  endif()
  set(used ${CMAKE_MATCH_1})
  if(used STREQUAL room OR NOT IS_DIRECTORY ${ROOT}/tools/${used})
    return()
  elseif(NOT used IN_LIST tool_rooms OR (room IN_LIST tool_rooms AND NOT used IN_LIST ${room}_may_use))
    message(SEND_ERROR "${file}: must not use the room ${used} of the tools: ${line}")
  endif()
endfunction()

# The library answers by values and exceptions: it prints nothing, never ends the program and knows no
# options of a command line.
function(check_manners file)
  file(STRINGS ${ROOT}/${file} lines
    REGEX "(^|[^a-zA-Z_])(std::)?(cout|cerr|clog|printf|fprintf|puts|perror|abort|exit|_Exit|quick_exit|terminate)($|[^a-zA-Z_])")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "//.*$" "" code "${line}")
    string(REGEX REPLACE "\"[^\"]*\"" "" code "${code}")
    if(code MATCHES "(cout|cerr|clog)($|[^a-zA-Z_])|(^|[^a-zA-Z_])[f]?(printf|puts|perror|abort|exit|_Exit|quick_exit|terminate) *\\(")
      message(SEND_ERROR "${file}: the library neither prints nor exits: ${line}")
    endif()
  endforeach()
  # "JSON of a tool --json" is where a file is from, --filters and --writers are of pdal.
  file(STRINGS ${ROOT}/${file} lines REGEX "\"[^\"]*--[a-z][a-z-]+[^\"]*\"")
  list(FILTER lines EXCLUDE REGEX "--json\"|--(filters|writers)|^ *//")
  foreach(line IN LISTS lines)
    message(SEND_ERROR "${file}: names an option of the tools, which these say of `its_name`: ${line}")
  endforeach()
endfunction()

file(GLOB_RECURSE sources RELATIVE ${ROOT}
  ${ROOT}/include/*.hpp ${ROOT}/src/*.hpp ${ROOT}/src/*.cpp ${ROOT}/tools/*.hpp ${ROOT}/tools/*.cpp
  ${ROOT}/tests/*.hpp ${ROOT}/tests/*.cpp ${ROOT}/benchmarks/*.cpp ${ROOT}/examples/*.cpp
  ${ROOT}/python/src/*.cpp ${ROOT}/python/src/*.hpp)
list(LENGTH sources count)
if(count LESS 30)
  message(SEND_ERROR "only ${count} source files under '${ROOT}': nothing was checked")
endif()

foreach(file IN LISTS sources)
  file(STRINGS ${ROOT}/${file} includes REGEX "^ *# *include")
  foreach(line IN LISTS includes)
    check_third_parties(${file} "${line}")
    if(file MATCHES "^(include|src)/")
      check_rooms(${file} "${line}")
    endif()
    if(file MATCHES "^tools/")
      check_tool_rooms(${file} "${line}")
    endif()
    if(file MATCHES "^(include|src|tools)/")
      collect_uses(${file} "${line}")
    endif()
  endforeach()
  if(file MATCHES "^(include|src)/")
    check_manners(${file})
  endif()
  file(STRINGS ${ROOT}/${file} head LIMIT_COUNT 2)
  if(NOT head MATCHES "SPDX-FileCopyrightText: .*;.*SPDX-License-Identifier: Apache-2.0")
    message(SEND_ERROR "${file}: lacks its two SPDX lines")
  endif()
endforeach()

get_property(modules GLOBAL PROPERTY modules)
list(REMOVE_DUPLICATES modules)
list(LENGTH modules count)
if(count LESS 200)
  message(SEND_ERROR "only ${count} modules with includes: no circle was looked for")
endif()
foreach(module IN LISTS modules)
  walk(${module})
endforeach()
