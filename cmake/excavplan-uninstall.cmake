# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# Removes what `cmake --install` wrote from the build folder BUILD, and the folders of excavplan that
# are empty then. Each component that was installed alone has a list of its own.
file(GLOB manifests ${BUILD}/install_manifest*.txt)
if(NOT manifests)
  message(FATAL_ERROR "${BUILD}/install_manifest*.txt: not found; nothing was installed from this build folder")
endif()

function(remove_with_folders path)
  file(REMOVE ${path})
  message(STATUS "Removed ${path}")
  cmake_path(GET path PARENT_PATH folder)
  while(folder MATCHES "/(lib)?excavplan(-dev|-doc)?(/|$)")
    file(GLOB left LIST_DIRECTORIES true ${folder}/*)
    if(left)
      break()
    endif()
    file(REMOVE_RECURSE ${folder})
    cmake_path(GET folder PARENT_PATH folder)
  endwhile()
endfunction()

foreach(manifest IN LISTS manifests)
  file(STRINGS ${manifest} files)
  foreach(file IN LISTS files)
    set(path "$ENV{DESTDIR}${file}")
    if(EXISTS ${path} OR IS_SYMLINK ${path})
      remove_with_folders(${path})
    endif()
  endforeach()
  file(REMOVE ${manifest})  # what comes to these places later is of others
endforeach()
