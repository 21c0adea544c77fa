# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.24)

# Sizes and tidiness as a test: run with cmake -D ROOT=<source directory> -P house.cmake

# No header and no program file is longer than this.
set(most_lines 150)

file(GLOB_RECURSE headers RELATIVE ${ROOT}
  ${ROOT}/include/*.hpp ${ROOT}/src/*.hpp ${ROOT}/tools/*.hpp)
file(GLOB programs RELATIVE ${ROOT} ${ROOT}/examples/*.cpp)
file(GLOB folders RELATIVE ${ROOT}/tools LIST_DIRECTORIES true ${ROOT}/tools/*)
foreach(folder IN LISTS folders)
  if(EXISTS ${ROOT}/tools/${folder}/${folder}.cpp)
    list(APPEND programs tools/${folder}/${folder}.cpp)
  endif()
endforeach()
foreach(file IN LISTS headers programs)
  file(READ ${ROOT}/${file} text)
  string(REGEX REPLACE "[^\n]" "" text "${text}")
  string(LENGTH "${text}" count)
  if(count GREATER most_lines)
    message(SEND_ERROR "${file}: ${count} lines, at most ${most_lines} are allowed")
  endif()
endforeach()

# A type of the library's namespace has one definition: of two that are linked into one program one
# would take the other's members.
set(types "")
foreach(file IN LISTS headers)
  if(file MATCHES "^(include|src)/")
    file(STRINGS ${ROOT}/${file} lines REGEX "^(struct|class|enum class) [A-Za-z0-9]+( final)?( :.*)? {")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^(struct|class|enum class) ([A-Za-z0-9]+).*" "\\2" type "${line}")
      if(type IN_LIST types)
        message(SEND_ERROR "${file}: ${type} is the name of a type of another header too")
      endif()
      list(APPEND types ${type})
    endforeach()
  endif()
endforeach()

# The version is that of project() wherever else it stands.
file(STRINGS ${ROOT}/CMakeLists.txt line REGEX "^project\\(excavplan VERSION ")
string(REGEX MATCH "[0-9]+[.][0-9]+[.][0-9]+" version "${line}")
foreach(place "CITATION.cff|^version: " "ros/ros1/excavplan_ros/package.xml|<version>"
    "ros/ros2/excavplan_ros/package.xml|<version>")
  string(REPLACE "|" ";" place ${place})
  list(GET place 0 file)
  list(GET place 1 mark)
  if(EXISTS ${ROOT}/${file})
    file(STRINGS ${ROOT}/${file} stated REGEX "${mark}")
    if(NOT stated MATCHES "${mark}\"?${version}(\"|<|$)")
      message(SEND_ERROR "${file}: '${stated}', but the version is ${version}")
    endif()
  endif()
endforeach()

# check_table(FILE WHAT names...): the tables of FILE have a row `NAME` of each and of no other.
function(check_table file what)
  file(STRINGS ${ROOT}/${file} table REGEX "^\\| `[a-z-]+` \\|")
  list(TRANSFORM table REPLACE "^\\| `([a-z-]+)`.*" "\\1")
  list(SORT table)
  list(SORT ARGN)
  if(NOT ARGN STREQUAL table)
    message(SEND_ERROR "${file}: a table of the ${what} ${table}, but there are ${ARGN}")
  endif()
endfunction()

# The tools are those of the table in the README, and where they are counted, as many.
file(STRINGS ${ROOT}/tools/CMakeLists.txt tools REGEX "^ *excavplan_tool\\([a-z]")
list(TRANSFORM tools REPLACE "^ *excavplan_tool\\(([a-z-]+).*" "\\1")
list(REMOVE_DUPLICATES tools)
check_table(README.md tools ${tools})
list(LENGTH tools count)
set(words zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen)
list(GET words ${count} count)
foreach(place "README.md|${count} command line tools" "docs/ecosystem.md|${count} tools"
    "docs/paper.md|${count} [tools](../README.md#tools)")
  string(REPLACE "|" ";" place ${place})
  list(GET place 0 file)
  list(GET place 1 stated)
  file(READ ${ROOT}/${file} text)
  string(FIND "${text}" "${stated}" found)
  if(found EQUAL -1)
    message(SEND_ERROR "${file}: does not say '${stated}'")
  endif()
endforeach()

# The checks of scripts/check-all are those of the table in docs/generated/checks.md.
file(GLOB checks RELATIVE ${ROOT}/scripts/check.d ${ROOT}/scripts/check.d/*)
list(TRANSFORM checks REPLACE "^[0-9]+-" "")
list(APPEND checks test)
check_table(docs/generated/checks.md checks ${checks})

# Fuzz targets and mutations are as many as docs/reliability.md says.
file(GLOB targets ${ROOT}/tests/fuzz/corpus/*)
file(READ ${ROOT}/tests/mutation/mutations.tsv text)
string(REGEX MATCHALL "\n(src|include|tools)/" mutations "${text}")
file(READ ${ROOT}/docs/reliability.md text)
list(LENGTH targets count)
if(NOT text MATCHES "`tests/fuzz` has ${count} targets ")
  message(SEND_ERROR "docs/reliability.md: states another number of fuzz targets than ${count}")
endif()
list(LENGTH mutations count)
if(NOT text MATCHES "`mutations`: ${count} small faults ")
  message(SEND_ERROR "docs/reliability.md: states another number of mutations than ${count}")
endif()

# Every text file names its copyright and licence, or lies where one statement covers the folder.
file(GLOB_RECURSE licensed RELATIVE ${ROOT} ${ROOT}/src/* ${ROOT}/include/* ${ROOT}/tools/*
  ${ROOT}/tests/*.cpp ${ROOT}/tests/*.hpp ${ROOT}/tests/*.py ${ROOT}/tests/*.cmake ${ROOT}/cmake/*
  ${ROOT}/examples/*.cpp ${ROOT}/examples/*.py ${ROOT}/python/*.py ${ROOT}/python/*.cpp
  ${ROOT}/ros/*.cpp ${ROOT}/ros/*.hpp ${ROOT}/ros/*.py ${ROOT}/benchmarks/*.cpp)
file(GLOB scripts RELATIVE ${ROOT} ${ROOT}/scripts/* ${ROOT}/scripts/check.d/*)
file(GLOB templates RELATIVE ${ROOT} ${ROOT}/scripts/docs.d/templates/*)
foreach(file IN LISTS licensed scripts templates)
  if(IS_DIRECTORY ${ROOT}/${file} OR file MATCHES "^tools.*[.]html$|[.](txt|js|css|json|pc.in|map|part.*)$")
    continue()
  endif()
  file(READ ${ROOT}/${file} head LIMIT 400)
  if(NOT head MATCHES "SPDX-License-Identifier: [A-Za-z0-9.-]+( -->| [*]/)?\n")
    message(SEND_ERROR "${file}: no SPDX-License-Identifier in its first lines")
  endif()
endforeach()

# Code that was commented out: a comment that is a statement, a brace or a preprocessor line.
string(CONCAT code
  "#(include|if|endif|define)|};?$|.*{$|.*\\);$|(if|for|while) \\(.*;$|[a-z_.]+ [-+*/]?= .*;$|"
  "(return|const|auto|double|int|bool|std::)[^.]*;$")
