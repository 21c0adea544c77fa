# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# What belongs to the tools of an installation beside the programs: their manual pages, made by
# help2man where it is found from what each says of itself, and completion for bash and zsh.

get_property(tools GLOBAL PROPERTY EXCAVPLAN_TOOL_NAMES)

find_program(EXCAVPLAN_HELP2MAN help2man DOC "Makes the manual pages of the tools")
mark_as_advanced(EXCAVPLAN_HELP2MAN)
if(EXCAVPLAN_HELP2MAN AND NOT CMAKE_CROSSCOMPILING)
  set(pages)
  foreach(tool IN LISTS tools)
    set(page ${PROJECT_BINARY_DIR}/man/${tool}.1)
    get_target_property(purpose ${tool} EXCAVPLAN_PURPOSE)
    add_custom_command(OUTPUT ${page}.gz
      COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/man
      COMMAND ${EXCAVPLAN_HELP2MAN} --no-info --section=1 --name=${purpose} --output=${page}
        $<TARGET_FILE:${tool}>
      COMMAND gzip -9nf ${page}
      DEPENDS ${tool} VERBATIM)
    list(APPEND pages ${page}.gz)
  endforeach()
  add_custom_target(manual ALL DEPENDS ${pages})
  install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT Runtime)
endif()

list(JOIN tools " " tools)
configure_file(cmake/completion/excavplan.bash completion/excavplan.bash @ONLY)
configure_file(cmake/completion/_excavplan completion/_excavplan @ONLY)
set(EXCAVPLAN_ZSH_DIR ${CMAKE_INSTALL_DATADIR}/zsh/site-functions CACHE STRING
  "Where the completion for zsh is installed, relative to the prefix: share/zsh/vendor-completions of Debian's own")
install(FILES ${PROJECT_BINARY_DIR}/completion/_excavplan
  DESTINATION ${EXCAVPLAN_ZSH_DIR} COMPONENT Runtime)
# bash looks for a file of the name of the program.
set(bash_folder ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
separate_arguments(tools)
foreach(tool IN LISTS tools)
  install(FILES ${PROJECT_BINARY_DIR}/completion/excavplan.bash DESTINATION ${bash_folder}
    RENAME ${tool} COMPONENT Runtime)
endforeach()
