# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# What excavplan_recordings reads recordings with. Each library is left out where it is not found or
# EXCAVPLAN_WITH_<NAME> is OFF; a build without one says so when it meets a file that needs it.

# excavplan_recordings_with(NAME header library)
function(excavplan_recordings_with name header library)
  option(EXCAVPLAN_WITH_${name} "Read recordings that need ${library}, where it is found" ON)
  find_path(EXCAVPLAN_${name}_INCLUDE ${header})
  find_library(EXCAVPLAN_${name}_LIBRARY ${library})
  mark_as_advanced(EXCAVPLAN_${name}_INCLUDE EXCAVPLAN_${name}_LIBRARY)
  if(NOT EXCAVPLAN_WITH_${name})
    return()
  elseif(NOT EXCAVPLAN_${name}_INCLUDE OR NOT EXCAVPLAN_${name}_LIBRARY)
    message(STATUS "excavplan::recordings without ${library}, which was not found")
    return()
  endif()
  # By its name for those who link an installed static library.
  target_link_libraries(excavplan_recordings PRIVATE
    $<BUILD_INTERFACE:${EXCAVPLAN_${name}_LIBRARY}> $<INSTALL_INTERFACE:${library}>)
  target_include_directories(excavplan_recordings PRIVATE
    $<BUILD_INTERFACE:${EXCAVPLAN_${name}_INCLUDE}>)
  target_compile_definitions(excavplan_recordings PRIVATE EXCAVPLAN_WITH_${name})
  set_property(TARGET excavplan_recordings APPEND PROPERTY EXCAVPLAN_LINKS -l${library})
endfunction()

excavplan_recordings_with(SQLITE3 sqlite3.h sqlite3)
excavplan_recordings_with(LZ4 lz4frame.h lz4)
excavplan_recordings_with(ZSTD zstd.h zstd)
excavplan_recordings_with(BZ2 bzlib.h bz2)
