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
require("checked copies" "__[a-z]+_chk@")