file(GLOB_RECURSE sources RELATIVE ${ROOT}
  ${ROOT}/include/*.hpp ${ROOT}/src/*.[ch]pp ${ROOT}/tools/*.[ch]pp ${ROOT}/tests/*.[ch]pp
  ${ROOT}/benchmarks/*.[ch]pp ${ROOT}/examples/*.cpp ${ROOT}/python/src/*.[ch]pp
  ${ROOT}/ros/*.[ch]pp)
list(LENGTH sources count)
if(count LESS 150)
  message(SEND_ERROR "only ${count} source files under '${ROOT}': nothing was checked")
endif()
foreach(file IN LISTS sources)
  file(STRINGS ${ROOT}/${file} comments REGEX "^ *//[^/!]")
  foreach(line IN LISTS comments)
    if(line MATCHES "// *(${code})")
      message(SEND_ERROR "${file}: commented-out code: ${line}")
    endif()
  endforeach()
endforeach()

# Sources of a folder are compiled at once: a constant of one would hide that of a header from others.
set(constant "^(inline )?constexpr [A-Za-z0-9_:<>, *]+ ([a-z][a-z0-9_]*)( =|\\[|{).*")
set(constants "")
foreach(file IN LISTS headers)
  file(STRINGS ${ROOT}/${file} lines REGEX "${constant}")
  list(TRANSFORM lines REPLACE "${constant}" "\\2")
  list(APPEND constants ${lines})
endforeach()
# check_hidden(FILE NAME): no other source beside FILE means the constant NAME of a header.
function(check_hidden file name)
  cmake_path(GET file PARENT_PATH folder)
  file(GLOB others RELATIVE ${ROOT} ${ROOT}/${folder}/*.cpp)
  list(REMOVE_ITEM others ${file})
  foreach(other IN LISTS others)
    file(STRINGS ${ROOT}/${other} uses REGEX "(^|[^A-Za-z0-9_.])${name}([^A-Za-z0-9_]|$)")
    if(uses)
      message(SEND_ERROR "${file}: ${name} is a constant of a header, which ${other} may mean")
    endif()
  endforeach()
endfunction()
file(GLOB_RECURSE united RELATIVE ${ROOT} ${ROOT}/src/*.cpp ${ROOT}/tools/*.cpp)
foreach(file IN LISTS united)
  file(STRINGS ${ROOT}/${file} lines REGEX "${constant}")
  list(TRANSFORM lines REPLACE "${constant}" "\\2")
  foreach(name IN LISTS lines)
    if(name IN_LIST constants)
      check_hidden(${file} ${name})
    endif()
  endforeach()
endforeach()

# Shared libraries export what is demangled to excavplan::. The name of a function template begins with
# a type instead.
foreach(file IN LISTS sources)
  file(STRINGS ${ROOT}/${file} lines REGEX "^template [a-z][A-Za-z0-9_:]* [a-z_]+(<.*>)?\\(")
  foreach(line IN LISTS lines)
    message(SEND_ERROR "${file}: a function template is instantiated for others: ${line}")
  endforeach()
endforeach()

# No file and no environment variable makes excavplan start a program or load code (SECURITY.md); of
# the options --simulator does, by plugin_simulator.cpp, and --simulator-command, by
# child_process.cpp.
foreach(file IN LISTS sources)
  if(file MATCHES "^(include|src|tools)/")
    file(STRINGS ${ROOT}/${file} calls
      REGEX "(^|[^a-z_.>])(system|popen|exec[lv][pe]*|posix_spawnp?|dlopen|fork) *\\(")
    if(file STREQUAL "src/simulation/plugin_simulator.cpp")
      list(FILTER calls EXCLUDE REGEX "::dlopen\\(")
    elseif(file STREQUAL "src/base/child_process.cpp")
      list(FILTER calls EXCLUDE REGEX "::(fork|execvp)\\(")
    endif()
    foreach(line IN LISTS calls)
      message(SEND_ERROR "${file}: starts a program or loads code: ${line}")
    endforeach()
  endif()
endforeach()
