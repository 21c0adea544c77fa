# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.24)

# Every link in the documents and every docs/... reference in code, data and scripts leads to a file
# and, after '#', to a heading in it. Every path that a document writes as `folder/file.ext` exists.
# Run with cmake -D ROOT=<source directory> -P links.cmake

# Anchors of the headings of a Markdown file, as GitHub forms them.
function(anchors_of file result)
  get_property(anchors GLOBAL PROPERTY anchors:${file})
  if(NOT anchors)
    file(STRINGS ${file} headings REGEX "^#+ ")
    foreach(heading IN LISTS headings)
      string(REGEX REPLACE "^#+ +" "" anchor "${heading}")
      string(TOLOWER "${anchor}" anchor)
      string(REGEX REPLACE "[^a-z0-9 _-]" "" anchor "${anchor}")
      string(REPLACE " " "-" anchor "${anchor}")
      list(APPEND anchors "${anchor}")
    endforeach()
    set_property(GLOBAL PROPERTY anchors:${file} "${anchors}")
  endif()
  set(${result} "${anchors}" PARENT_SCOPE)
endfunction()

# `link` is path, path#anchor or #anchor, relative to `folder`; `file` is where it stands.
function(check_link file folder link)
  math(EXPR links "${links} + 1")
  set(links ${links} PARENT_SCOPE)
  string(REGEX MATCH "^([^#]*)#?(.*)$" whole "${link}")
  set(path "${CMAKE_MATCH_1}")
  set(anchor "${CMAKE_MATCH_2}")
  if(path STREQUAL "")
    set(target ${ROOT}/${file})
  else()
    cmake_path(ABSOLUTE_PATH path BASE_DIRECTORY ${folder} NORMALIZE OUTPUT_VARIABLE target)
  endif()
  if(NOT EXISTS ${target})
    message(SEND_ERROR "${file}: no such file: ${link}")
  elseif(NOT anchor STREQUAL "")
    anchors_of(${target} anchors)
    if(NOT anchor IN_LIST anchors)
      message(SEND_ERROR "${file}: no such heading: ${link}")
    endif()
  endif()
endfunction()

# Reads a file without the characters that CMake's lists do not survive: "[text](link)" is then
# "text<link>(link)".
function(read_plain file result)
  file(READ ${ROOT}/${file} text)
  string(REPLACE "](" "<link>(" text "${text}")
  string(REGEX REPLACE "[][;\\]" "\n" text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

file(GLOB pages RELATIVE ${ROOT} ${ROOT}/*.md ${ROOT}/docs/*.md ${ROOT}/docs/guide/*.md
  ${ROOT}/docs/generated/*.md ${ROOT}/data/*.md)
file(GLOB_RECURSE sources RELATIVE ${ROOT}
  ${ROOT}/include/*.hpp ${ROOT}/src/*.[ch]pp ${ROOT}/tools/*.[ch]pp ${ROOT}/tests/*.[ch]pp
  ${ROOT}/benchmarks/*.cpp ${ROOT}/examples/*.cpp ${ROOT}/data/*.json ${ROOT}/scripts/*)
set(links 0)

foreach(page IN LISTS pages)
  cmake_path(GET page PARENT_PATH folder)
  read_plain(${page} text)
  string(REGEX MATCHALL "<link>\\([^) \n]+\\)" matches "${text}")
  foreach(match IN LISTS matches)
    string(REGEX REPLACE "<link>|[()]" "" link "${match}")
    if(NOT link MATCHES "^[a-z]+:")
      check_link(${page} ${ROOT}/${folder} ${link})
    endif()
  endforeach()
  string(REGEX MATCHALL
    "`(include|src|tools|tests|benchmarks|examples|data|docs|scripts|cmake)/[a-zA-Z0-9_./-]+\\.[a-z]+`"
    matches "${text}")
  foreach(match IN LISTS matches)
    string(REPLACE "`" "" link ${match})
    check_link(${page} ${ROOT} ${link})
  endforeach()
  # Headers may be named as they are included, by their room.
  string(REGEX MATCHALL "`[a-z]+/[a-z_]+\\.hpp`" matches "${text}")
  foreach(match IN LISTS matches)
    string(REPLACE "`" "" link ${match})
    if(NOT link MATCHES "^(tools|tests)/" AND NOT EXISTS ${ROOT}/src/${link})
      check_link(${page} ${ROOT}/include/excavplan ${link})
    endif()
  endforeach()
endforeach()

foreach(source IN LISTS sources)
  read_plain(${source} text)
  string(REGEX MATCHALL "docs/[a-z_]+\\.md(#[a-z0-9-]+)?" matches "${text}")
  foreach(link IN LISTS matches)
    check_link(${source} ${ROOT} ${link})
  endforeach()
endforeach()

if(links LESS 100)
  message(SEND_ERROR "only ${links} links under '${ROOT}': nothing was checked")
endif()
