# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.24)

# A program is hardened: cmake -D READELF=... -D PROGRAM=<file> -P hardened.cmake
execute_process(
  COMMAND ${READELF} --wide --file-header --program-headers --dynamic --dyn-syms ${PROGRAM}
  OUTPUT_VARIABLE found COMMAND_ERROR_IS_FATAL ANY)

function(require what pattern)
  if(NOT found MATCHES "${pattern}")
    message(SEND_ERROR "${PROGRAM}: ${what}: nothing matches '${pattern}'")
  endif()
endfunction()

require("loaded at a random address" "Type: +DYN")
require("read-only relocations" "GNU_RELRO")
require("no symbols bound late" "BIND_NOW|FLAGS_1.*NOW")
require("no code on the stack" "GNU_STACK[^\n]* RW +0x")
require("guarded stack frames" "__stack_chk_fail")

# Not every program copies what has to be checked at run time: that the compiler checks is in its
# command lines.
file(STRINGS ${COMMANDS} commands
  REGEX "\"command\": .* -c .*(/(src|tools)/[^ ]*\\.cpp|/Unity/unity_[^ ]*_cxx\\.cxx)")
if(NOT commands)
  message(SEND_ERROR "${COMMANDS}: no command compiles a file of src or tools")
endif()
foreach(command IN LISTS commands)
  if(NOT command MATCHES "-D_FORTIFY_SOURCE=2" OR NOT command MATCHES "-D_GLIBCXX_ASSERTIONS")
    message(SEND_ERROR "copies or containers are not checked: ${command}")
  endif()
endforeach()
